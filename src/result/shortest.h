// Writes the shortest digits that read back to a double, as std::to_chars does, in less time.
//
// Schubfach (R. Giulietti, The Schubfach way to render doubles, 2021): the boundaries of the numbers that read back to
// a double are multiplied by a power of ten of 128 bits, so that their whole parts decide which decimal lies between
// them and is nearest. std::to_chars writes numbers outside 1e-100 to 1e100, and whole ones from 2^53 on.
#pragma once

namespace anholon {

// Writes a finite number to `to`, which has room for kShortestRoom characters, more than the text has; returns the end
// of the text.
inline constexpr int kShortestRoom = 64;
char* write_shortest(char* to, double value);

}  // namespace anholon
