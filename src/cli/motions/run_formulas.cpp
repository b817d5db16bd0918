#include "cli/motions/run_formulas.h"

#include <algorithm>

#include "cli/motions/run_info.h"
#include "formula/formula.h"
#include "modelfile/read.h"
#include "report/columns.h"
#include "result/choose_columns.h"

namespace anholon::cli {

namespace {

bool holds(const RunTable& table, const std::string& name) {
  return table.find(name) < table.columns.size() ||
         std::any_of(
             table.columns.begin(), table.columns.end(), [&](const std::string& c) { return matches(name, c); });
}

void add(RunFile& run, const Reader& in, const std::string& name) {
  Value value;
  try {
    value = evaluate(parse_formula(FormulaText(name, Span{1, 1, 1})), *in.names);
  } catch (const Failure&) {
    return;
  }
  const Expr* e = std::get_if<Expr>(&value);
  if (!e)
    throw UsageError{"error: '" + name + "' is " + type_name(value) + ", no number\nhint: " +
                     (std::holds_alternative<Vector>(value)
                          ? "a component, as " + name + ".x, or its length, norm(" + name + ")"
                          : "a formula that is a number") +
                     "\n"};
  std::vector<double> values;
  if (!at_rows(*in.model, run, put_masses(*in.model, *e), values))
    throw UsageError{"error: '" + name +
                     "' needs numbers that the run does not hold\nhint: write it into the model as an [output], and "
                     "simulate anew\n"};
  run.table.columns.push_back(name);
  run.table.values.push_back(values);
  run.table.texts.emplace_back();
}

}  // namespace

Reader model_of(const RunFile& run, const ModelCommand& was) {
  SourceText source{run.model[0].name, run.model[0].text};
  for (std::size_t k = 1; k < run.model.size(); ++k) source.others.push_back({run.model[k].name, run.model[k].text});
  return read(was, std::move(source));
}

void add_formulas(RunFile& run, std::vector<std::string> names) {
  std::erase_if(names, [&](const std::string& n) { return holds(run.table, n); });
  if (names.empty() || run.model.empty() || run.table.rows() == 0) return;
  const Reader in = model_of(run, options_of(run, {}));
  for (const std::string& name : names)
    if (run.table.find(name) == run.table.columns.size()) add(run, in, name);
}

}  // namespace anholon::cli
