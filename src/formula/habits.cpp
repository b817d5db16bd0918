#include "formula/habits.h"

#include <algorithm>
#include <cstring>
#include <map>
#include <tuple>
#include <vector>

#include "formula/functions.h"
#include "formula/units.h"

namespace anholon {

namespace {

bool among(const std::string& word, std::initializer_list<const char*> list) {
  return std::any_of(list.begin(), list.end(), [&](const char* w) { return word == w; });
}

std::string derivative(const std::string& text) { return "a derivative by time is written with a prime: " + text; }

Syntax joined(Syntax::Op op, Syntax a, Syntax b) {
  Syntax s{op, "", {}, {}, 0, 0, {}};
  s.args.push_back(std::move(a));
  s.args.push_back(std::move(b));
  return s;
}

Syntax number(const char* text) { return {Syntax::Op::number, text, {}, {}, 0, 0, {}}; }

// Other names of functions that exist here.
const std::map<std::string, const char*>& other_names() {
  static const std::map<std::string, const char*> list = {{"arcsin", "asin"},   {"arccos", "acos"},
                                                          {"arctan", "atan"},   {"arctan2", "atan2"},
                                                          {"arcsinh", "asinh"}, {"arccosh", "acosh"},
                                                          {"arctanh", "atanh"}, {"arsinh", "asinh"},
                                                          {"arcosh", "acosh"},  {"artanh", "atanh"},
                                                          {"tg", "tan"},        {"arctg", "atan"},
                                                          {"sh", "sinh"},       {"ch", "cosh"},
                                                          {"th", "tanh"},       {"ln", "log"},
                                                          {"sgn", "sign"},      {"signum", "sign"},
                                                          {"fabs", "abs"},      {"Abs", "abs"},
                                                          {"mag", "norm"},      {"magnitude", "norm"},
                                                          {"length", "norm"},   {"normalize", "unit"},
                                                          {"Rx", "rotx"},       {"Ry", "roty"},
                                                          {"Rz", "rotz"},       {"rotX", "rotx"},
                                                          {"rotY", "roty"},     {"rotZ", "rotz"},
                                                          {"velocity", "vel"},  {"acceleration", "acc"},
                                                          {"omega", "angvel"},  {"angular_velocity", "angvel"},
                                                          {"spin", "angvel"},   {"angular_acceleration", "angacc"},
                                                          {"fmin", "min"},      {"fmax", "max"}};
  return list;
}

// Returns the order of diff(x, t, 2) and diff(x, t, t); 0 if the call is not a derivative by time.
int order_of(const Syntax& call) {
  const std::vector<Syntax>& a = call.args;
  const auto is_time = [](const Syntax& s) { return s.op == Syntax::Op::name && s.text == "t"; };
  if (a.size() == 1) return among(call.text, {"ddot", "der2", "ddt2", "d2dt2"}) ? 2 : 1;
  if (!is_time(a[1]))
    return a.size() == 2 && a[1].op == Syntax::Op::number && a[1].text.size() == 1 ? a[1].text[0] - '0' : 0;
  if (a.size() == 3 && a[2].op == Syntax::Op::number && a[2].text.size() == 1) return a[2].text[0] - '0';
  return std::all_of(a.begin() + 1, a.end(), is_time) ? static_cast<int>(a.size()) - 1 : 0;
}

// Returns the formula that replaces a call with these arguments.
std::string rewritten(const Syntax& s) {
  const std::string& f = s.text;
  const std::vector<Syntax>& a = s.args;
  const auto with = [&](const char* op, const char* other) {
    return print(joined(Syntax::Op::power, a[0], number(other))) + op;
  };
  const auto call = [&](const char* name, std::vector<Syntax> args) {
    return print(Syntax{Syntax::Op::call, name, std::move(args), {}, 0, 0, {}});
  };
  const auto times = [&](const char* factor) {
    Syntax product = joined(Syntax::Op::multiply, a[0], number("1"));
    product.operators.push_back({Syntax::Op::multiply, {}});
    std::string text = print(product);
    return text.substr(0, text.size() - 1) + factor;
  };
  if (a.size() == 1) {
    if (among(f, {"sqr", "square"})) return with("", "2");
    if (among(f, {"cbrt"})) return with("", "(1/3)");
    if (among(f, {"sec"})) return "1/" + call("cos", {a[0]});
    if (among(f, {"csc", "cosec"})) return "1/" + call("sin", {a[0]});
    if (among(f, {"cot", "ctg", "cotan"})) return "1/" + call("tan", {a[0]});
    if (among(f, {"log10", "lg"})) return call("log", {a[0]}) + "/log(10)";
    if (among(f, {"log2", "ld"})) return call("log", {a[0]}) + "/log(2)";
    if (among(f, {"rad", "radians", "deg2rad"}))
      return a[0].op == Syntax::Op::number ? a[0].text + " deg" : times("pi/180");
    if (among(f, {"deg", "degrees", "rad2deg"})) return times("180/pi");
    if (among(f, {"heaviside", "Heaviside", "step"})) return "piecewise(" + print(a[0]) + " >= 0, 1, 0)";
  }
  if (a.size() == 2) {
    if (among(f, {"pow", "power"})) return print(joined(Syntax::Op::power, a[0], a[1]));
    if (among(f, {"atan"})) return call("atan2", {a[0], a[1]});
    if (among(f, {"log"})) return call("log", {a[0]}) + "/" + call("log", {a[1]});
    if (among(f, {"hypot"}))
      return "sqrt(" + print(joined(Syntax::Op::power, a[0], number("2"))) + " + " +
             print(joined(Syntax::Op::power, a[1], number("2"))) + ")";
  }
  if (a.size() == 3) {
    if (among(f, {"if", "If", "ifelse", "iif", "IIf", "where", "cond"}) && a[0].op == Syntax::Op::compare)
      return call("piecewise", {a[0], a[1], a[2]});
    if (among(f, {"clip", "clamp", "limit", "sat", "saturate"}))
      return "min(max(" + print(a[0]) + ", " + print(a[1]) + "), " + print(a[2]) + ")";
    if (among(f, {"vec", "vector", "Vector", "vec3"}))
      return "[" + print(a[0]) + ", " + print(a[1]) + ", " + print(a[2]) + "]";
  }
  return {};
}

}  // namespace

std::string primed(const Syntax& s, int times) {
  if (times > 3) return "D(" + print(s) + ", " + std::to_string(times) + ")";
  Syntax p = s;
  for (int k = 0; k < times; ++k) {
    Syntax next{Syntax::Op::prime, "'", {}, {}, 0, 0, {}};
    next.args.push_back(std::move(p));
    p = std::move(next);
  }
  return print(p);
}

std::string habit_of_call(const Syntax& s) {
  const std::string& f = s.text;
  if (among(f,
            {"diff", "Diff", "der", "ddt", "dt", "Dt", "derivative", "Derivative", "dot", "ddot", "D", "d", "der2"}) &&
      !s.args.empty() && !(among(f, {"D", "dot"}) && s.args.size() != 1)) {
    if (const int k = order_of(s); k > 0) return derivative(primed(s.args[0], k));
    return "derivatives are taken by time only, " + primed(s.args[0], 1) + ": write others out";
  }
  if (const std::string text = rewritten(s); !text.empty()) return "write " + text;
  if (const auto it = other_names().find(f); it != other_names().end()) {
    Syntax other = s;
    other.text = it->second;
    return "write " + print(other) + (other.text == "atan2" ? ": first y, then x" : "");
  }
  if (among(f, {"if", "If", "ifelse", "iif", "where", "cond"}))
    return "write piecewise(x > 0, a, b): a where x > 0, else b";
  if (among(f, {"integral", "Integral", "integrate", "int"}))
    return "an integral over time is a state: [state] I = {rate = \"" +
           (s.args.empty() ? std::string("…") : print(s.args[0])) + "\", initial = 0}";
  return {};
}

std::string habit_of_member(const Syntax& s) {
  if (among(s.text, {"dt", "dot", "d", "der", "diff", "derivative", "vel", "velocity", "v"}))
    return derivative(primed(s.args[0], 1));
  if (among(s.text, {"ddt", "ddot", "dtdt", "acc", "acceleration", "a"})) return derivative(primed(s.args[0], 2));
  return {};
}

std::string habit_of_derivative(const std::string& name, const std::function<bool(const std::string&)>& varies) {
  // dx/dt and d2x/dt2
  for (const auto& [begin, end, order] : {std::tuple("d", "/dt", 1), {"d2", "/dt2", 2}, {"d^2", "/dt^2", 2}})
    if (name.starts_with(begin) && name.ends_with(end) && name.size() > std::strlen(begin) + std::strlen(end)) {
      const std::string base = name.substr(std::strlen(begin), name.size() - std::strlen(begin) - std::strlen(end));
      if (varies(base)) return derivative(base + std::string(static_cast<std::size_t>(order), '\''));
    }
  struct Affix {
    const char* text;
    bool behind;
    int order;
  };
  static const std::vector<Affix> affixes = {
      {"_dotdot", true, 2}, {"_ddot", true, 2}, {"dotdot", true, 2}, {"ddot", true, 2}, {"_dd", true, 2},
      {"dd", true, 2},      {"pp", true, 2},    {"_tt", true, 2},    {"_dot", true, 1}, {"dot", true, 1},
      {"Dot", true, 1},     {"_d", true, 1},    {"_p", true, 1},     {"_t", true, 1},   {"prime", true, 1},
      {"d", true, 1},       {"p", true, 1},     {"dd_", false, 2},   {"dd", false, 2},  {"ddot_", false, 2},
      {"d_", false, 1},     {"dot_", false, 1}, {"d", false, 1},     {"v_", false, 1},  {"v", false, 1}};
  for (const Affix& a : affixes) {
    const std::string text = a.text;
    if (name.size() <= text.size()) continue;
    const std::size_t rest = name.size() - text.size();
    if (name.compare(a.behind ? rest : 0, text.size(), text) != 0) continue;
    if (const std::string base = a.behind ? name.substr(0, rest) : name.substr(text.size()); varies(base))
      return derivative(base + std::string(static_cast<std::size_t>(a.order), '\''));
  }
  return {};
}

std::string habit_of_unit(const std::string& name) {
  static const std::map<std::string, const char*> list = {
      {"sec", "s"},        {"secs", "s"},        {"second", "s"},       {"seconds", "s"},     {"minute", "min"},
      {"minutes", "min"},  {"hr", "h"},          {"hrs", "h"},          {"hour", "h"},        {"hours", "h"},
      {"days", "day"},     {"degree", "deg"},    {"degrees", "deg"},    {"degs", "deg"},      {"radian", "rad"},
      {"radians", "rad"},  {"rads", "rad"},      {"meter", "m"},        {"meters", "m"},      {"metre", "m"},
      {"metres", "m"},     {"millimeter", "mm"}, {"millimeters", "mm"}, {"centimeter", "cm"}, {"centimeters", "cm"},
      {"kilometer", "km"}, {"kilometers", "km"}, {"gram", "g"},         {"grams", "g"},       {"kilogram", "kg"},
      {"kilograms", "kg"}, {"kgs", "kg"},        {"Kg", "kg"},          {"KG", "kg"},         {"ton", "t"},
      {"tons", "t"},       {"tonne", "t"},       {"tonnes", "t"},       {"newton", "N"},      {"newtons", "N"},
      {"Newton", "N"},     {"joule", "J"},       {"joules", "J"},       {"watt", "W"},        {"watts", "W"},
      {"pascal", "Pa"},    {"hertz", "Hz"},      {"hz", "Hz"},          {"Nm", "N*m"},        {"kNm", "kN*m"},
      {"Ns", "N*s"},       {"Nms", "N*m*s"},     {"Js", "J*s"},         {"Ws", "W*s"},        {"kgm", "kg*m"},
      {"mps", "m/s"},      {"kmh", "km/h"},      {"kph", "km/h"},       {"mph", "mi/h"},      {"rps", "rev/s"},
      {"inch", "in"},      {"inches", "in"},     {"feet", "ft"},        {"lbs", "lb"},        {"liter", "L"},
      {"litre", "L"}};
  const auto it = list.find(name);
  return it == list.end() ? std::string() : it->second;
}

std::string habit_of_name(const std::string& name, const std::function<bool(const std::string&)>& varies) {
  if (const std::string habit = habit_of_derivative(name, varies); !habit.empty()) return habit;
  if (among(name, {"e", "E", "euler_e"})) return "write exp(1), and exp(x) for its powers";
  if (among(name, {"PI", "Pi", "M_PI"})) return "write pi";
  if (among(name, {"time", "T", "Time"})) return "the time is t";
  if (among(name, {"true", "True", "false", "False"}))
    return "conditions stand in piecewise(x > 0, a, b); a mode is a number";
  const std::vector<std::string> functions = function_names();
  if (std::find(functions.begin(), functions.end(), name) != functions.end())
    return "a function stands with its argument: " + name + "(x), its square " + name + "(x)^2";
  if (find_unit(name))
    return "a unit stands behind a number and a blank: 30 " + name + ", and 1 " + name +
           " for itself; a name is declared under [parameters] or [define]";
  return {};
}

std::string habit_of_sign(const std::string& sign) {
  static const std::map<std::string, const char*> list = {
      {"&", "both of two conditions: min(a, b) > 0 says a > 0 and b > 0"},
      {"∧", "both of two conditions: min(a, b) > 0 says a > 0 and b > 0"},
      {"|",
       "one of two conditions: max(a, b) > 0 says a > 0 or b > 0; the length of a vector is norm(v), |x| is abs(x)"},
      {"∨", "one of two conditions: max(a, b) > 0 says a > 0 or b > 0"},
      {"!", "the opposite of x > 0 is x <= 0"},
      {"?", "write piecewise(x > 0, a, b): a where x > 0, else b"},
      {"°", "write 30 deg"},
      {"º", "write 30 deg"},
      {"%", "write 0.05 for 5 %"},
      {"√", "write sqrt(x)"},
      {"÷", "write a/b"},
      {"∕", "write a/b"},
      {"•", "write a*b"},
      {"∗", "write a*b"},
      {"∙", "write a*b"},
      {"@", "write a*b, of rotations and of a rotation and a vector, too"},
      {"″", "write x''"},
      {"”", "write x''"},
      {"`", "a derivative by time is written x'"},
      {"´", "a derivative by time is written x'"},
      {"¹", "write x^1"},
      {"⁴", "write x^4"},
      {"⁵", "write x^5"},
      {"⁶", "write x^6"},
      {"½", "write 1/2"},
      {"¼", "write 1/4"},
      {"¾", "write 3/4"},
      {"ẋ", "a derivative by time is written x'"},
      {"ẏ", "a derivative by time is written y'"},
      {"ż", "a derivative by time is written z'"},
      {"ẍ", "a second derivative by time is written x''"},
      {"ÿ", "a second derivative by time is written y''"},
      {"\u0307", "a derivative by time is written x'"},
      {"\u0308", "a second derivative by time is written x''"},
      {"\\", "a formula is not LaTeX: write theta, sin(theta), a/b"},
      {"$", "a formula is not LaTeX: write theta, sin(theta), a/b"},
      {"{", "write round brackets ( )"},
      {"}", "write round brackets ( )"},
      {";", "parts are separated by a comma"},
      {"≠", "conditions compare with <, <=, > and >="},
      {"∞", "write a large number"},
  };
  const auto it = list.find(sign);
  return it == list.end() ? std::string() : it->second;
}

}  // namespace anholon
