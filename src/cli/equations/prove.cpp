#include "proof/prove.h"

#include <chrono>
#include <cstdio>
#include <functional>

#include <unistd.h>

#include "base/json.h"
#include "base/stop.h"
#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/outputs.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "modelfile/hash.h"
#include "result/file.h"

namespace anholon::cli {

namespace {

std::vector<const Formulation*> wanted_forms(const ProveCommand& o, const Mechanics& m) {
  std::vector<const Formulation*> forms;
  const auto order = static_cast<unsigned>(o.m);  // forms without an order m are compared unchanged
  if (o.forms.empty()) {
    for (const Formulation* f : formulations())
      if (obstacle(*f, m).empty() && (!order || f->highest_m == 0 || order_obstacle(*f, m, order).empty()))
        forms.push_back(f);
    return forms;
  }
  for (const std::string& name : split(o.forms)) {
    SystemCommand one = o;
    one.motion.form = name;
    forms.push_back(&form(one, *m.model, &m));
    if (order && forms.back()->highest_m) must_have_order(*forms.back(), m, order);
  }
  return forms;
}

// Throws if the constraints cannot be lifted to the order m. Any forms need this: they are distinguished at points that
// satisfy all lifted constraints.
void must_lift(const Mechanics& m, unsigned order) {
  for (const Formulation* f : formulations())
    if (f->eliminates() && f->highest_m == kHighestM && obstacle(*f, m).empty()) must_have_order(*f, m, order);
}

// One line of cells: = proved, X refuted, ? unknown.
void print_matrix(const Proof& p) {
  std::size_t width = 0;
  for (const FormProof& f : p.forms) width = std::max(width, std::strlen(f.form->name));
  for (std::size_t i = 0; i < p.forms.size(); ++i) {
    say(stdout, "%3zu  %-*s ", i + 1, static_cast<int>(width), p.forms[i].form->name);
    for (std::size_t j = 0; j < p.forms.size(); ++j) {
      const Verdict v = i == j ? Verdict::proved : p.between(i, j);
      say(stdout, " %s", i == j ? "." : v == Verdict::proved ? "=" : v == Verdict::refuted ? "X" : "?");
    }
    say(stdout, "  %s\n", p.forms[i].form->equation[0] ? p.forms[i].form->equation : p.forms[i].form->source);
  }
  say(stdout, "\n=  proved equal    X  shown different    ?  unknown\n");
}

std::string point_text(const WitnessPoint& w, const SymbolNames& names) {
  std::string out;
  for (const auto& [symbol, value] : w.values)
    out += (out.empty() ? "" : ", ") + print(symbol, names, Format::text) + " = " + value.get_str();
  for (const WitnessPoint::Enclosed& e : w.enclosed)
    out += ", " + print(e.symbol, names, Format::text) + " = " + number_text(e.midpoint.get_d(), 6) + "…";
  return out;
}

void print_differences(const Proof& p, const SymbolNames& names) {
  for (const FormProof& f : p.forms)
    for (const Difference& d : f.differences) {
      if (d.verdict == Verdict::proved) continue;
      say(stdout, "%s differs from routh in the equation of %s%s: %s\n", f.form->name, d.component.c_str(),
          d.verdict == Verdict::unknown ? " (perhaps)" : "", d.detail.c_str());
      if (d.witness) say(stdout, "  at %s\n", point_text(*d.witness, names).c_str());
      if (d.verdict == Verdict::refuted) break;  // one point suffices
    }
  if (p.stopped) return;
  for (const Difference& d : p.kernel)
    if (d.verdict != Verdict::proved)
      say(stdout, "not shown: the tangents of the constraints, %s: %s\n", d.component.c_str(), d.detail.c_str());
}

std::string json(const Model& model, const Proof& p, const Certificate& c, const SymbolNames& names, double seconds) {
  JsonWriter j;
  j.open_object().key("model").string(model.title);
  j.key("meaning").string(c.meaning);
  j.key("hypotheses").open_array();
  for (const std::string& h : c.hypotheses) j.string(h);
  j.close();
  j.key("forms").open_array();
  for (const FormProof& f : p.forms) {
    j.open_object()
        .key("name")
        .string(f.form->name)
        .key("against")
        .string("routh")
        .key("verdict")
        .string(name(f.verdict));
    for (const Difference& d : f.differences) {
      if (d.verdict == Verdict::proved) continue;
      j.key("component").string(d.component).key("detail").string(d.detail);
      if (d.witness) j.key("point").string(point_text(*d.witness, names));
      break;
    }
    j.close();
  }
  j.close();
  j.key("pairs").open_array();
  for (std::size_t a = 0; a < p.forms.size(); ++a)
    for (std::size_t b = a + 1; b < p.forms.size(); ++b)
      j.open_object()
          .key("a")
          .string(p.forms[a].form->name)
          .key("b")
          .string(p.forms[b].form->name)
          .key("verdict")
          .string(name(p.between(a, b)))
          .close();
  j.close();
  j.key("seconds").number(number_text(seconds, 3)).close();
  return j.text();
}

// Says, after Ctrl-C, which forms were compared, with their verdicts. As long as the tangents of the constraints are
// not shown, nothing is proved of the forms that rest on them.
int say_stopped(const ProveCommand& o, const Proof& p) {
  say(stderr, "stopped (interrupted): %zu of %zu forms were compared with Routh's equations\n", p.compared,
      p.forms.size());
  const auto list = [&](const char* what, const std::function<bool(std::size_t)>& is) {
    std::string names;
    for (std::size_t k = 0; k < p.compared; ++k)
      if (is(k)) names += std::string(names.empty() ? "" : ", ") + p.forms[k].form->name;
    if (!names.empty()) say(stderr, "%s: %s\n", what, names.c_str());
  };
  for (const Verdict v : {Verdict::proved, Verdict::refuted})
    list(name(v), [&](std::size_t k) { return p.with_routh(k) == v; });
  list("unknown", [&](std::size_t k) { return p.forms[k].verdict == Verdict::unknown; });
  list("compared, but the tangents of the constraints are not shown",
       [&](std::size_t k) { return p.forms[k].verdict != p.with_routh(k); });
  if (!o.output.empty()) say(stderr, "%s was not written: a certificate is of a whole proof\n", o.output.c_str());
  return kStopped;
}

// Computes the proof until Ctrl-C; stores in `eliminations` those that the forms may use.
Proof proof(const ProveCommand& o, const Reader& in, const Mechanics& m, const std::vector<const Formulation*>& forms,
            std::vector<Eliminations>& eliminations) {
  ProofOptions options;
  options.digits = o.digits_of_enclosures;
  const bool terminal = isatty(STDERR_FILENO) != 0 && !o.quiet;
  std::size_t done = 0;
  if (terminal)
    options.progress = [&](const Formulation& f) {
      say(stderr, "\r\033[K%zu of %zu: %s", ++done, forms.size(), f.name);
    };
  const StopScope stop(stop_requested);
  Proof p;
  try {
    eliminations = eliminations_of(in, m, state_choice(o, *in.model), static_cast<unsigned>(o.m));
    p = anholon::prove(m, forms, eliminations, options);
  } catch (const StopRequested&) {
    p.stopped = true;
    for (const Formulation* f : forms) p.forms.push_back({f, Verdict::unknown, {}});
  }
  if (terminal) say(stderr, "\r\033[K");
  return p;
}

void must_be_written(const std::string& why) {
  if (!why.empty()) throw UsageError{"error: " + why + "\n"};
}

}  // namespace

int prove(const ProveCommand& o) {
  const auto start = std::chrono::steady_clock::now();
  const Reader in = in_mode(read(o), o, "prove");
  const Model& model = *in.model;
  must_spare_inputs(o, in, {}, {{"-o", o.output}});
  if (!o.output.empty()) must_be_written(obstacle_to_writing(o.output));
  const Mechanics m = mechanics(model);
  if (o.m) must_lift(m, static_cast<unsigned>(o.m));
  const std::vector<const Formulation*> forms = wanted_forms(o, m);
  catch_stop("");
  std::vector<Eliminations> eliminations;
  const Proof p = proof(o, in, m, forms, eliminations);
  if (p.stopped) return say_stopped(o, p);
  Certificate c = certificate(m, p, eliminations.front(), "anholon " ANHOLON_VERSION, model_hash(in.source));
  add_reading(c, o.cases, split(o.set));
  const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  SymbolNames names = model.names;
  if (eliminations.front().quasi.quasi) names.quasi = eliminations.front().quasi.free.names;
  if (!o.output.empty()) must_be_written(write_whole(o.output, to_json(c) + "\n"));
  if (o.json) {
    hand_out(json(model, p, c, names, seconds) + "\n");
  } else {
    if (!model.title.empty()) say(stdout, "%s\n\n", model.title.c_str());
    print_matrix(p);
    say(stdout, "\n");
    print_differences(p, names);
    for (const std::string& h : c.hypotheses) say(stdout, "given: %s\n", h.c_str());
    say(stdout, "%s\n", c.meaning.c_str());
    if (!o.output.empty()) say(stdout, "certificate: %s (anholon verify %s)\n", o.output.c_str(), o.output.c_str());
  }
  bool unknown = false;
  for (std::size_t a = 0; a < p.forms.size(); ++a)
    for (std::size_t b = a + 1; b < p.forms.size(); ++b) unknown = unknown || p.between(a, b) == Verdict::unknown;
  return unknown ? kStopped : kOk;
}

}  // namespace anholon::cli
