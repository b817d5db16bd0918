// Random systems whose motion between events is known in closed form. An independent method finds their events: bounds
// of the second derivative bracket every zero, and bisection in long double finds it, on the exact pieces. A formula
// may be replaced by another one with the same zeros that saturates, has a kink, or is steep.
#pragma once
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace anholon::test {

using Real = long double;

class EventModel {
 public:
  struct Occurred {
    std::size_t event;
    Real t, slope;  // slope of the formula at its zero
  };
  // The events up to `end`; undecided if two events are nearly simultaneous, or a formula nearly touches zero.
  struct Course {
    std::vector<Occurred> events;
    bool decided = true, stopped = false;
    std::vector<Real> x, v;  // at the end, of the bodies; v has no meaning for a body that fills
  };

  explicit EventModel(std::uint64_t seed) : seed_(seed * 0x9e3779b97f4a7c15ULL + 1) {
    make_bodies();
    make_events();
    end_ = decimal(300, 600);
    // The margin by which an arc misses is below the round-off of a steep formula.
    for (Event& e : events_) e.writing = e.level_text[0] == '(' ? kPlain : draw(kPlain + 1);
  }

  std::size_t bodies() const { return bodies_.size(); }
  std::string name(std::size_t body) const {
    return (bodies_[body].law == Law::filling ? "z" : "x") + std::to_string(body);
  }
  bool moves(std::size_t body) const { return bodies_[body].law != Law::filling; }
  std::string event_name(std::size_t e) const { return "e" + std::to_string(e); }
  int end_hundredths() const { return end_; }
  std::string text() const;
  Course course() const;

 private:
  enum class Law : std::uint8_t { falling, spring, filling };  // x'' = a; x'' = -w^2 (x - c); z' = r; constants by mode
  enum class When : std::uint8_t { level, gap, velocity, time, square };
  enum class Set : std::uint8_t { nothing, bounce, collide, mode, kick, move, stop };
  static constexpr std::size_t kPlain = 7;  // forms 0 to 2 replace the formula; forms 3 to 7 keep it
  struct Body {
    Law law;
    int w, constant[2], x, v;  // in hundredths
  };
  struct Event {
    When when;
    std::size_t i, j;
    Real level;
    std::string level_text;
    int direction;
    Set set;
    int factor;  // in hundredths
    std::size_t writing = 0;
  };
  // The state at one time.
  struct State {
    Real t;
    int mode;
    std::vector<Real> x, v;
  };
  struct Function {
    std::function<Real(Real)> value, slope;
    Real bend;  // bound of the second derivative
  };

  static Real real(int hundredths) { return static_cast<Real>(hundredths) / 100; }
  static std::string text(int hundredths) {
    const int a = std::abs(hundredths);
    return std::string(hundredths < 0 ? "-" : "") + std::to_string(a / 100) + "." + (a % 100 < 10 ? "0" : "") +
           std::to_string(a % 100);
  }
  std::uint64_t draw(std::uint64_t n) {
    seed_ ^= seed_ << 13;
    seed_ ^= seed_ >> 7;
    seed_ ^= seed_ << 17;
    return (seed_ * 0x2545f4914f6cdd1dULL >> 33) % n;
  }
  int decimal(int from, int to) { return from + static_cast<int>(draw(static_cast<std::uint64_t>(to - from + 1))); }

  void make_bodies();
  void make_events();
  State after(const State& s, Real dt) const;
  Real acceleration(const State& s, std::size_t i) const;
  Function function(const State& s, const Event& e, Real within) const;
  void set(const Event& e, State& s, bool& stopped) const;

  std::uint64_t seed_;
  int end_ = 0;
  std::vector<Body> bodies_;
  std::vector<Event> events_;
};

inline void EventModel::make_bodies() {
  const std::size_t n = 1 + draw(3);
  for (std::size_t i = 0; i < n; ++i) {
    if (i > 0 && draw(4) == 0) {  // equal to the one before: their events are simultaneous
      bodies_.push_back(bodies_.back());
      continue;
    }
    Body b{i == 0 || draw(4) > 0 ? (draw(3) == 0 ? Law::spring : Law::falling) : Law::filling, 0, {0, 0}, 0, 0};
    b.w = decimal(50, 300);
    for (int& c : b.constant)
      c = b.law == Law::falling ? -decimal(0, 1) * decimal(100, 1000) - decimal(0, 100) : decimal(-200, 200);
    b.x = decimal(50, 300);
    b.v = decimal(-200, 300);
    bodies_.push_back(b);
  }
}

inline void EventModel::make_events() {
  const std::size_t count = 1 + draw(4);
  for (std::size_t k = 0; k < count; ++k) {
    Event e{When::level, draw(bodies_.size()), 0, 0, "", static_cast<int>(draw(3)) - 1, Set::nothing, decimal(50, 100)};
    e.j = bodies_.size() > 1 ? (e.i + 1 + draw(bodies_.size() - 1)) % bodies_.size() : e.i;
    const bool moving = moves(e.i), both = moving && e.i != e.j && moves(e.j);
    int level = decimal(-100, 100);
    switch (draw(8)) {
    case 0:
      if (both) e.when = When::gap;
      break;
    case 1:
      if (moving) e.when = When::velocity;
      break;
    case 2:
      e.when = When::time, level = decimal(1, 5) * 50;
      break;
    case 3:
      e.when = When::square, level = std::abs(level) + 20;
      break;
    default:
      level = draw(2) == 0 ? 0 : level;  // usually a floor
    }
    e.level = real(level);
    e.level_text = text(level);
    const Body& b = bodies_[e.i];
    if (e.when == When::level && b.law == Law::falling && b.constant[0] < 0 && b.v > 0 && draw(3) == 0) {
      // The level is the top of the first arc, plus a margin by which the arc misses or passes the level.
      static const char* const misses[] = {"0", "1e-6", "-1e-6", "1e-9", "-1e-9", "1e-11", "-1e-11"};
      static const Real sizes[] = {0, 1e-6L, -1e-6L, 1e-9L, -1e-9L, 1e-11L, -1e-11L};
      const std::size_t m = draw(7);
      e.level = real(b.x) - real(b.v) * real(b.v) / (2 * real(b.constant[0])) + sizes[m];
      e.level_text = "(" + text(b.x) + " + " + text(b.v) + "^2/" + text(-2 * b.constant[0]) + " + " + misses[m] + ")";
      e.direction = static_cast<int>(draw(2));
    }
    switch (draw(7)) {
    case 0:
      break;
    case 1:
      e.set = Set::mode;
      break;
    case 2:
      e.set = moving ? Set::kick : Set::move;
      break;
    case 3:
      e.set = draw(3) == 0 ? Set::stop : Set::nothing;
      break;
    case 4:
      e.set = Set::move;
      break;
    default:
      if (e.when == When::gap)
        e.set = Set::collide;
      else if (moving && (e.when == When::level || e.when == When::square))
        e.set = Set::bounce;
      else if (e.when == When::level)
        e.set = Set::move;
    }
    // A bounce must not fire in both directions.
    if ((e.set == Set::bounce || e.set == Set::collide) && e.direction == 0) e.direction = draw(2) == 0 ? -1 : 1;
    events_.push_back(e);
  }
}

inline std::string EventModel::text() const {
  std::string coordinates, particles, forces, states, initial, list;
  const auto mode = [](const Body& b) { return "choose(k, " + text(b.constant[0]) + ", " + text(b.constant[1]) + ")"; };
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    const std::string x = name(i);
    if (b.law == Law::filling) {
      states += x + " = {rate = \"" + mode(b) + "\", initial = " + text(b.x) + "}\n";
      continue;
    }
    coordinates += (coordinates.empty() ? "\"" : ", \"") + x + "\"";
    particles += "[[particle]]\nname = \"p" + std::to_string(i) + "\"\nmass = 1\nposition = \"" + x + "*ex\"\n";
    forces += "[[force]]\nname = \"f" + std::to_string(i) + "\"\non = \"p" + std::to_string(i) + "\"\nvector = \"" +
              (b.law == Law::falling ? mode(b) : "-" + text(b.w) + "^2*(" + x + " - " + mode(b) + ")") + "*ex\"\n";
    initial += x + " = " + text(b.x) + "\n\"" + x + "'\" = " + text(b.v) + "\n";
  }
  for (std::size_t k = 0; k < events_.size(); ++k) {
    const Event& e = events_[k];
    const std::string i = name(e.i), j = name(e.j);
    list += "[[event]]\nname = \"" + event_name(k) + "\"\nwhen = \"";
    switch (e.when) {
    case When::level: {
      const std::string u = i + " - " + e.level_text;
      switch (e.writing) {
      case 0:
        list += "tanh((" + u + ")/0.01)";
        break;
      case 1:
        list += "1/(1 + exp(-(" + u + ")/0.02)) - 1/2";
        break;
      case 2:
        list += "atan((" + u + ")/0.001)";
        break;
      default:
        list += u;
      }
      break;
    }
    case When::gap:
      list += i + " - " + j;
      break;
    case When::velocity:
      list += i + "'";
      break;
    case When::time:
      list += "t - " + e.level_text;
      break;
    case When::square: {
      const std::string n = e.writing == 0 ? "8" : e.writing == 1 ? "20" : "2";
      if (e.writing == 2)
        list += "abs(" + i + ") - " + e.level_text;
      else
        list += i + "^" + n + " - " + e.level_text + "^" + n;
      break;
    }
    }
    list += "\"\n";
    if (e.direction != 0) list += std::string("direction = \"") + (e.direction > 0 ? "up" : "down") + "\"\n";
    const std::string f = text(e.factor);
    switch (e.set) {
    case Set::nothing:
      break;
    case Set::bounce:
      list += "set = {\"" + i + "'\" = \"-" + f + "*" + i + "'\"}\n";
      break;
    case Set::collide:
      list += "set = {\"" + i + "'\" = \"" + j + "'\", \"" + j + "'\" = \"" + i + "'\"}\n";
      break;
    case Set::mode:
      list += "set = {k = \"3 - k\"}\n";
      break;
    case Set::kick:
      list += "set = {\"" + i + "'\" = \"" + i + "' + " + f + "\"}\n";
      break;
    case Set::move:
      list += "set = {" + i + " = \"" + i + " + " + f + "\"}\n";
      break;
    case Set::stop:
      list += "stop = true\n";
      break;
    }
  }
  return "coordinates = [" + coordinates + "]\n" + particles + forces + list +
         (states.empty() ? "" : "[state]\n" + states) + "[mode]\nk = 1\n[initial]\n" + initial;
}

