#include "cli/model_options.h"

namespace anholon::cli {

const std::vector<ModelOption>& model_options() {
  using enum ModelOption::Of;
  static const std::vector<ModelOption> rows = {
      {parameters, "set", "NAME=VALUE", "NAME=VALUE: another value of a parameter, or of an integer of [index]",
       &SystemCommand::set, true},
      {parameters, "case", "NAME", "a scenario of the file, [case.NAME]; several are applied one after the other",
       &SystemCommand::cases, false},
      {state, "q", "NAME=VALUE", "initial positions x=0.2,y=1 (exact decimals); others from the file",
       &SystemCommand::q, true},
      {state, "qdot", "NAME=VALUE", "initial velocities x=0.2,y=1", &SystemCommand::qdot, true},
      {state, "qddot", "NAME=VALUE", "initial accelerations, where constraints of order 3 and more leave them free",
       &SystemCommand::qddot, true},
      {state, "qdddot", "NAME=VALUE", "initial third derivatives, likewise (order 4 and more)", &SystemCommand::qdddot,
       true},
      {state, "lambda", "NAME=VALUE", "initial multipliers blade=0.4, likewise (order 3 and more)",
       &SystemCommand::lambda, true},
      {state, "lambdadot", "NAME=VALUE", "initial rates of multipliers (order 4 and more)", &SystemCommand::lambdadot,
       true},
      {form, "eliminate", "NAME,…", "dependent coordinates of the forms without multipliers: y,z (default: chosen)",
       &SystemCommand::eliminate, false},
  };
  return rows;
}

}  // namespace anholon::cli
