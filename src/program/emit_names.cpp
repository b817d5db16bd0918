#include "program/emit_names.h"

#include <algorithm>
#include <cctype>

namespace anholon::emit {

namespace {

// Words of C, of Python, and of the generated texts.
constexpr const char* kReserved[] = {"auto",
                                     "break",
                                     "case",
                                     "char",
                                     "const",
                                     "continue",
                                     "default",
                                     "do",
                                     "double",
                                     "else",
                                     "enum",
                                     "extern",
                                     "float",
                                     "for",
                                     "goto",
                                     "if",
                                     "inline",
                                     "int",
                                     "long",
                                     "register",
                                     "restrict",
                                     "return",
                                     "short",
                                     "signed",
                                     "sizeof",
                                     "static",
                                     "struct",
                                     "switch",
                                     "typedef",
                                     "union",
                                     "unsigned",
                                     "void",
                                     "volatile",
                                     "while",
                                     "asm",
                                     "typeof",
                                     "bool",
                                     "true",
                                     "false",
                                     "nullptr",
                                     "constexpr",
                                     "alignas",
                                     "alignof",
                                     "static_assert",
                                     "thread_local",
                                     "linux",
                                     "unix",
                                     "and",
                                     "as",
                                     "assert",
                                     "async",
                                     "await",
                                     "class",
                                     "def",
                                     "del",
                                     "elif",
                                     "except",
                                     "finally",
                                     "from",
                                     "global",
                                     "import",
                                     "in",
                                     "is",
                                     "lambda",
                                     "nonlocal",
                                     "not",
                                     "or",
                                     "pass",
                                     "raise",
                                     "try",
                                     "with",
                                     "yield",
                                     "match",
                                     "type",
                                     "None",
                                     "True",
                                     "False",
                                     "np",
                                     "numpy",
                                     "main",
                                     "t",
                                     "state",
                                     "lead",
                                     "p",
                                     "out",
                                     "i",
                                     "fabs",
                                     "sqrt",
                                     "pow",
                                     "atan2",
                                     "isfinite"};

}  // namespace

std::string identifier(const std::string& text, const std::string& otherwise) {
  std::string out;
  for (char c : text)
    if (c != ']') out += std::isalnum(static_cast<unsigned char>(c)) ? c : '_';  // th[3] is th_3
  if (out.empty() || out.find_first_not_of('_') == std::string::npos) return otherwise;
  // Names that begin with _ are reserved for compilers.
  if (!std::isalpha(static_cast<unsigned char>(out[0]))) out = otherwise + (out[0] == '_' ? "" : "_") + out;
  return out;
}

std::string LocalNames::fresh(const std::string& wanted) {
  std::string name = identifier(wanted, "x");
  // A name in capitals may be a macro of math.h.
  if (name.size() > 2 && std::none_of(name.begin(), name.end(), [](unsigned char c) { return std::islower(c); }))
    name += '_';
  while (!taken_.insert(name).second) name += '_';
  return name;
}

LocalNames::LocalNames(const System& s, const Structure& structure, const Motion& motion)
    : taken_(std::begin(kReserved), std::end(kReserved)) {
  for (const FunctionInfo& f : elementary_functions()) taken_.insert(f.c);
  Graph& g = *s.model->graph;
  symbols_[g.time().id] = "t";
  if (!motion.inputs.empty()) taken_.insert({"u", "own"});
  for (std::size_t j = 0; j < s.size(); ++j) symbols_[s.symbol(j, 0).id] = fresh(s.variable_names[j]);
  for (std::size_t i = 0; i < s.model->parameters.size(); ++i)
    symbols_[g.parameter(static_cast<std::uint32_t>(i)).id] = fresh(s.model->parameters[i].name);
  for (std::size_t k = 0; k < motion.inputs.size(); ++k)
    symbols_[g.control(static_cast<std::uint32_t>(motion.inputs[k]), 0).id] = fresh(motion.input_names[k]);
  for (std::size_t j = 0; j < s.size(); ++j)
    for (int k = 1; k <= structure.d[j]; ++k)
      symbols_[s.symbol(j, static_cast<unsigned>(k)).id] = fresh(s.variable_names[j] + "_" + std::to_string(k));
}

}  // namespace anholon::emit
