#include "modelfile/mechanical/contact_shapes.h"

#include <algorithm>

#include "expr/normal.h"
#include "modelfile/mechanical/shapes.h"
#include "modelfile/names/constant.h"
#include "modelfile/text/collect.h"
#include "numeric/number.h"

namespace anholon {

namespace {

// Returns v scaled to length 1; unchanged if its length is proved to be 1.
Vector unit(const Vector& v) {
  const Expr square = dot(v, v);
  if (proved_zero(square - v[0].graph->one())) return v;
  return pow(square, Rational(-1, 2)) * v;
}

Vector axis(Graph& g, int k) {
  Vector v = zero_vector(g);
  v[k] = g.one();
  return v;
}

bool is_zero_vector(const Vector& v) { return proved_zero(v[0]) && proved_zero(v[1]) && proved_zero(v[2]); }

// Returns two directions orthogonal to n, one of them an axis if n has no component along it.
std::vector<Vector> tangents(const Vector& n) {
  Graph& g = *n[0].graph;
  constexpr int kAxes[] = {1, 0, 2};
  for (const int k : kAxes)
    if (proved_zero(n[k])) {
      const Vector e = axis(g, k);
      return {cross(e, n), e};
    }
  const Vector t = unit(cross(axis(g, 1), n));
  return {t, cross(n, t)};
}

// The hint for other ways in which two bodies touch.
constexpr const char* kTwoBodies = "on = \"ball(R)\" with through = \"B.center\" where the other body B is a ball; "
                                   "else gap = \"…\" and slip = \"…\" as formulas in place of 'body'";

class TouchingReader {
 public:
  TouchingReader(const Item& c, Scope& scope, Model& model) : c_(c), scope_(scope), model_(model), g_(*model.graph) {
    const Item& named = *c.find("body");
    if (named.kind == Item::Kind::array)
      throw Failure(named.span, "a contact names one body, which touches a plane, a ball or a bowl", kTwoBodies);
    if (named.kind != Item::Kind::string) throw Failure(named.span, "the name of a body", "body = \"ball\"");
    body_ = scope.body(named.text(), named.span);
    if (scope.parts(body_).body_failed) throw silent_failure();
    if (const Item* both = c.find("gap") ? c.find("gap") : c.find("slip"))
      throw Failure(both->key_span, "gap and slip velocity follow from the body and its shape",
                    "leave out 'gap' and 'slip', or 'body'");
    read_shape_of_contact();
    through_ = c.find("through") ? scope.vector(*c.find("through")) : zero_vector(g_);
    if (const Item* through = c.find("through"); through && is_zero_vector(through_ - body().center))
      throw Failure(through->span, "a body does not touch what goes through its own centre",
                    "leave out 'through', or name a place of what is touched: through = \"-3*ez\"");
    read_ground();
    if (shape_.kind == "box") note_moving_plane();
  }

  std::vector<Touching> read() {
    std::vector<Touching> list;
    const Vector middle = c_.find("at") ? scope_.vector(*c_.find("at")) : body().center;
    if (shape_.kind == "box") {
      for (int corner = 0; corner < 8; ++corner) {
        Vector p = middle;
        for (int k = 0; k < 3; ++k)
          p = p + (g_.number(Rational((corner >> k & 1) != 0 ? 1 : -1, 2)) * shape_.sizes[k]) * orientation()[k];
        Touching t = touching(p);
        const bool known =
            std::any_of(list.begin(), list.end(), [&](const Touching& o) { return proved_zero(o.gap - t.gap); });
        if (!known) list.push_back(std::move(t));
      }
      return list;
    }
    list.push_back(touching(middle));
    return list;
  }

 private:
  const Body& body() const { return model_.bodies[body_]; }
  const Rotation& orientation() const { return scope_.orientation(body_, c_.find("body")->span); }

  static constexpr const char* kShapes = "shape = \"point\", \"ball(R)\", \"disc(R)\", \"torus(R, r)\" or \"box(a, b, "
                                         "c)\", or gap and slip as formulas";

