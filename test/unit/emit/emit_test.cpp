// The generated texts in detail; test/backends/check_generated.py compiles and runs them.
#include <gtest/gtest.h>

#include "emit/names.h"
#include "emit/text.h"
#include "numeric/number.h"
#include "support/chain.h"
#include "support/models.h"
#include "tape/tape.h"

namespace anholon::emit_test {
namespace {

struct Made {
  System system;
  Structure structure;
};

Made made(const std::string& text) {
  const auto model = test::model_of(text);
  const Mechanics m = mechanics(*model);
  std::vector<std::size_t> constraints;
  for (std::size_t r = 0; r < model->constraints.size(); ++r) constraints.push_back(r);
  Made out{implicit_system(model, m, *find_formulation("routh"), constraints), {}};
  Column values;
  for (const Parameter& p : model->parameters) values.push_back(p.value);
  const Outcome o = analyse(out.system, evaluate_parameters<double>(*model->graph, values), {}, out.structure);
  if (!o.ok()) throw std::runtime_error(o.message);
  return out;
}

std::string bead(const std::string& force, const std::string& more = "") {
  return "coordinates = [\"x\"]\n" + more +
         "[[particle]]\nname = \"a\"\nmass = \"2\"\nposition = [\"x\", \"0\", \"0\"]\n"
         "[[force]]\nname = \"f\"\non = \"a\"\nvector = [\"" +
         force + "\", \"0\", \"0\"]\n";
}

bool holds(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t statements_of_residual(int n) {
  const Made m = made(test::chain_text(n));
  const std::string text = emit_c(m.system, m.structure, {});
  const std::size_t from = text.rfind("motion_residual(double t"), to = text.find("\n}\n", from);
  return static_cast<std::size_t>(std::count(text.begin() + static_cast<std::ptrdiff_t>(from),
                                             text.begin() + static_cast<std::ptrdiff_t>(to), ';'));
}

TEST(EmitNumber, IsExactOrRoundedOnce) {
  const auto text = [](const char* r) { return emit::number(*parse_rational(r)); };
  EXPECT_EQ(text("0"), "0.0");
  EXPECT_EQ(text("3"), "3.0");
  EXPECT_EQ(text("-7"), "-7.0");
  EXPECT_EQ(text("2/3"), "2.0/3.0");
  EXPECT_EQ(text("-2/3"), "-2.0/3.0");
  EXPECT_EQ(text("9.81"), "9.81");
  EXPECT_EQ(text("0.1"), "0.1");
  EXPECT_EQ(text("-0.0125"), "-0.0125");
  EXPECT_EQ(text("1e-9"), "1e-9");
  EXPECT_EQ(text("6.674e-11"), "6.674e-11");
  EXPECT_EQ(text("5.9722e24"), "5.9722e24");
  EXPECT_EQ(text("123456789.5"), "123456789.5");
  EXPECT_EQ(text("1000000000"), "1e9");
  for (const char* r : {"1/3", "100000000000000000000/3", "9007199254740993",
                        "0.1234567890123456789012345678901234567890", "1e300/7", "7/3e300", "123456789/1000000007"}) {
    const std::string t = text(r);
    const std::size_t slash = t.find('/');
    const double value =
        slash == std::string::npos ? std::stod(t) : std::stod(t.substr(0, slash)) / std::stod(t.substr(slash + 1));
    EXPECT_EQ(value, from_rational<double>(*parse_rational(r))) << t;
  }
  EXPECT_THROW(text("1e400"), Failure);
  EXPECT_THROW(text("1e-400"), Failure);
}

TEST(EmitNames, AreIdentifiers) {
  EXPECT_EQ(emit::identifier("lambda.rolling.x", "x"), "lambda_rolling_x");
  EXPECT_EQ(emit::identifier("luo-zhao-example-2", "motion"), "luo_zhao_example_2");
  EXPECT_EQ(emit::identifier("2nd", "motion"), "motion_2nd");
  EXPECT_EQ(emit::identifier("_q", "x"), "x_q");
  EXPECT_EQ(emit::identifier("", "motion"), "motion");
  EXPECT_EQ(emit::identifier("__", "motion"), "motion");
}

TEST(EmitNames, StayApart) {
  const Made m = made("coordinates = [\"x\", \"x_1\", \"w1\", \"int\"]\n[parameters]\nnp = 1\np = 2\n"
                      "[[particle]]\nname = \"a\"\nmass = \"np\"\nposition = [\"x\", \"x_1\", \"w1\"]\n"
                      "[[particle]]\nname = \"b\"\nmass = \"p\"\nposition = [\"int\", \"0\", \"0\"]\n");
  const emit::LocalNames names(m.system, m.structure, emit::motion_between_events(m.system, m.structure, {}));
  Graph& g = *m.system.model->graph;
  std::set<std::string> all;
  for (std::size_t j = 0; j < 4; ++j)
    for (unsigned k = 0; k < 3; ++k) EXPECT_TRUE(all.insert(names.symbol(m.system.symbol(j, k).id)).second);
  for (std::uint32_t i = 0; i < 2; ++i) EXPECT_TRUE(all.insert(names.symbol(g.parameter(i).id)).second);
  for (const char* word : {"int", "np", "p"}) EXPECT_EQ(all.count(word), 0U) << word;
  EXPECT_TRUE(names.taken("w1")) << "so that no intermediate result takes it";
}

TEST(Emit, RefusesWhatHasNoText) {
  const auto model = test::model_of(bead("f", "[functions]\nf = {}\n"));
  const Mechanics m = mechanics(*model);
  const System system = implicit_system(model, m, *find_formulation("routh"), {});
  Structure structure;
  structure.sigma = {{2}};
  structure.transversal = {0};
  structure.c = {0};
  structure.d = {2};
  EXPECT_THROW(emit_c(system, structure, {}), Failure);
  EXPECT_THROW(emit_python(system, structure, {}), Failure);
  const Made big = made(bead("1e-400*x"));
  EXPECT_THROW(emit_c(big.system, big.structure, {}), Failure);
}

TEST(Emit, WritesPowersAndRoots) {
  const Made m = made(bead("(1 + x^2)^(1/2) + (2 + x^2)^(3/2) + (3 + x^2)^(-5/2) + x^9 + (4 + x^2)^(1/3) + x^-1"));
  const std::string c = emit_c(m.system, m.structure, {}), python = emit_python(m.system, m.structure, {});
  EXPECT_TRUE(holds(c, "sqrt(1.0 + ")) << c;
  EXPECT_TRUE(holds(c, "pow(3.0 + ")) << c;
  EXPECT_TRUE(holds(c, ", 2.5)")) << c;
  EXPECT_TRUE(holds(c, "pow(x, 9.0)")) << c;
  EXPECT_TRUE(holds(c, ", 1.0/3.0)")) << c;
  EXPECT_TRUE(holds(python, "**(1.0/3.0)")) << python;
  EXPECT_TRUE(holds(python, "x**9.0")) << python;
}

TEST(Emit, KeepsATitleInItsComment) {
  const Made m = made("title = \"*/ \\\"\\\"\\\" $x$ \\\\\"\n" + bead("x"));
  EmitOptions options;
  options.name = "bead";
  const std::string c = emit_c(m.system, m.structure, options), python = emit_python(m.system, m.structure, options);
  EXPECT_TRUE(holds(c, "* / \"\"\" $x$ \\")) << c.substr(0, 200);
  EXPECT_FALSE(holds(c.substr(c.find("*/")), "$"));
  EXPECT_TRUE(holds(python, "* / \\\"\\\"\\\" $x$ \\\\")) << python.substr(0, 200);
  EXPECT_TRUE(holds(c, "int bead_rhs("));
}

TEST(Emit, OfAChainIsLinearInItsLinks) {
  const std::size_t at16 = statements_of_residual(16), at32 = statements_of_residual(32),
                    at64 = statements_of_residual(64);
  EXPECT_GT(at32, at16);
  EXPECT_LE(at64, at32 + 2 * (at32 - at16) + 64) << at16 << ", " << at32 << ", " << at64;
}

}  // namespace
}  // namespace anholon::emit_test
