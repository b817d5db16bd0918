#include <algorithm>
#include <cstdio>
#include <deque>

#include "base/join.h"
#include "base/read_file.h"
#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/models/show.h"
#include "cli/motions/progress.h"
#include "cli/motions/run_info.h"
#include "cli/motions/sweep_folder.h"
#include "cli/motions/sweep_output.h"
#include "cli/outputs.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "ensemble/case_scenario.h"
#include "ensemble/parts/judgement.h"
#include "ensemble/parts/scenarios.h"
#include "ensemble/reduce/reduction_notes.h"
#include "ensemble/request.h"
#include "ensemble/variation.h"
#include "ensemble/with_contacts.h"
#include "modelfile/contacts.h"
#include "result/choose_columns.h"

namespace anholon::cli {

namespace {

// Reads -n, or a number given to --cases; nullopt if neither is given.
std::optional<std::size_t> count_of(const SweepCommand& o) {
  if (o.case_count.empty()) return std::nullopt;
  const auto n = parse_rational(o.case_count);
  if (!n || !n->is_integer() || *n < 1 || *n > static_cast<unsigned long>(Variation::kMostCases))
    throw UsageError{"error: -n takes a number of cases up to " + std::to_string(Variation::kMostCases) + ", not '" +
                     o.case_count + "'\nhint: -n 1000\n"};
  return n->get_num().get_ui();
}

std::string text_of_table(const std::string& path) {
  std::string text, why;
  if (!read_file(path, text, &why))
    throw UsageError{
        "error: --cases: cannot read " + path + ": " + why +
        "\nhint: a CSV or Parquet file whose columns have the names of what varies; -n 1000 is a number of cases\n"};
  return text_of_case_table(std::move(text), path);
}

// Names the cases of the file that --vary case=a,b runs through; other words are left in `words`.
std::vector<std::string> cases_of_file(std::vector<std::string>& words) {
  constexpr std::string_view kName = "case=";
  std::vector<std::string> names;
  bool named = false;
  std::erase_if(words, [&](const std::string& word) {
    if (!word.starts_with(kName)) return false;
    named = true;
    for (const std::string& name : split({word.substr(kName.size())})) names.push_back(name);
    return true;
  });
  if (named) must_name_each_once(names, "--vary");
  return names;
}

// The motions of one model: of the file, or of the file with one of its cases.
struct Part {
  std::string word;  // the name of the case
  SweepCommand asked;
  Reader in;
  std::optional<Variation> variation;
  EnsembleOptions options;
  Scenario scenario;
  Outcome start;
  std::optional<SweepTable> table;
};

// Reads --vary, --cases, -n, --draw and --seed.
Variation variation_of(const SweepCommand& o, const Model& model, const std::shared_ptr<const CaseTable>& table,
                       bool of_cases) {
  Variation v(o.seed, o.draw == "sobol" ? Variation::Draws::sobol : Variation::Draws::random);
  try {
    for (const std::string& word : o.varied) v.add(word, model);
    if (table) v.add(table, model);
  } catch (const MistakeInWord& m) {
    refuse(m, "--vary");
  }
  if (of_cases && v.varied().empty() && o.case_count.empty())
    v.finish_with_one();
  else
    v.finish(count_of(o), "-n");
  return v;
}

Reductions reductions_of(const SweepCommand& o, const Reader& in) {
  Reductions list;
  const std::vector<Contact> moving = o.mode.empty() ? contacts(*in.names) : std::vector<Contact>{};
  try {
    for (const std::string& word : split(o.reduce)) list.add(word, {in.model, in.names}, moving);
  } catch (const MistakeInWord& m) {
    refuse(m, "--reduce");
  }
  return list;
}

// Makes the part ready. Returns false if --show asks for a stage of the derivation instead of a sweep.
bool prepare(Part& p, const std::shared_ptr<const CaseTable>& table) {
  p.in = read(p.asked);
  must_spare_inputs(p.asked, p.in, {p.asked.case_table}, {{"-o", p.asked.output}});
  // Without --mode the contacts change their modes during the motion.
  if (!p.asked.mode.empty()) p.in = in_mode(std::move(p.in), p.asked, "sweep");
  const SweepCommand o = p.asked = with_form(p.asked, p.in);
  p.variation = variation_of(o, *p.in.model, table, !p.word.empty());
  EnsembleOptions& e = p.options;
  e.state = state_choice(o, *p.in.model);
  std::vector<std::string> set;
  for (const std::string& word : split(o.set)) set.push_back(normal_name(word.substr(0, word.find('='))));
  for (const std::string& word : split(o.mode)) set.push_back(normal_name(word.substr(0, word.find('='))));
  must_not_be_given(p.variation->varied(), e.state, set);
  e.varied = p.variation->varied();
  e.state.open_parameters = varied_parameters(e);
  e.cases = p.variation->cases();
  e.numbers = [&variation = *p.variation](std::size_t k) { return EnsembleCase{variation(k), {}}; };
  e.threads = static_cast<std::size_t>(o.threads);
  e.reductions = reductions_of(o, p.in);
  switch_with(contacts(*p.in.names), *p.in.model, e);
  e.identities = identities(*p.in.names);
  p.start = ready(p.in, form(o, *p.in.model), e.state, p.scenario);
  form(o, *p.in.model, Workspace(p.scenario).mechanics.get());
  if (const auto d = not_integrated(*p.in.model)) throw UsageError{print(*d, p.in.source)};
  if (!o.show.empty()) return false;
  if (!p.start.ok()) scenario_of_cases(e, p.scenario);
  if (p.start.ok() && !p.asked.quiet)
    for (const std::string& text : notes_of_formulas(p.scenario, e.reductions)) asker().note(text);
  ask(o.motion, p.scenario, asker(), e);
  try {
    if (o.mode.empty()) move_with(contacts(*p.in.names), p.scenario, e);
  } catch (const Failure& f) {
    throw usage_error(f, p.in.source);
  }
  p.table.emplace(*p.in.model, e);
  if (const std::vector<std::string> names = split(o.columns); !names.empty()) {
    std::vector<std::string> all;
    for (const SweepColumn& c : p.table->available()) all.push_back(c.name);
    p.table->choose(chosen_columns(all, names));
  }
  if (!p.word.empty()) p.table->add_word("case_name");
  p.table->must_tell_columns_apart();
  return true;
}

std::vector<SweepPiece> pieces_of(std::deque<Part>& parts) {
  std::vector<SweepPiece> list;
  for (Part& p : parts) list.push_back({&p.scenario, &p.options, &*p.table, p.word});
  return list;
}

// Returns the names and texts of all data on which the rows depend.
std::vector<std::pair<std::string, std::string>>
asked_of(const RunInfo& info, const SweepCommand& o, const std::deque<Part>& parts, const std::string& table_text) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto add = [&](const std::string& name, const std::string& text) {
    if (!text.empty()) all.emplace_back(name, text);
  };
  // The mode comes first, because messages about differences must name it before the title, which tells it, too.
  if (const auto mode = info.settings.find("mode"); mode != info.settings.end()) add("mode", joined(mode->second, " "));
  add("title", info.title);
  add("model", parts.front().in.source.text);
  for (const Part& p : parts) {
    // Each scenario may have tables of its own; the base files are the same.
    SourceText source = p.in.model->source_text;
    if (&p != &parts.front()) source.others.clear();
    add_files(all, source);
  }
  for (const auto& [name, words] : info.settings)
    if (name != "model_sha256" && name != "error-estimate" && name != "mode") add(name, joined(words, " "));
  add("vary", joined(o.varied, " ")), add("table of cases", table_text), add("n", o.case_count), add("draw", o.draw);
  add("seed", std::to_string(o.seed)), add("reduce", joined(o.reduce, " "));
  return all;
}

// Computes the cases of all parts, one part after the other.
EnsembleReport compute(std::deque<Part>& parts, std::size_t cases, SweepOutput& out, bool quiet) {
  EnsembleReport all;
  Progress progress(quiet, "case", "cases");
  for (Part& p : parts) {
    const std::size_t before = all.done;
    p.options.progress = [&, before](std::size_t done) {
      const std::size_t now = before + done;
      progress(static_cast<double>(now) / static_cast<double>(cases), static_cast<double>(now), now);
    };
    // Stops if the rows cannot be written.
    p.options.cancelled = [&out] { return stop_requested() || out.failed(); };
    out.turn_to(*p.table, p.word);
    add_report(all, ensemble(p.scenario, p.options, out));
    if (!all.outcome.ok()) break;
  }
  return all;
}

}  // namespace

