// All output of the commands. No other file of cli/ writes to stdout or stderr, so foreign text never reaches a
// terminal unescaped.
#pragma once
#include <cstdio>
#include <string>

namespace anholon::cli {

// Prints like printf: the format comes from this program and is not changed; its arguments are passed through shown()
// (base/escape.h), one line for each %s. Widths count characters.
[[gnu::format(printf, 2, 3)]] void say(std::FILE* to, const char* format, ...);
// Returns the text that say() would print.
[[gnu::format(printf, 1, 2)]] std::string said(const char* format, ...);
// Prints lines that contain foreign text.
void say_lines(std::FILE* to, const std::string& text);
// Writes data for a program that reads the standard output (JSON, equations, the text of a file) byte by byte. On a
// terminal it prints like say_lines().
void hand_out(const std::string& data);
// Prints a drawing of this program, whose colours are terminal sequences; its labels are already escaped.
void draw(const std::string& picture);

}  // namespace anholon::cli
