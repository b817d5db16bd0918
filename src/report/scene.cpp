#include "report/scene.h"

#include <algorithm>
#include <array>

#include "numeric/number.h"

namespace anholon {

namespace {

using Place = std::array<std::size_t, 3>;

class SceneMaker {
 public:
  SceneMaker(const Mechanics& m, bool contacts) : m_(m), contacts_(contacts), model_(*m.model), view_(model_.view) {}

  Scene make() {
    for (const Body& b : model_.bodies) body(b);
    for (const auto& [name, place] : view_.points)
      if (!hidden(name)) item("point", name).places = {roots(place)};
    for (const Force& f : model_.forces)
      if (f.kind == Force::Kind::tension && f.from)
        item("line", f.name).places = {roots(f.on.point), roots(f.from->point)};
    bool traced = false;
    for (const View::Element& e : view_.elements) {
      element(e);
      traced = traced || e.kind == View::Kind::trace;
    }
    if (!traced) traces();
    velocities();
    reactions();
    if (view_.camera) scene_.camera = roots(*view_.camera);
    if (view_.target) scene_.target = roots(*view_.target);
    if (view_.up) up_ = roots(*view_.up);
    if (view_.floor)
      floor_ = root(*view_.floor);
    else if (!view_.no_floor && !flat() && level())
      floor_ = root(model_.graph->zero());
    scene_.no_grid = view_.no_floor;
    scene_.follow = view_.follow;
    scene_.flat = flat();
    scene_.tape = compile(exprs_);
    parameters();
    return std::move(scene_);
  }

 private:
  bool hidden(const std::string& name) const {
    return std::find(view_.hidden.begin(), view_.hidden.end(), name) != view_.hidden.end();
  }

  std::size_t root(Expr e) {
    exprs_.push_back(e);
    return exprs_.size() - 1;
  }
  Place roots(const Vector& v) {
    const Column c = put_masses(model_, Column{v.x, v.y, v.z});
    return {root(c[0]), root(c[1]), root(c[2])};
  }
  std::array<std::size_t, 9> roots(const Rotation& r) {
    std::array<std::size_t, 9> out{};
    for (int axis = 0; axis < 3; ++axis) {
      const Place p = roots(r[axis]);
      std::copy(p.begin(), p.end(), out.begin() + 3 * axis);
    }
    return out;
  }

  SceneItem& item(const char* kind, const std::string& name) {
    scene_.items.push_back({});
    scene_.items.back().kind = kind;
    scene_.items.back().name = name;
    return scene_.items.back();
  }

  void shape(SceneItem& i, const Shape& s) {
    i.shape = s.kind;
    // Sizes are numbers and parameters: their values are substituted when these are known.
    for (const Expr& e : s.sizes) sizes_.push_back({scene_.items.size() - 1, root(e)});
  }

  // A body without a shape is drawn as the homogeneous box with its moments of inertia: along its axis k, with the
  // second moment E_k, the box is sqrt(12 E_k/m) long.
  void inertia_box(SceneItem& i, const Body& b) {
    i.shape = "point";
    Graph& g = *model_.graph;
    Column moment(3, g.zero());
    if (b.axes.empty() || !b.orientation || is_zero(b.mass)) return;
    for (const Axis& axis : b.axes) {
      if (axis.own.empty()) return;
      for (std::size_t k = 0; k < 3; ++k) moment[k] += axis.weight * axis.own[k] * axis.own[k];
    }
    for (const Expr& e : moment)
      for (Expr part : {e, b.mass})
        for (NodeId id : symbols({&part, 1}))
          if (g.node(id).kind != Kind::parameter) return;  // it varies
    i.shape = "box";
    for (const Expr& e : moment) sizes_.push_back({scene_.items.size() - 1, root(sqrt(12 * e / b.mass))});
  }

