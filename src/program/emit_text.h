// Parts that the writers of C and Python share: the motion as expressions, names, statements, the head.
#pragma once
#include <set>
#include <string>
#include <unordered_map>
#include <vector>

#include "program/emit.h"

namespace anholon::emit {

enum class Language : std::uint8_t { c, python };

// One entry of the state: the derivative of this order of a variable.
struct StateEntry {
  std::size_t variable;
  unsigned order;
};

struct Motion {
  std::vector<StateEntry> state;     // by order, then by variable
  Column residual;                   // E_i^(c_i)
  std::vector<Column> jacobian;      // with respect to the leading derivatives
  Column hidden;                     // E_i^(k), k < c_i
  std::vector<std::size_t> derived;  // parameters whose values depend on other parameters
  std::vector<std::size_t> inputs;   // controls of the model
  Column input_values;               // by their formulas
  Column parameters;                 // values in terms of the independent parameters
  bool linear = true;                // the equations are linear in the leading derivatives
  std::vector<std::string> state_names, leading_names, equation_names, hidden_names, input_names;

  // The index of x_j^(k), k < d_j, in the state.
  std::size_t place(std::size_t variable, unsigned order) const;
};

Motion motion(const System& system, const Structure& structure, const EmitOptions& options);

// The initial state in the order of the state; multipliers begin with zero.
std::vector<double> start_state(const System& system, const Motion& motion, const EmitOptions::Start& start);

// Turns names into identifiers that neither language reserves.
class LocalNames {
 public:
  LocalNames(const System& system, const Structure& structure, const Motion& motion);
  const std::string& symbol(NodeId id) const { return symbols_.at(id); }
  bool taken(const std::string& name) const { return taken_.count(name) > 0; }

 private:
  std::string fresh(const std::string& wanted);
  std::set<std::string> taken_;
  std::unordered_map<NodeId, std::string> symbols_;
};

// An identifier like this text; empty text gives `otherwise`.
std::string identifier(const std::string& text, const std::string& otherwise);

// A rational number as a number of both languages: 2.5, 2.0/3.0, 1e-9.
std::string number(const Rational& r);

// The statements of one function. `$` marks the place of the prefix of names in C. A node that is used more than once,
// or is long, gets a variable.
struct Statements {
  std::string text;
  bool time = false, state = false, lead = false, parameters = false, inputs = false;  // the arguments that it reads
};

class Writer {
 public:
  Writer(const System& system, const Structure& structure, const Motion& motion, const LocalNames& names,
         Language language);
  // targets[i] = es[i], after the variables; structural zeros are left out if `sparse`.
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
  std::string call(NodeId id);
  Text power(NodeId base, const Rational& exponent) const;
  void write(NodeId id, Statements& body);
  std::string assign(const std::string& name, const std::vector<Piece>& pieces, bool declare) const;
  static std::string wrapped(const Text& t, int strength);
  std::string fresh();

  Graph& g_;
  const System& system_;
  const Structure& structure_;
  const Motion& motion_;
  const LocalNames& names_;
  Language language_;
  std::unordered_map<NodeId, Text> text_;
  std::unordered_map<NodeId, std::size_t> uses_;
  std::size_t next_ = 0;
  bool used_sign_ = false;
};

// The lines of a comment that describe the arrays.
std::vector<std::string> head(const System& system, const Structure& structure, const Motion& motion,
                              const EmitOptions& options);

std::string lines(const std::vector<std::string>& list, const std::string& indent);

}  // namespace anholon::emit
