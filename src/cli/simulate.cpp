#include "simulation/simulate.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>

#include "base/hash.h"
#include "cli/input.h"
#include "cli/motion_report.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/run_info.h"
#include "cli/saved.h"
#include "cli/say.h"
#include "cli/show.h"
#include "result/file.h"
#include "result/hdf5_sink.h"
#include "simulation/report_json.h"

namespace anholon::cli {

namespace {

bool is_hdf5(const std::string& path) {
  RunFormat format{};
  return format_of(path, format) && format == RunFormat::hdf5;
}

// Writes the saved runs that --save asks for; stops at the first failure and keeps its message.
class Saver {
 public:
  Saver(const Options& o, const Reader& in, const MotionSettings& settings) : o_(o), in_(in), settings_(settings) {}
  void operator()(SavedRun run) {
    if (!error.empty()) return;
    describe_run(run, o_, in_, settings_);
    error = write_whole(o_.save, print(run));
  }
  std::string error;

 private:
  const Options& o_;
  const Reader& in_;
  const MotionSettings& settings_;
};

SimulationReport run(Workspace& s, const SimulationOptions& options, RowSink& rows, Told* told) {
  try {
    if (!told) return simulate_in(s, options, rows);
    RunSink kept(told->run);
    TwoSinks both(rows, kept);
    return simulate_in(s, options, both);
  } catch (const Failure& e) {
    throw UsageError{"error: " + e.diagnostic.message + "\nhint: " + e.diagnostic.hint + "\n"};
  }
}

// A run that continues in its own file appends its rows to the existing ones; any other file is replaced.
void go_on(Hdf5Sink& rows, const Options& o, const SavedRun& resume, const Reader& in) {
  std::error_code none;
  if (!rows.error().empty() || !resume.has("given") || !std::filesystem::is_regular_file(o.output, none)) return;
  try {
    const RunFile before = read_run(o.output);
    const auto model = before.settings.find("model_sha256");
    const std::vector<double> given = resume.numbers<double>("given", 2);
    const auto count = static_cast<std::size_t>(given[0]);
    if (model == before.settings.end() || model->second != std::vector<std::string>{sha256_text(all_text(in.source))} ||
        before.table.rows() < count)
      return;
    rows.go_on(before, count, static_cast<std::size_t>(given[1]));
    if (!o.quiet) say(stderr, "note: rows are added to the first %zu of %s\n", count, o.output.c_str());
  } catch (const Failure&) {
    // The file holds no run, or is damaged.
  }
}

// The default number of rows for a drawn motion: as many as a page holds without reduction.
int rows_to_look_at(const Mechanics& m) {
  constexpr std::size_t kNumbers = 22000;
  return static_cast<int>(std::clamp<std::size_t>(kNumbers / (4 * m.q.size() + 3 * m.phi.size() + 6), 250, 1000));
}

// Drawn motions have an end and rows where nobody names them.
void settle_drawing(MotionSettings& settings, const Options& o, const Workspace& s) {
  const Rational start(s.state.t);
  if (settings.at.empty() && !settings.to) {
    constexpr int kShown = 10;
    settings.to = start + kShown;
    if (!o.quiet)
      say(stderr,
          "note: nobody says where the motion ends: it is shown up to t = %s; --to T, or [simulate] to = T in the "
          "model file, shows more or less\n",
          number_text(settings.to->get_d()).c_str());
  }
  if (!settings.every && settings.at.empty() && *settings.to != start)
    settings.every = abs(Rational(*settings.to - start)) / rows_to_look_at(*s.mechanics);
}

// JSON is held in memory, and has a lower limit than other formats.
void must_fit_json(const SimulationOptions& asked, const Workspace& s, const Rational& last) {
  constexpr long kMostNumbers = 5'000'000;
  const auto columns = static_cast<long>(1 + 4 * s.system.coordinates + s.system.constraints.size());
  if (asked.every && columns * abs(Rational(last - Rational(s.state.t))) > kMostNumbers * *asked.every)
    throw UsageError{"error: --every asks for more than " + std::to_string(kMostNumbers) +
                     " numbers of JSON\nhint: write HDF5 or CSV: -o run.h5\n"};
}

bool writes_json(const Options& o) { return o.output.ends_with(".json") || (o.json && !is_hdf5(o.output)); }

// All that is asked of the motion of this system. drawn: the motion is for a page or a film alone.
void ask(MotionSettings& settings, const Options& o, const Workspace& s, bool drawn, SimulationOptions& options) {
  if (drawn) settle_drawing(settings, o, s);
  const Rational last = anholon::ask(settings, s, asker(o), options);
  if (options.resume) beyond(*options.resume, o, last);
  if (writes_json(o)) must_fit_json(options, s, last);
  // An event that sets values does not conserve what is an integral between events.
  if (!sets_values(*s.model)) options.conserved = conserved(*s.mechanics);
  settings.tolerance = options.tolerance;
  settings.form = s.system.form->name;
}

// What became of a motion and of the file of its rows.
struct Written {
  SimulationReport report;
  std::string error;  // why the file could not be written; empty if it was
  std::string part;   // where the rows lie that could be written
  bool started = true;
};

// Computes the motion and writes its rows to where the options say.
class Writer {
 public:
  Writer(const Options& o, const Reader& in, Workspace& s, const RunInfo& info, const Outcome& start,
         SimulationOptions& options, Saver& saver, Told* told)
      : o_(o), in_(in), s_(s), info_(info), start_(start), options_(options), saver_(saver), told_(told) {}

