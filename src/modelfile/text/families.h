// [index] and families: a name with a letter in its bracket denotes one element for each value of the letter.
//
// Families are expanded in the tree of the file before anything is read: every reader sees ordinary elements with names
// such as P[3], whose formulas know the values of their letters (formula/indices.h).
//
//  * A key, or the name of an element of a list of tables (for a force without name, the object it acts on), makes the
//    family; so do entries of coordinates, dependent and by. A condition is a family if a letter occurs in it.
//  * A member that is written explicitly, "P[0]" = …, replaces that of the family.
//  * A list in place of a value gives the values of the members in order; the last letter of the bracket varies
//    fastest. Under [point] three formulas are one vector: a list of vectors is a list of lists.
#pragma once
#include <map>
#include <set>
#include <string>

#include "base/diagnostic.h"
#include "modelfile/text/toml.h"

namespace anholon {

struct Families {
  std::set<std::string> letters;  // integers and ranges of [index]: reserved names
  std::set<std::string> used;     // overrides that set an index integer
  std::size_t members = 0;        // number of expanded elements
};

// Expands the families of the file. `overrides`: values given from outside; those of index integers are used.
Families write_out_families(Item& root, const std::map<std::string, std::string>& overrides, Diagnostics& diagnostics);

}  // namespace anholon
