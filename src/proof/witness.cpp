#include "proof/witness.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "proof/enclose.h"
#include "proof/scattered.h"
#include "tape/point.h"

namespace anholon {

namespace {

constexpr int kPoints = 40;  // points tried before the search ends
constexpr int kSizes = 4;    // sizes of the free derivatives: 1, 1/2, 1/4, …
constexpr slong kFirstBits = 64;
constexpr slong kRootBits = 256;  // precision of the box of a root, unless more is requested
constexpr int kNewtonSteps = 60;
constexpr int kBitsNear[] = {12, 40};  // significant bits of the free values at a given start

// Returns a rational in (1/5, 8/5) that depends on the symbol and the attempt. Derivatives, and for Where::elsewhere
// also coordinates, have either sign.
Rational arbitrary(const Node& n, int attempt, Where where) {
  const std::uint64_t h = scattered_bits(static_cast<std::uint64_t>(n.kind) * 1000003 + n.index * 131 + n.order +
                                         static_cast<std::uint64_t>(attempt) * 7919);
  const unsigned long step = (h >> 40) % 89;
  Rational r(13 + step, 64);
  if (n.kind != Kind::jet || (n.order == 0 && where == Where::positive)) return r;
  if (n.order > 0)
    r /= 1 << (attempt % kSizes);
  else if (attempt % 2)
    r *= 3;
  return h & 1 ? Rational(-r) : r;
}

// Returns the number with the upper bits of its significand.
Rational rounded(double x, int bits) {
  int exponent = 0;
  const double significand = std::frexp(x, &exponent);
  return Rational(std::ldexp(std::round(std::ldexp(significand, bits)), exponent - bits));
}

// Returns the parameters of the model that have a rational value.
std::vector<std::optional<Rational>> rational_parameters(const Model& model) {
  Graph& g = *model.graph;
  std::vector<std::optional<Rational>> values;
  for (const Parameter& p : model.parameters) {
    // A value may refer to parameters before or after it: known values are substituted until nothing changes.
    Expr e = p.value;
    for (std::size_t k = 0; k <= model.parameters.size() && !is_number(e) && !symbols({&e, 1}).empty(); ++k)
      e = substitute({&e, 1}, [&](NodeId id) {
        const Node& n = g.node(id);
        return n.kind == Kind::parameter ? model.parameters[n.index].value : Expr{};
      })[0];
    values.push_back(is_number(e) ? std::optional<Rational>(number_value(e)) : std::nullopt);
  }
  return values;
}

class Search {
 public:
  // Parameters have the values of the model, or arbitrary ones.
  Search(const Difference& d, const Column& equations, const Column& unknowns, const Model& model, bool of_the_model,
         Where where = Where::positive, std::vector<PointValues>* starts = nullptr)
      : e_(d.expression()), g_(*e_.graph), where_(where), parts_{d.left}, equations_(equations), unknowns_(unknowns),
        starts_(starts) {
    if (of_the_model) parameters_ = rational_parameters(model);
    for (const auto& [coefficient, term] : d.right) parts_.insert(parts_.end(), {coefficient, term});
  }
  Search(const Difference& d, const Elimination& elimination, const Model& model) : Search(d, {}, {}, model, true) {
    if (elimination.phi.empty()) return;
    // The constraints and their derivatives, up to the highest dependent derivatives that occur. The first two
    // derivatives of solved constraints are substituted already, except in differences that are not restricted to the
    // manifold: those of forms with multipliers.
    Graph& g = *e_.graph;
    unsigned highest = 0;
    bool put_in = elimination.solved;
    for (NodeId id : symbols(parts_)) {
      const Node& n = g.node(id);
      const auto& D = elimination.dependent;
      if (n.kind != Kind::jet || std::find(D.begin(), D.end(), n.index) == D.end()) continue;
      highest = std::max(highest, static_cast<unsigned>(n.order));
      if (n.order == elimination.m || n.order == elimination.m + 1) put_in = false;
    }
    Column phi = elimination.phi;
    for (unsigned k = elimination.m; k <= highest; ++k) {
      if (!put_in || k > elimination.m + 1) {
        const Column level = put_in ? elimination.on(phi) : phi, unknown = elimination.D(jets(model, k));
        equations_.insert(equations_.end(), level.begin(), level.end());
        unknowns_.insert(unknowns_.end(), unknown.begin(), unknown.end());
      }
      phi = total_derivative(phi);
    }
  }

