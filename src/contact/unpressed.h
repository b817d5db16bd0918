// Closed contacts that nothing presses: those that stay open, those that rest, and those whose gap others keep closed.
#pragma once
#include "contact/touching_bodies.h"

namespace anholon {

// Leaves contacts open that nothing presses now, and that were open, or whose gap the constraints keep closed here
// alone: a pendulum at its lowest point touches the floor and carries nothing. `list`: the consistent modes, one, of the
// equations `problem`; both change.
void leave_open(const TouchingBodies& bodies, const Workspace& s, ContactProblem& problem,
                std::vector<ContactSolution>& list);

// Notes the contacts that nothing presses and nothing moves: such a contact may slip or stick, and it sticks.
void note_rests(TouchingBodies& bodies, const ContactProblem& problem, const ContactSolution& now);

// Notes the open contacts whose gaps constraints and the other contacts keep closed at rest: they neither open nor close
// but by round-off.
void note_still(TouchingBodies& bodies, const Workspace& s, const ContactProblem& problem);

}  // namespace anholon
