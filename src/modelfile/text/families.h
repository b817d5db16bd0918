// [index] and families: a name whose bracket holds a letter with a range is an element for each of its values.
//
// Families are written out on the tree of the file, before anything is read: every reader sees ordinary elements with
// names such as P[3], whose formulas know the values of their letters (formula/indices.h).
//
// * A key, or the name of an element of a list of tables (of a force without name, what it acts on), makes the family;
// entries of
//   coordinates, dependent and by likewise; a condition is a family if a letter stands in it.
// * A member written out, "P[0]" = …, takes the place of the family's. * A list in place of a value gives the members'
// values in order, the last letter of the bracket running fastest. Under [point]
//   three formulas are one vector: a list of vectors is a list of lists.
#pragma once
#include <map>
#include <set>
#include <string>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

struct Families {
  std::set<std::string> letters;  // integers and ranges of [index]: reserved names
  std::set<std::string> used;     // overrides that gave an index integer
  std::size_t members = 0;        // elements written out
};

// Writes the families of the file out. `overrides`: values given from outside; those of index integers are used.
Families write_out_families(Item& root, const std::map<std::string, std::string>& overrides, Diagnostics& diagnostics);

}  // namespace anholon
