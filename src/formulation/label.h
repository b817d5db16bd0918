// The name of a quantity in each output format: "d T/d x'", \frac{\partial T}{\partial \dot{x}}.
#pragma once
#include "mechanics/elimination.h"

namespace anholon {

struct Label {
  std::string text, latex, mathml;
};
using Labels = std::vector<Label>;

// The accent of a letter: T~ is reduced by coordinates, T* by quasi-velocities, Tbar by solved constraints of order 1.
enum class Over : std::uint8_t { nothing, tilde, star, bar };

// Returns a letter, or a word used as a letter, as SymbolNames would write it.
Label letter(const std::string& name);
// Returns T~^(2), the second derivative of T, reduced. If k = 0, the label has no order.
Label energy(const std::string& name, unsigned k = 0, Over over = Over::nothing);
// Returns Q.x, phi.edge, v.bead.y: `text` and its parts become the subscript.
Label indexed(const Label& of, const std::string& text, const std::vector<Label>& parts);
// Returns f^k: "QR", Q^R.
Label with_superscript(const std::string& text, const Label& base, const Label& upper);
Label minus(const Label& of);
Label operator-(const Label& a, const Label& b);

Label name_of(const Model& model, const std::string& name);
// Returns the derivative of order k of the quantity called `name`.
Label derivative_of(const Model& model, const std::string& name, unsigned k);
// Returns q^(k) of all coordinates.
Labels jet_labels(const Mechanics& M, unsigned k);
// Returns the free quantities u: q^(m) of the independent coordinates, or quasi-velocities with their own order;
// differentiated `more` times.
Labels free_labels(const Mechanics& M, const Elimination& E, unsigned more = 0);
Labels pick(const Labels& all, const std::vector<std::size_t>& which);

// d A/d B
Label partial(const Label& of, const Label& by);
Labels partial(const Label& of, const Labels& by);
// D/Dt A with frozen masses, d/dt A
Label frozen_rate(const Label& of);
Label rate(const Label& of);

}  // namespace anholon
