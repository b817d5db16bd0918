// [[contact]]: unilateral contacts with Coulomb friction and restitution (theory: contact).
//
// A contact is no part of the equations of a model: the model that is read is the one in which all contacts are open.
// Motions make a model for each mode of the contacts (contact/mode_model.h).
#pragma once
#include <cstdint>
#include <optional>
#include <vector>

#include "modelfile/names/names.h"

namespace anholon {

enum class ImpactLaw : std::uint8_t { newton, poisson };

struct Contact {
  std::string name;
  Expr gap;                // g(q, t) >= 0
  std::vector<Expr> slip;  // components of the relative tangential velocity, at most two, linear in q'
  Expr friction;           // of the slip, mu >= 0
  Expr static_friction;    // of sticking
  Expr restitution;        // 0 … 1
  ImpactLaw law = ImpactLaw::newton;
  Span span;
  // Resistance to rolling or drilling stands behind its contact, whose place in the list this is, and whose gap it has. Its
  // `slip` is an angular velocity, and its coefficients of friction are the length that times N is the largest moment.
  std::optional<std::size_t> under;
  bool rough() const;  // whether there is friction
};

// Whether a [[constraint]] has one_sided = true. Throws Failure if that is neither true nor false.
bool is_one_sided(const Item& constraint);

// Reads the contacts of a file whose names are declared: its [[contact]]s, each followed by its resistance to rolling
// (NAME.rolling) and drilling (NAME.drilling), then its constraints of one side, whose gaps are left - right. Contacts that
// rub or rebound have one law of impacts. Errors go to the diagnostics.
std::vector<Contact> read_contacts(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
