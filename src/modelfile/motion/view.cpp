#include "modelfile/motion/view.h"

#include <algorithm>
#include <array>

#include "modelfile/mechanical/shapes.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

namespace {

constexpr const char* kElement =
    "{line = [\"A\", \"B\"]}, {trace = \"P\"}, {vector = \"…\", at = \"P\"} or {shape = \"box(1, 2, 3)\", at = \"P\"}";

const std::string& text_of(const Item& item, const char* what) {
  if (item.kind != Item::Kind::string) throw Failure(item.span, std::string("'") + what + "' is a text");
  return item.text();
}

// Reads a colour, "#a33" or "#aa3333".
std::string color(const Item& item) {
  const std::string& s = text_of(item, "color");
  const bool hex = (s.size() == 4 || s.size() == 7) && s[0] == '#' &&
                   s.find_first_not_of("0123456789abcdefABCDEF", 1) == std::string::npos;
  if (!hex) throw Failure(item.span, "'" + s.substr(0, 40) + "' is not a colour", "color = \"#2a7fff\"");
  return s;
}

class ViewReader {
 public:
  ViewReader(Scope& scope, Model& model) : scope_(scope), view_(model.view), model_(model) {
    for (const Body& b : model.bodies) drawn_.push_back(b.name);
    for (const auto& [name, place] : view_.points) drawn_.push_back(name);
  }

  void read(const Item& i) {
    if (i.key == "camera")
      view_.camera = scope_.vector(i);
    else if (i.key == "target")
      view_.target = scope_.vector(i);
    else if (i.key == "up")
      up(i);
    else if (i.key == "floor")
      floor(i);
    else if (i.key == "follow")
      view_.follow = drawn(i);
    else if (i.key == "hide")
      hide(i);
    else
      element(i);
  }

 private:
  void floor(const Item& i) {
    if (i.kind == Item::Kind::boolean)
      view_.no_floor = !i.truth;
    else
      view_.floor = constant(i, scope_.number(i), "'floor' is a number or a formula of parameters", "floor = 0");
  }

  Expr constant(const Item& i, Expr e, const char* wrong, const char* hint) {
    for (NodeId id : symbols({&e, 1}))
      if (model_.graph->node(id).kind != Kind::parameter) throw Failure(i.span, wrong, hint);
    return e;
  }

  void up(const Item& i) {
    const Vector v = scope_.vector(i);
    for (int k = 0; k < 3; ++k) constant(i, v[k], "'up' is a constant direction", "up = \"-ez\"");
    if (is_zero(v)) throw Failure(i.span, "'up' is a direction, not zero", "up = \"-ez\"");
    view_.up = v;
  }

  // Reads the name of a body or point.
  std::string drawn(const Item& i) {
    const std::string name = normal_name(text_of(i, i.key.c_str()));
    if (std::find(drawn_.begin(), drawn_.end(), name) != drawn_.end()) return name;
    const std::string near = did_you_mean(name, drawn_);
    throw Failure(i.span, "there is no body or point '" + name.substr(0, 40) + "'" +
                              (near.empty() ? "" : "; did you mean '" + near + "'?"));
  }

  void hide(const Item& i) {
    if (i.kind != Item::Kind::array)
      throw Failure(i.span, "'hide' is a list of bodies and points", "hide = [\"rotor\"]");
    for (const Item& item : i.items) {
      // The name of a family denotes all its members.
      const std::string family = (item.kind == Item::Kind::string ? normal_name(item.text()) : "") + "[";
      bool any = false;
      for (const std::string& name : drawn_)
        if (name.compare(0, family.size(), family) == 0) view_.hidden.push_back(name), any = true;
      if (!any) view_.hidden.push_back(drawn(item));
    }
  }

