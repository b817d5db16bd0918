#include "plot/spread.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace anholon::plot {

namespace {

class Spread {
 public:
  Spread(const std::vector<SpreadCase>& cases, std::size_t most)
      : cases_(cases), most_(std::min(most, cases.size())), taken_(cases.size()), far_(cases.size(), kFar) {
    xs_ = different(&Point::x), ys_ = different(&Point::y);
    width_ = range(xs_), height_ = range(ys_);
  }

  std::vector<std::size_t> make() {
    borders();
    grid();
    while (chosen_.size() < most_) take(farthest([](const SpreadCase&) { return true; }));
    std::sort(chosen_.begin(), chosen_.end());
    return chosen_;
  }

 private:
  static constexpr double kFar = std::numeric_limits<double>::infinity();

  std::vector<double> different(double Point::* axis) const {
    std::vector<double> list;
    for (const SpreadCase& c : cases_) list.push_back(c.at.*axis);
    std::sort(list.begin(), list.end());
    list.erase(std::unique(list.begin(), list.end()), list.end());
    return list;
  }
  static double range(const std::vector<double>& ascending) {
    const double size = ascending.empty() ? 0 : ascending.back() - ascending.front();
    return size > 0 ? size : 1;
  }
  double distance(const Point& a, const Point& b) const {
    return std::hypot((a.x - b.x) / width_, (a.y - b.y) / height_);
  }

  void take(std::size_t k) {
    taken_[k] = true;
    chosen_.push_back(k);
    for (std::size_t i = 0; i < cases_.size(); ++i) far_[i] = std::min(far_[i], distance(cases_[i].at, cases_[k].at));
  }

  // Returns the first of the cases that are farthest from the chosen ones; the number of cases if none is left.
  template <class Condition>
  std::size_t farthest(const Condition& condition) const {
    std::size_t found = cases_.size();
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (!taken_[k] && condition(cases_[k]) && (found == cases_.size() || far_[k] > far_[found])) found = k;
    return found;
  }
  // Returns the first of the cases nearest to a point.
  template <class Condition>
  std::size_t next_to(const Point& at, const Condition& condition) const {
    std::size_t found = cases_.size();
    for (std::size_t k = 0; k < cases_.size(); ++k)
      if (condition(k) && (found == cases_.size() || distance(cases_[k].at, at) < distance(cases_[found].at, at)))
        found = k;
    return found;
  }

  void borders() {
    unsigned last = 0;
    for (const SpreadCase& c : cases_) last = std::max(last, c.generation);
    while (last > 0 && chosen_.size() + 2 <= (most_ + 1) / 2) {
      const std::size_t one = farthest([&](const SpreadCase& c) { return c.generation == last; });
      if (one == cases_.size()) return;
      take(one);
      const std::size_t other =
          next_to(cases_[one].at, [&](std::size_t k) { return cases_[k].outcome != cases_[one].outcome; });
      if (other < cases_.size() && !taken_[other]) take(other);
    }
  }

  // Returns the middles of `count` equal parts of a list.
  static std::vector<double> middles(const std::vector<double>& values, std::size_t count) {
    std::vector<double> list;
    for (std::size_t k = 0; k < count; ++k) list.push_back(values[(2 * k + 1) * values.size() / (2 * count)]);
    return list;
  }

  void grid() {
    const std::size_t left = most_ - chosen_.size();
    if (left == 0) return;
    const auto nx = static_cast<double>(xs_.size()), ny = static_cast<double>(ys_.size());
    const auto part = [](double wanted, std::size_t most) {
      return static_cast<std::size_t>(std::clamp(std::floor(wanted), 1.0, static_cast<double>(most)));
    };
    std::size_t across = part(std::round(std::sqrt(static_cast<double>(left) * nx / ny)), xs_.size());
    across = std::min(across, left);
    const std::size_t up = part(static_cast<double>(left / across), ys_.size());
    across = std::min(left / up, xs_.size());
    for (const double x : middles(xs_, across))
      for (const double y : middles(ys_, up))
        if (const std::size_t k = next_to({x, y}, [](std::size_t) { return true; }); !taken_[k]) take(k);
  }

  const std::vector<SpreadCase>& cases_;
  std::size_t most_;
  std::vector<bool> taken_;
  std::vector<double> far_;  // from the nearest chosen case
  std::vector<double> xs_, ys_;
  double width_ = 1, height_ = 1;
  std::vector<std::size_t> chosen_;
};

}  // namespace

std::vector<std::size_t> spread(const std::vector<SpreadCase>& cases, std::size_t most) {
  return Spread(cases, most).make();
}

}  // namespace anholon::plot
