// Runge-Kutta-Fehlberg 7(8) of Boost's odeint (serve.h: how it is asked).
#include <boost/numeric/odeint.hpp>

#include "serve.h"

namespace {

template <class System, class State>
struct Fehlberg {
  Fehlberg(const System& of, double with_tolerance, double to) : system(of), tolerance(with_tolerance), end(to) {}
  std::size_t operator()(State& x) {
    namespace ode = boost::numeric::odeint;
    std::size_t steps = 0;
    ode::integrate_adaptive(ode::make_controlled<ode::runge_kutta_fehlberg78<State>>(tolerance, tolerance),
                            std::cref(system), x, 0.0, end, end / 1000, [&steps](const State&, double) { ++steps; });
    return steps - 1;
  }
  const System& system;
  double tolerance, end;
};

}  // namespace

int main(int argc, char** argv) { return peers::serve<Fehlberg>(argc, argv); }
