#include "anholon/page.h"
#include "anholon/sweep_folder.h"
#include "interruptible.h"
#include "sweep_options.h"

namespace anholon::python {

namespace {

// Returns numbers as an array; words as a pair of the different words and an array of the index of each row.
nb::object column_of(FolderColumn column) {
  if (auto* numbers = std::get_if<std::vector<double>>(&column.values)) {
    const std::size_t size = numbers->size();
    return nb::cast(array<1>(std::move(*numbers), {size}));
  }
  const auto owned = [](auto values) {
    using Values = decltype(values);
    auto* held = new Values(std::move(values));
    const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<Values*>(p); });
    return nb::cast(
        nb::ndarray<nb::numpy, typename Values::value_type, nb::ndim<1>>(held->data(), {held->size()}, owner));
  };
  if (auto* whole = std::get_if<std::vector<std::int64_t>>(&column.values)) return owned(std::move(*whole));
  auto& words = std::get<FolderColumn::Words>(column.values);
  return nb::make_tuple(words.different, owned(std::move(words.rows)));
}

}  // namespace

void bind_sweep_folders(nb::module_& m) {
  nb::class_<FolderProgress>(m, "FolderProgress", "How far a sweep in a folder is.")
      .def_ro("parts", &FolderProgress::parts)
      .def_ro("all_parts", &FolderProgress::all_parts)
      .def_ro("cases", &FolderProgress::cases)
      .def_ro("all_cases", &FolderProgress::all_cases)
      .def_ro("unfinished", &FolderProgress::unfinished, "Files of parts under way, or of processes that were killed.")
      .def_ro("outcomes", &FolderProgress::outcomes, "How many cases ended in which way.")
      .def_ro("events", &FolderProgress::events, "How many of the cases that finished were ended by which event.")
      .def_ro("cases_per_second", &FolderProgress::cases_per_second,
              "By the times at which the last parts were written; 0: unknown.")
      .def_prop_ro(
          "generations",
          [](const FolderProgress& p) {
            std::vector<std::size_t> cases;
            for (const FolderGeneration& g : p.generations) cases.push_back(g.cases);
            return cases;
          },
          "The cases of each generation that is planned; the first one is what was asked for.")
      .def_ro("notes", &FolderProgress::notes,
              "Why cases stopped: for each outcome the first case, its message and a hint.")
      .def("__repr__", [](const FolderProgress& p) {
        return nb::cast<std::string>(
            nb::str("{} of {} parts, {} of {} cases").format(p.parts, p.all_parts, p.cases, p.all_cases));
      });
  nb::class_<SweepFolder>(m, "SweepFolder")
      .def_prop_ro("path", &SweepFolder::path)
      .def_prop_ro("cases", &SweepFolder::cases)
      .def_prop_ro("parts", &SweepFolder::parts)
      .def_prop_ro("chunk", &SweepFolder::chunk)
      .def_prop_ro("columns", &SweepFolder::columns)
      .def_prop_ro("recipe", &SweepFolder::recipe)
      .def("asked", &SweepFolder::asked, "name"_a)
      .def_prop_ro("keeps_files", &SweepFolder::keeps_files)
      .def(
          "model",
          [](const SweepFolder& f, const Numbers& set, const Words& cases, const Words& mode) {
            return value_of(interruptible([=] { return f.model(read_options(set, cases, mode)); }));
          },
          "set"_a, "cases"_a, "mode"_a)
      .def("missing", [](const SweepFolder& f) { return value_of(unlocked([&] { return f.missing(); })); })
      .def("present", [](const SweepFolder& f) { return value_of(unlocked([&] { return f.present(); })); })
      .def("progress", [](const SweepFolder& f) { return value_of(unlocked([&] { return f.progress(); })); })
      .def(
          "refine",
          [](const SweepFolder& f, const std::string& rule, std::size_t number) {
            return value_of(unlocked([&] { return f.refine(rule, number); }));
          },
          "rule"_a, "number"_a)
      .def(
          "numbers",
          [](const SweepFolder& f, std::size_t number) {
            return value_of(unlocked([&] { return f.numbers(number); }));
          },
          "number"_a)
      .def(
          "words",
          [](const SweepFolder& f, std::size_t number) { return value_of(unlocked([&] { return f.words(number); })); },
          "number"_a)
      .def(
          "judge",
          [](const SweepFolder& f, nb::object stop) {
            Attendant attendant(std::move(stop), nb::none());
            const Result<std::string> judged =
                attendant.attend([&] { return f.judge([&] { return attendant.cancelled(); }); });
            return std::pair(attendant.raised().is_none() ? value_of(judged) : std::string(), attendant.raised());
          },
          "stop"_a.none())
      .def(
          "read",
          [](const SweepFolder& f, const std::vector<std::string>& names) {
            std::vector<FolderColumn> columns = value_of(unlocked([&] { return f.read(names); }));
            std::vector<std::pair<std::string, nb::object>> all;
            for (FolderColumn& c : columns) {
              const std::string name = c.name;
              all.emplace_back(name, column_of(std::move(c)));
            }
            return all;
          },
          "names"_a)
      .def("points", [](const SweepFolder& f) { return unlocked([&] { return f.points(); }); })
      .def("units", [](const SweepFolder& f) { return unlocked([&] { return f.units(); }); })
      .def(
          "figure",
          [](const SweepFolder& f, const std::vector<std::string>& columns, const std::string& x,
             const std::string& y) {
            return value_of(unlocked([&] { return figure(f, SweepFigureOptions{columns, x, y}); }));
          },
          "columns"_a, "x"_a, "y"_a)
      .def(
          "fill",
          [](const SweepFolder& f, std::optional<std::vector<std::size_t>> parts, std::size_t share, std::size_t shares,
             std::size_t threads, nb::object stop, nb::object progress) {
            FolderWork work;
            work.parts = std::move(parts), work.share = share, work.shares = shares, work.threads = threads;
            Attendant attendant(std::move(stop), std::move(progress));
            work.cancelled = [&] { return attendant.cancelled(); };
            work.progress = [&](std::size_t done) { attendant.tell(static_cast<double>(done), done); };
            const FolderDone done = value_of(attendant.attend([&] { return f.fill(work); }));
            return std::tuple(done.cases, done.notes, done.error, attendant.raised());
          },
          "parts"_a.none(), "share"_a, "shares"_a, "threads"_a, "stop"_a.none(), "progress"_a.none());
  m.def(
      "open_sweep", [](const std::string& folder) { return value_of(unlocked([&] { return open_sweep(folder); })); },
      "folder"_a);
  m.def(
      "sweep_into",
      [](const System& system, const SweepWords& words, const std::string& folder, std::size_t chunk,
         const std::string& recipe, const std::optional<std::string>& refine) {
        const SweepOptions options = options_of(words);
        return value_of(unlocked([&] { return sweep_into(system, options, folder, chunk, recipe, refine); }));
      },
      "system"_a, "words"_a, "folder"_a, "chunk"_a, "recipe"_a, "refine"_a.none());
  m.def(
      "sweep_scenarios_into",
      [](const Model& model, const std::string& form, const Numbers& initial, const SweepWords& words,
         const std::string& folder, std::size_t chunk, const std::string& recipe,
         const std::optional<std::string>& refine) {
        const SweepOptions options = options_of(words);
        const PrepareOptions prepare{form, numbers(initial), {}};
        return value_of(unlocked([&] { return sweep_into(model, options, folder, chunk, recipe, prepare, refine); }));
      },
      "model"_a, "form"_a, "initial"_a, "words"_a, "folder"_a, "chunk"_a, "recipe"_a, "refine"_a.none());
}

}  // namespace anholon::python
