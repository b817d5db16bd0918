#include "jit/packs.h"

#include <algorithm>
#include <array>
#include <set>

namespace anholon::jit {

std::vector<Convolution> convolutions(const Step& s) {
  switch (s.act) {
  case Act::multiply:
    return {{s.a.at, s.b.at, s.lead}};
  case Act::square:
    return {{s.a.at, s.a.at, s.lead}};
  case Act::divide:
    return {{s.b.at, s.out.at, s.lead}};
  case Act::square_root:
    return {{s.out.at, s.out.at, s.lead}};
  case Act::power:
    return {{s.c.at, s.out.at, s.lead}, {s.d.at, s.a.at, s.lead}};
  case Act::sine_cosine:
    return {{s.b.at, s.c.at, s.lead}, {s.b.at, s.out.at, s.lead}};
  case Act::function:
    if (s.b_constant) return {};
    return {{s.c.at, s.b.at, s.lead}};
  case Act::arctan2: {
    std::vector<Convolution> r;
    if (!s.a_constant) r.push_back({s.e.at, s.c.at, s.lead});
    if (!s.b_constant) r.push_back({s.f.at, s.d.at, s.lead});
    return r;
  }
  case Act::input:
  case Act::linear:
  case Act::beyond:
  case Act::weigh:
  case Act::select:
  case Act::lookup:
    return {};
  }
  return {};
}

namespace {

// With at most this number of sums, the latency of the newest numbers determines the time of a stage, not the number of
// operations; then gathering sums into vectors does not pay.
constexpr std::size_t kFewSums = 16;

class Chooser {
 public:
  Chooser(const Plan& plan, unsigned width) : p_(plan), width_(width) {
    for (std::size_t j = 0; j < p_.x.size(); ++j) newest_[p_.x[j]] = p_.d[j];
    for (const Completion& c : p_.completions)
      if (c.out.series) newest_[c.out.at] = c.lead;
    for (const std::vector<Step>* list : {&p_.stage, &p_.weigh_again})
      for (const Step& s : *list)
        for (const Place& made :
             {s.out, s.act == Act::sine_cosine ? s.c : Place{}, s.act == Act::power ? s.d : Place{}})
          if (made.series) newest_[made.at] = s.lead;
  }

  Packs run() {
    for (const Step& s : p_.stage) place(s);
    for (const Row& row : rows_) {
      std::vector<const Step*> steps;
      std::copy_if(row.steps.begin(), row.steps.end(), std::back_inserter(steps),
                   [](const Step* s) { return s != nullptr; });
      if (steps.size() >= fewest_lanes(width_))
        pack(row);
      else
        for (const Step* s : steps) leave(*s);
    }
    if (seen_.size() <= kFewSums) left_.clear();
    for (const auto& [kind, rest] : left_)
      for (std::size_t from = 0; from + fewest_lanes(width_) <= rest.size(); from += width_) {
        std::vector<std::optional<Convolution>> lanes(width_);
        for (std::size_t l = 0; l < width_ && from + l < rest.size(); ++l) lanes[l] = rest[from + l];
        pack(lanes);
      }
    return std::move(out_);
  }

 private:
  struct Row {
    std::vector<const Step*> steps;  // in each lane
  };
  struct Seat {
    std::size_t row;
    int port;  // which result of that row
    std::size_t lane;
  };

  // The common properties of the steps of a row; they decide in which row steps find their lanes.
  using Kind = std::vector<std::int64_t>;

