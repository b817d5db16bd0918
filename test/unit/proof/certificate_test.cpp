#include <random>
#include <string>

#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "proof/checker/certificate.h"

namespace anholon::certificate_test {
namespace {

using Operation = Certificate::Operation;

// x sin²(x/2 + π) / √y and atan2, with one claim of each kind.
Certificate sample() {
  Certificate c;
  c.program = "anholon test";
  c.model = "sample \"quoted\"\n";
  c.source_hash = "00ff";
  c.hypotheses = {"ideal reactions", "the same forces"};
  c.meaning = "The forms agree.";
  c.symbols = {"x", "y'"};
  c.nodes = {{Operation::symbol, 0, 0, "", {}},
             {Operation::symbol, 0, 1, "", {}},
             {Operation::pi, 0, 0, "", {}},
             {Operation::number, Rational(-22, 7), 0, "", {}},
             {Operation::sum, 0, 0, "", {{Rational(1, 2), 0}, {1, 2}}},
             {Operation::function, 0, 0, "sin", {{1, 4}}},
             {Operation::product, 0, 0, "", {{1, 0}, {2, 5}, {Rational(-1, 2), 1}}},
             {Operation::atan2, 0, 0, "", {{1, 6}, {1, 3}}},
             {Operation::sum, 0, 0, "", {}}};
  const Certificate::Witness witness{{{0, Rational(1, 3)}}, {{1, Rational(1, 2), Rational(1, 1000)}}, {7}};
  c.claims = {{Certificate::ClaimKind::agree, "routh", "nielsen", "x", 7, {{3, 6}, {0, 1}}, {}},
              {Certificate::ClaimKind::differ, "routh", "tzenoff", "y", 6, {}, witness},
              {Certificate::ClaimKind::kernel, "routh", "", "u1", 8, {}, {}},
              {Certificate::ClaimKind::pivot, "routh", "", "1", 6, {}, witness}};
  return c;
}

std::string refusal(const std::string& text) {
  try {
    read_certificate(text);
  } catch (const Failure& f) {
    return f.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  EXPECT_NE(at, std::string::npos) << what;
  return text.replace(at, what.size(), by);
}

TEST(CertificateFormat, FunctionsAreThoseOfElementaryDef) {
  std::vector<std::string> names;
#define ROW(name, ...) names.push_back(#name);
#include "expr/elementary.def"
#undef ROW
  EXPECT_EQ(Certificate::functions(), names);
  EXPECT_FALSE(Certificate::has_function("sqrt"));
}

TEST(CertificateFormat, ReadsBackWhatItWrites) {
  const std::string text = to_json(sample());
  EXPECT_EQ(to_json(read_certificate(text)), text);
  const Certificate c = read_certificate(text);
  EXPECT_EQ(c.model, sample().model);
  EXPECT_EQ(c.nodes[6].terms[2].weight, Rational(-1, 2));
  EXPECT_EQ(c.claims[0].right[0].node, 6u);
  EXPECT_EQ(c.claims[1].witness->enclosed[0].radius, Rational(1, 1000));
  EXPECT_TRUE(c.claims[2].says_zero());
  EXPECT_FALSE(c.claims[3].says_zero());
}

TEST(CertificateFormat, TheExampleOfTheHeaderIsOne) {
  const std::string text = R"({ "format": "anholon-certificate", "version": 1,
     "program": "anholon 0.1.0", "model": "disc", "source_hash": "", "hypotheses": [""], "meaning": "",
     "symbols": ["x", "x'"],
     "nodes": [[0, "number", "1/2"], [1, "pi"], [2, "symbol", 0], [3, "sum", ["1/2", 2], ["-1", 0]],
               [4, "product", [2, "2"], [3, "-1/2"]], [5, "sin", 4], [6, "atan2", 4, 5]],
     "claims": [{"kind": "differ", "a": "routh", "b": "nielsen", "component": "x", "left": 5, "right": [[3, 4]],
                 "witness": {"values": [[0, "1/3"]], "enclosed": [[1, "1/2", "1/1000"]], "equations": [6]}}] })";
  EXPECT_EQ(read_certificate(text).nodes.size(), 7u);
}

TEST(CertificateFormat, SaysWhatIsWrongAndWhere) {
  const std::string good = to_json(sample());
  const auto bad = [&](const char* what, const char* by) { return refusal(replaced(good, what, by)); };
  EXPECT_EQ(bad("\"version\": 1", "\"version\": 2"), "version: only version 1 is known");
  EXPECT_EQ(bad("anholon-certificate", "something"), "format: this is not a certificate of anholon");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[5, \"sin\", 5]"), "nodes[5]: a node 5 is not below 5");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[5, \"sin\", -1]"), "nodes[5]: the number of a node is expected");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[5, \"sin\", 1e0]"), "nodes[5]: the number of a node is expected");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[5, \"sine\", 4]"), "nodes[5]: there is no operation 'sine'");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[4, \"sin\", 4]"), "nodes[5]: a node begins with its own number, 5");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "[5, \"sin\", 4, 4]"), "nodes[5]: [i, function, node] is expected");
  EXPECT_EQ(bad("[5, \"sin\", 4]", "5"), "nodes[5]: [number of the node, operation, …] is expected");
  EXPECT_EQ(bad("\"-22/7\"", "\"22/0\""), "nodes[3]: '22/0' is not a rational number");
  EXPECT_EQ(bad("\"-22/7\"", "22"), "nodes[3]: a text is expected");
  EXPECT_EQ(bad("\"-1/2\"", "\"1e300\"").substr(0, 50), "nodes[6]: the exponent '10000000000000000000000000");
  EXPECT_EQ(bad("\"symbol\", 1", "\"symbol\", 2"), "nodes[1]: a symbol 2 is not below 2");
  EXPECT_EQ(bad("\"kind\": \"agree\"", "\"kind\": \"agrees\""), "claims[0].kind: there is no kind 'agrees' of claim");
  EXPECT_EQ(bad("\"kind\": \"agree\"", "\"kind\": \"differ\""), "claims[0]: a claim of kind 'differ' needs a witness");
  EXPECT_EQ(bad("\"kind\": \"differ\"", "\"kind\": \"agree\""), "claims[1]: a claim of kind 'agree' has no witness");
  EXPECT_EQ(bad("\"left\": 7", "\"left\": 9"), "claims[0].left: a node 9 is not below 9");
  EXPECT_EQ(bad("\"equations\": [7]", "\"equations\": []"), "claims[1].witness: 0 equations for 1 enclosed symbols");
  EXPECT_EQ(bad("[1, \"1/2\", \"1/1000\"]", "[0, \"1/2\", \"1/1000\"]"),
            "claims[1].witness.enclosed[0]: the symbol 'x' has two values");
  EXPECT_EQ(bad("[1, \"1/2\", \"1/1000\"]", "[1, \"1/2\", \"0\"]"),
            "claims[1].witness.enclosed[0]: the radius is not positive");
  EXPECT_EQ(bad("\"meaning\"", "\"model\""), "the key 'model' occurs twice in one object");
  EXPECT_EQ(bad("\"meaning\"", "\"meanings\""), "the key 'meanings' is not known");
  EXPECT_EQ(bad("\"x\", \"y'\"", "\"x\", \"x\""), "symbols: a name occurs twice");
  EXPECT_EQ(refusal("[]"), "an object {…} is expected");
  EXPECT_EQ(refusal("{}"), "the key 'format' is missing");
  EXPECT_EQ(refusal("").substr(0, 9), "not JSON:");
  EXPECT_EQ(refusal(good + "x").substr(0, 9), "not JSON:");
}

