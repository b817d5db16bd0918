// Watches square roots in the gaps of contacts that fall towards zero, where a gap loses its derivatives: such a root
// is the height of the rim of a disc below its centre when the disc comes to lie flat.
#pragma once
#include "contact/law/contact_dynamics.h"

namespace anholon {

class GapRoots {
 public:
  // `contacts`: their expressions belong to the graph of `s`.
  GapRoots(Workspace& s, const std::vector<Contact>& contacts);

  void see(const ContactState& at);
  // The least root in the gap of a contact at the state seen last, relative to the largest value of this root.
  long double least_part(std::size_t contact) const;

 private:
  std::vector<std::size_t> contacts_;  // of each root
  std::vector<long double> parameters_, now_, most_;
  Graph& graph_;
  Tape tape_;
  Machine<long double> machine_;
};

}  // namespace anholon
