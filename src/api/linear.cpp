#include "anholon/linear.h"

#include "api/data.h"
#include "linear/equilibrium.h"
#include "linear/linearize.h"

namespace anholon::v1 {

static_assert(static_cast<int>(Steadiness::unchecked) == static_cast<int>(inner::LinearModel::Motion::unchecked));

static Matrix in_double(const inner::Matrix<inner::Multi>& a) {
  Matrix m{a.rows, a.cols, {}};
  for (std::size_t r = 0; r < a.rows; ++r)
    for (std::size_t c = 0; c < a.cols; ++c) m.values.push_back(inner::to_double(a(r, c)));
  return m;
}

Result<LinearModel> linearize(const System& system) {
  constexpr int kWorkingDigits = 40;
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<LinearModel> {
    inner::Signals signals;
    const std::shared_ptr<const inner::Model> model = inner::with_signals(*of.model->own_copy(), signals);
    inner::Scenario scenario;
    if (const inner::Outcome o = make_system(model, of.scenario.system.form->name, of.choice, scenario); !o.ok())
      return error_of(o);
    const inner::PrecisionScope precision(kWorkingDigits);
    const inner::Linearization l = inner::linearize(scenario, of.choice, std::nullopt, signals);
    const inner::LinearResult& r = l.results.at(0);
    if (!r.outcome.ok()) return error_of(r.outcome);
    LinearModel m;
    m.motion = static_cast<Steadiness>(r.model.motion);
    m.why = r.model.why;
    m.states = r.model.states, m.inputs = r.model.inputs, m.outputs = r.model.outputs;
    for (const inner::Multi& x : r.model.values) m.values.push_back(inner::to_double(x));
    m.A = in_double(r.model.A), m.B = in_double(r.model.B), m.C = in_double(r.model.C), m.D = in_double(r.model.D);
    for (const inner::Eigenvalue& e : r.model.spectrum)
      m.eigenvalues.emplace_back(inner::to_double(e.value.re), inner::to_double(e.value.im));
    return m;
  });
}

}  // namespace anholon::v1
