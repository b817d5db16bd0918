#include <algorithm>

#include "base/escape.h"
#include "emit/names.h"
#include "emit/rate_formulas.h"
#include "emit/straight_line.h"
#include "emit/text.h"
#include "expr/derivatives/point_gradient.h"
#include "numeric/number.h"

namespace anholon {

namespace {

using namespace emit;

// One block of the Jacobian: its entries column by column, each with the place of its value.
struct Block {
  std::size_t rows, columns;
  std::vector<std::vector<std::pair<std::size_t, std::size_t>>> entries;  // by column: row, place
};

class CasadiFile {
 public:
  CasadiFile(const RateFormulas& f, const std::string& name, const std::string& made_by)
      : f_(f), name_(identifier(name, "motion")), made_by_(made_by) {
    symbols_ = {{f_.model->graph->time()}, f_.x.symbols, f_.u.symbols, f_.p.symbols};
    results_ = {f_.rates, f_.outputs};
  }

  std::string text() {
    const std::string functions = this->functions(),
                      sign = used_sign_ ? "static double $_sign(double x) { return x > 0 ? 1 : x "
                                          "< 0 ? -1 : 0; }\n\n"
                                        : "";
    const std::string entries = f_.explicit_rates() ? "" : "enum { $_ENTRIES = " + std::to_string(values_) + " };\n\n";
    return replaced(head() + constants() + entries + sign + functions + right_side() + interface(), "$", name_);
  }

 private:
  static constexpr const char* kArguments =
      "double t, const double *x, const double *lead, const double *u, const double *p";

  std::string head() const {
    std::string out =
        "/*\n * " + comment_line(f_.title.empty() ? "A motion" : f_.title) +
        "\n * Written by: " + comment_line(made_by_) +
        "\n *\n * Numbers are double, in SI units; an output that has a unit in the file is in that unit.\n";
    const auto list = [&](const char* name, const std::vector<std::string>& of,
                          const std::vector<std::string>& meanings) {
      out += std::string(" * ") + name + ":";
      for (std::size_t i = 0; i < of.size(); ++i)
        out += "\n *   " + std::to_string(i) + "  " + comment_line(of[i]) +
               (i < meanings.size() && !meanings[i].empty() ? " = " + comment_line(meanings[i]) : "");
      out += of.empty() ? " none\n" : "\n";
    };
    list("x", f_.x.names, f_.meanings);
    list("u", f_.u.names, {});
    list("p", f_.p.names, {});
    list("y", f_.output_names, {});
    return out + R"( *
 * int $_rhs(t, x, u, p, dx) has the rates; a null pointer for p stands for the default values. It returns 0, or 1 if the
 * equations have no solution (dx is then NaN).)" +
           std::string(f_.u.size() == 0 ? " u may be a null pointer.\n"
                                        : "\n * u is no null pointer: the formulas of the inputs are not in this file. "
                                          "$_input_values are their values at\n"
                                          " * the initial state.\n") +
           R"( * $_start, $_input_values and $_defaults are the initial state, inputs and parameters of the model.
 * $ is a function (t, x, u, p) -> (dx, y) in CasADi's external interface, with its Jacobian jac_$.
 */
#include <math.h>
#include <string.h>

#ifndef casadi_real
#define casadi_real double
#endif
#ifndef casadi_int
#define casadi_int long long int
#endif

)";
  }

  std::string constants() const {
    std::string out =
        "enum { $_STATES = " + std::to_string(f_.x.size()) + ", $_INPUTS = " + std::to_string(f_.u.size()) +
        ", $_PARAMETERS = " + std::to_string(f_.p.size()) + ", $_OUTPUTS = " + std::to_string(f_.outputs.size()) +
        ", $_UNKNOWNS = " + std::to_string(f_.lead.size()) + " };\n\n";
    const auto numbers = [&](const char* name, const std::vector<double>& list) {
      out += std::string("const double $_") + name + "[] = {";
      for (double x : list) out += number_text(x) + ", ";
      out += "0};\n";
    };
    numbers("start", f_.start);
    numbers("input_values", f_.inputs);
    numbers("defaults", f_.parameters);
    return out + "\n";
  }

