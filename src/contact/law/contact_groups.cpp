#include "contact/law/contact_groups.h"

#include "contact/law/rows.h"

namespace anholon {

namespace {

// Sets of coordinates; the name of a set is one of its coordinates.
class JoinedCoordinates {
 public:
  explicit JoinedCoordinates(std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) next_.push_back(i);
  }
  std::size_t set(std::size_t i) const {
    while (next_[i] != i) i = next_[i];
    return i;
  }
  void join(std::size_t i, std::size_t j) { next_[set(i)] = set(j); }
  // Joins the coordinates of a row with those of `first`, the first coordinate of a row before it, if there is one.
  void join(const ContactNumbers& row, std::optional<std::size_t>& first) {
    for (std::size_t i = 0; i < row.size(); ++i) {
      if (row[i] == 0) continue;
      if (first) join(i, *first);
      first = first.value_or(i);
    }
  }

 private:
  std::vector<std::size_t> next_;
};

}  // namespace

std::vector<std::size_t> contact_groups(const ContactProblem& p) {
  JoinedCoordinates joined(p.b.size());
  for (const ContactNumbers& row : p.Phi) {
    std::optional<std::size_t> first;
    joined.join(row, first);
  }
  for (std::size_t i = 0; i < p.A.size(); ++i)
    for (std::size_t j = 0; j < p.A.size(); ++j)
      if (p.A[i][j] != 0) joined.join(i, j);
  std::vector<std::optional<std::size_t>> firsts;
  for (const ContactRows& rows : p.contacts) {
    std::optional<std::size_t> first;
    if (rows.under) first = firsts[*rows.under];
    joined.join(rows.normal, first);
    for (const ContactNumbers& row : rows.tangential) joined.join(row, first);
    firsts.push_back(first);
  }
  std::vector<std::size_t> groups;
  for (const auto& first : firsts) groups.push_back(first ? joined.set(*first) : p.b.size());
  return groups;
}

}  // namespace anholon
