#include "proof/checker/certificate.h"

#include <algorithm>
#include <array>
#include <set>

#include <nlohmann/json.hpp>

#include "base/diagnostic.h"
#include "base/json.h"
#include "proof/checker/functions.h"

namespace anholon {

namespace {

constexpr std::size_t kLongestText = std::size_t{64} << 20;
constexpr std::size_t kMostSymbols = 10'000;
constexpr std::size_t kMostNodes = 1'000'000;
constexpr std::size_t kMostTerms = 8'000'000;  // the limit of all nodes and claims together
constexpr std::size_t kMostClaims = 100'000;
constexpr std::size_t kMostBits = std::size_t{1} << 28;  // the limit of all rationals together
constexpr std::size_t kLongestString = 10'000;
constexpr long kLargestExponent = 1'000'000'000;
constexpr int kDeepest = 8;

constexpr std::array kKinds = {"agree", "differ", "kernel", "pivot"};

}  // namespace

const char* name(Certificate::ClaimKind kind) { return kKinds[static_cast<std::size_t>(kind)]; }

const std::vector<std::string>& Certificate::functions() {
  static const std::vector<std::string> all = [] {
    std::vector<std::string> names;
    for (const verification::KnownFunction& f : verification::functions()) names.push_back(f.name);
    return names;
  }();
  return all;
}

bool Certificate::has_function(std::string_view name) {
  const auto& all = functions();
  return std::find(all.begin(), all.end(), name) != all.end();
}

// Writing

namespace {

void write(JsonWriter& j, const Certificate::Node& n, std::size_t index) {
  using enum Certificate::Operation;
  j.open_array().integer(static_cast<long long>(index));
  switch (n.operation) {
  case number:
    j.string("number").string(to_string(n.value));
    break;
  case pi:
    j.string("pi");
    break;
  case symbol:
    j.string("symbol").integer(n.symbol);
    break;
  case sum:
    j.string("sum");
    for (const Certificate::Term& t : n.terms) j.open_array().string(to_string(t.weight)).integer(t.node).close();
    break;
  case product:
    j.string("product");
    for (const Certificate::Term& t : n.terms) j.open_array().integer(t.node).string(to_string(t.weight)).close();
    break;
  case function:
  case atan2:
    j.string(n.operation == atan2 ? "atan2" : n.function);
    for (const Certificate::Term& t : n.terms) j.integer(t.node);
    break;
  }
  j.close();
}

void write(JsonWriter& j, const Certificate::Witness& w) {
  j.open_object();
  j.key("values").open_array();
  for (const Certificate::Value& v : w.values) j.open_array().integer(v.symbol).string(to_string(v.value)).close();
  j.close().key("enclosed").open_array();
  for (const Certificate::Enclosed& e : w.enclosed)
    j.open_array().integer(e.symbol).string(to_string(e.midpoint)).string(to_string(e.radius)).close();
  j.close().key("equations").open_array();
  for (const Certificate::Index node : w.equations) j.integer(node);
  j.close().close();
}

}  // namespace

std::string to_json(const Certificate& c) {
  JsonWriter j;
  j.open_object();
  j.key("format").string("anholon-certificate").key("version").integer(1);
  j.key("program").string(c.program).key("model").string(c.model).key("source_hash").string(c.source_hash);
  j.key("hypotheses").open_array();
  for (const std::string& h : c.hypotheses) j.new_line().string(h);
  j.close().key("meaning").string(c.meaning);
  j.key("symbols").open_array();
  for (const std::string& s : c.symbols) j.string(s);
  j.close().key("nodes").open_array();
  for (std::size_t i = 0; i < c.nodes.size(); ++i) write(j.new_line(), c.nodes[i], i);
  j.close().key("claims").open_array();
  for (const Certificate::Claim& claim : c.claims) {
    j.open_object();
    j.key("kind").string(name(claim.kind)).key("a").string(claim.a).key("b").string(claim.b);
    j.key("component").string(claim.component).key("left").integer(claim.left);
    j.key("right").open_array();
    for (const Certificate::Pair& p : claim.right) j.open_array().integer(p.coefficient).integer(p.node).close();
    j.close();
    if (claim.witness) write(j.key("witness"), *claim.witness);
    j.close();
  }
  return j.close().close().text() + "\n";
}

// Reading

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& where, const std::string& what) {
  throw Failure(Span{0, 0, 0}, where.empty() ? what : where + ": " + what);
}

