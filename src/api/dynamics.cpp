#include "anholon/dynamics.h"

#include "api/data.h"
#include "motion/dynamics.h"

namespace anholon::v1 {

struct Dynamics::Data {
  std::unique_ptr<const inner::Dynamics> function;
  std::vector<StateName> states;
};

Result<Dynamics> dynamics(const System& system, const DynamicsOptions& options) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<Dynamics> {
    inner::Workspace s(of.scenario);
    auto data = std::make_shared<Dynamics::Data>();
    std::string why;
    data->function = inner::Dynamics::make(s, of.choice, options.minimal, why);
    if (!data->function)
      return mistake("there is no function x' = f(t, x) of these equations: " + why,
                     "simulate integrates them all the same");
    for (const inner::Dynamics::State& state : data->function->states())
      data->states.push_back({state.name, state.meaning});
    return Dynamics(std::move(data));
  });
}

const std::vector<StateName>& Dynamics::states() const { return data_->states; }
bool Dynamics::minimal() const { return data_->function->minimal(); }
double Dynamics::start_time() const { return data_->function->start_time(); }
const std::vector<double>& Dynamics::start() const { return data_->function->start(); }

void Dynamics::rates(double t, std::span<const double> x, std::size_t count, std::span<double> rates) const {
  data_->function->rates(t, x.data(), count, rates.data());
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