  void body(const Body& b) {
    if (hidden(b.name)) return;
    const auto drawn = std::find_if(view_.elements.begin(), view_.elements.end(), [&](const View::Element& e) {
      return e.kind == View::Kind::solid && e.name == b.name;
    });
    const View::Element* e = drawn == view_.elements.end() ? nullptr : &*drawn;
    SceneItem& i = item("body", b.name);
    if (e) i.color = e->color;
    const std::optional<Shape>& s = e ? e->shape : b.shape;
    if (s)
      shape(i, *s);
    else
      inertia_box(i, b);
    i.places = {roots(e && !e->places.empty() ? e->places[0] : b.center)};
    if (e && e->axes)
      i.axes = roots(*e->axes);
    else if (b.orientation)
      i.axes = roots(*b.orientation);
  }

  void element(const View::Element& e) {
    const bool of_a_body =
        std::any_of(model_.bodies.begin(), model_.bodies.end(), [&](const Body& b) { return b.name == e.name; });
    if (e.kind == View::Kind::solid && of_a_body) return;
    static constexpr const char* kinds[] = {"body", "line", "trace", "vector"};
    SceneItem& i = item(kinds[static_cast<int>(e.kind)], e.name);
    i.color = e.color;
    if (e.shape) shape(i, *e.shape);
    for (const Vector& v : e.places) i.places.push_back(roots(v));
    if (e.axes) i.axes = roots(*e.axes);
    if (e.vector) i.vector = roots(*e.vector), i.what = "own";
    if (e.kind == View::Kind::trace) i.of = e.name;
  }

  // Default traces are those of particles, or, without particles, those of points, if they move.
  void traces() {
    constexpr std::size_t kMost = 6;
    std::size_t count = 0;
    const auto trace = [&](const std::string& name, const Vector& place) {
      if (count == kMost || hidden(name) || std::max({jet_order(place.x), jet_order(place.y), jet_order(place.z)}) < 0)
        return;
      SceneItem& i = item("trace", name);
      i.of = name;
      i.places = {roots(place)};
      ++count;
    };
    for (const Body& b : model_.bodies)
      if (b.particle) trace(b.name, b.center);
    for (const auto& [name, place] : view_.points) trace(name, place);
    if (count == 0)
      for (const Body& b : model_.bodies) trace(b.name, b.center);
  }

  void arrow(const char* what, const Body& b, const Vector& v) {
    SceneItem& i = item("vector", std::string(what) + " of " + b.name);
    i.what = what;
    i.of = b.name;
    i.places = {roots(b.center)};
    i.vector = roots(v);
  }

  void velocities() {
    for (const Body& b : model_.bodies)
      if (!hidden(b.name))
        arrow("velocity", b,
              {total_derivative(b.center.x), total_derivative(b.center.y), total_derivative(b.center.z)});
  }

  void reactions() {
    if (model_.constraints.empty() && !contacts_) return;
    const std::vector<Load> loads = anholon::reactions(*m_.model);
    for (std::size_t k = 0; k < loads.size(); ++k) {
      const Vector& f = loads[k].force;
      if (!hidden(model_.bodies[k].name) && !(is_zero(f.x) && is_zero(f.y) && is_zero(f.z)))
        arrow("reaction", model_.bodies[k], f);
    }
  }

  // True if all places are in one plane z = const of the observer.
  bool flat() const {
    const auto fixed = [&](const Vector& v) { return is_zero(v.z); };
    return std::all_of(model_.bodies.begin(), model_.bodies.end(),
                       [&](const Body& b) {
                         return fixed(b.center) && (!b.orientation || is_number((*b.orientation)[2].z)) &&
                                !(b.shape && b.shape->kind != "disc" && b.shape->kind != "ring" &&
                                  b.shape->kind != "rod");
                       }) &&
           std::all_of(view_.points.begin(), view_.points.end(), [&](const auto& p) { return fixed(p.second); });
  }

  // True if there is a ground level: a named point stays in the plane z = 0.
  bool level() const {
    return std::any_of(view_.points.begin(), view_.points.end(), [](const auto& p) { return is_zero(p.second.z); });
  }

