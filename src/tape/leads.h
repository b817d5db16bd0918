// How far the slots of a tape are ahead of the state: an equation that is differentiated c times needs its operands c orders
// further.
#pragma once
#include <span>

#include "tape/tape.h"

namespace anholon {

// Sets these leads for the roots of a tape, and for the slots on which they depend the leads that the roots need.
void spread_leads(Tape& tape, std::span<const int> leads);

}  // namespace anholon