  // Returns contacts that may replace that of a solid whose contact is not known.
  std::string instead_of(const std::string& solid) const {
    const std::string b = body().name;
    if (solid == "cylinder")
      return "a contact for each end of the cylinder: shape = \"disc(R)\" with at = \"" + b + ".center + " + b +
             "(0, 0, h/2)\", and with -h/2";
    if (solid == "rod")
      return "a contact for each end of the rod: at = \"" + b + ".center + " + b + "(l/2, 0, 0)\", and with -l/2";
    return kShapes;
  }

  // Returns the failure for a disc or a torus whose axis is always along the normal.
  Failure lies_flat() const {
    const Item* shape = c_.find("shape");
    const std::string b = body().name;
    return Failure((shape ? shape : c_.find("body"))->span,
                   "the " + shape_.kind +
                       " lies flat: its axis is always along the normal, and no place of its rim is "
                       "the lowest one",
                   "contacts of points that carry it, three in space: shape = \"point\", at = \"" + b + ".center + " +
                       b + "(R, 0, 0)\" and so on");
  }

  // Reads the shape; the hint for an unknown shape lists the shapes that can touch.
  Shape shape_that_touches(const Item& given) const {
    try {
      return read_shape(given, scope_, model_);
    } catch (Failure& f) {
      if (f.diagnostic.message.starts_with("there is no shape")) f.diagnostic.hint = kShapes;
      throw;
    }
  }

  void read_shape_of_contact() {
    const Item* given = c_.find("shape");
    if (given && given->kind == Item::Kind::string && given->text() == "point")
      shape_ = {"point", {}};
    else if (given)
      shape_ = shape_that_touches(*given);
    else
      shape_ = c_.find("at") || !body().shape ? Shape{"point", {}} : *body().shape;
    if (shape_.kind == "shell") shape_.kind = "ball";
    if (shape_.kind == "ring") shape_.kind = "disc";
    static const std::vector<std::string> known = {"point", "ball", "disc", "torus", "box"};
    if (std::find(known.begin(), known.end(), shape_.kind) == known.end())
      throw Failure((given ? given : c_.find("body"))->span,
                    "what touches is a point, a ball, a disc, a torus or a box, and this is " +
                        (shape_.kind == "ellipsoid" ? "an " : std::string("a ")) + shape_.kind,
                    instead_of(shape_.kind));
  }

  void read_ground() {
    const Item *on = c_.find("on"), *normal = c_.find("normal");
    if (!on) {
      const Vector given = normal ? scope_.vector(*normal) : axis(g_, 2);
      if (is_zero_vector(given))
        throw Failure(normal->span, "the normal is zero and has no direction", "normal = \"ez\"");
      normal_ = normal ? unit(given) : given;
      for (int k = 0; k < 3; ++k)
        if (normal && !proved_zero(total_derivative(normal_[k])))
          throw Failure(normal->span, "the normal of a plane does not turn",
                        "gap = \"…\" and slip = \"…\" as formulas describe a plane that turns");
      return;
    }
    if (normal) throw Failure(normal->key_span, "a ball and a bowl have no 'normal'", "leave out 'normal', or 'on'");
    const Syntax s = on->kind == Item::Kind::string ? parse_formula(on->formula) : Syntax{};
    if (const Item::Kind kind = on->kind; kind == Item::Kind::string && scope_.find_body(on->text()))
      throw Failure(on->span,
                    *scope_.find_body(on->text()) == body_
                        ? "a body does not touch itself"
                        : "'" + on->text() + "' is a body, and a contact is on a ball or in a bowl",
                    kTwoBodies);
    if (s.op == Syntax::Op::call && s.text == "box")
      throw Failure(on->span, "a contact is on a ball or in a bowl: the edges and faces of a box are not known",
                    kTwoBodies);
    if (s.op != Syntax::Op::call || (s.text != "ball" && s.text != "bowl") || s.args.size() != 1)
      throw Failure(on->span, "a contact is on a ball or in a bowl",
                    "on = \"ball(R)\" or \"bowl(R)\"; without it on a plane");
    if (shape_.kind != "point" && shape_.kind != "ball")
      throw Failure(on->span, "on a ball and in a bowl there are points and balls, and this is a " + shape_.kind);
    radius_ = evaluate_number(s.args[0], scope_);
    if (const auto radius = constant_value(model_, *radius_); radius && !(*radius > 0))
      throw Failure(s.args[0].span,
                    "the radius of the " + s.text + " is " + number_text(*radius, 6) + ", and a radius is positive",
                    "on = \"ball(R)\" around 'through', or \"bowl(R)\" where the body is inside");
    bowl_ = s.text == "bowl";
  }

