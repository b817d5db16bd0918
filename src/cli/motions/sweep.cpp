#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>

#include "base/json.h"
#include "cli/input.h"
#include "cli/models/show.h"
#include "cli/motions/progress.h"
#include "cli/motions/report_text.h"
#include "cli/say.h"
#include "ensemble/request.h"
#include "ensemble/variation.h"
#include "result/format.h"
#include "simulation/report_json.h"

namespace anholon::cli {

namespace {

// Cases that ended in the same way; the first of them is printed.
struct Stopped {
  std::size_t count = 0, first = 0;
  Outcome outcome;
};

std::vector<std::string> header(const Variation& v, const std::vector<std::string>& columns) {
  std::vector<std::string> names = {"case"};
  // A varied initial value is not the final value.
  for (const Varied& each : v.varied())
    names.push_back(each.kind == Varied::Kind::initial ? each.name + "(0)" : each.name);
  names.insert(names.end(), {"outcome", "t"});
  names.insert(names.end(), columns.begin(), columns.end());
  return names;
}

std::string error_json(const CasesError& e) {
  JsonWriter j;
  j.open_object();
  if (!e.error)
    return j.key("digits").null().key("reason").string(e.none.empty() ? "not asked for" : e.none).close().text();
  write_error(j, *e.error);
  j.key("worst_case").integer(static_cast<long long>(e.worst)).key("compared").open_array();
  for (std::size_t k : e.cases) j.integer(static_cast<long long>(k));
  std::string text = j.close().close().text();
  for (std::size_t at = 0; (at = text.find('\n', at)) != std::string::npos; at += 3) text.insert(at + 1, "  ");
  return text;
}

// Hands the cases to the writer of a file, and counts the outcomes of those that stopped.
class Output final : public CaseSink {
 public:
  Output(const ResultFormat& format, const std::string& path, const Scenario& s, const Variation& v,
         const std::vector<std::string>& columns)
      : width_(columns.size()),
        file_(format.open_sweep(path, {s.model->title, s.system.form->name, header(v, columns)})) {
    if (!file_->error().empty()) throw UsageError{"error: " + file_->error() + "\n"};
  }
  void result(const CaseResult& r) override {
    if (!r.outcome.ok()) {
      Stopped& s = stopped_[r.outcome.kind];
      if (s.count++ == 0) s.first = r.number, s.outcome = r.outcome;
    }
    // The numbers that a stopped case does not have are NaN.
    std::vector<double> last = {r.t};
    last.insert(last.end(), r.last.begin(), r.last.end());
    last.resize(1 + width_, std::numeric_limits<double>::quiet_NaN());
    file_->row({r.number, r.values, name(r.outcome.kind), last});
    failed_ = !file_->error().empty();
  }
  // Called by all threads.
  bool failed() const { return failed_; }
  const std::map<OutcomeKind, Stopped>& stopped() const { return stopped_; }
  // Returns an empty string, or the reason why the file could not be written.
  std::string close(const EnsembleReport& report) { return file_->close(json(report)); }

 private:
  std::string json(const EnsembleReport& report) const {
    std::string text = "{\n  \"stopped\": [";
    bool first = true;
    for (const auto& [kind, s] : stopped_) {
      text += std::string(first ? "" : ",") + "\n    {\"outcome\": \"" + name(kind) +
              "\", \"cases\": " + std::to_string(s.count) + ", \"first\": " + std::to_string(s.first) +
              ", \"message\": \"" + json_escape(s.outcome.message) + "\", \"hint\": \"" + json_escape(s.outcome.hint) +
              "\"}";
      first = false;
    }
    return text + (first ? "" : "\n  ") + "],\n  \"error_estimate\": " + error_json(report.error) +
           ",\n  \"cases\": " + std::to_string(report.done) + ",\n  \"finished\": " + std::to_string(report.finished) +
           ",\n  \"outcome\": \"" + name(report.outcome.kind) + "\"\n}";
  }

