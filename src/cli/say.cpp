#include "cli/say.h"

#include <cctype>
#include <cstdarg>
#include <cstddef>
#include <cstdint>

#include <unistd.h>

#include "base/assert.h"
#include "base/escape.h"
#include "base/utf8.h"

namespace anholon::cli {

namespace {

// One conversion of a format: %-*s, %.3g, %zu.
struct Conversion {
  std::string flags, length;
  int width = -1, precision = -1;
  char kind = 0;

  std::string format(const char* kind_with_length) const {
    std::string text = "%" + flags;
    if (width >= 0) text += std::to_string(width);
    if (precision >= 0) text += "." + std::to_string(precision);
    return text + kind_with_length;
  }
};

template <class T>
std::string printed(const std::string& format, T value) {
  char few[64];
  const int n = std::snprintf(few, sizeof few, format.c_str(), value);
  if (n < static_cast<int>(sizeof few)) return few;
  std::string text(static_cast<std::size_t>(n) + 1, '\0');
  std::snprintf(text.data(), text.size(), format.c_str(), value);
  text.pop_back();
  return text;
}

std::string padded(std::string text, const Conversion& c) {
  const std::size_t width = c.width < 0 ? 0 : static_cast<std::size_t>(c.width), own = utf8_length(text);
  if (own >= width) return text;
  const std::string room(width - own, ' ');
  return c.flags.find('-') != std::string::npos ? text + room : room + text;
}

// Fills in a format; takes the arguments in turn, as printf does.
class Printer {
 public:
  Printer(const char* format, std::va_list& arguments) : at_(format), arguments_(arguments) {}

  std::string run() {
    std::string out;
    while (*at_) {
      if (*at_ != '%')
        out += *at_++;
      else if (*++at_ == '%')
        out += *at_++;
      else
        out += value(conversion());
    }
    return out;
  }

 private:
  int number() {
    if (*at_ == '*') return ++at_, va_arg(arguments_, int);
    int n = 0;
    while (std::isdigit(static_cast<unsigned char>(*at_))) n = 10 * n + (*at_++ - '0');
    return n;
  }

  Conversion conversion() {
    Conversion c;
    while (*at_ && std::string_view("-+ #0").find(*at_) != std::string_view::npos) c.flags += *at_++;
    if (*at_ == '*' || std::isdigit(static_cast<unsigned char>(*at_))) c.width = number();
    if (c.width < -1) c.flags += '-', c.width = -c.width;
    if (*at_ == '.') ++at_, c.precision = number();
    while (*at_ && std::string_view("hlzjt").find(*at_) != std::string_view::npos) c.length += *at_++;
    c.kind = *at_ ? *at_++ : '\0';
    return c;
  }

  std::string value(const Conversion& c) {
    switch (c.kind) {
    case 's': {
      const std::string text = shown(va_arg(arguments_, const char*));
      return padded(c.precision < 0 ? text : utf8_substr(text, 0, static_cast<std::size_t>(c.precision)), c);
    }
    case 'd':
    case 'i':
      if (c.length == "z" || c.length == "t") return printed(c.format("td"), va_arg(arguments_, std::ptrdiff_t));
      if (c.length == "ll") return printed(c.format("lld"), va_arg(arguments_, long long));
      if (c.length == "l") return printed(c.format("ld"), va_arg(arguments_, long));
      return printed(c.format("d"), va_arg(arguments_, int));
    case 'u':
    case 'x':
      if (c.length == "z") return printed(c.format(c.kind == 'u' ? "zu" : "zx"), va_arg(arguments_, std::size_t));
      if (c.length == "ll")
        return printed(c.format(c.kind == 'u' ? "llu" : "llx"), va_arg(arguments_, unsigned long long));
      if (c.length == "l") return printed(c.format(c.kind == 'u' ? "lu" : "lx"), va_arg(arguments_, unsigned long));
      return printed(c.format(c.kind == 'u' ? "u" : "x"), va_arg(arguments_, unsigned));
    case 'e':
    case 'f':
    case 'g': {
      const char kind[] = {c.kind, '\0'};
      return printed(c.format(kind), va_arg(arguments_, double));
    }
    default:
      ANHOLON_ASSERT(false && "a conversion that is not known here");
    }
    return {};
  }

  const char* at_;
  std::va_list& arguments_;
};

void put(std::FILE* to, const std::string& text) { std::fwrite(text.data(), 1, text.size(), to); }

}  // namespace

void say(std::FILE* to, const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  const std::string text = Printer(format, arguments).run();
  va_end(arguments);
  put(to, text);
}

std::string said(const char* format, ...) {
  std::va_list arguments;
  va_start(arguments, format);
  std::string text = Printer(format, arguments).run();
  va_end(arguments);
  return text;
}

void say_lines(std::FILE* to, const std::string& text) { put(to, shown_lines(text)); }

void hand_out(const std::string& data) { isatty(STDOUT_FILENO) ? say_lines(stdout, data) : put(stdout, data); }

void draw(const std::string& picture) { put(stdout, picture); }

}  // namespace anholon::cli
