// The units of [[contact]]s: gaps and slip velocities, coefficients, and the sizes of the shapes that touch.
#pragma once
#include <string>
#include <vector>

#include "modelfile/check/formula_dimensions.h"
#include "modelfile/mechanical/contacts.h"

namespace anholon {

// The equations between dimensions that contacts give. Errors go to `found`, doubts to `noted`.
class ContactDimensions {
 public:
  ContactDimensions(FormulaDimensions& formulas, Diagnostics& found, Diagnostics& noted)
      : formulas_(formulas), found_(found), noted_(noted) {}

  // Gives the quantities of the contact their dimensions. The power of friction is that of a force, so a coefficient
  // without a body has the dimension [gap]/([slip] s).
  void read(const Item& contact);

  // Reports a gap that is neither a length nor an angle, and a slip velocity that is not the rate of one. REQUIRES: all
  // elements of the file are read, because other formulas may determine these dimensions.
  void check(const Item& contact);

  // Gives the contacts of an element their units. A force times the rate of its gap, or times its slip velocity, is a
  // power. REQUIRES: all elements are read.
  void measure(const Item& element, const std::string& name, std::vector<Contact>& contacts);

 private:
  void expect(const Item* item, const DimensionForm& wanted);
  std::optional<DimensionForm> slip_velocity(const Item* slip);
  std::optional<Dimension> known_dimension(const Item& formula);
  bool of_length_or_angle(const Dimension& d, int order) const;
  void note_bare_coefficients(const Item& contact, const Item& gap, const Item& slip);
  std::string unit_of(const DimensionForm& form) const;

  FormulaDimensions& formulas_;
  Diagnostics &found_, &noted_;
};

}  // namespace anholon