  void element(const Item& i) {
    if (i.kind != Item::Kind::table)
      throw Failure(i.span, "'" + i.key.substr(0, 40) + "' in [view] is a table", kElement);
    View::Element e;
    e.name = i.key;
    e.span = i.key_span;
    static constexpr std::array<std::pair<const char*, View::Kind>, 4> kinds = {{{"shape", View::Kind::solid},
                                                                                 {"line", View::Kind::line},
                                                                                 {"trace", View::Kind::trace},
                                                                                 {"vector", View::Kind::vector}}};
    const Item* what = nullptr;
    for (const auto& [key, kind] : kinds)
      if (const Item* found = i.find(key)) {
        if (what) throw Failure(found->span, "'" + e.name + "' is one thing: shape, line, trace or vector");
        what = found;
        e.kind = kind;
      }
    if (!what) throw Failure(i.key_span, "'" + e.name.substr(0, 40) + "' in [view] shows nothing", kElement);
    keys(i, e);
    if (const Item* c = i.find("color")) e.color = color(*c);
    switch (e.kind) {
    case View::Kind::solid:
      solid(i, *what, e);
      break;
    case View::Kind::line:
      line(*what, e);
      break;
    case View::Kind::trace:
      e.places = {scope_.vector(*what)};
      break;
    case View::Kind::vector:
      e.vector = scope_.vector(*what);
      e.places = {at(i, e)};
      break;
    }
    view_.elements.push_back(std::move(e));
  }

  // Keys that depend on the object that is shown.
  void keys(const Item& i, const View::Element& e) {
    for (const Item& k : i.items) {
      const bool at = (e.kind == View::Kind::solid || e.kind == View::Kind::vector) && k.key == "at";
      const bool axes = e.kind == View::Kind::solid && k.key == "axes";
      if (at || axes || k.key == "color" || k.key == "shape" || k.key == "line" || k.key == "trace" ||
          k.key == "vector")
        continue;
      const std::string near = did_you_mean(k.key, {"at", "axes", "color", "shape", "line", "trace", "vector"});
      throw Failure(k.key_span,
                    "'" + k.key.substr(0, 40) + "' does not go with what '" + e.name + "' shows" +
                        (near.empty() || near == k.key ? "" : "; did you mean '" + near + "'?"),
                    kElement);
    }
  }

  Vector at(const Item& i, const View::Element& e) {
    const Item* place = i.find("at");
    if (!place) throw Failure(i.key_span, "'" + e.name + "' has no place", "at = \"P\"");
    return scope_.vector(*place);
  }

  void solid(const Item& i, const Item& shape, View::Element& e) {
    e.shape = read_shape(shape, scope_, model_);
    const bool of_a_body = scope_.find_body(e.name) != nullptr;
    if (i.find("at") || !of_a_body) e.places = {at(i, e)};
    if (const Item* axes = i.find("axes")) e.axes = scope_.rotation(*axes);
  }

  void line(const Item& corners, View::Element& e) {
    if (corners.kind != Item::Kind::array || corners.items.size() < 2)
      throw Failure(corners.span, "a line goes through a list of places, two at least", "line = [\"A\", \"B\"]");
    for (const Item& c : corners.items) e.places.push_back(scope_.vector(c));
  }

  Scope& scope_;
  View& view_;
  Model& model_;
  std::vector<std::string> drawn_;
};

}  // namespace

void read_view(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  std::vector<std::pair<std::size_t, std::string>> points;
  for (const auto& [name, d] : scope.declarations())
    if (d.role == Scope::Role::point && d.state == Scope::Declaration::State::done &&
        std::holds_alternative<Vector>(d.value))
      points.push_back({d.place, name});
  std::sort(points.begin(), points.end());
  for (const auto& [place, name] : points)
    model.view.points.push_back({name, std::get<Vector>(scope.declarations().at(name).value)});
  const Item* section = find_section(root, "view", diagnostics);
  if (!section) return;
  ViewReader reader(scope, model);
  for (const Item& i : section->items) collect(diagnostics, [&] { reader.read(i); }, i);
}

}  // namespace anholon
