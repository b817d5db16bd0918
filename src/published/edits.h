// The changes of single places of which a misprint may consist. An equation is taken as one formula, left - right: the
// first step of a path is the side.
#pragma once
#include "formula/formula.h"
#include "published/equation.h"

namespace anholon {

class Vocabulary;

// Names that a misprint may exchange.
struct Alphabet {
  std::vector<std::string> coordinates, others, constraints, masses, free;  // free: quasi-velocities
};

using Path = std::vector<std::uint32_t>;  // the path of a node: its indices among the arguments, from the root down

struct Edit {
  enum class Kind : std::uint8_t {
    dots,
    sign,
    coefficient,
    exponent,
    function,
    spare_dots,
    name,
    factor
  };  // the likely ones first
  enum class Effect : std::uint8_t { replaces, multiplies, squares };
  Path path;
  Kind kind;
  Effect effect;
  Syntax with;               // the replacement of the node; or its new factor
  bool in_function = false;  // the place is in the argument of an elementary function, or in an exponent
};

// Returns left - right.
Syntax difference_of(const PublishedEquation& equation);

const Syntax& node_at(const Syntax& s, const Path& path, std::size_t length);
inline const Syntax& node_at(const Syntax& s, const Path& path) { return node_at(s, path, path.size()); }
// Returns the length of the part of the path that leads to the innermost term that contains its end: an operand of a
// sum, or a side.
std::size_t innermost_term(const Syntax& difference, const Path& path);

// Returns all changes of one place; a symbol may have lost up to `most_dots` dots. The changed formula may be
// meaningless.
std::vector<Edit> edits_of(const Syntax& difference, Vocabulary& words, const Alphabet& alphabet, unsigned most_dots);

// Returns `s`, the node at `depth` on the paths of the edits, with all edits made.
Syntax edited(const Syntax& s, std::size_t depth, const std::vector<const Edit*>& edits);
// Returns -x for x, and x for -x.
Syntax opposite(const Syntax& s);

}  // namespace anholon