  Written write() {
    if (told_ && o_.output.empty()) return keep();
    if (is_hdf5(o_.output)) return hdf5();
    return writes_json(o_) ? json() : csv();
  }

 private:
  Written keep() {
    Written w;
    if (!has_started(w)) return w;
    RunSink rows(told_->run);
    if (!o_.save.empty()) options_.save = std::ref(saver_);
    w.report = run(s_, options_, rows, nullptr);
    return w;
  }

  Written json() {
    Written w;
    RunFile kept;
    RunSink rows(kept);
    GrowingFile file(o_.output);
    if (!file.error().empty()) throw UsageError{"error: " + file.error() + "\n"};
    if (!o_.save.empty()) options_.save = std::ref(saver_);
    if (start_.ok())
      w.report = run(s_, options_, rows, told_);
    else
      w.report.outcome = start_, w.report.t = s_.state.t, w.report.model = s_.model->title,
      w.report.form = s_.system.form->name;
    file.write(run_json(kept.table, w.report));
    w.error = file.close();
    return w;
  }

  Written hdf5() {
    Written w;
    if (!has_started(w)) return w;
    Hdf5Sink rows(o_.output, info_);
    if (options_.resume) go_on(rows, o_, *options_.resume, in_);
    into(rows, w);
    rows.report(report_json(w.report));
    w.error = rows.close();
    if (o_.json) hand_out(report_json(w.report) + "\n");
    return w;
  }

  Written csv() {
    Written w;
    if (!has_started(w)) return w;
    CsvSink rows(o_.output);
    into(rows, w);
    w.error = rows.close();
    w.part = rows.part();
    return w;
  }

  bool has_started(Written& w) const {
    if (start_.ok()) return true;
    print_outcome(start_);
    return w.started = false;
  }

  template <class Rows>
  void into(Rows& rows, Written& w) {
    if (!rows.error().empty()) throw UsageError{"error: " + rows.error() + "\n"};
    // What --save writes is never ahead of the rows.
    if (!o_.save.empty())
      options_.save = [this, &rows](const SavedRun& saved) {
        rows.flush();
        saver_(saved);
      };
    // Rows that cannot be written end the motion.
    options_.cancelled = [&rows] { return stop_requested() || !rows.error().empty(); };
    w.report = run(s_, options_, rows, told_);
  }

