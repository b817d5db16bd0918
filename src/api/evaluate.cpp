#include "anholon/evaluate.h"

#include "api/data.h"
#include "model/motion_settings.h"
#include "observe/evaluate.h"

namespace anholon::v1 {

namespace {

std::vector<NamedText> named(const inner::StateReport::Named& list) {
  std::vector<NamedText> out;
  for (const auto& [name, text] : list) out.push_back({name, text});
  return out;
}

}  // namespace

Result<StateReport> evaluate(const System& system, int digits) {
  const System::Data& of = system.data();
  return guarded(of.model->source, [&]() -> Result<StateReport> {
    of.model->without_contacts("evaluate");
    inner::MotionSettings checked;
    inner::set(checked, inner::motion_option("digits"), inner::Rational(digits), "digits");
    inner::StateReport r;
    if (const inner::Outcome o = inner::evaluate(of.scenario, of.choice, digits, r); !o.ok()) return error_of(o);
    StateReport out;
    out.form = of.scenario.system.form->name;
    out.t = r.t;
    out.q = named(r.q), out.qdot = named(r.qdot);
    for (const auto& [name, values] : r.forces) out.forces.push_back({name, values});
    out.derivatives = named(r.derivatives), out.multipliers = named(r.lambda), out.numbers = named(r.numbers);
    out.mass_matrix = std::move(r.mass_matrix);
    for (const inner::StateReport::Reaction& x : r.reactions) out.reactions.push_back({x.body, x.force, x.torque});
    out.residuals = named(r.residuals);
    return out;
  });
}

}  // namespace anholon::v1
