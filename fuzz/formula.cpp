// The parser on any bytes; where they are a formula, its value under the names of a small model.
#include "formula/formula.h"

#include <string>

#include "modelfile/read.h"

namespace {

constexpr std::size_t kLongest = 4096;

// A name of every kind; the formula under test is a definition, and each side of a constraint.
constexpr const char* kModel = R"toml(
coordinates = ["x", "y", "theta"]
[parameters]
m = 2
a = "1/3"
v = ["1", "a", "0"]
[functions]
f = "1 + t/10"
g = {}
"rho(h)" = "exp(-h/a)"
[frame]
blade = "rotz(theta)"
[point]
P = "x*ex + y*ey"
[observer]
spin = "sin(t)*ez"
origin_acceleration = "cos(t)*ex"
[[body]]
name = "B"
mass = "m"
inertia = "a"
center = "P + a*blade.x"
orientation = "blade"
[gravity]
field = "-here"
)toml";

// A basic string of TOML, so that the reader of escapes and places is tested too.
std::string quoted(const std::string& text) {
  static const char* const digits = "0123456789abcdef";
  std::string out = "\"";
  for (const char c : text) {
    const auto u = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\')
      out += '\\', out += c;
    else if (u < 0x20 || u == 0x7f)
      out += "\\u00", out += digits[u >> 4], out += digits[u & 15];
    else
      out += c;
  }
  return out + "\"";
}

void read(const std::string& more) {
  const anholon::SourceText source{"fuzz.toml", kModel + more};
  anholon::Diagnostics diagnostics;
  (void)anholon::read_model(source, diagnostics);
  (void)diagnostics.print(source);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
  if (size > kLongest) return 0;
  const std::string text(reinterpret_cast<const char*>(data), size);
  const anholon::FormulaText formula(text, anholon::Span{1, 1, 1});
  try {
    (void)anholon::parse_formula(formula);
    read("[define]\ne = " + quoted(text) + "\n");
  } catch (const anholon::Failure&) {
  }
  try {
    if (anholon::parse_equation(formula).size() == 2)
      read("[[constraint]]\nname = \"c\"\nequation = " + quoted(text) + "\n");
  } catch (const anholon::Failure&) {
  }
  return 0;
}
