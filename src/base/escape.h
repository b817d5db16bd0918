// What each output format makes of text that others wrote: titles, names, file names, messages that quote them.
//
// A person never gets what steers a terminal, ends a line or turns the direction of writing. Every control character
// becomes the sign of its own (ESC as ␛, a line break as ␊); marks of direction, characters without width, line
// separators, tags, surrogates and bytes that are no UTF-8 become �. One character stands for one, so that columns and
// carets still fit. The joiners of Persian and of pictograms (U+200C, U+200D) stay: they neither hide nor move
// anything, and names hold only A-Z a-z 0-9 _.
#pragma once
#include <string>
#include <string_view>

namespace anholon {

// One line for a person: a terminal, a message, a cell of a table, a drawing.
std::string shown(std::string_view text);
// Lines for a person: line breaks stay, a tab is a space.
std::string shown_lines(std::string_view text);

// Between the quotes of JSON, and of TOML: nothing is lost but bytes that are no UTF-8; what `shown` would replace is
// written by its number.
std::string json_escape(std::string_view text);
std::string toml_escape(std::string_view text);
// In HTML, MathML and SVG, as text or between the quotes of an attribute; XML allows no control character at all.
std::string markup_escape(std::string_view text);
// The same of a text with lines: <pre>.
std::string markup_lines(std::string_view text);
// In LaTeX and pgfplots, outside mathematics and within \mathrm.
std::string latex_escape(std::string_view text);
// A line of a comment in C or Python: neither ends it nor goes on in the next line.
std::string comment_line(std::string_view text);
// Between the quotes of a string of C or Python, three quotes included.
std::string code_string(std::string_view text);
// A cell of CSV, in quotes where it needs them.
std::string csv_cell(std::string_view text);
// A string of HDF5, which ends at the first NUL and is UTF-8.
std::string hdf5_text(std::string_view text);

}  // namespace anholon
