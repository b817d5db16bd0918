// What the commands print. No other file of cli/ writes to the standard output or to stderr, so that no text of others
// reaches a terminal as it is.
#pragma once
#include <cstdio>
#include <string>

namespace anholon::cli {

// As printf: the format is ours and stays as it is; what is put into it is shown (base/escape.h), one line for each %s.
// Widths count characters.
[[gnu::format(printf, 2, 3)]] void say(std::FILE* to, const char* format, ...);
// The same as a text.
[[gnu::format(printf, 1, 2)]] std::string said(const char* format, ...);
// Lines that hold text of others.
void say_lines(std::FILE* to, const std::string& text);
// For a program on the other side of the standard output: JSON, equations, the text of a file, byte by byte. On a
// terminal as `say_lines` does it.
void hand_out(const std::string& data);
// A drawing of ours, whose colours are sequences of the terminal; its labels are shown already.
void draw(const std::string& picture);

}  // namespace anholon::cli
