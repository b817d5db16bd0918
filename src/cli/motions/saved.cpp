#include "cli/motions/saved.h"

#include <algorithm>

#include "cli/model_options.h"
#include "modelfile/hash.h"

namespace anholon::cli {

namespace {

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

SavedRun continued(SimulateCommand& o) {
  for (const ModelOption& m : model_options()) must_be_absent(!(o.*m.words).empty(), "--" + std::string(m.name));
  must_be_absent(!o.t.empty(), "--t");
  for (const MotionOption& m : motion_options())
    if (m.kept) must_be_absent(is_set(o.motion, m), "--" + std::string(m.name));
  SourceText source{o.resume, {}};
  std::string why;
  if (!read_file(o.resume, source.text, &why)) throw UsageError{"error: cannot read " + o.resume + ": " + why + "\n"};
  return with_file(o.resume, [&] {
    SavedRun run = read_saved(source);
    for (const ModelOption& m : model_options()) o.*m.words = run.texts(m.name);
    o.t = run.texts("t0").empty() ? "" : run.one("t0");
    for (const MotionOption& m : motion_options())
      if (m.kept) set(o.motion, m, run.texts(m.name), m.name, [&](const std::string& n) { return exact(n, m.name); });
    return run;
  });
}

void same_model(const SavedRun& run, const Reader& in) {
  with_file("the saved run", [&] {
    if (run.one("model") != model_hash(in.source))
      throw UsageError{"error: the saved run is of another model" +
                       (run.one("title").empty() ? "" : " ('" + run.one("title") + "')") + ", or " + in.source.name +
                       (in.source.others.empty() && in.source.tables.empty() ? "" : " or a file that it reads") +
                       " has changed since\nhint: only the same model goes on with the same bits; to start from a "
                       "state, give it in [initial]\n"};
  });
}

void describe_run(SavedRun& run, const SystemCommand& o, const Reader& in, const MotionSettings& settings) {
  for (const ModelOption& m : model_options()) run.set(m.name, o.*m.words);
  run.set("t0", o.t.empty() ? SavedRun::Texts{} : SavedRun::Texts{o.t});
  for (const MotionOption& m : motion_options())
    if (m.kept) run.set(m.name, words(settings, m));
  run.set("model", {model_hash(in.source)});
  run.set("title", {in.model->title});
}

void beyond(const SavedRun& run, const SimulateCommand& o, const Rational& end) {
  with_file(o.resume, [&] {
    // Times of a saved run may be wider than double; the times compared with them are written by hand.
    const PrecisionScope precision(std::max(o.digits(), kQuadTextDigits) + 12);
    const Multi start = run.number<Multi>("start"), done = run.number<Multi>("rows"), to(end);
    const bool forward = start < done || (start == done && start < to);
    if (forward ? !(done < to) : !(to < done))
      throw UsageError{"error: the saved run has come to t = " + number_text(done.to_double()) +
                       " already\nhint: --to beyond that\n"};
    for (const WrittenTime& t : o.motion.at)
      if (const Multi time(t.value); forward ? !(done < time) : !(time < done))
        throw UsageError{"error: --at " + t.text + ": the saved run has come to t = " + number_text(done.to_double()) +
                         " already\nhint: times beyond that\n"};
  });
}

}  // namespace anholon::cli
