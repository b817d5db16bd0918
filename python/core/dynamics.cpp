#include "interruptible.h"

namespace anholon::python {

namespace {

using In = nb::ndarray<nb::numpy, const double, nb::c_contig>;
using Out = nb::ndarray<nb::numpy, double, nb::c_contig>;
using Some = std::optional<In>;
using Doubles = std::vector<double>;

std::span<const double> span_of(const Some& numbers) {
  return numbers ? std::span(numbers->data(), numbers->size()) : std::span<const double>();
}

// Returns the number of states that an array holds, in its last axes.
std::size_t states_of(const Dynamics& f, const In& x) {
  const std::size_t states = f.states().size(), count = states == 0 ? 0 : x.size() / states;
  if (x.size() != states * count) throw nb::value_error("the shape of x does not fit");
  return count;
}

// The number of states for which the rates, or the derivatives and outputs, may take a tenth of a second.
constexpr std::size_t kManyRates = 16'384, kManyDerivatives = 256;

// NaN is not needed, because an exception follows and nobody sees the numbers.
constexpr bool kNanIfStopped = false;

// Calls f() without the interpreter's lock. If there are `many` states or more, Ctrl-C ends it.
template <class F>
void for_states(std::size_t count, std::size_t many, const F& f) {
  count < many ? unlocked(f) : stoppable(f);
}

// Computes rates; releases the interpreter's lock if there are many states.
void rates(const Dynamics& f, double t, const In& x, const Out& out, const Some& u, const Some& p) {
  constexpr std::size_t kLong = 64;
  const std::size_t states = f.states().size(), count = states == 0 ? 0 : x.size() / states;
  if (x.size() != states * count || out.size() != x.size()) throw nb::value_error("the shapes of x and out do not fit");
  const std::span<const double> from(x.data(), x.size());
  const std::span<double> to(out.data(), out.size());
  const Dynamics::Given given{span_of(u), span_of(p), kNanIfStopped};
  if (count < kLong) return f.rates(t, from, count, to, given);
  for_states(count, kManyRates, [&] { f.rates(t, from, count, to, given); });
}

}  // namespace

void bind_dynamics(nb::module_& m) {
  nb::class_<StateName>(m, "StateName", "A number of the state x.")
      .def_ro("name", &StateName::name)
      .def_ro("meaning", &StateName::meaning, "Of an independent velocity: its formula in coordinates and velocities.")
      .def("__repr__", [](const StateName& s) { return s.meaning.empty() ? s.name : s.name + " = " + s.meaning; });
  nb::class_<Dynamics>(m, "Dynamics")
      .def_prop_ro("states", &Dynamics::states)
      .def_prop_ro("inputs", [](const Dynamics& f) { return f.inputs(); })
      .def_prop_ro("parameters", &Dynamics::parameters)
      .def_prop_ro("outputs", [](const Dynamics& f) { return f.outputs(); })
      .def_prop_ro("minimal", &Dynamics::minimal)
      .def_prop_ro("obstacle", &Dynamics::obstacle)
      .def_prop_ro("linear", &Dynamics::linear)
      .def_prop_ro("start_time", &Dynamics::start_time)
      .def_prop_ro("start", &Dynamics::start)
      .def_prop_ro("start_inputs", &Dynamics::start_inputs)
      .def_prop_ro("parameter_values", &Dynamics::parameter_values)
      .def("rates", rates, "t"_a, "x"_a, "out"_a, "u"_a = nb::none(), "p"_a = nb::none())
      .def(
          "outputs_at",
          [](const Dynamics& f, double t, const In& x, const Some& u, const Some& p) {
            const std::size_t count = states_of(f, x), rows = f.outputs().size();
            Doubles made;
            for_states(count, kManyDerivatives,
                       [&] { made = f.outputs(t, span_of(x), count, {span_of(u), span_of(p), kNanIfStopped}); });
            return array<2>(std::move(made), {rows, count});
          },
          "t"_a, "x"_a, "u"_a.none(), "p"_a.none())
      .def(
          "inputs_at",
          [](const Dynamics& f, double t, const Doubles& x, const Doubles& p,
             const std::vector<std::optional<double>>& given) {
            return given.empty() ? f.inputs(t, x, p) : f.inputs(t, x, p, given);
          },
          "t"_a, "x"_a, "p"_a, "given"_a = std::vector<std::optional<double>>())
      .def(
          "leading",
          [](const Dynamics& f, double t, const Doubles& x, const Doubles& u, const Doubles& p) {
            return f.leading(t, x, {u, p});
          },
          "t"_a, "x"_a, "u"_a, "p"_a)
      .def(
          "jacobian",
          [](const Dynamics& f, double t, const In& x, const Some& u, const Some& p, std::size_t by) {
            const std::size_t count = states_of(f, x);
            Dynamics::Jacobian made;
            for_states(count, kManyDerivatives, [&] {
              made = f.jacobian(t, span_of(x), count, {span_of(u), span_of(p), kNanIfStopped},
                                static_cast<Dynamics::By>(by));
            });
            return array<3>(std::move(made.values), {made.rows, made.columns, count});
          },
          "t"_a, "x"_a, "u"_a.none(), "p"_a.none(), "by"_a)
      .def(
          "equations",
          [](const Dynamics& f, double t, const In& x, const Some& u, const Some& p) {
            const std::size_t count = states_of(f, x);
            Dynamics::Equations made;
            for_states(count, kManyDerivatives,
                       [&] { made = f.equations(t, span_of(x), count, {span_of(u), span_of(p), kNanIfStopped}); });
            const std::size_t n = made.unknowns.size();
            return std::tuple(made.unknowns, array<3>(std::move(made.matrix), {n, n, count}),
                              array<2>(std::move(made.right), {n, count}));
          },
          "t"_a, "x"_a, "u"_a.none(), "p"_a.none())
      .def(
          "source",
          [](const Dynamics& f, bool casadi, const std::string& name) {
            return unlocked(
                [&] { return f.source(casadi ? Dynamics::Source::casadi : Dynamics::Source::formulas, name); });
          },
          "casadi"_a, "name"_a)
      .def(
          "from_motion",
          [](const Dynamics& f, double t, const Doubles& q, const Doubles& qdot, const Doubles& z, const Doubles& p) {
            return f.from_motion(t, q, qdot, z, p);
          },
          "t"_a, "q"_a, "qdot"_a, "z"_a, "p"_a = Doubles())
      .def(
          "to_motion",
          [](const Dynamics& f, double t, const Doubles& x, const Doubles& p) {
            const Dynamics::Motion motion = f.to_motion(t, x, p);
            return std::tuple(motion.q, motion.qdot, motion.z);
          },
          "t"_a, "x"_a, "p"_a = Doubles());
  m.def(
      "dynamics",
      [](const System& system, bool minimal, bool inputs, const std::vector<std::string>& names,
         const std::optional<std::vector<std::pair<std::string, std::string>>>& outputs) {
        DynamicsOptions options{minimal, inputs, names, {}};
        if (outputs) {
          options.outputs.emplace();
          for (const auto& [name, formula] : *outputs) options.outputs->push_back({name, formula});
        }
        return value_of(interruptible([=] { return dynamics(system, options); }));
      },
      "system"_a, "minimal"_a, "inputs"_a, "names"_a, "outputs"_a.none());
}

}  // namespace anholon::python
