// The frequencies of the numbers or words of a column.
#pragma once
#include "plot/heat_map.h"

namespace anholon::plot {

struct Histogram {
  std::string title;
  NamedColumn of;                   // `values` is empty
  double from = 0, to = 1;          // the range of the numbers; bars have equal widths
  std::vector<std::size_t> counts;  // of each bar
  std::vector<std::string> words;   // of each bar; empty: the bars are ranges of numbers
  std::size_t left_out = 0;         // rows without a number
  LabelStyle labels = LabelStyle::unicode;
  double width = 16, height = 9;  // cm
};

// Makes a bar for each word; for n numbers 2 n^(1/3) bars (the rule of Rice), from 5 to 100. Throws Failure without a
// place if no row has a number.
Histogram make_histogram(NamedColumn of, std::vector<std::string> words);

Drawing lay_out(const Histogram& histogram);

}  // namespace anholon::plot