  // Notes a plane that moves with coordinates: it may be meant as a face of another body.
  void note_moving_plane() {
    if (radius_ || !(jet_order(through_[0]) >= 0 || jet_order(through_[1]) >= 0 || jet_order(through_[2]) >= 0)) return;
    const Item* named = c_.find("name");
    model_.notes.push_back(
        (named ? "contact '" + named->text() + "'" : "the contact of '" + body().name + "'") +
        ": the corners of the box touch a plane that moves and has no border; edges and faces of two "
        "boxes do not touch each other");
  }

  Touching touching(const Vector& place) {
    Vector n = normal_, q = place;
    Expr gap;
    if (radius_) {
      const Vector d = place - through_;
      const Expr distance = sqrt(dot(d, d));
      n = pow(distance, Rational(-1)) * d;
      if (bowl_) n = g_.number(-1) * n;
      gap = bowl_ ? *radius_ - distance : distance - *radius_;
    } else {
      gap = dot(place - through_, n);
    }
    if (shape_.kind == "ball") {
      gap = gap - shape_.sizes[0];
      q = place - shape_.sizes[0] * n;
    }
    if (shape_.kind == "disc" || shape_.kind == "torus") {
      // The lowest place of the rim lies opposite to the part of the normal that is in the plane of the disc, a x (n x
      // a). Its size is |n x a|, which keeps its digits for a disc that lies almost flat; 1 - (n a)^2 would cancel
      // them.
      const Vector& a = orientation()[2];
      const Vector axis = cross(n, a), across = cross(a, axis);
      const Expr size = sqrt(dot(axis, axis));
      if (proved_zero(size)) throw lies_flat();
      gap = gap - shape_.sizes[0] * size;
      q = place - (shape_.sizes[0] * pow(size, Rational(-1))) * across;
      // The tube of a torus surrounds the rim.
      if (shape_.kind == "torus") {
        gap = gap - shape_.sizes[1];
        q = q - shape_.sizes[1] * n;
      }
    }
    const Vector from_center = q - body().center;
    Vector v = total_derivative(body().center) - total_derivative(through_);
    if (body().orientation)
      v = v + cross(body().orientation->rate, from_center);
    else if (!is_zero(from_center))
      throw Failure(c_.find("body")->span, "the body '" + body().name + "' has no orientation",
                    "a body without one touches with its centre, as a point");
    std::optional<Vector> rate;
    if (body().orientation) rate = body().orientation->rate;
    std::vector<Expr> sizes = shape_.sizes;
    if (radius_) sizes.push_back(*radius_);
    return {gap, v, tangents(n), n, rate, shape_.kind, sizes};
  }

  const Item& c_;
  Scope& scope_;
  Model& model_;
  Graph& g_;
  std::size_t body_ = 0;
  Shape shape_;
  Vector normal_, through_;
  std::optional<Expr> radius_;  // radius of the touched ball or bowl
  bool bowl_ = false;
};

}  // namespace

std::vector<Touching> read_touching(const Item& contact, Scope& scope, Model& model) {
  return TouchingReader(contact, scope, model).read();
}

}  // namespace anholon
