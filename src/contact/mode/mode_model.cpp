#include "contact/mode/mode_model.h"

#include <array>

#include "modelfile/contact_forces.h"

namespace anholon {

void put_forces(const ContactForces& of, const std::vector<Expr>& normals,
                const std::vector<std::vector<Expr>>& components, Model& model) {
  Graph& g = *model.graph;
  const auto force = [&](const Node& n) {
    const ContactForces::Force& f = of.forces[n.index - kContactForces];
    return total_derivative(f.friction ? components[f.contact][*f.friction] : normals[f.contact], n.order);
  };
  for (const ContactForces::Formula& f : of.formulas) {
    const Expr value = put_masses(model, with_contact_forces(g, g.own(f.value), force));
    switch (f.of) {
    case ContactForces::Formula::Of::monitor:
      model.monitors[f.index].value = value;
      break;
    case ContactForces::Formula::Of::output:
      model.outputs[f.index].values[f.component] = value;
      break;
    case ContactForces::Formula::Of::event:
      // An event never fires if its formula is a number; zero is replaced by 1, which does not pass zero either.
      model.events[f.index].when = is_zero(value) ? g.one() : value;
      break;
    case ContactForces::Formula::Of::rate:
      model.states[f.index].rate = value;
      break;
    }
  }
}

namespace {

// The numbers of a contact in a mode, in the order of their parameters.
enum class ModeNumber : std::uint8_t { along, across, fast, rest, slack, depth, given };
constexpr std::size_t kModeNumbers = 8;
constexpr const char* kNamesOfNumbers[kModeNumbers] = {".direction1", ".direction2", ".fast",   ".rest",
                                                       ".slack",      ".depth",      ".given1", ".given2"};

// After these numbers come the shares of the load and of each component that is shared, one for each holding force.
std::vector<long double> numbers_of(const ContactMode& m) {
  std::vector<long double> list = {m.direction[0], m.direction[1], m.fast.value_or(0), m.rest,
                                   m.slack,        m.depth,        m.shares[0].given,  m.shares[1].given};
  if (m.touch != Touch::open && m.load.shared) list.insert(list.end(), m.load.of.begin(), m.load.of.end());
  for (const ForceShare& s : m.shares)
    if (m.touch == Touch::sticks && s.shared) list.insert(list.end(), s.of.begin(), s.of.end());
  return list;
}

class ModeBuilder {
 public:
  ModeBuilder(const Model& model, const std::vector<Contact>& contacts, const ContactModes& modes, ModeEnds ends)
      : model_(clone(model)), g_(*model_->graph), ends_(ends), shares_friction_(anholon::shares_friction(modes)) {
    begin(contacts);
    if (!shares_friction_) return;
    for (std::size_t c = 0; c < contacts.size(); ++c)
      for (std::size_t a = 0; modes[c].touch == Touch::sticks && a < contacts[c].slip.size(); ++a)
        if (!modes[c].shares[a].shared) held_.push_back({{c, a}, hold(contacts[c], a)});
  }

  void add(const Contact& of, const ContactMode& mode) {
    Contact c = of;
    c.gap = g_.own(c.gap);
    for (Expr& v : c.slip) v = g_.own(v);
    c.friction = g_.own(c.friction), c.static_friction = g_.own(c.static_friction);
    numbers_.clear();
    for (std::size_t k = 0; k < numbers_of(mode).size(); ++k)
      numbers_.push_back(parameter(
          c.name + (k < kModeNumbers ? kNamesOfNumbers[k] : ".share" + std::to_string(k - kModeNumbers + 1))));
    Expr normal = g_.zero(), friction = g_.zero();
    components_.push_back(std::vector<Expr>(c.slip.size(), g_.zero()));
    if (c.under) {
      normal = normals_[*c.under];
      if (mode.touch != Touch::open && c.rough())
        friction = mode.touch == Touch::sticks ? stick(c, mode, normal) : slip(c, mode, normal);
    } else if (mode.touch == Touch::open) {
      // A gap that is zero at the start does not pass zero if it closes again at once.
      if (!mode.still) ends(c, ModeChange::hits, c.gap, -1, number(ModeNumber::depth));
    } else {
      normal = mode.load.shared ? shared_load(mode) : keep(c.name + ".gap", c.name + ".n", c.gap, 0);
      if (!mode.load.shared) loads_.push_back(normal);
      act(c, 0, normal, c.gap);
      // A force that is zero at the start does not pass zero if it begins to pull.
      ends(c, ModeChange::leaves, normal, -1, number(ModeNumber::slack));
      if (c.rough()) friction = mode.touch == Touch::sticks ? stick(c, mode, normal) : slip(c, mode, normal);
    }
    const std::map<std::string, std::string> units = column_units({c});
    const auto record = [&](const char* what, Expr e) {
      model_->monitors.push_back({c.name + what, put_masses(*model_, e), c.span});
      if (const auto unit = units.find(c.name + what); unit != units.end())
        model_->outputs.push_back({c.name + what, unit->second, {}, {}, false, c.span});
    };
    const bool slips = (mode.touch == Touch::slips && !mode.rests) || (mode.touch == Touch::sticks && mode.begins);
    record(".mode", g_.number(mode.touch == Touch::open ? 0 : slips ? 1 : 2));
    if (c.under) {
      record(".moment", friction);
    } else {
      record(".gap", c.gap);
      record(".normal", normal);
      record(".friction", friction);
    }
    normals_.push_back(normal);
    ++contact_;
  }

