// Initial angles that may have been meant in degrees.
#pragma once
#include <string>
#include <vector>

#include "structure/initial_problem.h"
#include "system/system.h"

namespace anholon {

// Returns the note on given initial angles whose numbers look like degrees, or "" if there are none. Such angles are
// 30, 45, 60, 90, 180, 270 or 360 rad of either sign, and angles of more than four turns on which the equations depend:
// the angle of a wheel that has rolled may have any value. A coordinate is an angle if it is a term in the argument of
// a sine, cosine or tangent, such as those of rotations, and no length in the position of a body. An angle that is
// written with its unit is never noted. `nodes`: the number of nodes of the graph when the model was read. `overrides`:
// the values that replace those of the model.
std::string note_of_large_angles(const System& system, const InitialState<double>& state, std::size_t nodes,
                                 const std::vector<StateOverride>& overrides);

}  // namespace anholon