int sweep(const SweepCommand& asked) {
  if (asked.json && names_folder(asked.output))
    throw UsageError{"error: --json is the format of a file, and " + asked.output +
                     " is a folder\nhint: anholon sweep status " + asked.output + " --json tells how far it is\n"};
  const ResultFormat& format = sweep_format(asked.output, asked.json);
  SweepCommand o = asked;
  const std::vector<std::string> names = cases_of_file(o.varied);
  std::shared_ptr<const CaseTable> table;
  std::string table_text;
  if (!o.case_table.empty()) {
    if (o.case_count.empty() && parse_rational(o.case_table))
      o.case_count = o.case_table;
    else
      try {
        table = std::make_shared<const CaseTable>(table_text = text_of_table(o.case_table), o.case_table);
      } catch (const MistakeInWord& m) {
        refuse(m, "--cases");
      }
  }
  std::deque<Part> parts;
  std::size_t cases = 0;
  for (std::size_t k = 0; k < std::max<std::size_t>(names.size(), 1); ++k) {
    Part& p = parts.emplace_back();
    p.asked = o;
    if (!names.empty()) p.word = names[k], p.asked.cases.push_back(names[k]);
    if (!prepare(p, table)) return show(p.asked, p.scenario);
    must_have_columns_of(*parts.front().table, parts.front().word, *p.table, p.word,
                         "--columns chooses those that both have");
    cases += p.options.cases;
  }
  catch_stop(o.output);
  const Part& first = parts.front();
  const auto info_with = [&](const MotionSettings& s) { return run_info(first.asked, first.in, first.scenario, s); };
  const RunInfo info = info_with(merged(o.motion, first.in.model->simulate));
  if (names_folder(o.output))
    // Each scenario has settings of its own, which follow from its name.
    return sweep_into_folder(
        o, {pieces_of(parts), asked_of(names.empty() ? info : info_with(first.asked.motion), asked, parts, table_text),
            cases, parts.size() == 1 ? &*first.variation : nullptr});
  for (const auto& [option, word] :
       {std::pair{"--shard", &o.shard}, {"--chunk", &o.chunk}, {"--refine", &o.refine}, {"--refine-by", &o.refine_by}})
    if (!word->empty())
      throw UsageError{"error: " + std::string(option) + " belongs to a sweep in a folder\nhint: -o falls/\n"};
  SweepOutput out(format, o.output, {info, first.scenario.system.form->name, first.table->columns()});
  const EnsembleReport r = compute(parts, cases, out, o.quiet);
  const std::string write_error = out.close(r);
  if (!o.quiet) report_sweep(r, cases, out);
  report_notes_on_cases(r);
  report_stopped(out.stopped());
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