  // Returns functions that set out[i] to the i-th expression: $_name with constants c, which $_name_constants computes
  // from p. The constants of the default parameters are written for functions that may be called with a null pointer
  // for p.
  enum class Parameters { given, given_or_null };
  std::string function(const std::string& name, const Column& es, Parameters p = Parameters::given_or_null,
                       bool sparse = false) {
    const StraightLine made(f_, es);
    used_sign_ = used_sign_ || made.used_sign();
    const std::size_t count = made.constant_count();
    std::string out = "enum { $_" + name + "_size = " + std::to_string(count + 1) + " };\n";
    out += "static void $_" + name + "_constants(const double *p, double *c)\n{\n" +
           (made.constants().find("p[") == std::string::npos ? "  (void)p;\n" : "") + (count ? "" : "  (void)c;\n") +
           made.constants() + "}\n\n";
    if (p == Parameters::given_or_null) {
      out += "static const double $_" + name + "_defaults[] = {";
      for (const double c : made.default_constants()) out += number_text(c) + ", ";
      out += "0};\n\n";
    }
    out += "static void $_" + name +
           "(double t, const double *x, const double *lead, const double *u, const double *c, double *out)\n{\n";
    if (!made.reads_time()) out += "  (void)t;\n";
    for (const char* argument : {"x", "lead", "u", "c"})
      if (!made.reads(argument)) out += std::string("  (void)") + argument + ";\n";
    return out + (es.empty() ? "  (void)out;\n" : "") + made.statements(sparse) + "}\n\n";
  }

  std::string functions() {
    std::string out = function("rates", f_.rates) + function("outputs", f_.outputs, Parameters::given);
    if (!f_.explicit_rates()) {
      out += function("equations", matrix_and_right(), Parameters::given_or_null, true) + elimination() + c_solver() +
             "\n";
    }
    return out + solution() + partials();
  }

  Column matrix_and_right() const {
    Column all = entries(f_.matrix());
    const Column right = f_.right();
    all.insert(all.end(), right.begin(), right.end());
    return all;
  }

  // Returns Gaussian elimination in the given order of pivots, statement by statement. If a multiplier is large, the
  // order is unsuitable, and the function reports it.
  std::string elimination() const {
    const std::size_t n = f_.lead.size();
    const Column given = matrix_and_right();
    const auto place = [](const char* array, std::size_t k) { return array + std::to_string(k); };
    std::vector<std::vector<std::string>> a(n, std::vector<std::string>(n));
    std::string out =
        R"(/* Solves the equations e by elimination, with the pivots that suit the start. Returns 1 if they do not suit e. */
static int $_eliminate(const double *e, double *lead)
{
  double l;
  int unsuited = 0;
)";
    for (std::size_t k = 0; k < n * n; ++k)
      if (!is_zero(given[k])) {
        a[k / n][k % n] = place("a", k);
        out += "  double " + a[k / n][k % n] + " = e[" + std::to_string(k) + "];\n";
      }
    for (std::size_t i = 0; i < n; ++i)
      out += "  double " + place("b", i) + " = e[" + std::to_string(n * n + i) + "];\n";
    std::vector<bool> done(n, false);
    for (const auto& [row, column] : f_.pivots) {
      done[row] = true;
      out += "  const double " + place("d", row) + " = 1/" + a[row][column] + ";\n  unsuited |= !isfinite(" +
             place("d", row) + ");\n";
      for (std::size_t i = 0; i < n; ++i) {
        if (done[i] || a[i][column].empty()) continue;
        out += "  l = " + a[i][column] + "*" + place("d", row) + ", unsuited |= !(fabs(l) < 1e3);\n";
        for (std::size_t j = 0; j < n; ++j) {
          if (a[row][j].empty() || j == column) continue;
          const bool fill = a[i][j].empty();
          if (fill) a[i][j] = place("a", i * n + j);
          out += "  " + (fill ? "double " + a[i][j] + " = -" : a[i][j] + " -= ") + "l*" + a[row][j] + ";\n";
        }
        out += "  " + place("b", i) + " -= l*" + place("b", row) + ";\n";
        a[i][column].clear();
      }
    }
    for (std::size_t k = f_.pivots.size(); k-- > 0;) {
      const auto [row, column] = f_.pivots[k];
      out += "  lead[" + std::to_string(column) + "] = (" + place("b", row);
      for (std::size_t j = 0; j < n; ++j)
        if (j != column && !a[row][j].empty()) out += " - " + a[row][j] + "*lead[" + std::to_string(j) + "]";
      out += ")*" + place("d", row) + ";\n";
    }
    // A triangular matrix has no multipliers.
    if (!f_.pivots.empty() && out.find("  l = ") == std::string::npos) out += "  (void)l;\n";
    return out + (f_.pivots.empty() ? "  (void)e, (void)lead, (void)l, (void)unsuited;\n  return 1;\n}\n"
                                    : "  return unsuited;\n}\n");
  }

