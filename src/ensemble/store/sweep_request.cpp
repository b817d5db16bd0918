#include "ensemble/store/sweep_request.h"

#include <algorithm>
#include <cstring>

#include <nlohmann/json.hpp>

#include "base/json.h"

namespace anholon {

namespace {

// In folders of the first version columns of parameters are in SI units. The second one is that of sweeps of which
// columns are in other units.
constexpr int kVersion = 1, kVersionWithUnits = 2;
constexpr const char *kBase = "base file ", *kTable = "data file ";

// Returns a text as JSON gives it back: bytes that are not UTF-8 are lost.
std::string as_kept(const std::string& text) {
  return nlohmann::json::parse(JsonWriter().string(text).text()).get<std::string>();
}

}  // namespace

std::string request_json(const SweepRequest& r, const std::string& program) {
  JsonWriter j;
  j.open_object().key("format").string("anholon sweep").key("format_version");
  j.integer(r.units.empty() ? kVersion : kVersionWithUnits);
  j.key("program").string(program);
  j.key("cases").integer(static_cast<long long>(r.cases)).key("chunk").integer(static_cast<long long>(r.chunk));
  j.key("columns").open_array();
  for (const std::string& name : r.columns) j.string(name);
  j.close().key("asked").open_object();
  for (const auto& [name, text] : r.asked) j.key(name).string(text);
  j.close();
  if (!r.units.empty()) j.key("units").string(r.units);
  if (!r.recipe.empty()) j.key("recipe").string(r.recipe);
  if (!r.model_name.empty()) j.key("model_name").string(r.model_name);
  return j.close().text() + "\n";
}

SweepRequest request_of(const std::string& text, const std::string& path) {
  using Json = nlohmann::ordered_json;
  const auto refuse = [&](const std::string& why) -> SweepRequest {
    throw Failure({}, path + " " + why, "it was changed, or another program wrote it");
  };
  const Json j = Json::parse(text, nullptr, false);
  if (!j.is_object() || j.value("format", Json()) != "anholon sweep") return refuse("does not tell of a sweep");
  const Json version = j.value("format_version", Json());
  if (version != kVersion && version != kVersionWithUnits)
    return refuse("is of version " + version.dump() + ", and this program reads the versions " +
                  std::to_string(kVersion) + " and " + std::to_string(kVersionWithUnits));
  const auto count = [&](const char* key) {
    const auto at = j.find(key);
    return at != j.end() && at->is_number_unsigned() ? at->get<std::size_t>() : std::size_t{0};
  };
  SweepRequest r;
  r.cases = count("cases"), r.chunk = count("chunk");
  const auto columns = j.find("columns"), asked = j.find("asked");
  if (r.cases == 0 || r.chunk == 0 || columns == j.end() || !columns->is_array() || asked == j.end() ||
      !asked->is_object())
    return refuse("is damaged");
  for (const Json& name : *columns) {
    if (!name.is_string()) return refuse("is damaged");
    r.columns.push_back(name.get<std::string>());
  }
  for (const auto& [name, value] : asked->items()) {
    if (!value.is_string()) return refuse("is damaged");
    r.asked.emplace_back(name, value.get<std::string>());
  }
  if (const auto recipe = j.find("recipe"); recipe != j.end() && recipe->is_string())
    r.recipe = recipe->get<std::string>();
  if (const auto units = j.find("units"); units != j.end() && units->is_string()) r.units = units->get<std::string>();
  if (r.units.empty() != (version == kVersion)) return refuse("is damaged");
  if (const auto named = j.find("model_name"); named != j.end() && named->is_string())
    r.model_name = named->get<std::string>();
  if (const auto made = j.find("program"); made != j.end() && made->is_string()) r.program = made->get<std::string>();
  return r;
}

void add_files(std::vector<std::pair<std::string, std::string>>& asked, const SourceText& model) {
  for (std::size_t k = 0; k < model.others.size(); ++k)
    asked.emplace_back(kBase + std::to_string(k + 1), model.others[k].text);
  for (const SourceText& s : model.tables) {
    const std::string name = as_kept(kTable + s.name);
    if (std::none_of(asked.begin(), asked.end(), [&](const auto& each) { return each.first == name; }))
      asked.emplace_back(name, as_kept(s.text));
  }
}

SourceText model_asked(const SweepRequest& r) {
  SourceText source{r.model_name.empty() ? "model" : r.model_name, {}};
  for (const auto& [name, text] : r.asked) {
    if (name == "model") source.text = text;
    if (name.starts_with(kBase)) source.others.push_back({name, text});
    if (name.starts_with(kTable)) source.tables.push_back({name.substr(std::strlen(kTable)), text});
  }
  return source;
}

std::optional<std::vector<std::string>> judgement_text(const std::string& json) {
  using Json = nlohmann::ordered_json;
  const Json j = Json::parse(json, nullptr, false);
  if (!j.is_object()) return std::nullopt;
  const auto text = j.find("text");
  if (text == j.end() || !text->is_array()) return std::nullopt;
  std::vector<std::string> lines;
  for (const Json& line : *text)
    if (line.is_string()) lines.push_back(line.get<std::string>());
  return lines;
}

void add_stopped(StoppedByKind& all, const std::string& json) {
  try {
    const nlohmann::json list = nlohmann::json::parse(json);
    for (const nlohmann::json& each : list) {
      StoppedCases next{each.at("cases"), each.at("first"), {}};
      const std::string called = each.at("outcome");
      auto kind = OutcomeKind::finished;
      while (kind != OutcomeKind::too_large && called != name(kind))
        kind = static_cast<OutcomeKind>(static_cast<std::uint8_t>(kind) + 1);
      next.outcome = {kind, each.at("message"), each.at("hint")};
      StoppedCases& known = all[kind];
      next.count += known.count;
      if (known.count == 0 || next.first < known.first)
        known = std::move(next);
      else
        known.count = next.count;
    }
  } catch (const nlohmann::json::exception&) {
    throw Failure({}, "what a part tells of cases that stopped is damaged");
  }
}

}  // namespace anholon
