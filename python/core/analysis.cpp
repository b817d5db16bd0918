#include "interruptible.h"

namespace anholon::python {

namespace {

using MatrixView = nb::ndarray<nb::numpy, const double, nb::ndim<2>>;

// Returns a view of numbers of `owner`, without a copy.
MatrixView matrix(const Matrix& a, nb::handle owner) { return MatrixView(a.values.data(), {a.rows, a.columns}, owner); }

// Returns the member of a LinearModel as an array that keeps the model alive.
template <Matrix LinearModel::* member>
MatrixView matrix_of(nb::handle self) {
  return matrix(nb::cast<const LinearModel&>(self).*member, self);
}
template <Matrix LinearModel::* member>
std::vector<std::string> texts_of(const LinearModel& l) {
  return (l.*member).texts;
}

const char* truth(Verdict v) { return v == Verdict::proved ? "true" : v == Verdict::refuted ? "false" : "unknown"; }

void bind_compare(nb::module_& m) {
  nb::class_<ChangedPlace> place(m, "ChangedPlace", "A place of a published equation that is to be changed.");
  place.def_ro("wrong", &ChangedPlace::from, "What stands there.")
      .def_ro("right", &ChangedPlace::to, "What should stand there.")
      .def_ro("place", &ChangedPlace::place, "'second term of the left side'.")
      .def_ro("line", &ChangedPlace::line, "In the text of the equations, from 1.")
      .def_ro("column", &ChangedPlace::column, "From 1, in characters.")
      .def("__repr__", [](const ChangedPlace& p) { return p.place + ": " + p.from + " should be " + p.to; });
  picklable(place, &ChangedPlace::from, &ChangedPlace::to, &ChangedPlace::place, &ChangedPlace::line,
            &ChangedPlace::column);
  nb::class_<Suggestion> suggestion(m, "Suggestion", "A change that makes a published equation true.");
  suggestion.def_ro("places", &Suggestion::places, "One place, or several that change together.")
      .def_ro("reads", &Suggestion::reads, "The changed equation.")
      .def_ro("proved", &Suggestion::proved, "Whether the changed equation is proved to be true.")
      .def_ro("text", &Suggestion::text, "The change as a sentence with its line and column.")
      .def("__repr__", [](const Suggestion& s) { return s.text + (s.proved ? "" : " (not proved)"); });
  picklable(suggestion, &Suggestion::places, &Suggestion::reads, &Suggestion::proved, &Suggestion::text);
  nb::class_<ComparedEquation> equation(m, "ComparedEquation", "A published equation, compared with the derived ones.");
  equation.def_ro("label", &ComparedEquation::label)
      .def_ro("text", &ComparedEquation::text)
      .def_prop_ro(
          "verdict", [](const ComparedEquation& e) { return std::string(truth(e.verdict)); },
          "'true' (proved), 'false' (refuted at a point of the motion) or 'unknown'.")
      .def_prop_ro(
          "what", [](const ComparedEquation& e) { return e.verdict == Verdict::refuted ? std::string() : e.what; },
          "Of a true equation: its kind.")
      .def_prop_ro(
          "nearest", [](const ComparedEquation& e) { return e.verdict == Verdict::refuted ? e.what : std::string(); },
          "Of a false equation: the nearest true one; empty if it holds at some points and fails at others, or has no "
          "term "
          "in common with any.")
      .def_ro("difference", &ComparedEquation::difference,
              "Of a false equation: left - right less the nearest true one; empty if there is none.")
      .def_ro("detail", &ComparedEquation::detail,
              "Of a false equation: left - right at `point`; of an unknown one: why.")
      .def_ro("point", &ComparedEquation::point, "Of a false equation: a point of the motion at which it fails.")
      .def_ro("suggestions", &ComparedEquation::suggestions, "Changes, each of which makes it true.")
      .def_ro(
          "with_numbers", &ComparedEquation::with_numbers,
          "Of a false or unknown equation that holds with numbers of the file: these numbers, as 'J = 0.5, c = 0.7'.")
      .def("__bool__", [](const ComparedEquation& e) { return e.verdict == Verdict::proved; })
      .def("__repr__", [](const ComparedEquation& e) {
        std::string text = e.label + ": " + truth(e.verdict);
        if (e.verdict == Verdict::refuted && !e.suggestions.empty()) return text + ", " + e.suggestions[0].text;
        if (!e.with_numbers.empty()) return text + ", it holds with the file's numbers " + e.with_numbers;
        if (e.what.empty() && e.verdict == Verdict::refuted)
          return text + ", left - right is " + e.detail + " at a point";
        return text + ", " +
               (e.verdict == Verdict::unknown ? e.detail : (e.verdict == Verdict::proved ? "" : "nearest: ") + e.what);
      });
  picklable(equation, &ComparedEquation::label, &ComparedEquation::text, &ComparedEquation::verdict,
            &ComparedEquation::what, &ComparedEquation::difference, &ComparedEquation::detail, &ComparedEquation::point,
            &ComparedEquation::suggestions, &ComparedEquation::with_numbers);
  m.def(
      "compare",
      [](const Model& model, const std::string& equations, bool file, const std::string& name,
         const std::vector<std::string>& eliminate, const Numbers& initial) {
        const CompareOptions options{name, eliminate, numbers(initial)};
        return value_of(interruptible(
            [=] { return file ? compare_file(model, equations, options) : compare(model, equations, options); }));
      },
      "model"_a, "equations"_a, "file"_a, "name"_a, "eliminate"_a, "initial"_a);
}

void bind_evaluate(nb::module_& m) {
  using Texts = std::vector<std::pair<std::string, std::string>>;
  static constexpr auto named = [](const std::vector<NamedText>& list) {
    Texts out;
    for (const NamedText& n : list) out.emplace_back(n.name, n.text);
    return out;
  };
  nb::class_<StateReport>(m, "StateReport", "Everything about one state, with numbers as texts.")
      .def_ro("form", &StateReport::form)
      .def_ro("t", &StateReport::t)
      .def_prop_ro("q", [](const StateReport& r) { return named(r.q); })
      .def_prop_ro("qdot", [](const StateReport& r) { return named(r.qdot); })
      .def_prop_ro("forces",
                   [](const StateReport& r) {
                     std::vector<std::pair<std::string, std::vector<std::string>>> out;
                     for (const StateReport::Force& f : r.forces) out.emplace_back(f.name, f.values);
                     return out;
                   })
      .def_prop_ro("derivatives", [](const StateReport& r) { return named(r.derivatives); })
      .def_prop_ro("multipliers", [](const StateReport& r) { return named(r.multipliers); })
      .def_prop_ro("numbers", [](const StateReport& r) { return named(r.numbers); })
      .def_ro("mass_matrix", &StateReport::mass_matrix)
      .def_prop_ro("reactions",
                   [](const StateReport& r) {
                     std::vector<std::tuple<std::string, std::vector<std::string>, std::vector<std::string>>> out;
                     for (const StateReport::Reaction& x : r.reactions) out.emplace_back(x.body, x.force, x.torque);
                     return out;
                   })
      .def_prop_ro("residuals", [](const StateReport& r) { return named(r.residuals); });
  m.def(
      "evaluate",
      [](const System& system, int digits) {
        return value_of(interruptible([=] { return evaluate(system, digits); }));
      },
      "system"_a, "digits"_a);
}

LinearOptions linear_options(const std::string& form, const Numbers& initial, const std::vector<std::string>& eliminate,
                             bool equilibrium, int digits) {
  return {form, numbers(initial), eliminate, equilibrium, digits};
}

void bind_linear(nb::module_& m) {
  nb::class_<Matrix> rows(m, "LinearMatrix", "Numbers of a linear model, row after row.");
  picklable(rows, &Matrix::rows, &Matrix::columns, &Matrix::values, &Matrix::texts);
  nb::class_<LinearModel> linear(m, "LinearModel");
  linear
      .def_prop_ro("motion",
                   [](const LinearModel& l) {
                     const char* names[] = {"equilibrium", "steady", "unsteady", "unchecked"};
                     return std::string(names[static_cast<int>(l.motion)]);
                   })
      .def_ro("why", &LinearModel::why)
      .def_ro("t", &LinearModel::t)
      .def_ro("states", &LinearModel::states)
      .def_ro("dependent", &LinearModel::dependent)
      .def_ro("cyclic", &LinearModel::cyclic)
      .def_ro("core", &LinearModel::core)
      .def_ro("inputs", &LinearModel::inputs)
      .def_ro("outputs", &LinearModel::outputs)
      .def_ro("notes", &LinearModel::notes)
      .def_ro("values", &LinearModel::values)
      .def_ro("value_texts", &LinearModel::value_texts)
      .def_prop_ro("A", matrix_of<&LinearModel::A>)
      .def_prop_ro("B", matrix_of<&LinearModel::B>)
      .def_prop_ro("C", matrix_of<&LinearModel::C>)
      .def_prop_ro("D", matrix_of<&LinearModel::D>)
      .def_prop_ro("A_texts", texts_of<&LinearModel::A>)
      .def_prop_ro("B_texts", texts_of<&LinearModel::B>)
      .def_prop_ro("C_texts", texts_of<&LinearModel::C>)
      .def_prop_ro("D_texts", texts_of<&LinearModel::D>)
      .def_ro("eigenvalues", &LinearModel::eigenvalues)
      .def_ro("eigenvalue_texts", &LinearModel::eigenvalue_texts)
      .def_ro("multiplicities", &LinearModel::multiplicities)
      .def_ro("modes", &LinearModel::modes);
  picklable(linear, &LinearModel::motion, &LinearModel::why, &LinearModel::t, &LinearModel::states,
            &LinearModel::dependent, &LinearModel::cyclic, &LinearModel::core, &LinearModel::inputs,
            &LinearModel::outputs, &LinearModel::values, &LinearModel::value_texts, &LinearModel::notes,
            &LinearModel::A, &LinearModel::B, &LinearModel::C, &LinearModel::D, &LinearModel::eigenvalues,
            &LinearModel::eigenvalue_texts, &LinearModel::multiplicities, &LinearModel::modes);
  nb::class_<Crossing> crossing(m, "Crossing",
                                "A value of a parameter at which an eigenvalue crosses the imaginary axis.");
  crossing.def_ro("value", &Crossing::value, "Of the parameter, in the unit that the model declares for it, else SI.")
      .def_ro("frequency", &Crossing::frequency, "Of the eigenvalue there, rad/s; 0: it is real.")
      .def_ro("eigenvalues", &Crossing::eigenvalues, "How many cross: 2 for a pair.")
      .def_ro("destabilizes", &Crossing::destabilizes, "For growing values the eigenvalue moves to the right.")
      .def_ro("value_text", &Crossing::value_text, "`value` with as many digits as asked for.")
      .def_ro("frequency_text", &Crossing::frequency_text, "`frequency` with as many digits as asked for.")
      .def_ro(
          "meaning", &Crossing::meaning,
          "'stable above' or 'unstable above'; 'to the left above', 'to the right above' of eigenvalues that do not "
          "decide, as others are unstable or the states are not steady.")
      .def("__repr__", [](const Crossing& c) {
        return c.value_text + (c.frequency > 0 ? ", a pair of frequency " + c.frequency_text : ", a real eigenvalue") +
               ": " + c.meaning;
      });
  picklable(crossing, &Crossing::value, &Crossing::frequency, &Crossing::eigenvalues, &Crossing::destabilizes,
            &Crossing::value_text, &Crossing::frequency_text, &Crossing::meaning);
  nb::class_<Stability> stability_class(m, "Stability");
  stability_class.def_ro("parameter", &Stability::parameter)
      .def_ro("values", &Stability::values)
      .def_ro("models", &Stability::models)
      .def_ro("outcomes", &Stability::outcomes)
      .def_ro("curves", &Stability::curves)
      .def_ro("crossings", &Stability::crossings)
      .def_ro("notes", &Stability::notes);
  picklable(stability_class, &Stability::parameter, &Stability::values, &Stability::models, &Stability::outcomes,
            &Stability::curves, &Stability::crossings, &Stability::notes);
  m.def(
      "linearize",
      [](const Model& model, const std::string& form, const Numbers& initial, const std::vector<std::string>& eliminate,
         bool equilibrium, int digits) {
        const LinearOptions options = linear_options(form, initial, eliminate, equilibrium, digits);
        return value_of(interruptible([=] { return linearize(model, options); }));
      },
      "model"_a, "form"_a, "initial"_a, "eliminate"_a, "equilibrium"_a, "digits"_a);
  m.def(
      "stability",
      [](const Model& model, const std::string& parameter, const std::vector<std::string>& values,
         const std::string& form, const Numbers& initial, const std::vector<std::string>& eliminate, bool equilibrium,
         int digits) {
        const LinearOptions options = linear_options(form, initial, eliminate, equilibrium, digits);
        const std::vector<Number> list(values.begin(), values.end());
        return value_of(interruptible([=] { return stability(model, parameter, list, options); }));
      },
      "model"_a, "parameter"_a, "values"_a, "form"_a, "initial"_a, "eliminate"_a, "equilibrium"_a, "digits"_a);
}

}  // namespace

void bind_analysis(nb::module_& m) {
  bind_compare(m);
  bind_evaluate(m);
  bind_linear(m);
}

}  // namespace anholon::python
