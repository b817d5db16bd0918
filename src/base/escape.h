// Escaping of foreign text (titles, names, file names, messages that quote them) for each output format.
//
// Text for a person never holds a character that controls a terminal, ends a line or changes the direction of writing.
// Every control character becomes its Unicode picture (ESC as ␛, a line break as ␊); direction marks, zero-width
// characters, line separators, tags, surrogates and bytes that are not UTF-8 become �. One character replaces one
// character, so columns and carets still match. The joiners of Persian and of pictograms (U+200C, U+200D) stay: they
// neither hide nor move anything, and names hold only A-Z a-z 0-9 _.
#pragma once
#include <string>
#include <string_view>

namespace anholon {

// Escapes one line for a person: a terminal, a message, a cell of a table, a drawing.
std::string shown(std::string_view text);
// Escapes lines for a person: line breaks are kept, a tab becomes a space.
std::string shown_lines(std::string_view text);

// Escape text between the quotes of JSON and of TOML. Only bytes that are not UTF-8 are lost; a character that shown()
// would replace is written as a numeric escape.
std::string json_escape(std::string_view text);
std::string toml_escape(std::string_view text);
// Escapes text for HTML, MathML and SVG, as content or between the quotes of an attribute. XML allows no control
// characters.
std::string markup_escape(std::string_view text);
// Escapes a text of several lines in the same way, for <pre>.
std::string markup_lines(std::string_view text);
// Escapes text for LaTeX and pgfplots, outside mathematics and within \mathrm.
std::string latex_escape(std::string_view text);
// Escapes a line for a comment in C or Python: the text can neither end the comment nor continue it in the next line.
std::string comment_line(std::string_view text);
// Escapes text between the quotes of a string of C or Python, triple quotes included.
std::string code_string(std::string_view text);
// Returns a cell of CSV, quoted if necessary.
std::string csv_cell(std::string_view text);
// Returns a string of HDF5, which ends at the first NUL and is UTF-8.
std::string hdf5_text(std::string_view text);

}  // namespace anholon