TEST(CertificateFormat, DepthAndSizeAreLimited) {
  EXPECT_EQ(refusal(std::string(3'000'000, '[')), "brackets are nested deeper than 8");
  std::string deep;
  for (int i = 0; i < 200'000; ++i) deep += "{\"a\":";
  EXPECT_EQ(refusal(deep), "brackets are nested deeper than 8");
  EXPECT_EQ(refusal(std::string((std::size_t{64} << 20) + 1, ' ')), "the certificate is longer than 64 MiB");
  EXPECT_EQ(refusal(replaced(to_json(sample()), "ideal reactions", std::string(10'001, 'x'))),
            "hypotheses[0]: a text longer than 10000 bytes");
  // A short text holds huge numbers.
  std::string numbers;
  for (int i = 0; i < 20'000; ++i) numbers += (i ? ",[" : "[") + std::to_string(i) + ",\"number\",\"1e5000\"]";
  const std::string head =
      R"({"format":"anholon-certificate","version":1,"program":"","model":"","source_hash":"","hypotheses":[],"meaning":"","symbols":[],"nodes":[)";
  EXPECT_NE(refusal(head + numbers + R"(],"claims":[]})").find("too many digits"), std::string::npos);
}

// Any bytes are either read or refused by a Failure, and a certificate that is read is written unchanged.
TEST(CertificateFormat, SurvivesMutatedBytes) {
  const std::string good = to_json(sample());
  std::mt19937_64 random(1);
  const auto below = [&](std::size_t n) { return static_cast<std::size_t>(random() % n); };
  const std::string_view letters = "0123456789-/.eE\"[]{},:+ abnxy\\u\x80\xff\n";
  int accepted = 0;
  for (int round = 0; round < 20'000; ++round) {
    std::string text = good;
    for (std::size_t k = 0, n = 1 + below(4); k < n; ++k) {
      const std::size_t at = below(text.size());
      switch (below(4)) {
      case 0:
        text[at] = letters[below(letters.size())];
        break;
      case 1:
        text.erase(at, 1 + below(6));
        break;
      case 2:
        text.insert(at, 1, letters[below(letters.size())]);
        break;
      default:
        text.insert(at, text.substr(below(text.size()), below(30)));
      }
    }
    try {
      const Certificate c = read_certificate(text);
      ++accepted;
      const std::string again = to_json(c);
      EXPECT_EQ(to_json(read_certificate(again)), again);
    } catch (const Failure&) {
    }
  }
  EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace anholon::certificate_test
