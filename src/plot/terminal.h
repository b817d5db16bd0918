// A figure in a terminal: curves in braille, two by four dots a character.
#pragma once
#include "plot/figure.h"

namespace anholon::plot {

struct TerminalSize {
  int columns = 80, rows = 20;  // rows: height of the box of one panel
  bool colours = false;         // if false, letters distinguish the curves
};

std::string draw_terminal(const Figure& figure, const TerminalSize& size);

}  // namespace anholon::plot
