// [[contact]]: unilateral contacts with Coulomb friction and restitution (theory: contact).
//
// A contact is no part of the equations of a model: the model that is read is the one in which all contacts are open.
// Motions make a model for each mode of the contacts (contact/mode_model.h).
#pragma once
#include <vector>

#include "modelfile/names/names.h"

namespace anholon {

struct Contact {
  std::string name;
  Expr gap;                // g(q, t) >= 0
  std::vector<Expr> slip;  // components of the relative tangential velocity, at most two, linear in q'
  Expr friction;           // of the slip, mu >= 0
  Expr static_friction;    // of sticking
  Expr restitution;        // 0 … 1
  Span span;
  bool rough() const;  // whether there is friction
};

// Whether a [[constraint]] has one_sided = true. Throws Failure if that is neither true nor false.
bool is_one_sided(const Item& constraint);

// Reads the contacts of a file whose names are declared: its [[contact]]s, then its constraints of one side, whose gaps
// are left - right.
std::vector<Contact> read_contacts(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics);

}  // namespace anholon
