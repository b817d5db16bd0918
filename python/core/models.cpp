#include "interruptible.h"

namespace anholon::python {

namespace {

void bind_model(nb::module_& m) {
  nb::class_<Coordinate>(m, "Coordinate", "A coordinate of a model.")
      .def_ro("name", &Coordinate::name)
      .def_ro("unit", &Coordinate::unit, "SI; empty where the file names none.")
      .def("__repr__", [](const Coordinate& c) { return c.unit.empty() ? c.name : c.name + " [" + c.unit + "]"; });
  nb::class_<Parameter>(m, "Parameter", "A parameter of a model.")
      .def_ro("name", &Parameter::name)
      .def_ro("value", &Parameter::value,
              "In the unit that the file declares for it, else SI; NaN if the file gives the parameter no value.")
      .def_ro("unit", &Parameter::unit, "Of the value; empty where the file names none.")
      .def("__repr__", [](const Parameter& p) {
        return nb::cast<std::string>(
            nb::str("{} = {!r}{}").format(p.name, p.value, p.unit.empty() ? "" : " " + p.unit));
      });
  nb::class_<Constraint>(m, "Constraint", "A constraint of a model.")
      .def_ro("name", &Constraint::name, "Its multiplier is lambda.NAME.")
      .def_ro("order", &Constraint::order, "The highest derivative of a coordinate in it; 0: holonomic.")
      .def("__repr__", [](const Constraint& c) { return c.name + ", order " + std::to_string(c.order); });
  nb::class_<Form>(m, "Form", "A classical form of the equations of motion.")
      .def_ro("name", &Form::name)
      .def_ro("title", &Form::title)
      .def_ro("equation", &Form::equation, "Its number in the source.")
      .def_ro("source", &Form::source)
      .def_ro("applies", &Form::applies, "Whether it applies to this model.")
      .def_ro("obstacle", &Form::obstacle, "Why it does not.")
      .def("__repr__",
           [](const Form& f) { return f.name + (f.applies ? "" : " (does not apply: " + f.obstacle + ")"); });
  nb::class_<ShippedModel>(m, "ShippedModel", "A model that comes with the library.")
      .def_ro("name", &ShippedModel::name)
      .def_ro("path", &ShippedModel::path)
      .def_ro("title", &ShippedModel::title)
      .def("__repr__", [](const ShippedModel& s) { return s.name + ": " + s.title; });
  nb::class_<Model>(m, "Model")
      .def_prop_ro("title", &Model::title)
      .def_prop_ro("coordinates", &Model::coordinates)
      .def_prop_ro("parameters", &Model::parameters)
      .def_prop_ro("constraints", &Model::constraints)
      .def_prop_ro("states", &Model::states)
      .def_prop_ro("inputs", &Model::inputs)
      .def_prop_ro("monitors", &Model::monitors)
      .def_prop_ro("cases", &Model::cases)
      .def_prop_ro("remarks", &Model::remarks)
      .def_prop_ro("text", &Model::text)
      .def("forms", [](const Model& model) { return value_of(interruptible([=] { return model.forms(); })); });
  m.def(
      "read_file",
      [](const std::string& path, const Numbers& set, const Words& cases, const Words& mode) {
        return value_of(interruptible([=] { return read_file(path, read_options(set, cases, mode)); }));
      },
      "path"_a, "set"_a, "cases"_a, "mode"_a);
  m.def(
      "read_text",
      [](const std::string& text, const Numbers& set, const Words& cases, const Words& mode, const std::string& name) {
        return value_of(interruptible([=] { return read_text(text, read_options(set, cases, mode), name); }));
      },
      "text"_a, "set"_a, "cases"_a, "mode"_a, "name"_a);
  m.def("shipped_models", shipped_models);
}

void bind_equations(nb::module_& m) {
  nb::class_<Equations> equations(m, "Equations");
  equations.def_ro("form", &Equations::form)
      .def_ro("text", &Equations::text)
      .def_ro("latex", &Equations::latex)
      .def_ro("mathml", &Equations::mathml)
      .def_ro("json", &Equations::json)
      .def_ro("html", &Equations::html);
  picklable(equations, &Equations::form, &Equations::text, &Equations::latex, &Equations::mathml, &Equations::json,
            &Equations::html);
  m.def(
      "derive",
      [](const Model& model, const std::string& form, const std::string& expand, bool steps, bool reactions) {
        const DeriveOptions options{form, expand, steps, reactions};
        return value_of(interruptible([=] { return derive(model, options); }));
      },
      "model"_a, "form"_a, "expand"_a, "steps"_a, "reactions"_a);
}

void bind_proofs(nb::module_& m) {
  nb::class_<FormVerdict> verdict(m, "FormVerdict", "Whether a form agrees with Routh's equations.");
  verdict.def_ro("form", &FormVerdict::form)
      .def_prop_ro(
          "verdict",
          [](const FormVerdict& v) {
            return std::string(v.verdict == Verdict::proved    ? "proved"
                               : v.verdict == Verdict::refuted ? "refuted"
                                                               : "unknown");
          },
          "'proved', 'refuted', or 'unknown' if neither a proof nor a point that refutes was found.")
      .def_ro("detail", &FormVerdict::detail, "The first difference that is not proved to vanish.")
      .def("__repr__", [](const FormVerdict& v) {
        return v.form + ": " + nb::cast<std::string>(nb::cast(v).attr("verdict")) +
               (v.detail.empty() ? "" : ", " + v.detail);
      });
  picklable(verdict, &FormVerdict::form, &FormVerdict::verdict, &FormVerdict::detail);
  nb::class_<Proof> proof(m, "Proof");
  proof.def_ro("forms", &Proof::forms)
      .def_ro("certificate", &Proof::certificate)
      .def_prop_ro("all_proved", &Proof::all_proved);
  picklable(proof, &Proof::forms, &Proof::certificate, &Proof::stopped);
  nb::class_<Verification> verification(m, "Verification", "What an independent check of a certificate found.");
  verification.def_ro("claims", &Verification::claims)
      .def_ro("confirmed", &Verification::confirmed)
      .def_prop_ro("all_confirmed", &Verification::all_confirmed)
      .def("__bool__", &Verification::all_confirmed)
      .def("__repr__", [](const Verification& v) {
        return std::to_string(v.confirmed) + " of " + std::to_string(v.claims) + " claims confirmed";
      });
  picklable(verification, &Verification::claims, &Verification::confirmed);
  m.def(
      "prove",
      [](const Model& model, const std::vector<std::string>& forms) {
        return value_of(interruptible([=] { return prove(model, forms); }));
      },
      "model"_a, "forms"_a);
  m.def(
      "verify",
      [](const std::string& certificate) { return value_of(interruptible([=] { return verify(certificate); })); },
      "certificate"_a);
}

}  // namespace

void bind_models(nb::module_& m) {
  bind_model(m);
  bind_equations(m);
  bind_proofs(m);
}

}  // namespace anholon::python
