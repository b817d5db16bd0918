#include "simulation/simulate.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>

#include "cli/input.h"
#include "cli/models/show.h"
#include "cli/motions/motion_report.h"
#include "cli/motions/progress.h"
#include "cli/motions/report.h"
#include "cli/motions/result_file.h"
#include "cli/motions/run_info.h"
#include "cli/motions/saved.h"
#include "cli/outputs.h"
#include "cli/say.h"
#include "cli/stop.h"
#include "contact/hybrid.h"
#include "modelfile/hash.h"
#include "observe/rows/quantity_units.h"
#include "report/columns.h"
#include "report/rows/page_rows.h"
#include "result/file.h"
#include "result/format.h"
#include "simulation/report_json.h"

namespace anholon::cli {

namespace {

// Returns the format that the file name selects. With --json, a format without the report is replaced by that of
// reports.
const ResultFormat& output_format(const SimulateCommand& o) {
  const ResultFormat* named = format_of(o.output);
  if (o.json && (!named || named->holds == Holds::rows)) return report_format();
  return named ? *named : plain_format();
}

// Writes the saved runs for --save; stops at the first failure and keeps its message.
class Saver {
 public:
  Saver(const SimulateCommand& o, const Reader& in, const MotionSettings& settings)
      : o_(o), in_(in), settings_(settings) {}
  void operator()(SavedRun run) {
    if (!error.empty()) return;
    describe_run(run, o_, in_, settings_);
    error = write_whole(o_.save, print(run));
  }
  std::string error;

 private:
  const SimulateCommand& o_;
  const Reader& in_;
  const MotionSettings& settings_;
};

SimulationReport run(Workspace& s, const Reader& in, const SimulationOptions& options, RowSink& rows, Told* told) {
  const std::vector<Contact>& touching = contacts(*in.names);
  const auto motion = [&](RowSink& to) {
    return touching.empty() ? simulate_in(s, options, to) : simulate_with_contacts(s, touching, options, to);
  };
  try {
    if (!told) return motion(rows);
    RunSink kept(told->run);
    TwoSinks both(rows, kept);
    return motion(both);
  } catch (const Failure& e) {
    throw usage_error(e, in.source);
  }
}

// Appends the rows to the existing ones if a run continues in its own file; any other file is replaced.
void go_on(RunWriter& rows, const SimulateCommand& o, const SavedRun& resume, const Reader& in) {
  std::error_code none;
  if (!rows.error().empty() || !resume.has("given") || !std::filesystem::is_regular_file(o.output, none)) return;
  try {
    const RunFile before = read_run(o.output);
    const auto model = before.settings.find("model_sha256");
    const std::vector<double> given = resume.numbers<double>("given", 2);
    const auto count = static_cast<std::size_t>(given[0]);
    if (model == before.settings.end() || model->second != std::vector<std::string>{model_hash(in.source)} ||
        before.table.rows() < count)
      return;
    rows.go_on(before, count, static_cast<std::size_t>(given[1]));
    if (!o.quiet) say(stderr, "note: rows are added to the first %zu of %s\n", count, o.output.c_str());
  } catch (const Failure&) {
    // The file holds no run, or is damaged.
  }
}

// Sets the end of a motion that is to be drawn, if none is given, and its rows, unless the command line gives them: the
// rows that the file asks for may be too coarse for a picture.
void settle_drawing(MotionSettings& settings, const SimulateCommand& o, const Workspace& s,
                    SimulationOptions& options) {
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
  if (o.motion.every || !o.motion.at.empty()) return;
  if (!settings.to)
    settings.to = settings.at.front().value < start ? settings.at.front().value : settings.at.back().value;
  settings.every.reset();
  settings.at.clear();
  constexpr int kInEachStep = 4;
  const int rows = rows_to_look_at(s.mechanics->q.size(), s.mechanics->phi.size());
  if (*settings.to != start)
    options.picture = PictureRows{kInEachStep, abs(Rational(*settings.to - start)).get_d() / rows};
}

// Throws UsageError if more numbers are asked for than the format, which is held in memory, can take.
void must_fit(const ResultFormat& format, const SimulationOptions& asked, const Workspace& s, const Rational& last) {
  const auto columns = static_cast<long>(1 + 4 * s.system.coordinates + s.system.constraints.size());
  if (format.most_numbers > 0 && asked.every &&
      columns * abs(Rational(last - Rational(s.state.t))) > format.most_numbers * *asked.every)
    throw UsageError{"error: --every asks for more than " + std::to_string(format.most_numbers) + " numbers of " +
                     format.name + "\nhint: write HDF5 or CSV: -o run.h5\n"};
}

// Sets all options of the motion of this system. drawn: the motion is only for a page or a film.
void ask(MotionSettings& settings, const SimulateCommand& o, const Workspace& s, bool drawn,
         SimulationOptions& options) {
  if (drawn) settle_drawing(settings, o, s, options);
  const char* saving = !o.save.empty() ? "--save" : !o.resume.empty() ? "--continue" : "";
  const Rational last = anholon::ask(settings, s, asker(saving), options);
  if (options.resume) beyond(*options.resume, o, last);
  must_fit(output_format(o), options, s, last);
  // An event that sets values may change an integral of the motion between events.
  if (!sets_values(*s.model)) options.conserved = conserved(*s.mechanics);
  settings.tolerance = options.tolerance;
  std::erase_if(settings.at, [&](const WrittenTime& t) {
    return std::find(options.at.begin(), options.at.end(), t.value) == options.at.end();
  });
  settings.form = s.system.form->name;
}

// The end of a motion and of the file of its rows.
struct Written {
  SimulationReport report;
  std::string error;  // the reason why the file could not be written; empty if it was
  std::string part;   // the file with the rows that could be written
  bool started = true;
};

// Computes the motion and writes its rows as the options say.
class Writer {
 public:
  Writer(const SimulateCommand& o, const Reader& in, Workspace& s, const RunInfo& info, const Outcome& start,
         SimulationOptions& options, Saver& saver, Told* told)
      : o_(o), in_(in), s_(s), info_(info), start_(start), options_(options), saver_(saver), told_(told) {}

