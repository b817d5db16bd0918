#include <memory>

#include "core.h"

namespace anholon::python {

std::map<std::string, Number> numbers(const Numbers& texts) {
  std::map<std::string, Number> list;
  for (const auto& [name, text] : texts) list.emplace(name, Number(text));
  return list;
}

View view(std::span<const double> numbers, nb::handle owner) { return View(numbers.data(), {numbers.size()}, owner); }

namespace {

nb::list diagnostics_of(const Error& error) {
  nb::list list;
  for (const Diagnostic& d : error.diagnostics) list.append(nb::cast(d));
  return list;
}

// Translates errors into exceptions, which are classes of the Python package; the package makes them.
void translate(const std::exception_ptr& thrown, void*) {
  try {
    std::rethrow_exception(thrown);
  } catch (const Trouble& trouble) {
    const nb::object made =
        nb::module_::import_("anholon._errors")
            .attr("error_of")(trouble.error.text, diagnostics_of(trouble.error),
                              trouble.error.outcome ? nb::cast(*trouble.error.outcome) : nb::none());
    PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(made.ptr())), made.ptr());
  }
}

}  // namespace

void bind_results(nb::module_& m) {
  nb::register_exception_translator(translate, nullptr);
  m.def("version", version, "The version of the library.");

  nb::enum_<Severity>(m, "Severity", "How much a remark on a model matters.")
      .value("error", Severity::error)
      .value("warning", Severity::warning)
      .value("note", Severity::note);
  nb::class_<Diagnostic>(m, "Diagnostic", "One remark on the text of a model, with its place.")
      .def_ro("severity", &Diagnostic::severity)
      .def_ro("message", &Diagnostic::message)
      .def_ro("hint", &Diagnostic::hint, "What to write instead; may be empty.")
      .def_ro("file", &Diagnostic::file)
      .def_ro("line", &Diagnostic::line, "From 1; 0 stands for the text as a whole.")
      .def_ro("column", &Diagnostic::column, "From 1, in characters.")
      .def_ro("length", &Diagnostic::length, "In characters.")
      .def("__getstate__",
           [](const Diagnostic& d) {
             return std::make_tuple(static_cast<int>(d.severity), d.message, d.hint, d.file, d.line, d.column,
                                    d.length);
           })
      .def("__setstate__",
           [](Diagnostic& d,
              const std::tuple<int, std::string, std::string, std::string, unsigned, unsigned, unsigned>& state) {
             const auto& [severity, message, hint, file, line, column, length] = state;
             new (&d) Diagnostic{static_cast<Severity>(severity), message, hint, file, line, column, length};
           })
      .def("__repr__", [](const Diagnostic& d) {
        return d.file + ":" + std::to_string(d.line) + ":" + std::to_string(d.column) + ": " + d.message;
      });
  nb::class_<Outcome> outcome(m, "Outcome", "How a computation ended, and what to do if it stopped early.");
  outcome
      .def_prop_ro(
          "kind", [](const Outcome& o) { return std::string(name(o.kind)); },
          "'finished', 'singular', 'step_collapse', 'blow_up', 'negative_mass', 'not_a_number', "
          "'no_convergence', 'inconsistent', 'interrupted' or 'too_large'.")
      .def_ro("message", &Outcome::message, "What happened, and where.")
      .def_ro("hint", &Outcome::hint, "What to do.")
      .def_prop_ro("ok", &Outcome::ok)
      .def("__bool__", &Outcome::ok)
      .def("__getstate__",
           [](const Outcome& o) { return std::make_tuple(static_cast<int>(o.kind), o.message, o.hint); })
      .def("__setstate__",
           [](Outcome& o, const std::tuple<int, std::string, std::string>& state) {
             const auto& [kind, message, hint] = state;
             new (&o) Outcome{static_cast<OutcomeKind>(kind), message, hint};
           })
      .def("__repr__", [](const Outcome& o) {
        return o.ok() ? std::string("finished") : std::string(name(o.kind)) + ": " + o.message + "\nhint: " + o.hint;
      });
  shown(outcome, "outcome");
}

void Attendant::look() {
  const nb::gil_scoped_acquire lock;
  if (cancelled()) return;
  try {
    if (PyErr_CheckSignals() != 0) throw nb::python_error();
    if (!progress_.is_none() && count_ > 0) progress_(done_.load(), count_.load());
    if (!stop_.is_none()) {
      const nb::object answer = stop_();
      const int truth = PyObject_IsTrue(answer.ptr());  // a bool of NumPy, None, a number: what `if` takes for true
      if (truth < 0) throw nb::python_error();
      if (truth > 0) ends_ = true;
    }
  } catch (nb::python_error& error) {
    raised_ = nb::borrow(error.value());
    ends_ = true;
  } catch (...) {
    // The exception must not leave this function, because the computing thread has to be waited for.
    failed_ = std::current_exception();
    ends_ = true;
  }
}

}  // namespace anholon::python