  void put(const ContactForces& forces) { put_forces(forces, normals_, components_, *model_); }

  ModeModel take() { return {std::move(model_), std::move(events_), std::move(conditions_), std::move(stopped_)}; }

 private:
  void begin(const std::vector<Contact>& contacts) {
    InitialData& initial = model_->initial;
    initial = {};
    // The sides come first, because the formulas of the surfaces refer to them by number.
    if (!contacts.empty() && contacts[0].borders) pass_borders(*contacts[0].borders);
    initial.t = parameter("begin.t");
    stopped_.assign(model_->coordinates.size(), false);
    for (const std::uint32_t order : {0U, 1U})
      for (std::size_t a = 0; a < model_->coordinates.size(); ++a) {
        const Coordinate& q = model_->coordinates[a];
        initial.given.push_back({g_.jet(static_cast<std::uint32_t>(a), order),
                                 parameter("begin." + q.name + (order == 0 ? "" : "'")), q.span});
      }
    for (auto& state : model_->states) state.initial = parameter("begin." + state.name);
  }

  void pass_borders(const std::vector<Expr>& borders) {
    Column sides, near;
    for (std::size_t k = 0; k < borders.size(); ++k) sides.push_back(parameter("side" + std::to_string(k + 1)));
    for (std::size_t k = 0; k < borders.size(); ++k) near.push_back(parameter("near" + std::to_string(k + 1)));
    for (std::size_t k = 0; k < borders.size(); ++k) {
      contact_ = k;
      Contact surface;
      surface.name = "surface" + std::to_string(k + 1);
      ends(surface, ModeChange::passes, sides[k] * g_.own(borders[k]), -1, near[k]);
    }
    contact_ = 0;
  }

  Expr parameter(const std::string& name) {
    const std::size_t index = model_->parameters.size();
    model_->parameters.push_back({name, g_.zero(), {}, {}});
    model_->names.parameters.push_back(name);
    return g_.parameter(static_cast<std::uint32_t>(index));
  }
  Expr number(ModeNumber which) const { return numbers_[static_cast<std::size_t>(which)]; }

  // Notes the coordinate that a constraint stops: its velocity is a factor of the constraint's rate, and the only
  // velocity in it.
  void note_stopped(Expr phi, int order) {
    const Expr rate = order == 0 ? total_derivative(phi) : phi;
    std::vector<std::size_t> moved;
    for (const NodeId id : symbols({&rate, 1}))
      if (const Node& n = g_.node(id); n.kind == Kind::jet && n.order == 1) moved.push_back(n.index);
    if (moved.size() != 1) return;
    const NodeId velocity = g_.jet(static_cast<std::uint32_t>(moved[0]), 1).id;
    const Expr rest = substitute({&rate, 1}, [&](NodeId id) { return id == velocity ? g_.zero() : Expr{}; })[0];
    if (is_zero(rest)) stopped_[moved[0]] = true;
  }

  // Adds a constraint that an input keeps; returns the input.
  Expr keep(const std::string& constraint, const std::string& input, Expr phi, int order) {
    note_stopped(phi, order);
    const std::size_t u = model_->controls.size(), r = model_->constraints.size();
    model_->controls.push_back({input, std::nullopt, r, {}});
    model_->names.controls.push_back(input);
    model_->constraints.push_back({constraint, phi, order, constraint + " = 0", {}, u});
    model_->names.multipliers.push_back(constraint);
    return g_.control(static_cast<std::uint32_t>(u), 0);
  }

