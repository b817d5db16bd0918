// The equations of motion of a model in a classical form.
#pragma once
#include "anholon/model.h"

namespace anholon::v1 {

struct DeriveOptions {
  std::string form = "routh";   // a name that Model::forms() lists
  std::string expand = "auto";  // auto, none, paper, full or parts: how far sums and products are written out
  bool steps = false;           // with the quantities that lead to them: energies, momenta, forces
  bool reactions = false;       // with the ideal reactions
};

// The same equations in five notations. html: MathML in lines that wrap, which a notebook shows.
struct Equations {
  std::string form;
  std::string text, latex, mathml, json, html;
};

// Errors: the form is not known or does not apply (a diagnostic that lists those that do).
ANHOLON_API Result<Equations> derive(const Model& model, const DeriveOptions& options = {});

// The name of a coordinate, a derivative, a parameter as a formula: "theta'" is \dot{\theta}.
struct Symbol {
  std::string latex, mathml;
};
// In the notation of the model, or as names are written without one.
ANHOLON_API Symbol symbol(const std::string& name, const Model* model = nullptr);

}  // namespace anholon::v1
