// The initial state during its computation: every value with its origin.
#pragma once
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "expr/expr.h"
#include "numeric/number.h"

namespace anholon {

// The origin of a value of the state.
enum class Origin : std::uint8_t { given, derived, chosen, guessed, corrected };
const char* name(Origin origin);

// The derivatives of one order, of all coordinates or of all multipliers.
template <Number N>
struct Level {
  std::vector<N> value;
  std::vector<Origin> origin;
};

// The note on positions and velocities that the least change has chosen.
struct LeastChangeNote {
  std::vector<Node> entries;         // the values that it names
  std::optional<std::size_t> place;  // its index among the notes of the state
};

// A value of the file in whose place another one was found, because it clashes with a value of an option.
template <Number N>
struct ReplacedValue {
  Node entry;
  N before{0};
};

// The values of the file that clash with values of options, and the note on them. Conditions on values of options alone
// are replaced as values of the file for the same entries are, without a note.
template <Number N>
struct ReplacedByOptions {
  std::vector<ReplacedValue<N>> values;
  std::vector<std::string> conditions;  // left out: "condition 'x^2 = 4'"
  std::vector<Node> options;            // values that they clash with
  std::string note;                     // empty if every value stays; also among the notes of the state
  std::optional<std::size_t> place;     // its index there
};

template <Number N>
struct InitialState {
  N t{0};
  std::vector<N> q, qd;
  std::vector<Origin> q_origin, qd_origin;
  std::vector<Level<N>> higher;        // q^(k), k = 2, 3, …: the state and the leading derivatives, if they were needed
  std::vector<Level<N>> multipliers;   // lambda^(k), k = 0, 1, … of all constraints of the model, if they were needed
  std::vector<N> states, state_rates;  // z and z' of the model's states
  std::vector<Origin> states_origin, state_rates_origin;
  N largest_correction{0};         // the largest correction of a given value
  std::vector<std::string> notes;  // the choices made
  LeastChangeNote least_change;
  ReplacedByOptions<N> replaced;

  // Removes all values; the storage of the lists is kept for the next state.
  void clear() {
    t = largest_correction = N(0);
    q.clear(), qd.clear(), q_origin.clear(), qd_origin.clear();
    higher.clear(), multipliers.clear();
    states.clear(), state_rates.clear(), states_origin.clear(), state_rates_origin.clear();
    notes.clear();
    least_change = {};
    replaced = {};
  }

  // Returns q_a^(k) or lambda_r^(k); nullptr for orders that the state does not hold, and for other symbols.
  N* value(const Node& n) { return entry(*this, n); }
  const N* value(const Node& n) const { return entry(*this, n); }
  Origin* origin(const Node& n) {
    if (!entry(*this, n)) return nullptr;
    if (n.kind == Kind::state) return n.order == 0 ? &states_origin[n.index] : &state_rates_origin[n.index];
    if (n.kind == Kind::multiplier) return &multipliers[n.order].origin[n.index];
    return n.order == 0   ? &q_origin[n.index]
           : n.order == 1 ? &qd_origin[n.index]
                          : &higher[n.order - 2U].origin[n.index];
  }
  const Origin* origin(const Node& n) const { return const_cast<InitialState*>(this)->origin(n); }

 private:
  template <class State>
  static auto entry(State& s, const Node& n) -> decltype(&s.q[0]) {
    if (n.kind == Kind::multiplier)
      return n.order < s.multipliers.size() ? &s.multipliers[n.order].value[n.index] : nullptr;
    if (n.kind == Kind::state && n.order < 2)
      return n.index >= s.states.size() ? nullptr : n.order == 0 ? &s.states[n.index] : &s.state_rates[n.index];
    if (n.kind != Kind::jet) return nullptr;
    if (n.order == 0) return n.index < s.q.size() ? &s.q[n.index] : nullptr;
    if (n.order == 1) return n.index < s.qd.size() ? &s.qd[n.index] : nullptr;
    return n.order - 2U < s.higher.size() ? &s.higher[n.order - 2U].value[n.index] : nullptr;
  }
};

}  // namespace anholon