  // Adds the generalized force of a force along a gap (order 0) or a slip velocity (order 1); its power is force times
  // the rate.
  void act(const Contact& c, std::uint32_t order, Expr force, Expr along) {
    Force f;
    f.name = c.name;
    f.span = c.span;
    f.kind = Force::Kind::generalized;
    Column jets;
    for (std::uint32_t a = 0; a < model_->coordinates.size(); ++a) jets.push_back(g_.jet(a, order));
    const Column d = gradient(along, jets);
    for (std::size_t a = 0; a < d.size(); ++a)
      if (!is_zero(d[a])) f.generalized.push_back({a, force * d[a]});
    model_->forces.push_back(std::move(f));
  }

  // Returns the force that holds a component.
  Expr hold(const Contact& c, std::size_t a) {
    const std::string tag = std::to_string(a + 1);
    return keep(c.name + ".slip" + tag, c.name + ".t" + tag, g_.own(c.slip[a]), 1);
  }

  // Returns the load of a contact whose gap others hold.
  Expr shared_load(const ContactMode& mode) const {
    Expr load = g_.zero();
    for (std::size_t k = 0; k < mode.load.of.size(); ++k) load = load + numbers_[kModeNumbers + k] * loads_[k];
    return load;
  }

  // Returns the components of friction that is shared.
  std::vector<Expr> shared(const Contact& c, const ContactMode& mode) {
    std::vector<Expr> forces;
    std::size_t next = kModeNumbers + (mode.load.shared ? mode.load.of.size() : 0);
    for (std::size_t a = 0; a < c.slip.size(); ++a) {
      Expr force = numbers_[static_cast<std::size_t>(ModeNumber::given) + a];
      for (const auto& [place, holds] : held_) {
        if (mode.shares[a].shared)
          force = force + numbers_[next++] * holds;
        else if (place.contact == contact_ && place.component == a)
          force = force + holds;
      }
      forces.push_back(force);
    }
    return forces;
  }

  Expr stick(const Contact& c, const ContactMode& mode, Expr normal) {
    std::vector<Expr> forces;
    if (!shares_friction_)
      for (std::size_t a = 0; a < c.slip.size(); ++a) forces.push_back(hold(c, a));
    else
      forces = shared(c, mode);
    components_.back() = forces;
    for (std::size_t a = 0; a < c.slip.size(); ++a) act(c, 1, forces[a], c.slip[a]);
    if (mode.held && (mode.begins || mode.at_bound)) {
      // The slip that begins is left out of the motion for a moment; its friction has the size of that of a slip.
      Expr square = g_.zero();
      for (const Expr f : forces) square = square + f * f;
      for (Expr& f : components_.back()) f = f * c.friction * normal * pow(square, Rational(-1, 2));
      return forces.size() == 1 ? components_.back()[0] : c.friction * normal;
    }
    const Expr size =
        forces.size() == 1 ? forces[0] : pow(forces[0] * forces[0] + forces[1] * forces[1], Rational(1, 2));
    if (mode.held) return size;
    const Expr most = c.static_friction * normal;
    if (forces.size() == 1) {
      for (const Expr force : {forces[0], g_.number(-1) * forces[0]})
        ends(c, ModeChange::slips, force - most, 1, number(ModeNumber::slack));
      return size;
    }
    // The slack belongs to |T|; the square has the slope 2 |T|.
    const Expr square = forces[0] * forces[0] + forces[1] * forces[1], slack = number(ModeNumber::slack);
    ends(c, ModeChange::slips, square - most * most, 1, slack * (g_.number(2) * most + slack));
    return size;
  }

