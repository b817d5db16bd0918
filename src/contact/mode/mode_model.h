// Makes the model of one mode of the contacts: a contact that touches is a constraint gap = 0 that a normal force keeps
// as an input; one that sticks has slip = 0 as well, kept by its friction; friction of a contact that slips is -mu N d.
#pragma once
#include <map>
#include <optional>

#include "contact/law/contact_dynamics.h"
#include "modelfile/contacts.h"

namespace anholon {

// The reason why a mode ends. A slip that passes zero sticks, or reverses if it goes on. `slows` and `turns` change the
// formula of a slip's direction, but not the motion; `passes` leads over a border of the surfaces.
enum class ModeChange : std::uint8_t { hits, leaves, slips, sticks, reverses, slows, turns, passes };
struct ModeEvent {
  std::size_t contact = 0;  // the number of the border for `passes`
  ModeChange change = ModeChange::hits;
  bool is_told() const {
    return change != ModeChange::slows && change != ModeChange::turns && change != ModeChange::passes;
  }
};

// The kind of ends of a mode: events of its model, or conditions for methods that do not look for events. Conditions
// are monitors whose names begin with kCondition; a mode holds as long as each of them has the listed sign, or is zero.
enum class ModeEnds : std::uint8_t { events, conditions };
inline constexpr char kCondition = '#';

struct ModeModel {
  std::shared_ptr<Model> model;
  std::map<std::string, ModeEvent> events;  // by their names
  std::vector<int> conditions;              // the signs, in the order of the monitors
  // The coordinates whose velocity a contact keeps at 0, because its gap or its slip velocity moves with one coordinate
  // alone.
  std::vector<bool> stopped;
};

// The WORD of the event NAME.WORD of this change: a resistance starts, stops and reverses.
std::string word(const Contact& contact, ModeChange change);

// The columns of rows that contacts add after those of the model.
std::vector<std::string> contact_columns(const std::vector<Contact>& contacts);

// The names of the events of these contacts, NAME.WORD, in the order of the contacts; none for switched constraints.
std::vector<std::string> contact_events(const std::vector<Contact>& contacts);

// Inserts the forces of a mode, N and the components of friction of each contact, into the monitors, events and rates
// that contain them.
void put_forces(const ContactForces& of, const std::vector<Expr>& normals,
                const std::vector<std::vector<Expr>>& components, Model& model);

// Returns the model of a mode. Its initial state and the numbers of its contacts (the direction of a slip, and limits
// of round-off), which differ whenever the mode begins, are parameters after those of the model.
ModeModel mode_model(const Model& model, const std::vector<Contact>& contacts, const ContactModes& modes,
                     ModeEnds ends = ModeEnds::events);
// The values of these parameters; all except the time are doubles.
std::vector<double> mode_values(const ContactModes& modes, const ContactState& at);
std::vector<Rational> mode_numbers(const ContactModes& modes, const ContactState& at);
// Two modes have the same model, except for these values, if their shapes are equal.
std::vector<int> mode_shape(const std::vector<Contact>& contacts, const ContactModes& modes);

// Makes the model that of a mode in which the contacts exert ideal forces alone: one that touches is a constraint NAME,
// gap = 0; one that sticks has also constraints NAME.t1, …, which keep its slip velocity zero. Their multipliers are
// the forces of the contact. `touches`: for each contact, resistances included. Throws Failure if a contact slips
// against friction.
void put_ideal_mode(Model& model, const std::vector<Contact>& contacts, const std::vector<Touch>& touches);

}  // namespace anholon
