#include "simulation/simulate.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <deque>
#include <filesystem>

#include "base/hash.h"
#include "cli/input.h"
#include "cli/method.h"
#include "cli/progress.h"
#include "cli/report.h"
#include "cli/report_text.h"
#include "cli/result_file.h"
#include "cli/run_info.h"
#include "cli/saved.h"
#include "cli/say.h"
#include "cli/show.h"
#include "result/file.h"
#include "result/format.h"
#include "simulation/report_json.h"

namespace anholon::cli {

namespace {

// More rows are refused before they fill memory or disk; a format that is held in memory has a limit of its own.
constexpr long kMostRows = 5'000'000;

// The format of the rows: by the name of the file; --json asks for the report, too, if that format does not hold it.
const ResultFormat& output_format(const Options& o) {
  const ResultFormat* named = format_of(o.output);
  if (o.json && (!named || named->holds == Holds::rows)) return report_format();
  return named ? *named : plain_format();
}

// drawn: the motion is for a page or a film, which has a default end.
Rational times(const Options& o, const Scenario& scenario, SimulationOptions& s, bool drawn) {
  const Model& model = *scenario.model;
  const SimulationSettings& file = model.simulate;
  s.to = o.to.empty() ? file.to : std::optional<Rational>(exact(o.to, "--to"));
  s.every = o.every.empty() ? file.every : std::optional<Rational>(exact(o.every, "--every"));
  if (s.every && *s.every <= 0) throw UsageError{"error: --every is a positive time\n"};
  s.at_text = split(o.at);
  if (!o.at.empty() && s.at_text.empty()) throw UsageError{"error: --at has no times\nhint: --at 0.25,0.5,1\n"};
  std::stable_sort(s.at_text.begin(), s.at_text.end(),
                   [](const std::string& a, const std::string& b) { return exact(a, "--at") < exact(b, "--at"); });
  for (const std::string& t : s.at_text) s.at.push_back(exact(t, "--at"));
  if (!s.at.empty())
    s.every.reset();
  else if (o.every.empty())
    s.at = file.at;
  std::sort(s.at.begin(), s.at.end());
  // With --at only these rows are computed; the end in the file is for runs without --at.
  if (!o.at.empty() && o.to.empty()) s.to.reset();
  Rational start(scenario.state.t);
  if (s.state.t)
    start = *s.state.t;
  else if (is_number(model.initial.t))
    start = number_value(model.initial.t);
  if (s.at.empty() && !s.to) {
    if (!drawn) throw UsageError{"error: no end time\nhint: --to 10, or [simulate] to = 10 in the model file\n"};
    constexpr int kShown = 10;
    s.to = start + kShown;
    if (!o.quiet)
      say(stderr,
          "note: nobody says where the motion ends: it is shown up to t = %s; --to T, or [simulate] to = T in the "
          "model file, shows more or less\n",
          number_text(s.to->get_d()).c_str());
  }
  if (s.to && abs(*s.to) > Rational(mpz_class("1000000000000000000")))
    throw UsageError{"error: an end time beyond 1e18\n"};

  if (!s.at.empty() && s.at.front() < start && s.at.back() > start)
    throw UsageError{"error: the time " + s.at.front().get_str() + " lies before the start, t = " + start.get_str() +
                     "\n"};
  const Rational end = s.at.empty() ? *s.to : s.at.front() < start ? s.at.front() : s.at.back();
  if (end < start)
    say(stderr, "note: the end lies before the start, t = %s: the motion is computed backwards\n",
        number_text(start.get_d()).c_str());
  if (s.every && abs(Rational(end - start)) > kMostRows * *s.every)
    throw UsageError{"error: --every asks for more than " + std::to_string(kMostRows) + " rows\n"};
  const ResultFormat& format = output_format(o);
  const auto columns = static_cast<long>(1 + 4 * scenario.system.coordinates + scenario.system.constraints.size());
  if (s.every && format.most_numbers > 0 && columns * abs(Rational(end - start)) > format.most_numbers * *s.every)
    throw UsageError{"error: --every asks for more than " + std::to_string(format.most_numbers) + " numbers of " +
                     format.name + "\nhint: write HDF5 or CSV: -o run.h5\n"};
  return end;
}

void accuracy(const Options& o, const Model& model, SimulationOptions& s) {
  // The tolerance of quad without --digits: it leaves some digits for round-off.
  constexpr int kQuadTolerance = 32;
  s.digits = o.digits;
  s.precision = precision(o, Precision::real);
  if (o.digits > 16 || s.precision == Precision::quad)
    s.tolerance = exact("1e-" + std::to_string(o.digits > 16 ? o.digits + 2 : kQuadTolerance), "--digits");
  else if (model.simulate.tolerance)
    s.tolerance = *model.simulate.tolerance;
  if (!o.tolerance.empty()) s.tolerance = exact(o.tolerance, "--tolerance");
  if (s.tolerance <= 0 || s.tolerance >= 1) throw UsageError{"error: the tolerance lies between 0 and 1\n"};
  if (s.precision == Precision::multi) return;
  const std::string floor = s.precision == Precision::real        ? "2e-16"
                            : s.precision == Precision::long_real ? "1e-19"
                                                                  : "2e-34";
  if (s.tolerance < exact(floor, "")) {
    say(stderr, "note: a tolerance below %s means %s in these numbers\n", floor.c_str(), floor.c_str());
    s.tolerance = exact(floor, "");
  }
}

// --rigorous N or all.
std::optional<std::size_t> rigorous(const std::string& text) {
  constexpr long kMostTimes = 1'000'000;
  if (text.empty()) return std::nullopt;
  if (text == "all") return 0;
  const std::optional<Rational> n = parse_rational(text);
  if (!n || n->get_den() != 1 || *n < 1 || *n > kMostTimes)
    throw UsageError{"error: --rigorous takes a number of times up to " + std::to_string(kMostTimes) +
                     ", or the word all, not '" + text + "'\nhint: --rigorous 64\n"};
  return n->get_num().get_ui();
}

// SUNDIALS computes in double, and not below its own least tolerance.
void integrator(const Options& o, const Model& model, SimulationOptions& s) {
  s.integrator = model.simulate.integrator.value_or(Integrator::taylor);
  if (!o.integrator.empty()) {
    const auto wanted = find_integrator(o.integrator);
    if (!wanted) {
      const std::string near = did_you_mean(o.integrator, integrator_names());
      throw UsageError{"error: there is no integrator '" + o.integrator + "'" +
                       (near.empty() ? "" : "; did you mean '" + near + "'?") +
                       "\nhint: --integrator taylor, cvode or ida\n"};
    }
    s.integrator = *wanted;
  }
  if (s.integrator == Integrator::taylor) return;
  const MethodInfo& method = info(s.integrator);
  const auto refuse = [&](const std::string& what, const std::string& option) {
    throw UsageError{"error: the integrator '" + std::string(method.name) + "' " + what + "\nhint: leave out " +
                     option + ", or use --integrator taylor\n"};
  };
  if (const auto refused = refusal(method, demands(o, s))) refuse(refused->why, option_of(refused->of, o));
  if (std::any_of(model.events.begin(), model.events.end(), [](const Event& e) { return e.ends_step(); }))
    refuse("does not stop at events", "the events");
  // The difference from Taylor's motion says how many digits of the rows can be trusted.
  if (s.estimate == ErrorEstimate::always)
    refuse("has its difference from Taylor's motion for an estimate", "--error-estimate");
  say_raised(method, s);
}

// "blade'" for the first derivative of the constraint with the largest residual.
std::string worst_constraint(const SimulationReport& r) {
  std::string name;
  double worst = 0;
  for (const ConstraintReport& c : r.constraints_each)
    for (std::size_t k = 0; k < c.residuals.size(); ++k)
      if (c.residuals[k] > worst)
        worst = c.residuals[k], name = derivative_name(c.name, static_cast<unsigned>(k), Format::text);
  return name.empty() ? "" : ", worst '" + name + "'";
}

// Names the motion with which a second opinion is compared.
std::string beside(const SimulationReport& r) {
  return r.method.steps > 0 ? "the motion by method " + std::string(name(r.method.last)) : "Taylor's motion";
}

void second_opinion(const Scenario& s, const SimulationReport& r) {
  const SecondOpinion& o = *r.second;
  say(stderr,
      "second opinion: the rows are those of %s%s (%zu steps, %zu evaluations, %.3g s); they differ from %s by at most "
      "%s (%s at t = %s, relative to 1 + |%s|)\n",
      name(o.integrator), o.form == s.system.form->name ? "" : " on Routh's equations", o.steps, o.evaluations,
      o.seconds, beside(r).c_str(), small(o.difference).c_str(), o.of.c_str(), number_text(o.t, 6).c_str(),
      o.of.c_str());
}

// "event burn_out at t = 160: stage 1 -> 2, fuel 0 -> 90000"
void events(const SimulationReport& r) {
  constexpr std::size_t kMostLines = 20;
  for (std::size_t k = 0; k < r.events.size() && k < kMostLines; ++k) {
    const EventReport& e = r.events[k];
    std::string list;
    for (const auto& c : e.changes)
      list += (list.empty() ? ": " : ", ") + c.name + " " + c.before.text() + " -> " + c.after.text();
    if (e.correction > 0) list += "; made consistent by " + small(e.correction);
    say(stderr, "event %s at t = %s%s%s\n", e.name.c_str(), e.t.text().c_str(), list.c_str(),
        e.stop ? ": the motion ends here" : "");
  }
  if (r.events.size() > kMostLines)
    say(stderr, "… and %zu more events (all of them with --json)\n", r.events.size() - kMostLines);
}

void report(const Scenario& s, const SimulationReport& r) {
  std::fflush(stdout);
  // `check` prints the notes that concern the model itself; here only those of the state follow.
  for (const std::string& n : s.state.notes) say(stderr, "note: %s\n", n.c_str());
  const std::string before = r.second ? "not projected" : "before projection " + small(r.constraints);
  say(stderr,
      "residual report (relative): Newton's law %s, without multipliers %s, constraints %s (%s%s), power balance %s\n",
      small(r.newton).c_str(), small(r.projected).c_str(), small(r.constraints_kept).c_str(), before.c_str(),
      worst_constraint(r).c_str(), small(r.power).c_str());
  if (r.error)
    say(stderr, "digits to trust%s\n", digits_to_trust(*r.error).c_str());
  else if (!r.no_error.empty())
    say(stderr, "digits to trust: not estimated, %s\n", r.no_error.c_str());
  events(r);
  for (const WatchedReport& w : r.conserved)
    say(stderr, "conserved: %s = %s, largest change %s of its terms\n", w.name.c_str(), w.first.text().c_str(),
        small(w.largest_change).c_str());
  for (const WatchedReport& w : r.monitors)
    say(stderr, "monitor %s: from %s to %s, between %s and %s, largest change %s of its size\n", w.name.c_str(),
        w.first.text().c_str(), w.last.text().c_str(), w.least.text().c_str(), w.greatest.text().c_str(),
        small(w.largest_change).c_str());
  if (r.rigorous) {
    const RigorousReport& g = *r.rigorous;
    say(stderr,
        "rigorous, %s of the dense output: Newton's law misses by at most %s of its terms, without multipliers %s, "
        "constraints %s, steps join within %s\n",
        (g.times ? "at " + std::to_string(*g.times) + " times" : std::string("for all t")).c_str(), g.newton.c_str(),
        g.projected.c_str(), g.constraints.c_str(), g.joints.c_str());
  }
  say(stderr, "%s%zu steps of order %d, %zu rows, smallest scaled singular value %s at t = %s, %.3g s\n",
      (r.second ? beside(r) + ": " : "").c_str(), r.steps, r.order, r.rows, small(r.smallest_sigma).c_str(),
      number_text(r.smallest_sigma_t, 6).c_str(), r.second ? r.seconds - r.second->seconds : r.seconds);
  print_method(r.method);
  if (r.second) second_opinion(s, r);
  for (const Warning& w : r.warnings) say(stderr, "warning: %s\nhint: %s\n", w.message.c_str(), w.hint.c_str());
}

// Writes the saved runs that --save asks for; stops at the first failure and keeps its message.
class Saver {
 public:
  Saver(const Options& o, const Reader& in, const Formulation& form, const SimulationOptions& options)
      : o_(o), in_(in), form_(form), options_(options) {}
  void operator()(SavedRun run) {
    if (!error.empty()) return;
    describe_run(run, o_, in_, form_, options_);
    error = write_whole(o_.save, print(run));
  }
  std::string error;

