#include "cli/saved.h"

#include <algorithm>

#include "base/hash.h"

namespace anholon::cli {

namespace {

// Lists of words, as given on the command line.
struct WordsOption {
  const char* option;
  const char* entry;
  std::vector<std::string> Options::* words;
};
constexpr WordsOption kWords[] = {{"--set", "set", &Options::set},
                                  {"--case", "case", &Options::cases},
                                  {"--q", "q", &Options::q},
                                  {"--qdot", "qdot", &Options::qdot},
                                  {"--qddot", "qddot", &Options::qddot},
                                  {"--qdddot", "qdddot", &Options::qdddot},
                                  {"--lambda", "lambda0", &Options::lambda},
                                  {"--lambdadot", "lambda1", &Options::lambdadot},
                                  {"--eliminate", "eliminate", &Options::eliminate}};

void must_be_absent(bool given, const std::string& option) {
  if (given)
    throw UsageError{"error: " + option + " belongs to the saved run and stays as it is\nhint: leave " + option +
                     " out, or start a run of its own\n"};
}

// Calls f and turns its failure about the saved run into a message that names the file.
template <class F>
auto with_file(const std::string& path, F f) {
  try {
    return f();
  } catch (const Failure& e) {
    throw UsageError{print(e.diagnostic, SourceText{path, {}})};
  }
}

}  // namespace

SavedRun continued(Options& o) {
  for (const WordsOption& w : kWords) must_be_absent(!(o.*w.words).empty(), w.option);
  must_be_absent(!o.t.empty(), "--t");
  must_be_absent(!o.tolerance.empty(), "--tolerance");
  must_be_absent(o.form_given, "--form");
  must_be_absent(o.order != 0, "--order");
  must_be_absent(o.digits != Options().digits, "--digits");
  must_be_absent(o.numbers != Options().numbers, "--numbers");
  SourceText source{o.resume, {}};
  std::string why;
  if (!read_file(o.resume, source.text, &why)) throw UsageError{"error: cannot read " + o.resume + ": " + why + "\n"};
  return with_file(o.resume, [&] {
    SavedRun run = read_saved(source);
    for (const WordsOption& w : kWords) o.*w.words = run.texts(w.entry);
    o.t = run.texts("t0").empty() ? "" : run.one("t0");
    o.tolerance = run.one("tolerance");
    o.form = run.one("form");
    o.form_given = true;
    o.numbers = run.one("numbers");
    o.digits = static_cast<int>(run.number<double>("digits"));
    o.order = static_cast<int>(run.number<double>("order"));
    return run;
  });
}

void same_model(const SavedRun& run, const Reader& in) {
  with_file("the saved run", [&] {
    if (run.one("model") != sha256_text(all_text(in.source)))
      throw UsageError{"error: the saved run is of another model ('" + run.one("title") + "'), or " + in.source.name +
                       " has changed since\nhint: only the same model goes on with the same bits; to start from a "
                       "state, give it in [initial]\n"};
  });
}

void describe_run(SavedRun& run, const Options& o, const Reader& in, const Formulation& form,
                  const SimulationOptions& options) {
  for (const WordsOption& w : kWords) run.set(w.entry, o.*w.words);
  run.set("t0", o.t.empty() ? SavedRun::Texts{} : SavedRun::Texts{o.t});
  run.set("tolerance", {options.tolerance.get_str()});
  run.set("form", {form.name});
  run.set("numbers", {o.numbers});
  run.set("digits", {std::to_string(o.digits)});
  run.set("order", {std::to_string(o.order)});
  run.set("model", {sha256_text(all_text(in.source))});
  run.set("title", {in.model->title});
}

void beyond(const SavedRun& run, const Options& o, const Rational& end) {
  with_file(o.resume, [&] {
    // Times of a saved run may be wider than double; the times compared with them are written by hand.
    const PrecisionScope precision(std::max(o.digits, kQuadTextDigits) + 12);
    const Multi start = run.number<Multi>("start"), done = run.number<Multi>("rows"), to(end);
    const bool forward = start < done || (start == done && start < to);
    if (forward ? !(done < to) : !(to < done))
      throw UsageError{"error: the saved run has come to t = " + number_text(done.to_double()) +
                       " already\nhint: --to beyond that\n"};
    for (const std::string& t : split(o.at))
      if (const Multi time(exact(t, "--at")); forward ? !(done < time) : !(time < done))
        throw UsageError{"error: --at " + t + ": the saved run has come to t = " + number_text(done.to_double()) +
                         " already\nhint: times beyond that\n"};
  });
}

}  // namespace anholon::cli