inline Real EventModel::acceleration(const State& s, std::size_t i) const {
  const Body& b = bodies_[i];
  const Real c = real(b.constant[s.mode - 1]);
  return b.law == Law::falling ? c : b.law == Law::spring ? -real(b.w) * real(b.w) * (s.x[i] - c) : 0;
}

inline EventModel::State EventModel::after(const State& s, Real dt) const {
  State n = s;
  n.t += dt;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& b = bodies_[i];
    const Real c = real(b.constant[s.mode - 1]), w = real(b.w);
    switch (b.law) {
    case Law::falling:
      n.x[i] += dt * (s.v[i] + dt * c / 2);
      n.v[i] += dt * c;
      break;
    case Law::spring: {
      const Real cos = std::cos(w * dt), sin = std::sin(w * dt), u = s.x[i] - c;
      n.x[i] = c + u * cos + s.v[i] / w * sin;
      n.v[i] = s.v[i] * cos - u * w * sin;
      break;
    }
    case Law::filling:
      n.x[i] += dt * c;
      n.v[i] = c;
      break;
    }
  }
  return n;
}

inline EventModel::Function EventModel::function(const State& s, const Event& e, Real within) const {
  const auto x = [this, s](std::size_t i) { return [this, s, i](Real dt) { return after(s, dt).x[i]; }; };
  const auto v = [this, s](std::size_t i) { return [this, s, i](Real dt) { return after(s, dt).v[i]; }; };
  // Bounds of |x''|, |x'|, |x| and |x'''| over the interval.
  const auto bounds = [&](std::size_t i) {
    const Body& b = bodies_[i];
    const Real c = real(b.constant[s.mode - 1]), w = real(b.w);
    struct {
      Real x, v, a, jerk;
    } r{};
    if (b.law == Law::spring) {
      const Real amplitude = std::hypot(s.x[i] - c, s.v[i] / w);
      r = {std::abs(c) + amplitude, w * amplitude, w * w * amplitude, w * w * w * amplitude};
    } else {
      const Real a = b.law == Law::falling ? std::abs(c) : 0,
                 v0 = b.law == Law::falling ? std::abs(s.v[i]) : std::abs(c);
      r = {std::abs(s.x[i]) + within * (v0 + within * a / 2), v0 + within * a, a, 0};
    }
    return r;
  };
  const Real level = e.level;
  const std::function<Real(Real)> xi = x(e.i), vi = v(e.i), xj = x(e.j), vj = v(e.j);
  const auto bi = bounds(e.i), bj = bounds(e.j);
  switch (e.when) {
  case When::level:
    return {[=](Real d) { return xi(d) - level; }, vi, bi.a};
  case When::gap:
    return {[=](Real d) { return xi(d) - xj(d); }, [=](Real d) { return vi(d) - vj(d); }, bi.a + bj.a};
  case When::velocity:
    return {vi, [this, s, i = e.i](Real d) { return acceleration(after(s, d), i); }, bi.jerk};
  case When::time:
    return {[t = s.t, level](Real d) { return t + d - level; }, [](Real) { return Real(1); }, 0};
  case When::square:
    return {[=](Real d) { return xi(d) * xi(d) - level * level; }, [=](Real d) { return 2 * xi(d) * vi(d); },
            2 * (bi.v * bi.v + bi.x * bi.a)};
  }
  return {};
}