  void parameters() {
    Column es;
    for (const Parameter& p : model_.parameters) es.push_back(p.value);
    scene_.parameters = evaluate_parameters<double>(*model_.graph, es);
    Machine<double> machine(scene_.tape, 0, scene_.parameters);
    machine.evaluate();
    if (floor_) scene_.floor = machine.value(*floor_);
    if (up_)
      for (std::size_t k = 0; k < 3; ++k) scene_.up[k] = machine.value((*up_)[k]);
    for (const auto& [i, root] : sizes_) {
      const double size = machine.value(root);
      // a moment that rounding made negative has no root
      scene_.items[i].sizes.push_back(std::isfinite(size) ? size : 0);
    }
  }

  const Mechanics& m_;
  const bool contacts_;
  const Model& model_;
  const View& view_;
  Scene scene_;
  Column exprs_;
  std::optional<Place> up_;
  std::optional<std::size_t> floor_;
  std::vector<std::pair<std::size_t, std::size_t>> sizes_;  // item, root
};

std::string number(double x) { return number_text(x); }

class SceneWriter {
 public:
  SceneWriter(JsonWriter& j, const Scene& s, const Graph& g, const ColumnOf& column)
      : j_(j), s_(s), g_(g), column_(column) {}

  void write(const std::function<void(JsonWriter&)>& observer) {
    j_.open_object();
    inputs();
    code();
    items();
    j_.key("observer");
    if (observer)
      observer(j_);
    else
      j_.null();
    j_.key("camera").open_object();
    optional_place("eye", s_.camera);
    optional_place("target", s_.target);
    j_.key("up").open_array();
    for (double x : s_.up) j_.number(number(x));
    j_.close();
    j_.key("flat").boolean(s_.flat).key("follow");
    if (s_.follow.empty())
      j_.null();
    else
      j_.string(s_.follow);
    j_.close();
    j_.key("floor");
    if (s_.floor)
      j_.open_object().key("z").number(number(*s_.floor)).close();
    else if (s_.no_grid)
      j_.boolean(false);
    else
      j_.null();
    j_.close();
  }

 private:
  void inputs() {
    j_.key("inputs").open_array();
    for (const Input& in : s_.tape.inputs) {
      const Node n = g_.node(in.symbol);
      const auto derivative = [&](unsigned by) {
        Node higher = n;
        higher.order = static_cast<std::uint8_t>(n.order + by);
        return n.kind == Kind::time ? -1 : column_(higher).value_or(-1);
      };
      // A row without the column omits the items that need it.
      j_.open_object()
          .key("column")
          .integer(column_(n).value_or(-2))
          .key("d1")
          .integer(derivative(1))
          .key("d2")
          .integer(derivative(2))
          .close();
    }
    j_.close();
  }

  void operation(const char* name) { j_.open_array().string(name); }