  void place(const Step& s) {
    const std::vector<Convolution> sums = convolutions(s);
    if (sums.empty() ||
        !std::all_of(sums.begin(), sums.end(), [&](const Convolution& c) { return seen_.insert(c).second; }))
      return;
    Kind kind{static_cast<int>(s.act), s.lead, s.a_constant, s.b_constant, s.a_unknown, s.b_unknown, s.b_later};
    const Seat* seat = nullptr;
    int position = 0, found_at = 0;
    for (const Convolution& c : sums)
      for (const std::uint32_t x : {c.a, c.b}) {
        const auto newest = newest_.find(x);
        if (newest == newest_.end()) return;  // the stages do not compute it
        kind.push_back(newest->second);
        const auto it = seats_.find(x);
        if (!seat && it != seats_.end()) seat = &it->second, found_at = position;
        ++position;
      }
    kind.push_back(seat ? found_at : -1);
    if (seat) kind.push_back(static_cast<std::int64_t>(seat->row)), kind.push_back(seat->port);
    std::size_t& row = open_.try_emplace(kind, rows_.size()).first->second;
    std::size_t lane = 0;
    const auto taken = [&] { return row < rows_.size() && (lane == width_ || rows_[row].steps[lane]); };
    if (seat)
      lane = seat->lane;
    else
      while (lane < width_ && taken()) ++lane;
    if (taken()) row = rows_.size(), lane = seat ? lane : 0;
    if (row == rows_.size()) rows_.push_back({std::vector<const Step*>(width_, nullptr)});
    rows_[row].steps[lane] = &s;
    int port = 0;
    for (const Place& made : {s.out, s.act == Act::sine_cosine ? s.c : Place{}})
      if (made.series) seats_.try_emplace(made.at, Seat{row, port++, lane});
  }

  void pack(const Row& row) {
    std::size_t count = 0;
    for (const Step* s : row.steps)
      if (s) count = convolutions(*s).size();
    for (std::size_t k = 0; k < count; ++k) {
      std::vector<std::optional<Convolution>> lanes;
      for (const Step* s : row.steps) lanes.push_back(s ? std::optional(convolutions(*s)[k]) : std::nullopt);
      pack(lanes);
    }
  }

  void pack(const std::vector<std::optional<Convolution>>& lanes) {
    Packs::Lanes a, b;
    std::uint8_t lead = 0;
    for (const std::optional<Convolution>& c : lanes) {
      if (c) lead = c->lead;
      a.push_back(c ? c->a : Packs::kNobody);
      b.push_back(c ? c->b : Packs::kNobody);
    }
    const std::size_t first = bundle(a), second = bundle(b);
    out_.packs.push_back({lanes, lead, first, second});
  }

  // Packs at least the histories of steps if there are too few steps of their kind.
  void leave(const Step& s) {
    for (const Convolution& c : convolutions(s)) left_[{c.lead, newest_.at(c.a), newest_.at(c.b)}].push_back(c);
  }

  // Returns a bundle that has all of these in their lanes, or room for them.
  std::size_t bundle(const Packs::Lanes& at) {
    int newest = 0;
    for (const std::uint32_t x : at)
      if (x != Packs::kNobody) newest = newest_.at(x);
    std::size_t i = 0;
    const auto agrees = [&](const Packs::Bundle& o) {
      for (unsigned l = 0; l < width_; ++l)
        if (at[l] != o.at[l] && at[l] != Packs::kNobody && o.at[l] != Packs::kNobody) return false;
      return o.newest == newest;
    };
    while (i < out_.bundles.size() && !(agrees(out_.bundles[i]) && shares(out_.bundles[i].at, at))) ++i;
    if (i == out_.bundles.size()) out_.bundles.push_back({Packs::Lanes(width_, Packs::kNobody), newest});
    for (unsigned l = 0; l < width_; ++l)
      if (at[l] != Packs::kNobody) out_.bundles[i].at[l] = at[l];
    return i;
  }

  static bool shares(const Packs::Lanes& x, const Packs::Lanes& y) {
    for (std::size_t l = 0; l < x.size(); ++l)
      if (x[l] != Packs::kNobody && x[l] == y[l]) return true;
    return false;
  }

  const Plan& p_;
  const unsigned width_;
  Packs out_;
  std::map<std::uint32_t, int> newest_;  // by series
  std::map<std::uint32_t, Seat> seats_;
  std::map<Kind, std::size_t> open_;  // rows that are not full
  std::vector<Row> rows_;
  std::set<Convolution> seen_;  // two steps may need the same one
  std::map<std::array<int, 3>, std::vector<Convolution>> left_;
};

}  // namespace

Packs choose_packs(const Plan& plan, unsigned width) { return Chooser(plan, width).run(); }

}  // namespace anholon::jit
