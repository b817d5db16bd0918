// Families of elements in formulas: the meanings of the letters of [index], and formulas with these meanings
// substituted.
//
// In a parsed formula an index integer or bound letter is a number, P[i-1] the name "P[2]", T[j](a, b) the call
// "T[2]"(a, b), sum(k, e) and prod(k, e) are expanded to one sum of all terms, one product. Over an empty range the sum
// is 0 and the product 1.
#pragma once
#include <map>
#include <memory>
#include <string>

#include "formula/formula.h"

namespace anholon {

// Both ends are included; the range is empty if last < first.
struct IndexRange {
  long first = 0, last = -1;
  std::size_t size() const { return last < first ? 0 : static_cast<std::size_t>(last - first) + 1; }
};

struct Indices {
  std::map<std::string, IndexRange> ranges;  // i = "1..n"
  std::map<std::string, long> values;        // n = 10; for a member of a family also its letters
  std::shared_ptr<const Indices> outer;      // for a member of a family, the letters of the file
  std::shared_ptr<std::size_t> room;         // number of terms that sums and products may still expand to

  const long* value(const std::string& name) const;
  const IndexRange* range(const std::string& name) const;  // the range of a letter that has no value here
  std::size_t* budget() const;
};

// Substitutes the values of the indices in a formula. If `indices` is null, P[0] is a name and there are no letters.
Syntax with_indices(Syntax s, const Indices* indices);
// Returns the value of an integer formula: + - * and brackets of whole numbers, index integers and bound letters.
// Throws Failure.
long index_value(const Syntax& s, const Indices* indices);
// Appends to `letters` the letters in a formula that have a range and no value, except those that a sum or product
// binds.
using Letters = std::vector<std::pair<std::string, IndexRange>>;
void free_letters(const Syntax& s, const Indices& indices, Letters& letters);
// Returns an equation as written; for a member of a family, with the values of its letters.
std::string equation_text(const FormulaText& text, const std::vector<Syntax>& sides);
// Returns the name "P[2]" or "c[1,-1]" of a family and the values in its bracket.
std::string member_name(const std::string& family, const std::vector<long>& values);
// True for an identifier, or one with whole numbers in a bracket: P, P[2], c[1,2].
bool is_element_name(std::string_view name);
// Returns "; P has 0..10" for a name P[11] if other members are among the known names; else an empty string.
std::string members_known(const std::string& name, const std::vector<std::string>& known);

}  // namespace anholon
