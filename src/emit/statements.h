// Expressions as statements of C or Python, by one sweep from the leaves up without recursion, so the depth is not
// limited.
#pragma once
#include <map>
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "emit/names.h"
#include "print/powers.h"

namespace anholon::emit {

enum class Language : std::uint8_t { c, python };
// The function for roots of sums of squares, whose derivative at 0 is no number: that of the language, or _root(np, u, r)
// of the module, by which a library can have its own.
enum class RootsOfSquares : std::uint8_t { plain, of_library };

// The statements of one function. `$` marks the place of the prefix of names in C. A node that is used more than once,
// or is long, gets a variable.
struct Statements {
  std::string text;
  bool time = false;             // true if the function reads t
  std::set<std::string> arrays;  // the other arguments that the function reads
  bool reads(const std::string& array) const { return arrays.count(array) > 0; }
};

class Writer {
 public:
  Writer(const Graph& graph, const LocalNames& names, Language language, RootsOfSquares roots = RootsOfSquares::plain)
      : g_(graph), names_(names), language_(language), roots_(roots) {}
  // Writes targets[i] = es[i], after the variables; structural zeros are left out if `sparse`.
  Statements body(const Column& es, const std::vector<std::string>& targets, bool sparse = false);
  bool used_sign() const { return used_sign_; }

 private:
  struct Text {
    std::string s;
    int strength;
  };
  struct Piece {
    char op;  // + - * /
    std::string s;
  };

  void load(const std::vector<NodeId>& ids, Statements& body);
  std::vector<Piece> pieces(NodeId id);
  std::vector<Piece> sum(NodeId id);
  std::vector<Piece> product(NodeId id);
  // A node that occurs in a text, to this power.
  struct Use {
    NodeId node;
    Rational exponent;
  };
  // Returns exp(n*log(x)) as pow(x, n), which has a value for x <= 0 if n is a whole number; nullptr if `id` is no
  // power.
  const GeneralPowers* powers(NodeId id);
  // Returns the factors of a product without such powers, and without whole powers of their bases; both are added to
  // `out`.
  std::vector<Term> without_powers(NodeId product, GeneralPowers& out);
  std::vector<Use> read_by(NodeId id);
  std::vector<NodeId> needed(const Column& es);
  std::vector<Piece> factors(const GeneralPowers& powers) const;
  std::string call(NodeId id);
  Text power(NodeId base, const Rational& exponent) const;
  void name_powers(NodeId product, Statements& body);
  void write(NodeId id, Statements& body);
  std::string assign(const std::string& name, const std::vector<Piece>& pieces, bool declare) const;
  static std::string wrapped(const Text& t, int strength);
  std::string fresh();

  const Graph& g_;
  const LocalNames& names_;
  Language language_;
  RootsOfSquares roots_;
  std::unordered_map<NodeId, Text> text_;
  std::unordered_map<NodeId, std::size_t> uses_;
  std::map<std::pair<NodeId, Rational>, std::size_t> power_uses_;  // uses of roots and reciprocals
  std::map<std::pair<NodeId, Rational>, std::string> powers_;      // the powers that have a variable
  std::unordered_map<NodeId, std::optional<GeneralPowers>> general_;
  std::size_t next_ = 0;
  bool used_sign_ = false;
};

}  // namespace anholon::emit