// The first d in (from, to] after which f + shift has the sign -side.
inline std::optional<Real> first_change(const std::function<Real(Real)>& value, const std::function<Real(Real)>& slope,
                                        Real bend, Real shift, int side, Real from, Real to) {
  const Real middle = (from + to) / 2, half = (to - from) / 2, f = side * (value(middle) + shift),
             d = side * slope(middle);
  if (std::abs(f) > std::abs(d) * half + bend * half * half / 2)
    return f < 0 ? std::optional<Real>(from) : std::nullopt;
  if (std::abs(d) > bend * half) {
    const auto at = [&](Real x) { return side * (value(x) + shift); };
    constexpr Real kRoundoff = 1e-15L;  // time of the last event
    if (d > 0) return at(from) < -kRoundoff ? std::optional<Real>(from) : std::nullopt;
    if (!(at(to) < 0)) return std::nullopt;
    if (at(from) < -kRoundoff) return from;
    Real low = from, high = to;
    for (int k = 0; k < 200; ++k) {
      const Real x = (low + high) / 2;
      if (x == low || x == high) break;
      (at(x) < 0 ? high : low) = x;
    }
    return high;
  }
  if (half < 1e-12L) return std::nullopt;  // the function touches zero
  if (const auto x = first_change(value, slope, bend, shift, side, from, middle)) return x;
  return first_change(value, slope, bend, shift, side, middle, to);
}

