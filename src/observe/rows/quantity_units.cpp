#include "observe/rows/quantity_units.h"

#include "modelfile/names/declared_unit.h"
#include "observe/rows/row_values.h"

namespace anholon {

std::map<std::string, std::string> quantity_units(const Model& model, const std::vector<Contact>& contacts) {
  std::map<std::string, std::string> units = column_units(model);
  units.merge(column_units(contacts));
  for (std::size_t k = 0; k < model.parameters.size(); ++k)
    if (const std::string unit = unit_of_parameter(model, k); !unit.empty())
      units.emplace(model.parameters[k].name, unit);
  return units;
}

void add_units(const Model& model, const std::vector<Conserved>& conserved, std::map<std::string, std::string>& units) {
  for (const Conserved& c : conserved)
    if (const std::string unit = unit_of(model, c); !unit.empty()) units["conserved " + c.name] = unit;
}

}  // namespace anholon