std::string in_quotes(const std::string& s) {
  return "'" + json_escape(s.size() > 60 ? s.substr(0, 60) + "…" : s) + "'";
}

// Excessive depth and repeated keys are refused during parsing, before anything is built from them.
Json parse(std::string_view text) {
  if (text.size() > kLongestText)
    fail("", "the certificate is longer than " + std::to_string(kLongestText >> 20) + " MiB");
  std::vector<std::set<std::string>> keys;
  const auto watch = [&keys](int depth, Json::parse_event_t event, Json& parsed) {
    using enum Json::parse_event_t;
    if (depth > kDeepest) fail("", "brackets are nested deeper than " + std::to_string(kDeepest));
    if (event == object_start) keys.emplace_back();
    if (event == object_end && !keys.empty()) keys.pop_back();
    if (event == key && !keys.empty() && !keys.back().insert(parsed.get_ref<const std::string&>()).second)
      fail("", "the key " + in_quotes(parsed.get<std::string>()) + " occurs twice in one object");
    return true;
  };
  try {
    return Json::parse(text.begin(), text.end(), watch);
  } catch (const Json::exception& e) {
    const std::string what = e.what();  // "[json.exception.parse_error.101] parse error at line …"
    const std::size_t end = what.find("] ");
    std::string message;
    for (const char ch : end == std::string::npos ? what : what.substr(end + 2))
      message += static_cast<unsigned char>(ch) < 0x20 || static_cast<unsigned char>(ch) > 0x7e ? '?' : ch;
    fail("", "not JSON: " + message.substr(0, 300));
  }
}

class CertificateReader {
 public:
  Certificate run(const Json& root) {
    check_keys(root, "",
               {"format", "version", "program", "model", "source_hash", "hypotheses", "meaning", "symbols", "nodes",
                "claims"});
    if (string(root, "", "format") != "anholon-certificate") fail("format", "this is not a certificate of anholon");
    const Json& version = member(root, "", "version");
    if (!version.is_number_integer() || version != 1) fail("version", "only version 1 is known");
    c_.program = string(root, "", "program");
    c_.model = string(root, "", "model");
    c_.source_hash = string(root, "", "source_hash");
    c_.meaning = string(root, "", "meaning");
    c_.hypotheses = strings(root, "hypotheses", 1000);
    c_.symbols = strings(root, "symbols", kMostSymbols);
    const std::set<std::string> names(c_.symbols.begin(), c_.symbols.end());
    if (names.size() != c_.symbols.size()) fail("symbols", "a name occurs twice");
    const Json& nodes = array(root, "", "nodes", kMostNodes);
    c_.nodes.reserve(nodes.size());
    for (const Json& n : nodes) c_.nodes.push_back(node(n, at("nodes", c_.nodes.size())));
    const Json& claims = array(root, "", "claims", kMostClaims);
    c_.claims.reserve(claims.size());
    for (const Json& claim_json : claims) c_.claims.push_back(claim(claim_json, at("claims", c_.claims.size())));
    return std::move(c_);
  }

 private:
  using Index = Certificate::Index;

  static std::string at(const std::string& where, std::size_t i) { return where + "[" + std::to_string(i) + "]"; }
  static std::string path(const std::string& where, const char* key) { return where.empty() ? key : where + "." + key; }

