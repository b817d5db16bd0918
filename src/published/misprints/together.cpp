#include "published/misprints/together.h"

#include <algorithm>
#include <cmath>

namespace anholon {

namespace {

constexpr std::size_t kMostDots = 700;      // places that may have lost dots
constexpr std::size_t kMostTried = 60'000;  // combined sets that are tried, for each number of changes
constexpr std::size_t kMostLookedUp = 2'000'000;
constexpr std::size_t kMostCompared = 4'000'000;  // pairs that are tested for adding up
constexpr std::size_t kMostFound = 200;
// The costs of a lost dot, of another change, of a symbol that changes everywhere.
constexpr int kDots = 10, kOther = 12, kEverywhere = 4;

Numbers sizes(const Numbers& a) {
  Numbers out;
  for (std::size_t k = 0; k < kTrialPoints; ++k) out[k] = std::abs(a[k]);
  return out;
}

Numbers total(Numbers a, const Numbers& b) {
  for (std::size_t k = 0; k < kTrialPoints; ++k) a[k] += b[k];
  return a;
}

bool before(const Numbers& a, const Numbers& b) { return a[0] < b[0]; }

// A factor of a product with its exponent before and after an edit.
struct Raised {
  Path product;
  std::uint32_t factor = 0;
  long from = 1, to = 1;
};

std::optional<Raised> exponent_of(const Edit& e, const Syntax& difference) {
  Raised x;
  std::size_t length = e.path.size();
  if (e.kind != Edit::Kind::exponent || length < 2) return std::nullopt;
  const auto whole = [](const Syntax& s) {
    return s.op == Syntax::Op::number && s.text.size() == 1 && s.text[0] >= '1' && s.text[0] <= '9' ? s.text[0] - '0'
                                                                                                    : 0L;
  };
  if (e.effect == Edit::Effect::squares) {
    x.to = 2;
  } else {
    const Syntax& parent = node_at(difference, e.path, --length);
    if (parent.op != Syntax::Op::power) return std::nullopt;
    x.from = whole(parent.args[1]);
    x.to = whole(e.with);
    if (x.from == 0 || x.to == 0) return std::nullopt;
  }
  x.factor = e.path[length - 1];
  x.product.assign(e.path.begin(), e.path.begin() + static_cast<std::ptrdiff_t>(length - 1));
  if (node_at(difference, x.product).op != Syntax::Op::multiply) return std::nullopt;
  return x;
}

}  // namespace

Together::Together(Trial& trial, const Syntax& difference) : trial_(trial) {
  for (std::uint32_t i = 0; i < trial.size(); ++i) {
    const Edit& e = trial.edit(i);
    const bool dots = e.kind == Edit::Kind::dots && !e.in_function;
    put({i}, dots ? kDots : kOther, dots);
  }
  single_dots_ = static_cast<std::uint32_t>(dot_items_.size());
  symbols_everywhere(difference);
  moved_exponents(difference);
}

void Together::put(std::vector<std::uint32_t> edits, int cost, bool dots) {
  const Numbers change = edits.size() == 1 ? trial_.change_of(edits[0]) : trial_.change(edits);
  if (!std::all_of(change.begin(), change.end(), [](double v) { return std::isfinite(v); })) return;
  if (dots && dot_items_.size() < kMostDots) dot_items_.push_back(static_cast<std::uint32_t>(items_.size()));
  items_.push_back({std::move(edits), cost, dots, change});
}

void Together::symbols_everywhere(const Syntax& difference) {
  std::map<std::pair<std::string, std::string>, std::vector<std::uint32_t>> places;
  for (std::uint32_t i = 0; i < trial_.size(); ++i) {
    const Edit& e = trial_.edit(i);
    if ((e.kind == Edit::Kind::dots && !e.in_function) || e.kind == Edit::Kind::name)
      places[{print(node_at(difference, e.path)), print(e.with)}].push_back(i);
  }
  for (const auto& [names, edits] : places) {
    if (edits.size() < 2) continue;
    const bool dots = trial_.edit(edits[0]).kind == Edit::Kind::dots;
    put(edits, (dots ? kDots : kOther) + kEverywhere, dots);
  }
}

void Together::moved_exponents(const Syntax& difference) {
  std::map<Path, std::vector<std::pair<std::uint32_t, Raised>>> products;
  for (std::uint32_t i = 0; i < trial_.size(); ++i)
    if (const auto x = exponent_of(trial_.edit(i), difference)) products[x->product].push_back({i, *x});
  for (const auto& [path, list] : products)
    for (const auto& [lowered, a] : list)
      for (const auto& [raised, b] : list)
        if (a.factor != b.factor && a.to == a.from - 1 && b.to == a.from && b.from == a.to)
          put({lowered, raised}, kOther, false);
}

// ---- items and their sums ----------------------------------------------------------------------

Together::Relation Together::relation(std::uint32_t a, std::uint32_t b) const {
  Relation r = Relation::independent;
  if (a == b) return Relation::impossible;
  for (std::uint32_t i : items_[a].edits)
    for (std::uint32_t j : items_[b].edits) {
      if (!trial_.possible(i, j)) return Relation::impossible;
      if (!trial_.independent(i, j)) r = Relation::bound;
    }
  return r;
}

bool Together::independent(const Items& a, const Items& b) const {
  for (std::uint32_t i : a)
    for (std::uint32_t j : b)
      if (relation(i, j) != Relation::independent) return false;
  return true;
}

// Tries items whose effects do not add up as one.
std::optional<Together::Sum> Together::joined(const Items& items) {
  if (++tried_ > kMostTried) return std::nullopt;
  std::vector<std::uint32_t> edits;
  for (std::uint32_t i : items) edits.insert(edits.end(), items_[i].edits.begin(), items_[i].edits.end());
  const Numbers change = trial_.change(edits);
  if (!std::all_of(change.begin(), change.end(), [](double v) { return std::isfinite(v); })) return std::nullopt;
  return Sum{items, change, sizes(change)};
}

void Together::prepare_singles() {
  if (std::exchange(singles_known_, true)) return;
  for (std::uint32_t i = 0; i < items_.size(); ++i) {
    singles_.push_back({Items{i}, items_[i].change, sizes(items_[i].change)});
    if (items_[i].dots) dots_.push_back(singles_.back());
  }
  for (std::vector<Sum>* list : {&singles_, &dots_})
    std::stable_sort(list->begin(), list->end(), [](const Sum& a, const Sum& b) { return before(a.change, b.change); });
}

void Together::prepare_pairs() {
  if (std::exchange(pairs_known_, true)) return;
  const std::size_t n = dot_items_.size();
  of_dots_.assign(n * n, Relation::impossible);
  for (std::uint32_t k = 0; k < n; ++k)
    for (std::uint32_t l = k + 1; l < n; ++l) {
      const std::uint32_t a = dot_items_[k], b = dot_items_[l];
      const Relation r = relation(a, b);
      of_dots_[k * n + l] = of_dots_[l * n + k] = r;
      if (r == Relation::independent) {
        pairs_.push_back({{a, b},
                          total(items_[a].change, items_[b].change),
                          total(sizes(items_[a].change), sizes(items_[b].change))});
      } else if (r == Relation::bound) {
        if (auto s = joined({a, b})) pairs_.push_back(std::move(*s));
      }
    }
  std::stable_sort(pairs_.begin(), pairs_.end(), [](const Sum& a, const Sum& b) { return before(a.change, b.change); });
}

// Collects sets of lost dots that are connected by bound pairs (pairs whose effects do not add up), each set once.
// `set` and `open` are indices of lost dots; those in `open` come after the first of the set and may be joined.
void Together::connect(std::vector<std::uint32_t>& set, const std::vector<std::uint32_t>& open, unsigned count,
                       std::vector<Sum>& out) {
  const std::size_t n = dot_items_.size();
  if (set.size() == count) {
    Items items;
    for (std::uint32_t k : set) items.list[items.size++] = dot_items_[k];
    if (auto s = joined(items)) out.push_back(std::move(*s));
    return;
  }
  const auto bound = [&](std::uint32_t a, std::uint32_t b) { return of_dots_[a * n + b] == Relation::bound; };
  for (std::size_t k = 0; k < open.size() && tried_ <= kMostTried; ++k) {
    const std::uint32_t next = open[k];
    if (std::any_of(set.begin(), set.end(),
                    [&](std::uint32_t i) { return of_dots_[i * n + next] == Relation::impossible; }))
      continue;
    std::vector<std::uint32_t> further(open.begin() + static_cast<std::ptrdiff_t>(k + 1), open.end());
    // Adds the dots bound to the new one and to none before it; the others are or were in `open` already.
    for (std::uint32_t i = set[0] + 1; i < single_dots_; ++i)
      if (bound(next, i) &&
          std::none_of(set.begin(), set.end(), [&](std::uint32_t j) { return j == i || bound(j, i); }))
        further.push_back(i);
    set.push_back(next);
    connect(set, further, count, out);
    set.pop_back();
  }
}

std::vector<Together::Sum> Together::connected(unsigned count) {
  prepare_pairs();
  std::vector<Sum> out;
  for (std::uint32_t i = 0; i < single_dots_; ++i) {
    std::vector<std::uint32_t> set = {i}, open;
    for (std::uint32_t j = i + 1; j < single_dots_; ++j)
      if (of_dots_[i * dot_items_.size() + j] == Relation::bound) open.push_back(j);
    connect(set, open, count, out);
  }
  return out;
}

// ---- search ------------------------------------------------------------------------------------

void Together::check(const Sum& s) {
  if (!trial_.vanishes(s.change, s.extent)) return;
  std::vector<std::uint32_t> edits;
  int cost = 0;
  for (std::uint32_t i : s.items) {
    edits.insert(edits.end(), items_[i].edits.begin(), items_[i].edits.end());
    cost += items_[i].cost;
  }
  std::sort(edits.begin(), edits.end());
  const auto [place, is_new] = found_.try_emplace(std::move(edits), cost);
  if (!is_new) place->second = std::min(place->second, cost);
}

// Matches each of `sums` with one of `sorted` whose effect adds up with it.
void Together::find(const std::vector<Sum>& sums, const std::vector<Sum>& sorted) {
  for (const Sum& s : sums) {
    if (++looked_up_ > kMostLookedUp || found_.size() > kMostFound) return;
    const double wanted = -trial_.value()[0] - s.change[0];
    // The sizes of the terms of the other sum are not known yet: they are not much larger than the sum itself.
    const double window = 4 * trial_.tolerance(0, s.extent[0] + std::abs(wanted));
    auto it = std::lower_bound(sorted.begin(), sorted.end(), wanted - window,
                               [](const Sum& a, double v) { return a.change[0] < v; });
    for (; it != sorted.end() && it->change[0] <= wanted + window; ++it) {
      const Sum both{{}, total(s.change, it->change), total(s.extent, it->extent)};
      if (!trial_.vanishes(both.change, both.extent) || !independent(s.items, it->items)) continue;
      Sum whole = both;
      whole.items = s.items;
      for (std::uint32_t i : it->items) whole.items.list[whole.items.size++] = i;
      check(whole);
    }
  }
}

// Tries two changes that do not add up, at most one of them a lost dot. Exchanged names are tried only beside a lost
// dot.
void Together::try_bound_pairs() {
  std::vector<bool> plain;
  for (const Item& item : items_) plain.push_back(trial_.edit(item.edits[0]).kind < Edit::Kind::name);
  std::size_t compared = 0;
  for (std::uint32_t a = 0; a < items_.size(); ++a)
    for (std::uint32_t b = a + 1; b < items_.size(); ++b) {
      const bool dots = items_[a].dots || items_[b].dots;
      if ((items_[a].dots && items_[b].dots) || (!dots && !(plain[a] && plain[b])) || items_[a].edits.size() > 2 ||
          items_[b].edits.size() > 2)
        continue;
      if (tried_ > kMostTried || ++compared > kMostCompared) return;
      if (relation(a, b) != Relation::bound) continue;
      if (auto s = joined({a, b})) {
        check(*s);
        if (dots) bound_.push_back(std::move(*s));
      }
    }
}

std::vector<Misprint> Together::sets_of(unsigned count) {
  found_.clear();
  tried_ = looked_up_ = 0;
  prepare_singles();
  if (count == 1) {
    for (const Sum& s : singles_) check(s);
    // A single change of any kind has the same cost.
    for (auto& [edits, cost] : found_)
      if (edits.size() == 1) cost = 0;
  } else if (count == 2) {
    find(dots_, dots_);
    find(singles_, singles_);
    prepare_pairs();
    for (const Sum& s : pairs_) check(s);
    try_bound_pairs();
  } else if (count == 3) {
    triples_ = connected(count);
    for (const Sum& s : triples_) check(s);
    find(pairs_, dots_);
    find(pairs_, singles_);
    find(bound_, dots_);
  } else if (count == 4) {
    for (const Sum& s : connected(count)) check(s);
    find(pairs_, pairs_);
    find(triples_, singles_);
    find(bound_, pairs_);
    // Adds one more change to three lost dots.
    for (const Sum& other : singles_) {
      if (items_[other.items.list[0]].dots) continue;
      std::vector<Sum> with_dot;
      for (const Sum& d : dots_)
        if (relation(other.items.list[0], d.items.list[0]) == Relation::independent)
          with_dot.push_back(
              {{other.items.list[0], d.items.list[0]}, total(other.change, d.change), total(other.extent, d.extent)});
      find(with_dot, pairs_);
    }
  }
  std::vector<Misprint> list;
  for (const auto& [edits, cost] : found_) list.push_back({edits, cost});
  std::stable_sort(list.begin(), list.end(), [](const Misprint& a, const Misprint& b) { return a.cost < b.cost; });
  return list;
}

}  // namespace anholon
