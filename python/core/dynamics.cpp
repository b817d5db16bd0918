#include "core.h"

namespace anholon::python {

namespace {

using In = nb::ndarray<nb::numpy, const double, nb::c_contig>;
using Out = nb::ndarray<nb::numpy, double, nb::c_contig>;

// Without the interpreter's lock where that pays.
void rates(const Dynamics& f, double t, const In& x, const Out& out) {
  constexpr std::size_t kLong = 64;
  const std::size_t states = f.states().size(), count = states == 0 ? 0 : x.size() / states;
  if (x.size() != states * count || out.size() != x.size()) throw nb::value_error("the shapes of x and out do not fit");
  const std::span<const double> from(x.data(), x.size());
  const std::span<double> to(out.data(), out.size());
  if (count < kLong) return f.rates(t, from, count, to);
  unlocked([&] { f.rates(t, from, count, to); });
}

}  // namespace

void bind_dynamics(nb::module_& m) {
  nb::class_<StateName>(m, "StateName", "A number of the state x.")
      .def_ro("name", &StateName::name)
      .def_ro("meaning", &StateName::meaning, "Of an independent velocity: its formula in coordinates and velocities.")
      .def("__repr__", [](const StateName& s) { return s.meaning.empty() ? s.name : s.name + " = " + s.meaning; });
  nb::class_<Dynamics>(m, "Dynamics")
      .def_prop_ro("states", &Dynamics::states)
      .def_prop_ro("minimal", &Dynamics::minimal)
      .def_prop_ro("start_time", &Dynamics::start_time)
      .def_prop_ro("start", &Dynamics::start)
      .def("rates", rates, "t"_a, "x"_a, "out"_a)
      .def("from_motion", &Dynamics::from_motion, "t"_a, "q"_a, "qdot"_a, "z"_a)
      .def(
          "jacobian",
          [](const Dynamics& f, double t, const std::vector<double>& x, bool by_parameter) {
            Dynamics::Jacobian made = f.jacobian(t, x);
            return array<2>(std::move(by_parameter ? made.by_parameter : made.by_state),
                            {made.states, by_parameter ? made.parameters : made.states});
          },
          "t"_a, "x"_a, "by_parameter"_a)
      .def(
          "to_motion",
          [](const Dynamics& f, double t, const std::vector<double>& x) {
            const Dynamics::Motion motion = f.to_motion(t, x);
            return std::tuple(motion.q, motion.qdot, motion.z);
          },
          "t"_a, "x"_a);
  m.def(
      "dynamics",
      [](const System& system, bool minimal) {
        return value_of(unlocked([&] { return dynamics(system, DynamicsOptions{minimal}); }));
      },
      "system"_a, "minimal"_a);
}

}  // namespace anholon::python