  static void check_keys(const Json& object, const std::string& where, const std::vector<std::string>& known) {
    if (!object.is_object()) fail(where, "an object {…} is expected");
    for (const auto& item : object.items())
      if (std::find(known.begin(), known.end(), item.key()) == known.end())
        fail(where, "the key " + in_quotes(item.key()) + " is not known");
  }
  static const Json& member(const Json& object, const std::string& where, const char* key) {
    const auto it = object.find(key);
    if (it == object.end()) fail(where, std::string("the key '") + key + "' is missing");
    return *it;
  }
  static const Json& array(const Json& object, const std::string& where, const char* key, std::size_t most) {
    const Json& a = member(object, where, key);
    if (!a.is_array()) fail(path(where, key), "a list […] is expected");
    if (a.size() > most) fail(path(where, key), "more than " + std::to_string(most) + " entries");
    return a;
  }
  static std::string string(const Json& value, const std::string& where) {
    if (!value.is_string()) fail(where, "a text is expected");
    const auto& s = value.get_ref<const std::string&>();
    if (s.size() > kLongestString) fail(where, "a text longer than " + std::to_string(kLongestString) + " bytes");
    return s;
  }
  static std::string string(const Json& object, const std::string& where, const char* key) {
    return string(member(object, where, key), path(where, key));
  }
  static std::vector<std::string> strings(const Json& object, const char* key, std::size_t most) {
    std::vector<std::string> list;
    for (const Json& s : array(object, "", key, most)) list.push_back(string(s, at(key, list.size())));
    return list;
  }

  static Index index(const Json& value, std::size_t end, const std::string& where, const char* what) {
    if (!value.is_number_unsigned()) fail(where, std::string("the number of ") + what + " is expected");
    const auto i = value.get<std::uint64_t>();
    if (i >= end)
      fail(where, std::string(what) + " " + std::to_string(i) +
                      (end == 0 ? " is not there yet" : " is not below " + std::to_string(end)));
    return static_cast<Index>(i);
  }
  Index earlier(const Json& value, const std::string& where) {
    count_term(where);
    return index(value, c_.nodes.size(), where, "a node");
  }
  Index symbol(const Json& value, const std::string& where) {
    return index(value, c_.symbols.size(), where, "a symbol");
  }

  Rational rational(const Json& value, const std::string& where) {
    const std::string text = string(value, where);
    const auto r = parse_rational(text);
    if (!r) fail(where, in_quotes(text) + " is not a rational number");
    bits_ += r->bits();
    if (bits_ > kMostBits) fail(where, "the numbers have too many digits altogether");
    return *r;
  }
  void count_term(const std::string& where) {
    if (++terms_ > kMostTerms) fail(where, "more than " + std::to_string(kMostTerms) + " terms altogether");
  }
  static void length(const Json& list, std::size_t n, const std::string& where, const char* what) {
    if (!list.is_array() || list.size() != n) fail(where, std::string(what) + " is expected");
  }

  Certificate::Node node(const Json& json, const std::string& where) {
    using Operation = Certificate::Operation;
    if (!json.is_array() || json.size() < 2) fail(where, "[number of the node, operation, …] is expected");
    if (!json[0].is_number_unsigned() || json[0].get<std::uint64_t>() != c_.nodes.size())
      fail(where, "a node begins with its own number, " + std::to_string(c_.nodes.size()));
    const std::string operation = string(json[1], where);
    Certificate::Node n;
    if (operation == "number") {
      length(json, 3, where, "[i, \"number\", \"p/q\"]");
      n.operation = Operation::number;
      n.value = rational(json[2], where);
    } else if (operation == "pi") {
      length(json, 2, where, "[i, \"pi\"]");
      n.operation = Operation::pi;
    } else if (operation == "symbol") {
      length(json, 3, where, "[i, \"symbol\", k]");
      n.operation = Operation::symbol;
      n.symbol = symbol(json[2], where);
    } else if (operation == "sum" || operation == "product") {
      const bool is_sum = operation == "sum";
      n.operation = is_sum ? Operation::sum : Operation::product;
      n.terms.reserve(json.size() - 2);
      for (std::size_t k = 2; k < json.size(); ++k) {
        length(json[k], 2, where, is_sum ? "a term [\"coefficient\", node]" : "a factor [node, \"exponent\"]");
        const Json &weight = json[k][is_sum ? 0 : 1], &operand = json[k][is_sum ? 1 : 0];
        n.terms.push_back({rational(weight, where), earlier(operand, where)});
        const Rational& w = n.terms.back().weight;
        if (!is_sum && (::abs(w.get_num()) > kLargestExponent || w.get_den() > kLargestExponent))
          fail(where, "the exponent " + in_quotes(to_string(w)) + " is too large");
      }
    } else if (operation == "atan2") {
      length(json, 4, where, "[i, \"atan2\", y, x]");
      n.operation = Operation::atan2;
      n.terms = {{Rational(1), earlier(json[2], where)}, {Rational(1), earlier(json[3], where)}};
    } else if (Certificate::has_function(operation)) {
      length(json, 3, where, "[i, function, node]");
      n.operation = Operation::function;
      n.function = operation;
      n.terms = {{Rational(1), earlier(json[2], where)}};
    } else {
      fail(where, "there is no operation " + in_quotes(operation));
    }
    return n;
  }