  const Options& o_;
  const Reader& in_;
  Workspace& s_;
  const RunInfo& info_;
  const Outcome& start_;
  SimulationOptions& options_;
  Saver& saver_;
  Told* told_;
};

// Says how the motion ended and where its rows are; returns the exit status.
int say_end(const Options& o, const Written& w, const std::string& save_error) {
  const SimulationReport& r = w.report;
  std::string write_error = w.error;
  // A run that is ended because its rows have no place was not interrupted by anybody.
  if (!r.outcome.ok() && (write_error.empty() || stop_requested())) {
    print_outcome(r.outcome);
    if (r.rows > 0 && !o.output.empty() && write_error.empty())
      say(stderr, "the %zu rows before that are in %s\n", r.rows, o.output.c_str());
  }
  if (write_error.empty()) write_error = save_error;
  if (!write_error.empty()) {
    say(stderr, "error: %s\n", write_error.c_str());
    if (!w.part.empty()) say(stderr, "the rows that could be written are in %s\n", w.part.c_str());
    return kBadInput;
  }
  return r.outcome.ok() ? kOk : kStopped;
}

}  // namespace

int simulate_motion(const Options& asked, const SavedRun* resume, Told* told) {
  if (is_hdf5(asked.output) && !has_hdf5())
    throw UsageError{"error: " + std::string(kNoHdf5) + "\nhint: " + kNoHdf5Hint + "\n"};
  Told own;
  Told& all = told ? *told : own;
  all.in = read(asked);
  const Reader& in = all.in;
  const Options o = with_form(asked, in);
  if (resume) same_model(*resume, in);
  SimulationOptions options;
  options.resume = resume;
  options.state = state_choice(o, *in.model);
  Scenario prepared;
  const Outcome start = ready(in, form(o, *in.model), options.state, prepared);
  all.scenario = std::make_unique<Workspace>(prepared);
  Workspace& s = *all.scenario;
  form(o, *in.model, s.mechanics.get());
  if (const auto d = not_integrated(*in.model)) {
    print_diagnostic(*d, in.source);
    return kBadInput;
  }
  if (!o.show.empty()) return show(o, prepared);
  MotionSettings settings = merged(o.motion, in.model->simulate);
  ask(settings, o, s, told && o.output.empty(), options);
  const RunInfo info = run_info(o, in, s, settings);
  Saver saver(o, in, settings);
  if (!o.quiet) options.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  catch_stop(told && o.output.empty() ? o.report : o.output);
  options.cancelled = stop_requested;
  if (told) {
    static_cast<RunInfo&>(told->run) = info;
    told->conserved = options.conserved;
  }
  Written w;
  {
    const double end = options.at.empty() ? options.to->get_d()
                                          : std::max(options.at.back().get_d(),
                                                     options.to ? options.to->get_d() : options.at.back().get_d());
    Progress progress(o.quiet || end == s.state.t, "t", "steps");
    options.progress = [&](double t, std::size_t steps) { progress((t - s.state.t) / (end - s.state.t), t, steps); };
    w = Writer(o, in, s, info, start, options, saver, told).write();
  }
  if (!w.started) return kStopped;
  if (told) told->run.report = report_json(w.report);
  if (!o.quiet && w.report.rows > 0) print_report(s, w.report);
  return say_end(o, w, saver.error);
}

int simulate(const Options& o) {
  SavedRun run;
  Options all = o;
  if (!o.resume.empty()) run = continued(all);
  const SavedRun* resume = o.resume.empty() ? nullptr : &run;
  if (o.report.empty()) return simulate_motion(all, resume, nullptr);
  check_page(all);
  std::deque<Told> cases(1);
  const int code = simulate_motion(all, resume, &cases[0]);
  if (cases[0].run.table.rows() == 0) return code;
  write_page(all, cases);
  return code;
}

}  // namespace anholon::cli