  // Returns functions that compute lead by elimination or, if its pivots do not suit, by one that searches pivots; and
  // the factors of the matrix for the Jacobian.
  std::string solution() const {
    if (f_.explicit_rates()) return {};
    std::string out = R"(typedef struct {
  double a[$_UNKNOWNS * $_UNKNOWNS], row[$_UNKNOWNS], column[$_UNKNOWNS], lead[$_UNKNOWNS];
  int order[$_UNKNOWNS];
} $_solution;

static int $_factored(const double *e, $_solution *s)
{
  int i;
  memcpy(s->a, e, sizeof s->a);
  if ($_factor(s->a, s->order, s->row, s->column)) {
    for (i = 0; i < $_UNKNOWNS; ++i) s->lead[i] = NAN;
    return 1;
  }
  $_solve(s->a, s->order, s->row, s->column, e + $_UNKNOWNS * $_UNKNOWNS, s->lead);
  return 0;
}

static int $_leading(double t, const double *x, const double *u, const double *p, double *lead)
{
@DECLARE  double e[$_UNKNOWNS * ($_UNKNOWNS + 1)] = {0};
  $_solution s;
  int status;
@SET  $_equations(t, x, 0, u, c_equations, e);
  if (!$_eliminate(e, lead)) return 0;
  status = $_factored(e, &s);
  memcpy(lead, s.lead, sizeof s.lead);
  return status;
}

)";
    return put(put(out, "@DECLARE", constants_of("equations")), "@SET", set_constants_of("equations"));
  }

  // Returns statements that declare `lead` and `status`, and solve for `lead`.
  std::string solved() const {
    return f_.explicit_rates() ? "  const double *lead = 0;\n  int status = 0;\n"
                               : "  double lead[$_UNKNOWNS];\n  int status = $_leading(t, x, u, p, lead);\n";
  }

  std::string right_side() const {
    return "int $_rhs(double t, const double *x, const double *u, const double *p, double *dx)\n{\n" +
           constants_of("rates") + solved() + "  int i;\n" + set_constants_of("rates") +
           R"(  $_rates(t, x, lead, u, c_rates, dx);
  for (i = 0; i < $_STATES; ++i)
    if (!isfinite(dx[i])) status = 1;
  return status;
}

)";
  }

  // Returns statements that declare the constants of a function: those for p, or for the default values if p is a null
  // pointer.
  static std::string constants_of(const std::string& function) {
    return replaced("  double own_@[$_@_size];\n  const double *c_@ = $_@_defaults;\n", "@", function);
  }
  static std::string set_constants_of(const std::string& function) {
    return replaced("  if (p) $_@_constants(p, own_@), c_@ = own_@;\n", "@", function);
  }

  // The nonzero partial derivatives of a list by lead, t, x, u and p, and their places.
  struct Partials {
    Column es;
    std::vector<std::vector<std::ptrdiff_t>> place;  // by row: the place of each column, or -1
  };
  Partials partials_of(const Column& es) const {
    Column by = f_.lead.symbols;
    for (const Column& s : symbols_) by.insert(by.end(), s.begin(), s.end());
    Partials out;
    for (Expr e : es) {
      out.place.emplace_back();
      for (Expr d : point_gradient(e, by, AtKinks::between)) {
        out.place.back().push_back(is_zero(d) ? -1 : static_cast<std::ptrdiff_t>(out.es.size()));
        if (!is_zero(d)) out.es.push_back(d);
      }
    }
    return out;
  }

  // Returns the Jacobian of the results as values one after the other, block by block.
  std::string partials() {
    Column results;
    for (const Column& r : results_) results.insert(results.end(), r.begin(), r.end());
    Partials own = partials_of(results);
    const Partials below = partials_of(f_.equations);
    // Each row whose formula may have no value, with the place of this value.
    std::vector<std::pair<std::size_t, std::size_t>> values;
    for (const std::size_t row : f_.rows_that_may_lack_values())
      values.push_back({row, own.es.size()}), own.es.push_back(results[row]);
    const std::string functions =
        function("partials", own.es) + (f_.explicit_rates() ? "" : function("equation_partials", below.es));
    const std::string entries = jacobian_entries(own, below), missing = missing_entries(values);
    const bool solves = entries.find("$_solve(") != std::string::npos;
    return functions + jacobian_start(own.es.size(), below.es.size(), solves) + entries + missing +
           "  return status;\n}\n\n";
  }

  // Returns the head of the function of the Jacobian, which computes the partial derivatives d of the results and e of
  // the equations. All entries are NaN if the equations have no solution.
  std::string jacobian_start(std::size_t own, std::size_t below, bool solves) const {
    std::string out = "static int $_jacobian(double t, const double *x, const double *u, const double *p, double "
                      "*out)\n{\n  double d[" +
                      std::to_string(own + 1) + "];\n" + constants_of("partials");
    if (f_.explicit_rates())
      return out + "  const double *lead = 0;\n  const int status = 0;\n" + set_constants_of("partials") +
             "  $_partials(t, x, lead, u, c_partials, d);\n";
    out += constants_of("equations") + constants_of("equation_partials") + "  double e[" + std::to_string(below + 1) +
           "], of[$_UNKNOWNS * ($_UNKNOWNS + 1)] = {0}" + (solves ? ", b[$_UNKNOWNS], s[$_UNKNOWNS]" : "") +
           ";\n  $_solution at;\n  const double *lead = at.lead;\n  int status, i;\n" + set_constants_of("partials") +
           set_constants_of("equations") + set_constants_of("equation_partials") +
           "  $_equations(t, x, 0, u, c_equations, of);\n  status = $_factored(of, &at);\n  if (status) {\n    for (i "
           "= 0; i < $_ENTRIES; ++i) out[i] = NAN;\n    return status;\n  }\n"
           "  $_equation_partials(t, x, lead, u, c_equation_partials, e);\n";
    return out + "  $_partials(t, x, lead, u, c_partials, d);\n";
  }

  // Returns the statements out[i] = …, and puts the entries into blocks: by result, then by argument.
  std::string jacobian_entries(const Partials& own, const Partials& below) {
    const std::size_t n = f_.lead.size();
    // These are true if d equation / d column occurs, or if d result / d lead occurs.
    const auto occurs = [&](std::size_t column) {
      return std::any_of(below.place.begin(), below.place.end(), [&](const auto& row) { return row[n + column] >= 0; });
    };
    const auto through_lead = [&](std::size_t row) {
      return std::any_of(own.place[row].begin(), own.place[row].begin() + static_cast<std::ptrdiff_t>(n),
                         [](std::ptrdiff_t p) { return p >= 0; });
    };
    for (const Column& result : results_)
      for (const Column& argument : symbols_)
        blocks_.push_back({result.size(), argument.size(), decltype(Block::entries)(argument.size())});
    std::string out;
    std::size_t place = 0, column = 0;
    for (std::size_t argument = 0; argument < symbols_.size(); ++argument)
      for (std::size_t c = 0; c < symbols_[argument].size(); ++c, ++column) {
        const bool solved = n > 0 && occurs(column);
        if (solved) {
          for (std::size_t i = 0; i < n; ++i) {
            const std::ptrdiff_t k = below.place[i][n + column];
            out += "  b[" + std::to_string(i) + "] = " + (k < 0 ? "0" : "-e[" + std::to_string(k) + "]") + ";\n";
          }
          out += "  $_solve(at.a, at.order, at.row, at.column, b, s);\n";
        }
        std::size_t row = 0;
        for (std::size_t result = 0; result < results_.size(); ++result) {
          Block& block = blocks_[result * symbols_.size() + argument];
          for (std::size_t r = 0; r < block.rows; ++r, ++row) {
            const std::ptrdiff_t direct = own.place[row][n + column];
            if (direct < 0 && !(solved && through_lead(row))) continue;
            std::string value = direct < 0 ? "0" : "d[" + std::to_string(direct) + "]";
            if (solved)
              for (std::size_t j = 0; j < n; ++j)
                if (own.place[row][j] >= 0)
                  value += " + d[" + std::to_string(own.place[row][j]) + "]*s[" + std::to_string(j) + "]";
            out += "  out[" + std::to_string(place) + "] = " + value + ";\n";
            block.entries[c].push_back({r, place++});
          }
        }
      }
    values_ = place;
    return out;
  }

  // Returns statements that put NaN into the rows of formulas without a value. `values`: rows, and the places of their
  // values in d.
  std::string missing_entries(const std::vector<std::pair<std::size_t, std::size_t>>& values) const {
    std::string out;
    for (const auto& [row, value] : values) {
      const std::size_t result = row < results_[0].size() ? 0 : 1, r = result == 0 ? row : row - results_[0].size();
      std::string of_row;
      for (std::size_t argument = 0; argument < symbols_.size(); ++argument)
        for (const auto& column : blocks_[result * symbols_.size() + argument].entries)
          for (const auto& [entry, place] : column)
            if (entry == r) of_row += "out[" + std::to_string(place) + "] = ";
      if (!of_row.empty()) out += "  if (isnan(d[" + std::to_string(value) + "])) " + of_row + "NAN;\n";
    }
    return out;
  }

  static std::string ccs(const Block& b) {
    std::string out = std::to_string(b.rows) + ", " + std::to_string(b.columns) + ", 0";
    std::size_t total = 0;
    for (const auto& column : b.entries) out += ", " + std::to_string(total += column.size());
    for (const auto& column : b.entries)
      for (const auto& [row, place] : column) out += ", " + std::to_string(row);
    return out;
  }

  static Block dense(std::size_t rows) { return {rows, 1, {dense_column(rows)}}; }
  static std::vector<std::pair<std::size_t, std::size_t>> dense_column(std::size_t rows) {
    std::vector<std::pair<std::size_t, std::size_t>> out;
    for (std::size_t r = 0; r < rows; ++r) out.push_back({r, r});
    return out;
  }
  static Block empty(std::size_t rows) { return {rows, 1, {{}}}; }

  static std::string cases(const std::string& function, const std::vector<std::string>& values, const char* otherwise) {
    std::string out = function + "(casadi_int i)\n{\n  switch (i) {\n";
    for (std::size_t i = 0; i < values.size(); ++i)
      out += "  case " + std::to_string(i) + ": return " + values[i] + ";\n";
    return out + "  default: return " + otherwise + ";\n  }\n}\n";
  }

  // Returns the functions that CasADi calls to query a function: names and sparsities of its arguments and results.
  static std::string asked(const std::string& function, const std::vector<std::string>& in,
                           const std::vector<Block>& in_blocks, const std::vector<std::string>& out_names,
                           const std::vector<Block>& out_blocks) {
    std::string out = "casadi_int " + function + "_n_in(void) { return " + std::to_string(in.size()) +
                      "; }\ncasadi_int " + function + "_n_out(void) { return " + std::to_string(out_names.size()) +
                      "; }\n";
    const auto quoted = [](const std::vector<std::string>& list) {
      std::vector<std::string> all;
      for (const std::string& s : list) all.push_back("\"" + s + "\"");
      return all;
    };
    out += cases("const char *" + function + "_name_in", quoted(in), "0");
    out += cases("const char *" + function + "_name_out", quoted(out_names), "0");
    for (const bool into : {true, false}) {
      const std::vector<Block>& blocks = into ? in_blocks : out_blocks;
      const std::string name = function + (into ? "_sparsity_in" : "_sparsity_out");
      std::vector<std::string> tables;
      for (std::size_t i = 0; i < blocks.size(); ++i) {
        tables.push_back(name + "_" + std::to_string(i));
        out += "static const casadi_int " + tables.back() + "[] = {" + ccs(blocks[i]) + "};\n";
      }
      out += cases("const casadi_int *" + name, tables, "0");
    }
    return out + "int " + function +
           "_work(casadi_int *sz_arg, casadi_int *sz_res, casadi_int *sz_iw, casadi_int *sz_w)\n{\n  if (sz_arg) "
           "*sz_arg = " +
           std::to_string(in.size()) + ";\n  if (sz_res) *sz_res = " + std::to_string(out_names.size()) +
           ";\n  if (sz_iw) *sz_iw = 0;\n  if (sz_w) *sz_w = 0;\n  return 0;\n}\n\n";
  }

  std::string interface() const {
    std::string out =
        R"(static const double $_zeros[$_STATES + $_INPUTS + $_PARAMETERS + 1];

int $(const casadi_real **arg, casadi_real **res, casadi_int *iw, casadi_real *w, int mem)
{
  const double t = arg[0] ? arg[0][0] : 0, *x = arg[1] ? arg[1] : $_zeros, *u = arg[2] ? arg[2] : $_zeros, *p = arg[3] ? arg[3] : $_zeros;
)" + std::string("  double own_rates[$_rates_size], own_outputs[$_outputs_size];\n") +
        solved() +
        R"(  (void)iw, (void)w, (void)mem;
  $_rates_constants(p, own_rates), $_outputs_constants(p, own_outputs);
  if (res[0]) $_rates(t, x, lead, u, own_rates, res[0]);
  if (res[1]) $_outputs(t, x, lead, u, own_outputs, res[1]);
  return status;
}

)";
    const std::vector<std::string> in{"t", "x", "u", "p"}, results{"dx", "y"};
    std::vector<Block> in_blocks, result_blocks, nothing;
    for (const Column& s : symbols_) in_blocks.push_back(dense(s.size()));
    for (const Column& r : results_) result_blocks.push_back(dense(r.size())), nothing.push_back(empty(r.size()));
    out += asked("$", in, in_blocks, results, result_blocks);
    out += "double $_default_in(casadi_int i) { (void)i; return 0; }\n\n";
    std::vector<std::string> jac_in = in, jac_out;
    for (const std::string& r : results) jac_in.push_back("out_" + r);
    std::vector<Block> jac_in_blocks = in_blocks;
    jac_in_blocks.insert(jac_in_blocks.end(), nothing.begin(), nothing.end());
    for (const std::string& r : results)
      for (const std::string& a : in) jac_out.push_back("jac_" + r + "_" + a);
    out += "int jac_$(const casadi_real **arg, casadi_real **res, casadi_int *iw, casadi_real *w, int mem)\n{\n"
           "  const double t = arg[0] ? arg[0][0] : 0, *x = arg[1] ? arg[1] : $_zeros, *u = arg[2] ? arg[2] : $_zeros, "
           "*p = "
           "arg[3] ? arg[3] : $_zeros;\n  double v[" +
           std::to_string(values_ + 1) +
           "];\n  const int status = $_jacobian(t, x, u, p, v);\n  (void)iw, (void)w, (void)mem;\n";
    for (std::size_t b = 0; b < blocks_.size(); ++b) {
      std::string body;
      std::size_t k = 0;
      for (const auto& column : blocks_[b].entries)
        for (const auto& [row, place] : column)
          body +=
              "    res[" + std::to_string(b) + "][" + std::to_string(k++) + "] = v[" + std::to_string(place) + "];\n";
      if (!body.empty()) out += "  if (res[" + std::to_string(b) + "]) {\n" + body + "  }\n";
    }
    out += "  return status;\n}\n\n";
    return out + asked("jac_$", jac_in, jac_in_blocks, jac_out, blocks_);
  }

  const RateFormulas& f_;
  bool used_sign_ = false;
  std::string name_, made_by_;
  std::vector<Column> symbols_, results_;  // t, x, u, p; dx, y
  std::vector<Block> blocks_;
  std::size_t values_ = 0;
};

}  // namespace

std::string emit_casadi(const RateFormulas& formulas, const std::string& name, const std::string& made_by) {
  return CasadiFile(formulas, name, made_by).text();
}

}  // namespace anholon