 private:
  const Options& o_;
  const Reader& in_;
  const Formulation& form_;
  const SimulationOptions& options_;
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
void go_on(RunWriter& rows, const Options& o, const SavedRun& resume, const Reader& in) {
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

bool sets_values(const Model& model) {
  return std::any_of(model.events.begin(), model.events.end(), [](const Event& e) { return !e.set.empty(); });
}

// All that is asked of the motion of this system. drawn: the motion is for a page or a film alone.
void ask(const Options& o, const Reader& in, const Workspace& s, bool drawn, SimulationOptions& options) {
  options.estimate = error_estimate(o);
  options.order = o.order;
  const Rational last = times(o, s, options, drawn);
  if (options.resume) beyond(*options.resume, o, last);
  if (drawn && !options.every && options.at.empty() && last != Rational(s.state.t))
    options.every = abs(Rational(last - Rational(s.state.t))) / rows_to_look_at(*s.mechanics);
  const bool reset = sets_values(*in.model);
  if (reset && last < Rational(s.state.t))
    throw UsageError{"error: what events set cannot be taken back: the motion goes forwards only\nhint: an end after "
                     "the start, t = " +
                     number_text(s.state.t) + "\n"};
  options.rigorous = rigorous(o.rigorous);
  if (options.rigorous && reset)
    throw UsageError{
        "error: --rigorous encloses motions without events that set something\nhint: leave out --rigorous\n"};
  accuracy(o, *in.model, options);
  integrator(o, *in.model, options);
  choose_method(o, s, options);
  // An event that sets values does not conserve what is an integral between events.
  if (!reset) options.conserved = conserved(*s.mechanics);
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
  Writer(const Options& o, const Reader& in, Workspace& s, const Outcome& start, SimulationOptions& options,
         Saver& saver, Told* told)
      : o_(o), in_(in), s_(s), start_(start), options_(options), saver_(saver), told_(told) {}

  Written write() { return told_ && o_.output.empty() ? keep() : to_file(output_format(o_)); }

 private:
  Written keep() {
    Written w;
    if (!has_started(w)) return w;
    RunSink rows(told_->run);
    if (!o_.save.empty()) options_.save = std::ref(saver_);
    w.report = run(s_, options_, rows, nullptr);
    return w;
  }

  Written to_file(const ResultFormat& format) {
    Written w;
    if (!format.without_rows && !has_started(w)) return w;
    const std::unique_ptr<RunWriter> rows = format.open(o_.output, run_info(o_, in_, s_, options_));
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
  check_format(format_of(asked.output));
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
  ask(o, in, s, told && o.output.empty(), options);
  Saver saver(o, in, *s.system.form, options);
  if (!o.quiet) options.note = [](const std::string& text) { say(stderr, "note: %s\n", text.c_str()); };
  catch_stop(told && o.output.empty() ? o.report : o.output);
  options.cancelled = stop_requested;
  if (told) {
    static_cast<RunInfo&>(told->run) = run_info(o, in, s, options);
    told->conserved = options.conserved;
  }
  Written w;
  {
    const double end = options.at.empty() ? options.to->get_d()
                                          : std::max(options.at.back().get_d(),
                                                     options.to ? options.to->get_d() : options.at.back().get_d());
    Progress progress(o.quiet || end == s.state.t, "t", "steps");
    options.progress = [&](double t, std::size_t steps) { progress((t - s.state.t) / (end - s.state.t), t, steps); };
    w = Writer(o, in, s, start, options, saver, told).write();
  }
  if (!w.started) return kStopped;
  if (told) told->run.report = report_json(w.report);
  if (!o.quiet && w.report.rows > 0) report(s, w.report);
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