  void code() {
    const Tape& t = s_.tape;
    std::vector<long long> input(t.code.size(), -1);
    for (std::size_t k = 0; k < t.inputs.size(); ++k) input[t.inputs[k].slot] = static_cast<long long>(k);
    const auto rational = [&](std::uint32_t index) { return number(t.rationals[index].get_d()); };
    j_.key("code").open_array();
    for (std::size_t slot = 0; slot < t.code.size(); ++slot) {
      const Instruction& in = t.code[slot];
      switch (in.op) {
      case Op::constant:
        operation("c"), j_.number(rational(in.index));
        break;
      case Op::pi:
        operation("c"), j_.number(number(3.141592653589793));
        break;
      case Op::input:
        operation("i"), j_.integer(input[slot]);
        break;
      case Op::parameter:
        operation("c"), j_.number(number(s_.parameters[in.index]));
        break;
      case Op::linear:
        operation("l");
        j_.integer(0);
        for (std::uint32_t k = in.first; k < in.first + in.count; ++k)
          j_.number(rational(t.linear_terms[k].coefficient)).integer(t.linear_terms[k].slot);
        break;
      case Op::multiply:
      case Op::scale:
        operation("*"), j_.integer(in.a).integer(in.b);
        break;
      case Op::square:
        operation("*"), j_.integer(in.a).integer(in.a);
        break;
      case Op::divide:
        operation("/"), j_.integer(in.a).integer(in.b);
        break;
      case Op::power:
        operation("^"), j_.integer(in.a).number(rational(in.index));
        break;
      case Op::function:
        operation("f"), j_.string(info(static_cast<Function>(in.index)).name).integer(in.a);
        break;
      case Op::arctan2:
        operation("atan2"), j_.integer(in.a).integer(in.b);
        break;
      case Op::select:
        operation("?"), j_.integer(in.first).integer(in.a).integer(in.b);
        break;
      case Op::lookup:
        steps(t.step_functions[in.index], in.a);
        break;
      case Op::rate:
        operation("c"), j_.null();
        break;  // does not occur without rates
      }
      j_.close();
    }
    j_.close();
  }

  void steps(const StepFunction& f, std::uint32_t argument) {
    operation("s");
    j_.integer(argument);
    for (const std::vector<Rational>* list : {&f.knots, &f.values}) {
      j_.open_array();
      for (const Rational& r : *list) j_.number(number(r.get_d()));
      j_.close();
    }
  }

  template <std::size_t n>
  void slots(const std::array<std::size_t, n>& roots) {
    j_.open_array();
    for (std::size_t r : roots) j_.integer(s_.tape.roots[r]);
    j_.close();
  }
  void optional_place(const char* key, const std::optional<Place>& p) {
    j_.key(key);
    if (p)
      slots(*p);
    else
      j_.null();
  }

  void items() {
    j_.key("items").open_array();
    for (const SceneItem& i : s_.items) {
      j_.open_object().key("kind").string(i.kind).key("name").string(i.name).key("label").string(i.name);
      if (!i.of.empty()) j_.key("of").string(i.of);
      if (!i.what.empty()) j_.key("what").string(i.what);
      j_.key("color");
      if (i.color.empty())
        j_.null();
      else
        j_.string(i.color);
      if (i.kind == "line") {
        j_.key("points").open_array();
        for (const Place& p : i.places) slots(p);
        j_.close();
      } else {
        j_.key("position");
        slots(i.places[0]);
      }
      if (i.kind == "body") {
        j_.key("shape").string(i.shape).key("sizes").open_array();
        for (double s : i.sizes) j_.number(number(s));
        j_.close().key("axes");
        if (i.axes)
          slots(*i.axes);
        else
          j_.null();
      }
      if (i.vector) j_.key("vector"), slots(*i.vector);
      j_.close();
    }
    j_.close();
  }

  JsonWriter& j_;
  const Scene& s_;
  const Graph& g_;
  const ColumnOf& column_;
};

}  // namespace

Scene scene(const Mechanics& mechanics, bool contacts) { return SceneMaker(mechanics, contacts).make(); }

std::vector<int> columns_of(const Scene& scene, const Graph& graph, const ColumnOf& column) {
  std::vector<int> list;
  for (const Input& in : scene.tape.inputs) {
    const Node n = graph.node(in.symbol);
    for (unsigned by = 0; by < 3; ++by) {
      Node higher = n;
      higher.order = static_cast<std::uint8_t>(n.order + by);
      if (const auto k = column(higher); k && *k >= 0 && std::find(list.begin(), list.end(), *k) == list.end())
        list.push_back(*k);
      if (n.kind == Kind::time) break;
    }
  }
  std::sort(list.begin(), list.end());
  return list;
}

void write_scene(JsonWriter& json, const Scene& scene, const Graph& graph, const ColumnOf& column,
                 const std::function<void(JsonWriter&)>& observer) {
  SceneWriter(json, scene, graph, column).write(observer);
}

}  // namespace anholon
