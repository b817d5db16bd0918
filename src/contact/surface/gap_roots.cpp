#include "contact/surface/gap_roots.h"

#include <algorithm>
#include <cmath>

namespace anholon {

static Column radicands(Workspace& s, const std::vector<Contact>& contacts, std::vector<std::size_t>& of) {
  Graph& g = s.graph();
  Column list;
  for (std::size_t c = 0; c < contacts.size(); ++c)
    for (const NodeId id : reachable({&contacts[c].gap, 1})) {
      if (contacts[c].under || g.node(id).kind != Kind::product) continue;
      for (const Term& t : g.terms(id))
        if (g.rational(t.weight).has_even_denominator()) list.push_back({&g, t.node}), of.push_back(c);
    }
  if (list.empty()) list.push_back(g.zero());  // a tape must not be empty
  return list;
}

GapRoots::GapRoots(Workspace& s, const std::vector<Contact>& contacts)
    : parameters_(parameter_values<long double>(*s.model)), graph_(s.graph()),
      tape_(compile(radicands(s, contacts, contacts_))), machine_(tape_, 0, with_sides(parameters_, sides(contacts))) {
  now_.assign(contacts_.size(), 0), most_ = now_;
}

void GapRoots::see(const ContactState& at) {
  if (contacts_.empty()) return;
  machine_.set_parameters(with_sides(parameters_, at.borders));
  evaluate_at(at, graph_, machine_);
  for (std::size_t k = 0; k < contacts_.size(); ++k) {
    now_[k] = std::sqrt(std::abs(machine_.value(k)));
    most_[k] = std::max(most_[k], now_[k]);
  }
}

long double GapRoots::least_part(std::size_t contact) const {
  long double least = 1;
  for (std::size_t k = 0; k < contacts_.size(); ++k)
    if (contacts_[k] == contact && most_[k] > 0) least = std::min(least, now_[k] / most_[k]);
  return least;
}

}  // namespace anholon
