#include "anholon/dynamics.h"

#include <mutex>

#include "api/data.h"
#include "motion/dynamics.h"
#include "motion/state_jacobian.h"

namespace anholon::v1 {

struct Dynamics::Data {
  std::unique_ptr<const inner::Dynamics> function;
  std::vector<StateName> states;
  std::size_t coordinates = 0, model_states = 0;
  System system;
  // The derivatives, made when they are asked for first.
  mutable std::once_flag once;
  mutable std::unique_ptr<const inner::StateJacobian> derivatives;
};

Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Dynamics> {
    inner::Workspace s(of.scenario);
    const auto data = std::shared_ptr<Dynamics::Data>(new Dynamics::Data{{}, {}, 0, 0, system, {}, {}});
    data->coordinates = s.system.coordinates, data->model_states = s.model->states.size();
    std::string why;
    data->function = inner::Dynamics::make(s, of.choice, options.minimal, why);
    if (!data->function)
      return mistake("there is no function x' = f(t, x) of these equations: " + why,
                     "simulate integrates them all the same");
    for (const inner::Dynamics::State& state : data->function->states())
      data->states.push_back({state.name, state.meaning});
    return Dynamics(data);
  });
}

const std::vector<StateName>& Dynamics::states() const { return data_->states; }
bool Dynamics::minimal() const { return data_->function->minimal(); }
double Dynamics::start_time() const { return data_->function->start_time(); }
const std::vector<double>& Dynamics::start() const { return data_->function->start(); }

void Dynamics::rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates) const {
  data_->function->rates(t, x.data(), count, rates.data());
}

Dynamics::Jacobian Dynamics::jacobian(double t, const std::vector<double>& x) const {
  const Data& data = *data_;
  std::call_once(data.once, [&] {
    inner::Workspace own(data.system.data().scenario);
    data.derivatives = std::make_unique<const inner::StateJacobian>(own);
  });
  const std::size_t n = data.coordinates, z = data.model_states, size = x.size();
  // Entries of the state in the order of the unknowns: q_a and q_a' together.
  std::vector<std::size_t> place;
  for (std::size_t a = 0; a < n; ++a) place.insert(place.end(), {a, n + a});
  for (std::size_t i = 0; i < z; ++i) place.push_back(2 * n + i);
  std::vector<double> state;
  for (const std::size_t p : place) state.push_back(x[p]);
  const std::vector<double> leading = data.function->leading(t, x);
  const std::vector<double> parameters(data.function->parameters().begin(), data.function->parameters().end());
  const auto d = data.derivatives->at(t, state, leading, parameters);
  Jacobian out{size, d.parameters, std::vector<double>(size * size, 0), std::vector<double>(size * d.parameters, 0)};
  for (std::size_t a = 0; a < n; ++a) out.by_state[a * size + n + a] = 1;
  const std::size_t unknowns = leading.size();
  for (std::size_t row = n; row < size; ++row) {
    const std::size_t j = row < 2 * n ? row - n : unknowns - z + row - 2 * n;
    for (std::size_t e = 0; e < place.size(); ++e) out.by_state[row * size + place[e]] = d.by_state[j * d.states + e];
    for (std::size_t p = 0; p < d.parameters; ++p)
      out.by_parameter[row * d.parameters + p] = d.by_parameter[j * d.parameters + p];
  }
  return out;
}

std::vector<double> Dynamics::from_motion(double t, const std::vector<double>& q, const std::vector<double>& qdot,
                                          const std::vector<double>& z) const {
  return data_->function->from_motion(t, q, qdot, z);
}

Dynamics::Motion Dynamics::to_motion(double t, const std::vector<double>& x) const {
  auto [q, qdot, z] = data_->function->to_motion(t, x);
  return {std::move(q), std::move(qdot), std::move(z)};
}

}  // namespace anholon::v1