  std::size_t width_;
  std::unique_ptr<SweepWriter> file_;
  std::atomic<bool> failed_{false};
  std::map<OutcomeKind, Stopped> stopped_;
};

// --vary, -n and --seed.
Variation variation_of(const Options& o, const Model& model) {
  Variation v(o.seed);
  try {
    for (const std::string& word : o.varied) v.add(word, model);
  } catch (const VariationMistake& m) {
    throw UsageError{print(m.diagnostic, SourceText{"--vary", m.word})};
  }
  std::optional<std::size_t> cases;
  if (!o.case_count.empty()) {
    const auto n = parse_rational(o.case_count);
    if (!n || n->get_den() != 1 || *n < 1 || *n > static_cast<unsigned long>(Variation::kMostCases))
      throw UsageError{"error: -n takes a number of cases up to " + std::to_string(Variation::kMostCases) + ", not '" +
                       o.case_count + "'\nhint: -n 1000\n"};
    cases = n->get_num().get_ui();
  }
  v.finish(cases, "-n");
  return v;
}

// The format of the cases: by the name of the file, else --json decides.
const ResultFormat& output_format(const Options& o) {
  const ResultFormat* named = format_of(o.output);
  // A data base is planned.
  const char* unable = o.output.ends_with(".db") ? ".db" : named && !named->open_sweep ? named->endings[0] : nullptr;
  if (unable)
    throw UsageError{"error: " + std::string(unable) +
                     " files are not written yet\nhint: " + known_files("-o cases", sweep_formats()) + "\n"};
  if (o.json) return report_format();
  return named ? *named : plain_format();
}

void report(const EnsembleReport& r, const EnsembleOptions& o, const Output& out) {
  std::string list;
  for (const auto& [kind, s] : out.stopped()) list += ", " + std::to_string(s.count) + " " + name(kind);
  say(stderr, "%zu of %zu cases: %zu finished%s; %.3g s on %zu %s\n", r.done, o.cases, r.finished, list.c_str(),
      r.seconds, r.threads, r.threads == 1 ? "thread" : "threads");
  std::string cases;
  for (std::size_t k : r.error.cases) cases += (cases.empty() ? "" : ", ") + std::to_string(k);
  if (r.error.error)
    say(stderr, "digits to trust%s; %s\n", digits_to_trust(*r.error.error).c_str(),
        r.error.cases.size() == 1
            ? ("of case " + cases).c_str()
            : ("of the cases " + cases + " the worst is " + std::to_string(r.error.worst)).c_str());
  else if (!r.error.none.empty())
    say(stderr, "digits to trust: not estimated, %s\n", r.error.none.c_str());
}

}  // namespace

int sweep(const Options& asked) {
  const ResultFormat& format = output_format(asked);
  const Reader in = read(asked);
  const Options o = with_form(asked, in);
  const Variation variation = variation_of(o, *in.model);
  EnsembleOptions options;
  options.state = state_choice(o, *in.model);
  must_not_be_given(variation.varied(), options.state);
  options.varied = variation.varied();
  options.cases = variation.cases();
  options.numbers = [&](std::size_t k) { return EnsembleCase{variation(k), {}}; };
  options.threads = static_cast<std::size_t>(o.threads);
  Scenario s;
  Outcome start = ready(in, form(o, *in.model), options.state, s);
  form(o, *in.model, Workspace(s).mechanics.get());
  if (const auto d = not_integrated(*in.model)) {
    print_diagnostic(*d, in.source);
    return kBadInput;
  }
  if (!o.show.empty()) return show(o, s);
  ask(merged(o.motion, in.model->simulate), s, asker(o), options);
  if (!start.ok()) start = scenario_of_cases(options, s);
  if (!start.ok()) {
    print_outcome(start);
    return kStopped;
  }
  catch_stop(o.output);
  Output out(format, o.output, s, variation, ensemble_columns(*in.model));
  // Stops if the rows cannot be written.
  options.cancelled = [&] { return stop_requested() || out.failed(); };
  EnsembleReport r;
  {
    Progress progress(o.quiet, "case", "cases");
    options.progress = [&](std::size_t done) {
      progress(static_cast<double>(done) / static_cast<double>(options.cases), static_cast<double>(done), done);
    };
    r = ensemble(s, options, out);
  }
  const std::string write_error = out.close(r);
  if (!o.quiet) report(r, options, out);
  for (const auto& [kind, stopped] : out.stopped())
    say(stderr, "stopped (%s), %zu %s, first case %zu: %s\nhint: %s\n", name(kind), stopped.count,
        stopped.count == 1 ? "case" : "cases", stopped.first, stopped.outcome.message.c_str(),
        stopped.outcome.hint.c_str());
  if (!r.outcome.ok() && (write_error.empty() || stop_requested())) {
    print_outcome(r.outcome);
    if (!o.output.empty() && write_error.empty())
      say(stderr, "the %zu cases before that are in %s\n", r.done, o.output.c_str());
  }
  if (!write_error.empty()) {
    say(stderr, "error: %s\n", write_error.c_str());
    return kBadInput;
  }
  return r.outcome.ok() && r.finished == r.done ? kOk : kStopped;
}

}  // namespace anholon::cli