  Written write() { return told_ && o_.output.empty() ? keep() : to_file(output_format(o_)); }

 private:
  Written keep() {
    Written w;
    if (!has_started(w)) return w;
    PageSink rows(told_->run);
    if (!o_.save.empty()) options_.save = std::ref(saver_);
    w.report = run(s_, in_, options_, rows, nullptr);
    rows.finish();
    return w;
  }

  Written to_file(const ResultFormat& format) {
    Written w;
    if (!format.without_rows && !has_started(w)) return w;
    const std::unique_ptr<RunWriter> rows = format.open(o_.output, info_);
    if (!rows->error().empty()) throw UsageError{"error: " + rows->error() + "\n"};
    if (options_.resume && format.holds == Holds::everything) go_on(*rows, o_, *options_.resume, in_);
    if (start_.ok())
      into(*rows, w);
    else
      w.report.outcome = start_, w.report.t = s_.state.t, w.report.model = s_.model->title,
      w.report.form = s_.system.form->name;
    const std::string report = report_json(w.report);
    w.error = rows->close(report);
    w.part = rows->part();
    // The report is in a file that also holds the model: --json asks for it on the standard output.
    if (o_.json && &format != &report_format()) hand_out(report + "\n");
    return w;
  }

  bool has_started(Written& w) const {
    if (start_.ok()) return true;
    print_outcome(start_);
    return w.started = false;
  }

  void into(RunWriter& rows, Written& w) {
    // Saves a run only after the rows before it are in the file.
    if (!o_.save.empty())
      options_.save = [this, &rows](const SavedRun& saved) {
        rows.flush();
        saver_(saved);
      };
    options_.rows_lost = [&rows] { return !rows.error().empty(); };
    w.report = run(s_, in_, options_, rows, told_);
  }

  const SimulateCommand& o_;
  const Reader& in_;
  Workspace& s_;
  const RunInfo& info_;
  const Outcome& start_;
  SimulationOptions& options_;
  Saver& saver_;
  Told* told_;
};

// Prints how the motion ended and where its rows are; returns the exit status.
int say_end(const SimulateCommand& o, const SourceText& source, const Written& w, const std::string& save_error) {
  const SimulationReport& r = w.report;
  std::string write_error = w.error;
  // A run that ended because its rows could not be written was not interrupted by the user.
  if (!r.outcome.ok() && (write_error.empty() || stop_requested())) {
    print_outcome(r.outcome, source);
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

int simulate_motion(const SimulateCommand& asked, const SavedRun* resume, Told* told) {
  check_ending(asked.output, result_formats());
  check_format(format_of(asked.output));
  Told own;
  Told& all = told ? *told : own;
  all.in = read(asked);
  const Reader& in = all.in;
  // A continued run may be saved to its own file.
  must_spare_inputs(asked, in, {asked.resume}, {{"-o", asked.output}, {"the page", asked.page.path}});
  must_spare_inputs(asked, in, {}, {{"-o", asked.output}, {"the page", asked.page.path}, {"--save", asked.save}});
  const SimulateCommand o = with_form(asked, in);
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
  const RunInfo info = run_info(o, in, s, settings, o.resume);
  Saver saver(o, in, settings);
  if (!o.quiet) options.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  catch_stop(told && o.output.empty() ? o.page.path : o.output);
  options.cancelled = stop_requested;
  if (told) {
    static_cast<RunInfo&>(told->run) = info;
    // An impact and friction do not keep the integrals either.
    if (contacts(*in.names).empty()) told->conserved = options.conserved;
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
  if (!o.quiet && w.report.rows > 0) {
    std::map<std::string, std::string> units = info.units;
    add_units(*s.model, options.conserved, units);
    print_report(s, w.report, units, resume != nullptr);
  }
  return say_end(o, in.source, w, saver.error);
}

int simulate(const SimulateCommand& o) {
  SavedRun run;
  SimulateCommand all = o;
  if (!o.resume.empty()) run = continued(all);
  const SavedRun* resume = o.resume.empty() ? nullptr : &run;
  if (o.page.path.empty()) return simulate_motion(all, resume, nullptr);
  check_page(all.page);
  std::deque<Told> cases(1);
  const int code = simulate_motion(all, resume, &cases[0]);
  if (cases[0].run.table.rows() == 0) return code;
  write_page(all, all.page, cases);
  return code;
}

}  // namespace anholon::cli
