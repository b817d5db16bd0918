// Expressions as numbers at the points of a motion, and the multipliers that they hold.
#pragma once
#include <algorithm>

#include "numeric/relative.h"
#include "setup/scenario.h"

namespace anholon {

template <Number N>
class LeastMultipliers;

// Returns the size to which a residual is compared: that of the numbers behind its terms; or, if their round-off does
// not explain the residual, `moved`, the size of these numbers by OutputTape::evaluate_moved.
template <Number N>
N size_behind(const N& miss, const N& made_of, const N& moved) {
  const bool explained = abs(miss) <= unit_roundoff<N>() * N(kRoundoffsOfSum) * made_of;
  return explained || !(moved > made_of) ? made_of : moved;
}

// Expressions evaluated at a point of the motion. evaluate() reads no graph, so that one thread may evaluate while
// another builds expressions. If constraints are redundant, multipliers are the least ones with the same forces; if
// multipliers belong to the state, those of constraints that are left out are zero.
template <Number N>
class OutputTape {
 public:
  OutputTape(Workspace& s, const Column& es, const std::vector<N>& parameters)
      : system_(s.system), tape_(compile(s.redundant.empty() ? put(s, es) : es)), machine_(tape_, 0, parameters) {
    for (const Input& in : tape_.inputs) {
      const Node& n = s.model->graph->node(in.symbol);
      places_.push_back({n.kind == Kind::time, system_.variable(in.symbol), n.order, in.slot});
      if (!s.redundant.empty() && n.kind == Kind::multiplier) multipliers_.push_back({places_.size() - 1, n.index});
    }
    if (!multipliers_.empty() && multiplier_orders(s) == 0)
      least_ = std::make_shared<LeastMultipliers<N>>(s, parameters);
  }
  void evaluate(const Expansion<N>& point) {
    if (!multipliers_.empty()) find_multipliers(*point.program().system);
    for (const InputPlace& in : places_)
      machine_.series(in.slot)[0] = in.time       ? point.time()
                                    : in.variable ? point.derivative(*in.variable, in.order)
                                                  : N(0);
    if (least_) {
      const std::vector<N> all = least_->at(point);
      for (const MultiplierPlace& m : multipliers_)
        if (places_[m.input].order == 0) machine_.series(places_[m.input].slot)[0] = all[m.constraint];
    }
    machine_.evaluate();
    sizes_.clear();
  }
  // Evaluates with enlarged values: a leading derivative that is round-off of the terms of the equations gets the size
  // of these terms, and the derivative below it gets that size times the elapsed time. The sizes of outputs are taken
  // from these values if accelerations are round-off. Returns false, and evaluates nothing, if no value becomes larger.
  bool evaluate_moved(const Expansion<N>& point, const N& elapsed) {
    std::vector<std::pair<std::uint32_t, N>> moved;
    for (const InputPlace& in : places_) {
      if (!in.variable) continue;
      const int d = point.program().d[*in.variable], below = d - in.order;
      if (below != 0 && below != 1) continue;
      const N leading = point.size_of_leading(*in.variable);
      if (abs(point.derivative(*in.variable, d)) > unit_roundoff<N>() * N(kRoundoffsOfSum) * leading) continue;
      const N x = point.derivative(*in.variable, in.order), size = below == 0 ? leading : N(leading * elapsed);
      if (abs(x) < size) moved.push_back({in.slot, x < N(0) ? N(-size) : size});
    }
    if (moved.empty()) return false;
    evaluate(point);
    for (const auto& [slot, x] : moved) machine_.series(slot)[0] = x;
    machine_.evaluate();
    sizes_.clear();
    return true;
  }
  // Evaluates with the inputs that the rule of tape/bind.h gives.
  template <class Rule>
  void evaluate_at(const Rule& rule) {
    bind(machine_, *system_.model->graph, rule);
    machine_.evaluate();
    sizes_.clear();
  }
  const N& operator[](std::size_t i) const { return machine_.value(i); }
  // Returns the sum of the absolute values of the terms of expression i.
  N terms(std::size_t i) const { return machine_.terms(i, 0); }
  // Returns the size of the numbers of which expression i is made (tape/tape.h), at the last evaluated point.
  const N& made_of(std::size_t i) const {
    if (sizes_.empty()) machine_.made_of(sizes_);
    return sizes_[tape_.roots[i]];
  }
  // Sets the parameters anew, after modes have changed.
  void set_parameters(const std::vector<N>& parameters) {
    machine_.set_parameters(parameters);
    if (least_) least_->set_parameters(parameters);
    sizes_.clear();
  }
  static Column put(Workspace& s, const Column& es) { return taking_part(s.system, es); }

 private:
  struct InputPlace {
    bool time;
    std::optional<std::size_t> variable;  // the unknown; nullopt for the multiplier of a redundant constraint
    int order;                            // order of its derivative
    std::uint32_t slot;
  };
  struct MultiplierPlace {
    std::size_t input;       // among the places
    std::size_t constraint;  // index in the model
  };
  void find_multipliers(const System& of_point) {
    for (const MultiplierPlace& m : multipliers_) {
      const auto row = std::find(of_point.constraints.begin(), of_point.constraints.end(), m.constraint);
      places_[m.input].variable = std::nullopt;
      if (row != of_point.constraints.end())
        places_[m.input].variable = of_point.coordinates + static_cast<std::size_t>(row - of_point.constraints.begin());
    }
  }

  const System& system_;
  Tape tape_;
  Machine<N> machine_;
  std::vector<InputPlace> places_;              // places of the inputs
  std::vector<MultiplierPlace> multipliers_;    // those among the places, if constraints are redundant
  std::shared_ptr<LeastMultipliers<N>> least_;  // computes them; null if there is nothing to choose
  mutable std::vector<N> sizes_;
};

// The multipliers of all constraints if some are redundant: the least ones with the same forces (theory: dae-view).
template <Number N>
class LeastMultipliers {
 public:
  LeastMultipliers(Workspace& s, const std::vector<N>& parameters);
  // Returns the multipliers of all constraints of the model at a point.
  std::vector<N> at(const Expansion<N>& point);
  // Returns the dependencies of the constraints at the last point, and those that are left out there; none before.
  UndeterminedMultipliers undetermined() const;
  void set_parameters(const std::vector<N>& parameters) { phi_.set_parameters(parameters); }

 private:
  std::size_t coordinates_, constraints_;
  OutputTape<N> phi_;  // the rows of all constraints
  Matrix<N> rows_;     // their values at the last point
  std::vector<std::size_t> kept_;
};

extern template class LeastMultipliers<double>;
extern template class LeastMultipliers<long double>;
extern template class LeastMultipliers<Quad>;
extern template class LeastMultipliers<Multi>;

}  // namespace anholon
