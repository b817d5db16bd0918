// Shipped models with a line `# oracle: NAME`, and the reference data test/oracle/data/NAME.json.
#pragma once
#include <regex>

#include <nlohmann/json.hpp>

#include "support/models.h"

namespace anholon::test {

struct OraclePair {
  std::string model, oracle;
};

inline std::vector<OraclePair> oracle_pairs() {
  std::vector<OraclePair> pairs;
  const std::regex line("(?:^|\n)# oracle: (\\S+)");
  for (const std::string& name : shipped_models()) {
    const std::string text = shipped_text(name);
    std::smatch found;
    if (std::regex_search(text, found, line)) pairs.push_back({name, found[1]});
  }
  return pairs;
}

inline nlohmann::json oracle_data(const std::string& name) {
  return nlohmann::json::parse(file_text(source_dir() / "test/oracle/data" / (name + ".json")));
}

// x_2 of the data -> (x, 2); x -> (x, 0).
inline std::pair<std::string, unsigned> split_order(const std::string& symbol) {
  const std::size_t at = symbol.rfind('_');
  if (at == std::string::npos || at + 1 == symbol.size() ||
      symbol.find_first_not_of("0123456789", at + 1) != std::string::npos)
    return {symbol, 0};
  return {symbol.substr(0, at), static_cast<unsigned>(std::stoul(symbol.substr(at + 1)))};
}

}  // namespace anholon::test
