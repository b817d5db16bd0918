#include "setup/program.h"

#include "setup/ends_of_tables.h"
#include "setup/inputs.h"
#include "structure/parameters_of_order.h"

namespace anholon {

namespace {

// Returns the start by variable, as programs need it. Values that constraints determine are computed in wider numbers,
// as for a motion.
EmitOptions::Start start_for_program(Workspace& s, const StateChoice& choice) {
  Start<double> start;
  if (Start<long double> wide; initial_state(s, choice, wide).ok()) {
    start.t = static_cast<double>(wide.t);
    start.state.assign(wide.state.begin(), wide.state.end());
    start.leading.assign(wide.leading.begin(), wide.leading.end());
  } else {
    start = start_of(s);
  }
  EmitOptions::Start out{start.t, {}, start.leading};
  auto next = start.state.begin();
  for (std::size_t j = 0; j < s.system.size(); ++j) {
    const auto end = next + s.structure.d[j];
    out.values.emplace_back(next, end);
    next = end;
  }
  return out;
}

}  // namespace

std::string program_text(const Scenario& scenario, const StateChoice& choice, ProgramLanguage language,
                         const std::string& name, const std::string& made_by, const ProgramExtras& extras) {
  Workspace own(scenario);
  EmitOptions options;
  options.name = name;
  options.made_by = made_by;
  options.rates = extras.rates;
  options.start = start_for_program(own, choice);
  put_ends_of_tables(own);
  OpenSystem open = open_inputs(own);
  for (const Monitor& m : open.system.model->monitors) options.outputs.emplace_back(m.name, m.value);
  options.inputs = std::move(open.inputs);
  for (const std::size_t i : parameters_of_order(*own.mechanics, own.elimination, own.system, own.structure))
    options.of_order.push_back(own.model->parameters[i].name);
  for (const std::size_t i : extras.switching) options.switching.push_back(own.model->parameters[i].name);
  return (language == ProgramLanguage::c ? emit_c : emit_python)(open.system, own.structure, options);
}

}  // namespace anholon