  WitnessSearch run(slong most_bits = kWitnessBits) {
    most_bits_ = std::max(most_bits, kFirstBits);
    WitnessSearch out;
    std::string largest;
    int tried = 0;
    const int near = starts_ ? static_cast<int>(starts_->size() * std::size(kBitsNear)) : 0;
    for (int attempt = 0; attempt < kPoints + near; ++attempt) {
      if (attempt == kPoints && tried > 0) break;
      begin_at(attempt);
      WitnessPoint w;
      if (!place(attempt, w)) continue;
      std::string value;
      const int found = excludes_zero(w, value);
      if (found < 0) continue;
      ++tried;
      if (found > 0) {
        out.detail = value;
        out.witness = std::move(w);
        return out;
      }
      largest = value;
    }
    const std::string points = " at " + std::to_string(tried) + " points";
    // A ball with a large radius says nothing about the difference.
    const bool is_small = std::strtod(largest.c_str(), nullptr) < 1;
    out.detail = tried == 0 ? "no point of the manifold was found"
                 : is_small ? "zero to " + largest + points
                            : "its values have no digits that are known" + points;
    return out;
  }

 private:
  bool is_unknown(NodeId id) const {
    return std::any_of(unknowns_.begin(), unknowns_.end(), [&](Expr u) { return u.id == id; });
  }

  // From attempt kPoints on, free symbols have rounded values at the starts.
  void begin_at(int attempt) {
    const auto k = static_cast<std::size_t>(std::max(attempt - kPoints, 0));
    start_ = attempt < kPoints ? nullptr : &(*starts_)[k % starts_->size()];
    if (start_) bits_ = kBitsNear[k / starts_->size()];
  }

  // Chooses values of the free symbols, and a verified root for the others.
  bool place(int attempt, WitnessPoint& w) {
    Column all = equations_;
    // operands that cancel in the difference must have values as well
    all.insert(all.end(), parts_.begin(), parts_.end());
    std::unordered_map<NodeId, Rational> value;
    for (NodeId id : symbols(all)) {
      if (is_unknown(id)) continue;
      const Node& n = g_.node(id);
      const bool given = n.kind == Kind::parameter && n.index < parameters_.size() && parameters_[n.index];
      const auto at_start = [&] { return (*start_)(Expr{&g_, id}); };
      if (!given && start_ && !std::isfinite(at_start())) return false;
      const Rational r = given    ? *parameters_[n.index]
                         : start_ ? rounded(at_start(), bits_)
                                  : arbitrary(n, attempt, where_);
      value.emplace(id, r);
      w.values.push_back({Expr{&g_, id}, r});
    }
    if (unknowns_.empty()) return true;
    std::vector<long double> root;
    if (!approximate(value, attempt, root)) return false;
    SquareSystem system;
    system.size = unknowns_.size();
    const auto at = [&](const Box& box) {
      BallPoint point;
      for (const auto& [id, r] : value) point.emplace(id, Ball(r));
      for (std::size_t i = 0; i < unknowns_.size(); ++i) point.emplace(unknowns_[i].id, box[i]);
      return point;
    };
    Column derivatives;
    for (Expr f : equations_) {
      const Column row = gradient(f, unknowns_);
      derivatives.insert(derivatives.end(), row.begin(), row.end());
    }
    system.value = [&](const Box& box) { return enclose(equations_, at(box)); };
    system.jacobian = [&](const Box& box) { return enclose(derivatives, at(box)); };
    const BallScope precision(most_bits_ > kWitnessBits ? most_bits_ : kRootBits);
    const std::optional<Box> box = enclose_root(system, root);
    if (!box) return false;
    for (std::size_t i = 0; i < unknowns_.size(); ++i) {
      const auto middle = (*box)[i].midpoint(), radius = (*box)[i].radius();
      if (!middle || !radius) return false;
      w.enclosed.push_back({unknowns_[i], *middle, *radius > 0 ? *radius : Rational(1, mpz_class(1) << 200)});
    }
    w.equations = equations_;
    return true;
  }