  // Adds the friction of a slip, with d = v/|v|. For a slow slip the formula uses the ratio r of the components across
  // and along the direction e in which the contact slips at the start: (e + r e')/sqrt(1 + r^2) is analytic where v
  // passes zero on a straight line.
  Expr slip(const Contact& c, const ContactMode& mode, Expr normal) {
    const Expr force = g_.number(-1) * c.friction * normal;
    if (c.slip.size() == 1) {
      const Expr sign = g_.number(mode.direction[0] < 0 ? -1 : 1);
      components_.back()[0] = force * sign;
      act(c, 1, force * sign, c.slip[0]);
      ends(c, ModeChange::sticks, sign * c.slip[0], -1);
      return force * sign;
    }
    if (mode.begins) {
      components_.back() = {force * number(ModeNumber::along), force * number(ModeNumber::across)};
      for (std::size_t a = 0; a < 2; ++a) act(c, 1, components_.back()[a], c.slip[a]);
      // A force that jumps may turn the slip back.
      ends(c, ModeChange::slows, c.slip[0] * number(ModeNumber::along) + c.slip[1] * number(ModeNumber::across), -1);
      return c.friction * normal;
    }
    if (mode.fast) {
      const Expr square = c.slip[0] * c.slip[0] + c.slip[1] * c.slip[1], inverse = pow(square, Rational(-1, 2));
      components_.back() = {force * c.slip[0] * inverse, force * c.slip[1] * inverse};
      for (std::size_t a = 0; a < 2; ++a) act(c, 1, components_.back()[a], c.slip[a]);
      ends(c, ModeChange::slows, square - number(ModeNumber::fast) * number(ModeNumber::fast), -1);
      return c.friction * normal;
    }
    const Expr e1 = number(ModeNumber::along), e2 = number(ModeNumber::across);
    const Expr along = c.slip[0] * e1 + c.slip[1] * e2, across = c.slip[1] * e1 - c.slip[0] * e2;
    const Expr r = across * pow(along, Rational(-1)), length = pow(g_.one() + r * r, Rational(-1, 2));
    components_.back() = {force * (e1 - r * e2) * length, force * (e2 + r * e1) * length};
    for (std::size_t a = 0; a < 2; ++a) act(c, 1, components_.back()[a], c.slip[a]);
    // At v = 0 the direction has no derivatives, unless v passes zero on a straight line.
    ends(c, ModeChange::sticks, along - number(ModeNumber::rest), -1);
    for (const Expr side : {across, g_.number(-1) * across}) ends(c, ModeChange::turns, side - along, 1);
    return c.friction * normal;
  }

  // Ends the mode where `when` passes zero in this direction, also if it begins at zero and passes it by more than the
  // slack.
  void ends(const Contact& c, ModeChange change, Expr when, int direction, std::optional<Expr> slack = std::nullopt) {
    const Expr later = slack ? when - g_.number(direction) * *slack : when;
    if (ends_ == ModeEnds::conditions) {
      const std::string name = kCondition + std::to_string(conditions_.size());
      model_->monitors.push_back({name, put_masses(*model_, later), c.span});
      conditions_.push_back(-direction);
      return;
    }
    event(c, change, when, direction);
    if (slack) event(c, change, later, direction);
  }

  void event(const Contact& c, ModeChange change, Expr when, int direction) {
    std::string name = c.name + "." + word(c, change);
    while (events_.count(name)) name += "'";
    events_[name] = {contact_, change};
    model_->events.push_back({name, put_masses(*model_, when), direction, {}, true, c.span});
  }

