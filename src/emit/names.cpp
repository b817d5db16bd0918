#include "emit/names.h"

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
                                     "matrix",
                                     "right",
                                     "abs",
                                     "all",
                                     "enumerate",
                                     "len",
                                     "list",
                                     "max",
                                     "min",
                                     "print",
                                     "range",
                                     "slice",
                                     "sum",
                                     "tuple",
                                     "zip",
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

LocalNames::LocalNames(std::vector<std::string> arrays)
    : arrays_(std::move(arrays)), taken_(std::begin(kReserved), std::end(kReserved)) {
  for (const FunctionInfo& f : elementary_functions()) taken_.insert(f.c);
  taken_.insert(arrays_.begin(), arrays_.end());
}

void LocalNames::add(NodeId id, const std::string& wanted, Place place) {
  symbols_[id] = fresh(wanted);
  places_[id] = place;
}

const LocalNames::Place* LocalNames::place(NodeId id) const {
  const auto it = places_.find(id);
  return it == places_.end() ? nullptr : &it->second;
}

LocalNames::LocalNames(const System& s, const Structure& structure, const Motion& motion)
    : LocalNames(std::vector<std::string>{"state", "lead", "p"}) {
  enum { state, lead, parameters, inputs };
  Graph& g = *s.model->graph;
  symbols_[g.time().id] = "t";
  if (!motion.inputs.empty()) arrays_.push_back("u"), taken_.insert({"u", "own"});
  const auto add_variable = [&](std::size_t j, int k, const std::string& wanted) {
    add(s.symbol(j, static_cast<unsigned>(k)).id, wanted,
        k < structure.d[j] ? Place{state, motion.place(j, static_cast<unsigned>(k))} : Place{lead, j});
  };
  for (std::size_t j = 0; j < s.size(); ++j) add_variable(j, 0, s.variable_names[j]);
  for (std::size_t i = 0; i < s.model->parameters.size(); ++i)
    add(g.parameter(static_cast<std::uint32_t>(i)).id, s.model->parameters[i].name, {parameters, i});
  for (std::size_t k = 0; k < motion.inputs.size(); ++k)
    add(g.control(static_cast<std::uint32_t>(motion.inputs[k]), 0).id, motion.input_names[k], {inputs, k});
  for (std::size_t j = 0; j < s.size(); ++j)
    for (int k = 1; k <= structure.d[j]; ++k) add_variable(j, k, s.variable_names[j] + "_" + std::to_string(k));
}

LocalNames::LocalNames(const RateFormulas& f) : LocalNames(std::vector<std::string>{"x", "lead", "u", "p"}) {
  enum { x, lead, inputs, parameters };
  symbols_[f.model->graph->time().id] = "t";
  const auto add_all = [&](const RateFormulas::Symbols& list, std::size_t array) {
    for (std::size_t i = 0; i < list.symbols.size(); ++i) add(list.symbols[i].id, list.names[i], {array, i});
  };
  add_all(f.x, x);
  add_all(f.u, inputs);
  add_all(f.p, parameters);
  add_all(f.lead, lead);
}

}  // namespace anholon::emit