  bool approximate(const std::unordered_map<NodeId, Rational>& value, int attempt, std::vector<long double>& root) {
    std::vector<double> x;
    for (Expr u : unknowns_) x.push_back(start_ ? (*start_)(u) : arbitrary(g_.node(u.id), attempt, where_).get_d());
    Rows jacobian;
    for (Expr f : equations_) jacobian.push_back(gradient(f, unknowns_));
    for (int k = 0; k < kNewtonSteps; ++k) {
      PointValues at([&](const Node& n) {
        for (std::size_t i = 0; i < unknowns_.size(); ++i) {
          const Node& u = g_.node(unknowns_[i].id);
          if (u.kind == n.kind && u.index == n.index && u.order == n.order) return x[i];
        }
        for (const auto& [id, r] : value) {
          const Node& s = g_.node(id);
          if (s.kind == n.kind && s.index == n.index && s.order == n.order) return r.get_d();
        }
        return 0.0;
      });
      Matrix<double> j(x.size(), x.size());
      std::vector<double> f, step;
      for (std::size_t i = 0; i < x.size(); ++i) {
        f.push_back(at(equations_[i]));
        for (std::size_t c = 0; c < x.size(); ++c) j(i, c) = at(jacobian[i][c]);
      }
      Lu<double> lu;
      if (!lu.factor(j)) return false;
      lu.solve(f, step);
      double largest = 0;
      for (std::size_t i = 0; i < x.size(); ++i) {
        x[i] -= step[i];
        largest = std::max(largest, std::abs(step[i]) / (1 + std::abs(x[i])));
      }
      if (!(largest < 1e8)) return false;
      if (largest < 1e-14) {
        root.assign(x.begin(), x.end());
        return true;
      }
    }
    return false;
  }

  // Returns 1 if a ball around e excludes zero, 0 if none does at any precision, -1 if e has no value there.
  int excludes_zero(const WitnessPoint& w, std::string& value) {
    for (slong bits = kFirstBits;; bits = std::min(4 * bits, most_bits_)) {
      const BallScope precision(bits);
      BallPoint at;
      for (const auto& [symbol, r] : w.values) at.emplace(symbol.id, Ball(r));
      for (const WitnessPoint::Enclosed& x : w.enclosed) at.emplace(x.symbol.id, Ball(x.midpoint, x.radius));
      const Ball b = enclose({&e_, 1}, at)[0];
      if (b.is_finite() && !b.contains_zero()) {
        value = b.midpoint_text(6);
        return 1;
      }
      if (b.is_finite()) value = b.radius_text();
      if (bits == most_bits_) return b.is_finite() ? 0 : -1;
    }
  }

  Expr e_;
  Graph& g_;
  Where where_;
  slong most_bits_ = kWitnessBits;
  std::vector<std::optional<Rational>> parameters_;
  Column parts_, equations_, unknowns_;
  std::vector<PointValues>* starts_ = nullptr;
  PointValues* start_ = nullptr;  // the start of this attempt
  int bits_ = 0;                  // of the values at the start
};

}  // namespace

WitnessSearch find_witness(const Difference& d, const Elimination& elimination, const Model& model, long bits) {
  return Search(d, elimination, model).run(bits);
}

WitnessSearch find_witness(const Difference& d, const Column& equations, const Column& unknowns, const Model& model,
                           Where where, std::vector<PointValues>* starts) {
  WitnessSearch search;
  for (const bool of_the_model : {true, false}) {
    search = Search(d, equations, unknowns, model, of_the_model, where, starts).run();
    if (search.witness) break;
  }
  return search;
}

}  // namespace anholon