  std::shared_ptr<Model> model_;
  Graph& g_;
  ModeEnds ends_;
  std::map<std::string, ModeEvent> events_;
  std::vector<int> conditions_;
  struct Held {
    HeldComponent place;
    Expr force;
  };
  bool shares_friction_;
  std::vector<Held> held_;                     // of shared friction; empty if gaps and constraints hold all of it
  std::vector<Expr> loads_;                    // the loads that hold the gaps so far
  std::vector<Expr> normals_, numbers_;        // numbers_: of the contact that is being added
  std::vector<std::vector<Expr>> components_;  // of friction, along the components of the slip
  std::size_t contact_ = 0;
  std::vector<bool> stopped_;
};

}  // namespace

std::string word(const Contact& c, ModeChange change) {
  switch (change) {
  case ModeChange::hits:
    return "hits";
  case ModeChange::leaves:
    return "leaves";
  case ModeChange::slips:
    return c.under ? "starts" : "slips";
  case ModeChange::sticks:
    return c.under ? "stops" : "sticks";
  case ModeChange::slows:
    return "slows";
  case ModeChange::reverses:
    return "reverses";
  case ModeChange::turns:
    return "turns";
  case ModeChange::passes:
    return "passes";
  }
  return {};
}

std::vector<std::string> contact_columns(const std::vector<Contact>& contacts) {
  std::vector<std::string> names;
  for (const Contact& c : contacts) {
    if (c.held) {
      names.push_back(c.name + ".active");
      names.push_back("lambda." + c.name);
      continue;
    }
    names.push_back(c.name + ".mode");
    if (c.under)
      names.push_back(c.name + ".moment");
    else
      for (const char* what : {".gap", ".normal", ".friction"}) names.push_back(c.name + what);
  }
  return names;
}

std::vector<std::string> contact_events(const std::vector<Contact>& contacts) {
  std::vector<std::string> names;
  for (const Contact& c : contacts) {
    if (c.held) continue;
    if (!c.under)
      for (const std::string& what : {word(c, ModeChange::hits), word(c, ModeChange::leaves), std::string("rests")})
        names.push_back(c.name + "." + what);
    if (c.slip.empty()) continue;
    for (const ModeChange change : {ModeChange::slips, ModeChange::sticks, ModeChange::reverses})
      names.push_back(c.name + "." + word(c, change));
  }
  return names;
}

ModeModel mode_model(const Model& model, const std::vector<Contact>& contacts, const ContactModes& modes,
                     ModeEnds ends) {
  ModeBuilder builder(model, contacts, modes, ends);
  for (std::size_t c = 0; c < contacts.size(); ++c) builder.add(contacts[c], modes[c]);
  if (!contacts.empty() && contacts[0].forces) builder.put(*contacts[0].forces);
  return builder.take();
}

std::vector<double> mode_values(const ContactModes& modes, const ContactState& at) {
  std::vector<double> values = at.borders;
  for (const std::vector<double>* list : {&at.q, &at.qd, &at.states})
    values.insert(values.end(), list->begin(), list->end());
  for (const ContactMode& m : modes)
    for (const long double x : numbers_of(m)) values.push_back(static_cast<double>(x));
  return values;
}

std::vector<Rational> mode_numbers(const ContactModes& modes, const ContactState& at) {
  std::vector<Rational> values;
  for (const double x : mode_values(modes, at)) values.emplace_back(x);
  values.insert(values.begin() + static_cast<std::ptrdiff_t>(at.borders.size()), at.t);
  return values;
}

std::vector<int> mode_shape(const std::vector<Contact>& contacts, const ContactModes& modes) {
  std::vector<int> shape;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const ContactMode& m = modes[c];
    const bool backwards = contacts[c].slip.size() == 1 && m.touch == Touch::slips && m.direction[0] < 0;
    const bool sticks = m.touch == Touch::sticks;
    shape.insert(shape.end(), {static_cast<int>(m.touch), m.touch != Touch::open && m.load.shared,
                               sticks && m.shares[0].shared, sticks && m.shares[1].shared, m.held, m.begins, m.at_bound,
                               m.fast.has_value(), backwards, m.rests, m.still});
  }
  return shape;
}

void put_ideal_mode(Model& model, const std::vector<Contact>& contacts, const std::vector<Touch>& touches) {
  static const char* const kWords[] = {"open", "slips", "sticks"};
  Graph& g = *model.graph;
  std::vector<Expr> normals;
  std::vector<std::vector<Expr>> components;
  const auto keep = [&](const std::string& name, Expr phi, int order, Span span) {
    const auto r = static_cast<std::uint32_t>(model.constraints.size());
    model.constraints.push_back({name, g.own(phi), order, name + " = 0", span});
    model.names.multipliers.push_back(name);
    return g.multiplier(r, 0);
  };
  std::string mode;
  for (std::size_t c = 0; c < contacts.size(); ++c) {
    const Contact& contact = contacts[c];
    const Touch touch = touches[c];
    const bool open = touches[contact.under.value_or(c)] == Touch::open;
    if (open && contact.under && touch != Touch::open)
      throw Failure({}, "'" + contact.name + "' resists only while its contact touches",
                    contacts[*contact.under].name + "=sticks as well");
    if (!open && touch != Touch::sticks && contact.rough() && (contact.under || touch == Touch::slips))
      throw Failure({},
                    "the contact '" + contact.name + "' " + (contact.under ? "moves" : "slips") +
                        " against friction, which is no ideal force",
                    contact.name + "=sticks, or a coefficient 0 in the file");
    normals.push_back(contact.under || open ? g.zero() : keep(contact.name, contact.gap, 0, contact.span));
    components.push_back(std::vector<Expr>(contact.slip.size(), g.zero()));
    for (std::size_t a = 0; touch == Touch::sticks && a < contact.slip.size(); ++a)
      components[c][a] = keep(contact.name + ".t" + std::to_string(a + 1), contact.slip[a], 1, contact.span);
    mode += (c == 0 ? "" : ", ") + contact.name + " " + (touch == Touch::open ? "is " : "") +
            kWords[static_cast<std::size_t>(touch)];
  }
  if (!contacts.empty() && contacts[0].forces) put_forces(*contacts[0].forces, normals, components, model);
  model.title += (model.title.empty() ? "" : ": ") + mode;
  std::erase_if(model.notes, [](const ModelNote& n) { return n.of_modes(); });
}

}  // namespace anholon
