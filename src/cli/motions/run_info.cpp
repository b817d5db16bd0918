#include "cli/motions/run_info.h"

#include "cli/model_options.h"
#include "modelfile/hash.h"
#include "observe/rows/quantity_units.h"

namespace anholon::cli {

RunInfo run_info(const SystemCommand& o, const Reader& in, const Scenario& scenario, const MotionSettings& settings,
                 const std::string& continued) {
  RunInfo info;
  info.title = in.model->title;
  info.command = o.command_line;
  info.created_by = "anholon " ANHOLON_VERSION;
  info.model.push_back({in.source.name, in.source.text});
  for (const SourceText& s : in.source.others) info.model.push_back({s.name, s.text});
  info.units = quantity_units(*in.model, contacts(*in.names));

  const auto one = [&](const char* name, const std::string& word) {
    info.settings[name] = word.empty() ? std::vector<std::string>{} : std::vector<std::string>{word};
  };
  for (const ModelOption& m : model_options()) info.settings[m.name] = o.*m.words;
  if (!o.mode.empty()) info.settings["mode"] = split(o.mode);
  one("t", o.t), one("start", number_text(scenario.state.t));
  for (const MotionOption& m : motion_options()) info.settings[m.name] = words(settings, m);
  one("continued", continued);
  one("model_sha256", model_hash(in.source));
  return info;
}

SystemCommand options_of(const RunInfo& run, SystemCommand o) {
  const auto words = [&](const char* name) {
    const auto it = run.settings.find(name);
    return it == run.settings.end() ? std::vector<std::string>{} : it->second;
  };
  const auto word = [&](const char* name) {
    const std::vector<std::string> list = words(name);
    return list.empty() ? std::string() : list[0];
  };
  for (const ModelOption& m : model_options()) o.*m.words = words(m.name);
  o.t = word("t");
  if (!word("form").empty()) o.motion.form = word("form");
  return o;
}

}  // namespace anholon::cli
