#include "interruptible.h"

namespace anholon::python {

namespace {

void bind_system(nb::module_& m) {
  nb::class_<InitialValue>(m, "InitialValue", "A value of the initial state, and where it comes from.")
      .def_ro("name", &InitialValue::name)
      .def_ro("value", &InitialValue::value, "SI.")
      .def_prop_ro(
          "origin",
          [](const InitialValue& v) {
            const char* names[] = {"given", "derived", "chosen", "guessed", "corrected"};
            return std::string(names[static_cast<int>(v.origin)]);
          },
          "'given', 'derived' from the constraints, 'chosen' (free, and set to 0), 'guessed' (the solution next "
          "to a guess) or 'corrected' (given, and moved onto the constraints).")
      .def("__repr__",
           [](const InitialValue& v) { return nb::cast<std::string>(nb::str("{} = {!r}").format(v.name, v.value)); });
  nb::class_<ConstraintClass>(m, "ConstraintClass", "What kind of constraint it is.")
      .def_ro("name", &ConstraintClass::name)
      .def_ro("kind", &ConstraintClass::kind, "Holonomic, linear, affine or nonlinear in its highest derivatives.")
      .def_ro("homogeneous", &ConstraintClass::homogeneous)
      .def_ro("rheonomic", &ConstraintClass::rheonomic, "It holds t explicitly.")
      .def_ro("redundant", &ConstraintClass::redundant, "It follows from the others at the initial state.")
      .def("__repr__", [](const ConstraintClass& c) { return c.name + ": " + c.kind; });
  nb::class_<System>(m, "System")
      .def_prop_ro("form", &System::form)
      .def_prop_ro("start", &System::start)
      .def_prop_ro("initial", &System::initial)
      .def_prop_ro("constraints", &System::constraints)
      .def_prop_ro("degrees_of_freedom", &System::degrees_of_freedom)
      .def_prop_ro("notes", &System::notes);
  m.def(
      "prepare",
      [](const Model& model, const std::string& form, const Numbers& initial,
         const std::vector<std::string>& eliminate) {
        const PrepareOptions options{form, numbers(initial), eliminate};
        return value_of(interruptible([=] { return prepare(model, options); }));
      },
      "model"_a, "form"_a, "initial"_a, "eliminate"_a);
  m.def(
      "program_text",
      [](const System& system, const std::string& language) {
        return value_of(program_text(system, language == "c" ? Language::c : Language::python));
      },
      "system"_a, "language"_a);
}

void bind_run(nb::module_& m) {
  nb::class_<Column> column(m, "Column", "A column of a run.");
  column.def_ro("name", &Column::name)
      .def_ro("kind", &Column::kind, "'coordinates', 'velocities', 'multipliers', 'reactions', …")
      .def_ro("unit", &Column::unit, "Empty where the model names none.")
      .def_ro("order", &Column::order, "Of the derivative.")
      .def_ro("latex", &Column::latex, "Its symbol, in the notation of the model.")
      .def_ro("mathml", &Column::mathml)
      .def("__repr__", [](const Column& c) { return c.unit.empty() ? c.name : c.name + " [" + c.unit + "]"; });
  picklable(column, &Column::name, &Column::kind, &Column::unit, &Column::order, &Column::latex, &Column::mathml);
  nb::class_<Event::Change> change(m, "Change", "A value that an event has changed.");
  change.def_ro("name", &Event::Change::name)
      .def_ro("before", &Event::Change::before)
      .def_ro("after", &Event::Change::after);
  picklable(change, &Event::Change::name, &Event::Change::before, &Event::Change::after);
  nb::class_<Event> event(m, "Event", "An event that happened.");
  event.def_ro("name", &Event::name)
      .def_ro("t", &Event::t, "s.")
      .def_ro("changes", &Event::changes)
      .def_ro("stop", &Event::stop, "It ended the motion.")
      .def("__repr__",
           [](const Event& e) { return nb::cast<std::string>(nb::str("{} at t = {!r}").format(e.name, e.t)); });
  picklable(event, &Event::name, &Event::t, &Event::changes, &Event::stop);
  nb::class_<Trust> trust(m, "Trust", "Digits of the columns of one kind that can be trusted.");
  trust.def_ro("kind", &Trust::kind)
      .def_ro("digits", &Trust::digits)
      .def_ro("error", &Trust::error, "Of the worst column, in relation to its largest value.")
      .def_ro("worst", &Trust::worst, "The worst column.")
      .def("__repr__", [](const Trust& t) { return t.kind + ": " + std::to_string(t.digits) + " digits"; });
  picklable(trust, &Trust::kind, &Trust::digits, &Trust::error, &Trust::worst);
  nb::class_<Watched> watched(m, "Watched", "A quantity that was watched from the first row to the last.");
  watched.def_ro("name", &Watched::name)
      .def_ro("first", &Watched::first)
      .def_ro("last", &Watched::last)
      .def_ro("least", &Watched::least)
      .def_ro("greatest", &Watched::greatest)
      .def_ro("largest_change", &Watched::largest_change, "From the first value, relative.")
      .def_ro("conserved", &Watched::conserved, "It is known to be an integral of the motion.")
      .def("__repr__",
           [](const Watched& w) { return nb::cast<std::string>(nb::str("{} = {!r}").format(w.name, w.last)); });
  picklable(watched, &Watched::name, &Watched::first, &Watched::last, &Watched::least, &Watched::greatest,
            &Watched::largest_change, &Watched::conserved);
  nb::class_<Report> report(
      m, "Report",
      "How far a run can be trusted. All residuals are relative to the greatest of their terms along the "
      "motion.");
  report.def_ro("newton", &Report::newton, "Newton's law by the points themselves, with ideal reactions.")
      .def_ro("projected", &Report::projected, "The same without multipliers.")
      .def_ro("constraints", &Report::constraints, "Constraints and their derivatives at the rows.")
      .def_ro("before_projection", &Report::before_projection, "The same before each step is projected.")
      .def_ro("power", &Report::power, "The change of the energy less the work.")
      .def_ro("smallest_sigma", &Report::smallest_sigma, "The least scaled singular value of the system Jacobian.")
      .def_ro("smallest_sigma_t", &Report::smallest_sigma_t, "When it was met, s.")
      .def_ro("steps", &Report::steps)
      .def_ro("order", &Report::order, "Of the Taylor polynomials.")
      .def_ro("method", &Report::method, "By which the last step was made.")
      .def_ro("seconds", &Report::seconds)
      .def_ro("trust", &Report::trust, "Empty if there is no estimate; no_trust then tells why.")
      .def_ro("no_trust", &Report::no_trust)
      .def_ro("watched", &Report::watched)
      .def_ro("warnings", &Report::warnings)
      .def_ro("notes", &Report::notes)
      .def_ro("rows_looked_at", &Report::rows_looked_at,
              "At so many rows the residuals were computed; the report of a long run looks at ever fewer.");
  shown(report, "report");
  picklable(report, &Report::newton, &Report::projected, &Report::constraints, &Report::before_projection,
            &Report::power, &Report::smallest_sigma, &Report::smallest_sigma_t, &Report::steps, &Report::order,
            &Report::method, &Report::seconds, &Report::trust, &Report::no_trust, &Report::watched, &Report::warnings,
            &Report::notes, &Report::rows_looked_at);
  nb::class_<Run>(m, "Run")
      .def_prop_ro("outcome", &Run::outcome)
      .def_prop_ro("rows", &Run::rows)
      .def_prop_ro("columns", &Run::columns)
      .def(
          "column",
          [](nb::handle self, const std::string& name) { return view(nb::cast<const Run&>(self).column(name), self); },
          "name"_a)
      .def(
          "block",
          [](nb::handle self, std::size_t first, std::size_t count) {
            const Run& run = nb::cast<const Run&>(self);
            const std::size_t rows = run.rows();
            if (first + count > run.columns().size()) throw nb::index_error("there are not so many columns");
            return nb::ndarray<nb::numpy, const double, nb::ndim<2>>(run.block().data() + first * rows, {rows, count},
                                                                     self, {1, static_cast<std::int64_t>(rows)});
          },
          "first"_a, "count"_a, "Columns that lie side by side, shape (rows, count), without a copy.")
      .def_prop_ro("has_dense", &Run::has_dense)
      .def(
          "at",
          [](const Run& run, const std::string& name, const View& times, int order) {
            constexpr std::size_t kMany = 16'384;
            std::vector<double> numbers;
            const auto compute = [&] { numbers = run.at(name, {times.data(), times.size()}, order); };
            times.size() < kMany ? unlocked(compute) : stoppable(compute);
            return array<1>(std::move(numbers), {times.size()});
          },
          "name"_a, "times"_a, "order"_a)
      .def("text", &Run::text, "row"_a, "column"_a)
      .def_prop_ro("events", &Run::events)
      .def_prop_ro("report", &Run::report)
      .def(
          "page",
          [](const Run& run, const std::vector<std::string>& forms, bool proof) {
            return value_of(interruptible([=] { return page(run, PageOptions{forms, proof}); }));
          },
          "forms"_a, "proof"_a)
      .def("picture_data", [](const Run& run) { return value_of(interruptible([=] { return picture_data(run); })); })
      .def(
          "figure",
          [](const Run& run, const std::vector<std::string>& columns, const std::string& x) {
            return value_of(unlocked([&] { return figure(run, FigureOptions{columns, x}); }));
          },
          "columns"_a, "x"_a)
      .def("json", [](const Run& run) { return interruptible([=] { return run.json(); }); })
      .def(
          "write",
          [](const Run& run, const std::string& path) {
            return value_of(interruptible([=] { return run.write(path); }));
          },
          "path"_a);
  m.def(
      "simulate",
      [](const System& system, const std::map<std::string, std::string>& others, const std::vector<std::string>& at,
         bool dense, nb::object stop, nb::object progress) {
        MotionOptions options;
        options.others = others;
        options.dense = dense;
        for (const std::string& t : at) options.at.emplace_back(t);
        Attendant attendant(std::move(stop), std::move(progress));
        options.cancelled = [&] { return attendant.cancelled(); };
        options.progress = [&](double t, std::size_t steps) { attendant.tell(t, steps); };
        Run run = value_of(attendant.attend([&] { return simulate(system, options); }));
        return std::pair(std::move(run), attendant.raised());
      },
      "system"_a, "others"_a, "at"_a, "dense"_a, "stop"_a.none(), "progress"_a.none());
}

}  // namespace

void bind_motions(nb::module_& m) {
  m.def(
      "symbol",
      [](const std::string& name, const Model* model) {
        Symbol s = symbol(name, model);
        return std::pair(std::move(s.latex), std::move(s.mathml));
      },
      "name"_a, "model"_a.none() = nb::none(), "LaTeX and MathML of a name, in the notation of the model.");
  bind_system(m);
  bind_run(m);
}

}  // namespace anholon::python