  Certificate::Claim claim(const Json& json, const std::string& where) {
    check_keys(json, where, {"kind", "a", "b", "component", "left", "right", "witness"});
    Certificate::Claim claim;
    const std::string kind = string(json, where, "kind");
    const auto it = std::find(kKinds.begin(), kKinds.end(), kind);
    if (it == kKinds.end()) fail(path(where, "kind"), "there is no kind " + in_quotes(kind) + " of claim");
    claim.kind = static_cast<Certificate::ClaimKind>(it - kKinds.begin());
    claim.a = string(json, where, "a");
    claim.b = string(json, where, "b");
    claim.component = string(json, where, "component");
    claim.left = earlier(member(json, where, "left"), path(where, "left"));
    for (const Json& pair : array(json, where, "right", kMostTerms)) {
      const std::string here = at(path(where, "right"), claim.right.size());
      length(pair, 2, here, "[coefficient node, node]");
      claim.right.push_back({earlier(pair[0], here), earlier(pair[1], here)});
    }
    if (const auto w = json.find("witness"); w != json.end()) claim.witness = witness(*w, path(where, "witness"));
    if (!claim.says_zero() && !claim.witness) fail(where, "a claim of kind '" + kind + "' needs a witness");
    if (claim.says_zero() && claim.witness) fail(where, "a claim of kind '" + kind + "' has no witness");
    return claim;
  }

  Certificate::Witness witness(const Json& json, const std::string& where) {
    check_keys(json, where, {"values", "enclosed", "equations"});
    Certificate::Witness w;
    std::vector<bool> seen(c_.symbols.size(), false);
    const auto once = [&](Index s, const std::string& here) {
      if (seen[s]) fail(here, "the symbol " + in_quotes(c_.symbols[s]) + " has two values");
      seen[s] = true;
      return s;
    };
    for (const Json& v : array(json, where, "values", kMostSymbols)) {
      const std::string here = at(path(where, "values"), w.values.size());
      length(v, 2, here, "[symbol, \"value\"]");
      w.values.push_back({once(symbol(v[0], here), here), rational(v[1], here)});
    }
    for (const Json& e : array(json, where, "enclosed", kMostSymbols)) {
      const std::string here = at(path(where, "enclosed"), w.enclosed.size());
      length(e, 3, here, "[symbol, \"midpoint\", \"radius\"]");
      w.enclosed.push_back({once(symbol(e[0], here), here), rational(e[1], here), rational(e[2], here)});
      if (w.enclosed.back().radius <= 0) fail(here, "the radius is not positive");
    }
    for (const Json& node : array(json, where, "equations", kMostSymbols))
      w.equations.push_back(earlier(node, at(path(where, "equations"), w.equations.size())));
    if (w.equations.size() != w.enclosed.size())
      fail(where, std::to_string(w.equations.size()) + " equations for " + std::to_string(w.enclosed.size()) +
                      " enclosed symbols");
    return w;
  }

  Certificate c_;
  std::size_t terms_ = 0, bits_ = 0;
};

}  // namespace

Certificate read_certificate(std::string_view text) { return CertificateReader().run(parse(text)); }

}  // namespace anholon
