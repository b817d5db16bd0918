#include "linear/linear_model.h"

namespace anholon {

const char* name(LinearModel::Motion motion) {
  switch (motion) {
  case LinearModel::Motion::equilibrium:
    return "equilibrium";
  case LinearModel::Motion::steady:
    return "steady";
  case LinearModel::Motion::unsteady:
    return "unsteady";
  case LinearModel::Motion::unchecked:
    return "unchecked";
  }
  return "";
}

}  // namespace anholon
