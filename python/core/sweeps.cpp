#include "sweep_options.h"

namespace anholon::python {

SweepOptions options_of(const SweepWords& words) {
  const auto& [values, laws, cases, seed, draw, together, to, tolerance, at, columns, reduce, table] = words;
  SweepOptions options;
  options.draw = draw, options.together = together, options.columns = columns, options.reduce = reduce;
  options.cases = cases, options.seed = seed;
  options.table_name = table.first, options.table = table.second;
  for (const std::string& t : at) options.at.emplace_back(t);
  for (const auto& [name, list] : values) {
    Vary& vary = options.vary.emplace_back();
    vary.name = name;
    for (const std::string& number : list) vary.values.emplace_back(number);
    if (const auto law = laws.find(name); law != laws.end()) vary.law = law->second;
  }
  if (to) options.to = Number(*to);
  if (tolerance) options.tolerance = Number(*tolerance);
  return options;
}

// Computes f(options) with an attendant. Returns the sweep, and the object that was raised meanwhile.
template <class F>
static std::pair<Sweep, nb::object> attended(const SweepWords& words, std::size_t threads, nb::object stop,
                                             nb::object progress, const F& f) {
  SweepOptions options = options_of(words);
  options.threads = threads;
  Attendant attendant(std::move(stop), std::move(progress));
  options.cancelled = [&] { return attendant.cancelled(); };
  options.progress = [&](std::size_t done) { attendant.tell(static_cast<double>(done), done); };
  Sweep done = value_of(attendant.attend([&] { return f(options); }));
  return {std::move(done), attendant.raised()};
}

void bind_sweeps(nb::module_& m) {
  nb::class_<Sweep>(m, "Sweep")
      .def_prop_ro("cases", &Sweep::cases)
      .def_prop_ro("finished", &Sweep::finished)
      .def_prop_ro("columns", &Sweep::columns)
      .def_prop_ro("varied_names", &Sweep::varied_names)
      .def(
          "column",
          [](nb::handle self, const std::string& name) {
            return view(nb::cast<const Sweep&>(self).column(name), self);
          },
          "name"_a)
      .def(
          "varied",
          [](nb::handle self, const std::string& name) {
            return view(nb::cast<const Sweep&>(self).varied(name), self);
          },
          "name"_a)
      .def(
          "rows",
          [](nb::handle self, const std::string& name) { return view(nb::cast<const Sweep&>(self).rows(name), self); },
          "name"_a)
      .def_prop_ro("times", [](nb::handle self) { return view(nb::cast<const Sweep&>(self).times(), self); })
      .def("event", &Sweep::event, "number"_a)
      .def("steps", &Sweep::steps, "number"_a)
      .def_prop_ro("t", [](nb::handle self) { return view(nb::cast<const Sweep&>(self).t(), self); })
      .def("outcome_of", nb::overload_cast<std::size_t>(&Sweep::outcome, nb::const_), "number"_a)
      .def_prop_ro("outcome", nb::overload_cast<>(&Sweep::outcome, nb::const_))
      .def_prop_ro("notes", &Sweep::notes)
      .def_prop_ro("units", &Sweep::units)
      .def(
          "write",
          [](const Sweep& sweep, const std::string& path) {
            return value_of(unlocked([&] { return sweep.write(path); }));
          },
          "path"_a)
      .def(
          "figure",
          [](const Sweep& sweep, const std::vector<std::string>& columns, const std::string& x, const std::string& y) {
            return value_of(unlocked([&] { return figure(sweep, SweepFigureOptions{columns, x, y}); }));
          },
          "columns"_a, "x"_a, "y"_a)
      .def_prop_ro("scenarios", &Sweep::scenarios)
      .def("scenario", &Sweep::scenario, "number"_a);
  m.def(
      "case_table", [](const std::string& path) { return value_of(unlocked([&] { return case_table(path); })); },
      "path"_a);
  m.def(
      "sweep",
      [](const System& system, const SweepWords& words, std::size_t threads, nb::object stop, nb::object progress) {
        return attended(words, threads, std::move(stop), std::move(progress),
                        [&](const SweepOptions& options) { return sweep(system, options); });
      },
      "system"_a, "words"_a, "threads"_a, "stop"_a.none(), "progress"_a.none());
  m.def(
      "sweep_scenarios",
      [](const Model& model, const std::string& form, const Numbers& initial, const SweepWords& words,
         std::size_t threads, nb::object stop, nb::object progress) {
        const PrepareOptions prepare{form, numbers(initial), {}};
        return attended(words, threads, std::move(stop), std::move(progress),
                        [&](const SweepOptions& options) { return sweep(model, options, prepare); });
      },
      "model"_a, "form"_a, "initial"_a, "words"_a, "threads"_a, "stop"_a.none(), "progress"_a.none());
}

}  // namespace anholon::python
