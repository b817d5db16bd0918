#include "cli/run_info.h"

#include "base/hash.h"
#include "observe/row_values.h"

namespace anholon::cli {

RunInfo run_info(const Options& o, const Reader& in, const Scenario& scenario, const SimulationOptions& options) {
  RunInfo info;
  info.title = in.model->title;
  info.command = o.command_line;
  info.created_by = "anholon " ANHOLON_VERSION;
  info.model.push_back({in.source.name, in.source.text});
  for (const SourceText& s : in.source.others) info.model.push_back({s.name, s.text});
  info.units = column_units(*in.model);

  const auto set = [&](const char* name, const std::vector<std::string>& words) { info.settings[name] = words; };
  const auto one = [&](const char* name, const std::string& word) {
    info.settings[name] = word.empty() ? std::vector<std::string>{} : std::vector<std::string>{word};
  };
  set("set", o.set), set("case", o.cases), set("q", o.q), set("qdot", o.qdot), set("qddot", o.qddot),
      set("qdddot", o.qdddot);
  set("lambda", o.lambda), set("lambdadot", o.lambdadot), set("eliminate", o.eliminate);
  one("t", o.t), one("start", number_text(scenario.state.t));
  one("form", scenario.system.form->name);
  one("to", options.to ? options.to->get_str() : ""), one("every", options.every ? options.every->get_str() : "");
  std::vector<std::string> at;
  for (const Rational& t : options.at) at.push_back(t.get_str());
  set("at", at);
  one("tolerance", options.tolerance.get_str()), one("numbers", o.numbers), one("digits", std::to_string(o.digits)),
      one("order", std::to_string(o.order));
  one("method", o.method), one("integrator", name(options.integrator)), one("rigorous", o.rigorous),
      one("error-estimate", o.error_estimate);
  one("continued", o.resume);
  one("model_sha256", sha256_text(all_text(in.source)));
  return info;
}

Options options_of(const RunInfo& run, Options o) {
  const auto words = [&](const char* name) {
    const auto it = run.settings.find(name);
    return it == run.settings.end() ? std::vector<std::string>{} : it->second;
  };
  const auto word = [&](const char* name) {
    const std::vector<std::string> list = words(name);
    return list.empty() ? std::string() : list[0];
  };
  o.set = words("set"), o.cases = words("case"), o.q = words("q"), o.qdot = words("qdot"), o.qddot = words("qddot"),
  o.qdddot = words("qdddot");
  o.lambda = words("lambda"), o.lambdadot = words("lambdadot"), o.eliminate = words("eliminate");
  o.t = word("t");
  if (!word("form").empty()) o.form = word("form"), o.form_given = true;
  return o;
}

}  // namespace anholon::cli
