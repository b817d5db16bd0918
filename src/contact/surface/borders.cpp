#include "contact/surface/borders.h"

#include <cmath>

#include "expr/diff.h"

namespace anholon {

namespace {

bool is(const Node& n, Function f) { return n.kind == Kind::function && static_cast<Function>(n.index) == f; }

// True for a table that jumps at its knots, each of which is a border.
bool jumps(const StepFunction& f) {
  constexpr std::size_t kMost = 64;
  return f.smooth < 0 && f.power == 0 && f.knots.size() <= kMost;
}

// The values of a table, as the first one plus the steps at the knots below the argument.
Expr sum_of_steps(Graph& g, const StepFunction& f, Expr argument, const std::function<Expr(Expr)>& side) {
  Expr value = g.number(f.values[0]);
  for (std::size_t k = 0; k < f.knots.size(); ++k)
    value = value + g.select(side(argument - g.number(f.knots[k])), g.number(f.values[k + 1] - f.values[k]), g.zero());
  return value;
}

Column surfaces(const std::vector<Contact>& contacts) {
  Column list;
  for (const Contact& c : contacts) {
    list.push_back(c.gap);
    list.insert(list.end(), c.slip.begin(), c.slip.end());
  }
  return list;
}

const Column& borders_of(const std::vector<Contact>& contacts) {
  static const Column none;
  return contacts.empty() || !contacts[0].borders ? none : *contacts[0].borders;
}

// Returns the formulas in the order in which SurfaceBorders::places reads them.
Column formulas(Workspace& s, const std::vector<Contact>& contacts) {
  Column es, by = {s.graph().time()};
  const std::vector<Coordinate>& q = s.model->coordinates;
  for (const std::uint32_t order : {0U, 1U})
    for (std::uint32_t a = 0; a < q.size(); ++a) by.push_back(s.graph().jet(a, order));
  for (const Expr border : borders_of(contacts)) {
    es.push_back(border);
    es.push_back(put_state_rates(*s.model, total_derivative(border), 1));
    const Column d = gradient(border, by);
    es.insert(es.end(), d.begin(), d.end());
  }
  if (es.empty()) es.push_back(s.graph().zero());  // a tape must not be empty
  return es;
}

}  // namespace

std::vector<Contact> with_borders(Workspace& s, std::vector<Contact> contacts) {
  Graph& g = s.graph();
  for (Contact& c : contacts) {
    c.gap = g.own(c.gap);
    for (Expr& v : c.slip) v = g.own(v);
  }
  const Column before = surfaces(contacts);
  const auto borders = std::make_shared<Column>();
  std::unordered_map<NodeId, Expr> image, sides;
  const auto side = [&](Expr border) {
    const auto [at, fresh] = sides.try_emplace(border.id);
    if (fresh) {
      at->second = g.parameter(static_cast<std::uint32_t>(s.model->parameters.size() + borders->size()));
      borders->push_back(border);
    }
    return at->second;
  };
  for (const NodeId id : reachable(before)) {
    const Node n = g.node(id);
    const bool steps = n.kind == Kind::lookup && jumps(g.step_function(n.index));
    if (n.kind != Kind::select && !is(n, Function::sign) && !is(n, Function::abs) && !steps) continue;
    Column operands;
    for (const Term& t : g.terms(id)) operands.push_back({&g, t.node});
    operands = replace_nodes(operands, image);
    if (steps) {
      image[id] = sum_of_steps(g, g.step_function(n.index), operands[0], side);
      continue;
    }
    if (n.kind == Kind::function)
      operands = is(n, Function::sign) ? Column{operands[0], g.one(), g.number(-1)}
                                       : Column{operands[0], operands[0], -operands[0]};
    image[id] = g.select(side(operands[0]), operands[1], operands[2]);
  }
  if (borders->empty()) return contacts;
  const Column after = replace_nodes(before, image);
  std::size_t k = 0;
  for (Contact& c : contacts) {
    c.gap = after[k++];
    for (Expr& v : c.slip) v = after[k++];
    c.borders = borders;
  }
  return contacts;
}

SurfaceBorders::SurfaceBorders(Workspace& s, const std::vector<Contact>& contacts)
    : count_(borders_of(contacts).size()), coordinates_(s.model->coordinates.size()), here_(count_, Here::unknown),
      parameters_(parameter_values<long double>(*s.model)), graph_(s.graph()), tape_(compile(formulas(s, contacts))),
      machine_(tape_, 0, with_sides(parameters_, sides(contacts))) {
  for (const Expr border : borders_of(contacts)) of_velocity_.push_back(jet_order(border) > 0);
}

std::vector<SurfaceBorders::Place> SurfaceBorders::places(const ContactState& at) {
  constexpr long double kRoundOff = 1e-12L;
  if (count_ == 0) return {};
  machine_.set_parameters(with_sides(parameters_, at.borders));
  evaluate_at(at, graph_, machine_);
  std::size_t next = 0;
  std::vector<Place> list(count_);
  for (Place& p : list) {
    p.value = machine_.value(next++);
    p.rate = machine_.value(next++);
    const long double by_time = std::abs(machine_.value(next++));
    p.near = by_time * (1 + std::abs(at.t.get_d())), p.slow = p.by_time = by_time;
    for (std::size_t a = 0; a < coordinates_; ++a) {
      const long double d = std::abs(machine_.value(next++));
      p.near += d * (1 + std::abs(at.q[a])), p.slow += d * std::abs(at.qd[a]);
      p.by_place.push_back(d);
    }
    for (std::size_t a = 0; a < coordinates_; ++a)
      p.near += std::abs(machine_.value(next++)) * (1 + std::abs(at.qd[a]));
    p.near *= kRoundOff, p.slow *= kRoundOff;
  }
  return list;
}

void SurfaceBorders::begin(ContactState& at) {
  at.borders.assign(2 * count_, 1);
  // A border may depend on the side of another one.
  for (std::size_t k = 0; k < count_; ++k) {
    const Place p = places(at)[k];
    if (std::abs(p.value) > p.near)
      at.borders[k] = p.value < 0 ? -1 : 1;
    else if (!of_velocity_[k] && std::abs(p.rate) > p.slow)
      at.borders[k] = p.rate < 0 ? -1 : 1;
    at.borders[count_ + k] = static_cast<double>(p.near);
  }
}

std::vector<std::size_t> SurfaceBorders::at_rest(const ContactState& at,
                                                 const std::function<long double(std::size_t)>& most) {
  constexpr long double kSlow = 1e-5L;
  std::vector<std::size_t> list;
  for (std::size_t k = 0; k < count_; ++k) {
    const Place p = places(at)[k];
    long double fast = 0;
    for (std::size_t a = 0; a < coordinates_; ++a) fast += p.by_place[a] * most(a);
    const bool at_it = here_[k] != Here::unknown || std::abs(p.value) <= p.near;
    if (at_it && !of_velocity_[k] && p.by_time == 0 && std::abs(p.rate) <= kSlow * fast) list.push_back(k);
  }
  return list;
}

bool SurfaceBorders::pass(ContactState& at) {
  bool any = false;
  for (std::size_t k = 0; k < count_; ++k) {
    const Place p = places(at)[k];
    at.borders[count_ + k] = static_cast<double>(p.near);
    const long double value = at.borders[k] * p.value, rate = of_velocity_[k] ? 0 : at.borders[k] * p.rate;
    const bool back = rate > p.slow, on = rate < -p.slow;
    const bool at_it = here_[k] != Here::unknown || std::abs(value) <= p.near;
    if (at_it ? !on && (back || here_[k] != Here::reached) : value > 0) continue;
    at.borders[k] = -at.borders[k];
    here_[k] = Here::passed;
    any = true;
  }
  return any;
}

}  // namespace anholon
