// The mode of a model that a user names by words, for commands that do not compute changes of the mode.
#pragma once
#include "base/outcome.h"
#include "modelfile/contacts.h"
#include "structure/initial_problem.h"

namespace anholon {

// Makes the model that of one mode, in which contacts exert ideal forces. `words`: NAME=open, NAME=slips or NAME=sticks
// for contacts, which are open without a word; NAME=NUMBER for modes, which have their values of the start without a
// word. Throws Failure without a place for a word that names nothing, and for a mode in which a contact slips against
// friction.
void put_chosen_mode(Model& model, const std::vector<Contact>& contacts, const std::vector<std::string>& words);

// The error of a command that needs the mode. `option`: "--mode ", which stands before the word in the hint.
Failure needs_mode(const std::string& command, const Model& model, const std::vector<Contact>& contacts,
                   const std::string& option);

// Replaces the hint of a start in a chosen mode that is inconsistent, if initial data of the file take part: they are
// those of the mode in which the motion of the file starts. `options`: "--q and --qdot", by which a state is given.
void hint_at_state_of_mode(Outcome& start, const Model& model, const std::vector<StateOverride>& given,
                           const std::string& options);

}  // namespace anholon
