#include "formulation/formulation.h"

namespace anholon {

const Formulation* find_formulation(const std::string& name) {
  for (const Formulation* f : formulations())
    if (name == f->name) return f;
  return nullptr;
}

}  // namespace anholon