inline void EventModel::set(const Event& e, State& s, bool& stopped) const {
  const Real f = real(e.factor);
  switch (e.set) {
  case Set::nothing:
    break;
  case Set::bounce:
    s.v[e.i] = -f * s.v[e.i];
    break;
  case Set::collide:
    std::swap(s.v[e.i], s.v[e.j]);
    break;
  case Set::mode:
    s.mode = 3 - s.mode;
    break;
  case Set::kick:
    s.v[e.i] += f;
    break;
  case Set::move:
    s.x[e.i] += f;
    break;
  case Set::stop:
    stopped = true;
    break;
  }
}

inline EventModel::Course EventModel::course() const {
  constexpr Real kSame = 1e-15L, kApart = 1e-7L, kZero = 1e-13L, kFirst = 1e-12L, kDoubt = 1e-8L;
  constexpr std::size_t kMany = 60;
  Course out;
  State s{0, 1, {}, {}};
  for (const Body& b : bodies_)
    s.x.push_back(real(b.x)), s.v.push_back(b.law == Law::filling ? real(b.constant[0]) : real(b.v));
  const Real end = real(end_);
  std::vector<int> sides(events_.size(), 0);
  const auto find_sides = [&](const State& at, const std::vector<bool>& fired) {
    for (std::size_t k = 0; k < events_.size(); ++k) {
      const Function f = function(at, events_[k], 1);
      const Real value = f.value(0), slope = f.slope(0), bend = f.slope(1e-6L) - slope;
      // The formula is nearly zero without having fired: undecided.
      if (!fired[k] && out.events.size() > 0 && std::abs(value) < kDoubt &&
          !(std::abs(value) < kZero && std::abs(slope) < kZero))
        out.decided = false;
      const Real what = std::abs(value) > kZero   ? value
                        : std::abs(slope) > kZero ? slope
                        : std::abs(bend) > kZero  ? bend
                                                  : 0;
      if (std::abs(what) < kDoubt && what != 0 && what != bend && out.events.size() > 0) out.decided = false;
      sides[k] = what > 0 ? 1 : what < 0 ? -1 : 0;
    }
  };
  find_sides(s, std::vector<bool>(events_.size(), true));
  Real since = 0;  // events of this piece are recorded up to this time
  while (out.decided) {
    const Real within = end - s.t;
    struct Next {
      std::size_t event;
      Real dt, slope;
    };
    std::vector<Next> next;
    for (std::size_t k = 0; k < events_.size(); ++k) {
      if (sides[k] == 0) continue;
      const Function f = function(s, events_[k], within);
      const auto change = [&](Real shift) {
        return first_change(f.value, f.slope, f.bend, shift, sides[k], since, within);
      };
      const auto dt = change(0);
      const Real doubt = s.t == 0 ? kFirst : kDoubt;
      for (Real shift : {doubt, -doubt}) {
        // If the formula begins at zero, a shift against its side is passed at once.
        if (std::abs(f.value(since)) <= doubt && shift * sides[k] < 0) continue;
        const auto other = change(shift);
        if (dt.has_value() != other.has_value() || (dt && std::abs(*dt - *other) > 1e-2L)) {
          // An arc that touches zero exactly at the first event is decided: the arc does not pass.
          const bool exact = doubt == kFirst && !dt && !change(-sides[k] * 1e-16L) ? false : doubt == kFirst && !dt;
          if (!exact) out.decided = false;
        }
      }
      if (dt) next.push_back({k, *dt, f.slope(*dt)});
    }
    if (next.empty() || !out.decided) break;
    Real first = within;
    for (const Next& n : next) first = std::min(first, n.dt);
    if (within - first < kApart) out.decided = false;
    std::vector<bool> fired(events_.size(), false);
    bool restart = false, stopped = false;
    State there = after(s, first);
    std::sort(next.begin(), next.end(), [](const Next& a, const Next& b) { return a.event < b.event; });
    for (const Next& n : next) {
      if (n.dt - first > kSame) {
        if (n.dt - first < kApart) out.decided = false;
        continue;
      }
      sides[n.event] = -sides[n.event];
      const Event& e = events_[n.event];
      if (e.direction != 0 && e.direction != sides[n.event]) continue;
      fired[n.event] = true;
      out.events.push_back({n.event, s.t + n.dt, std::abs(n.slope)});
      set(e, there, stopped);
      restart = restart || (e.set != Set::nothing && e.set != Set::stop);
    }
    if (out.events.size() > kMany) out.decided = false;
    since = first;
    if (stopped) {
      s = there;
      out.stopped = true;
      break;
    }
    if (!restart) continue;
    s = there;
    for (std::size_t i = 0; i < bodies_.size(); ++i)
      if (bodies_[i].law == Law::filling) s.v[i] = real(bodies_[i].constant[s.mode - 1]);
    since = 0;
    find_sides(s, fired);
  }
  const State last = out.stopped ? s : after(s, end - s.t);
  out.x = last.x;
  out.v = last.v;
  return out;
}

}  // namespace anholon::test
