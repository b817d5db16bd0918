// Ten thousand random systems with events, 300 in the fast suite, are compared with closed forms: the events, their
// order, their times and the end agree, or the run ends with an honest outcome.
#include <cstdio>
#include <cstdlib>

#include <gtest/gtest.h>

#include "simulation/simulate.h"
#include "support/models.h"
#include "support/random_events.h"
#include "support/rows.h"

namespace anholon::random_events_test {
namespace {

constexpr std::size_t kFew = 300, kAll = 10'000;
constexpr long double kTime = 1e-10L, kGrazing = 1e-13L,
                      kSpeed = 10;   // of an event; of its formula, over the slope there
constexpr long double kEnd = 1e-8L;  // error of the state at the end: round-off that events and waves enlarge

struct Verdict {
  bool decided = false, honest = false;
  std::string fault;
};

SimulationReport run(const test::EventModel& m, const std::string& text, test::TextRows& rows) {
  Scenario s;
  SimulationReport r;
  r.outcome = make_scenario(test::model_of(text), *find_formulation("routh"), {}, s);
  if (!r.outcome.ok()) return r;
  SimulationOptions o;
  o.to = Rational(m.end_hundredths(), 100);
  o.tolerance = Rational(1, mpz_class("100000000000000"));
  return simulate(s, o, rows);
}

Verdict judge(std::uint64_t seed) {
  const test::EventModel m(seed);
  const test::EventModel::Course expected = m.course();
  Verdict v;
  if (!expected.decided) return v;
  v.decided = true;
  test::TextRows rows;
  const SimulationReport r = run(m, m.text(), rows);
  std::string found, wanted;
  for (const EventReport& e : r.events) found += " " + e.name + "@" + e.t.text();
  for (const auto& e : expected.events)
    wanted += " " + m.event_name(e.event) + "@" + number_text(static_cast<double>(e.t));
  const std::string both = "\nfound:  " + found + "\nwanted: " + wanted + "\n" + m.text();
  if (!r.outcome.ok()) {
    if (r.outcome.message.find("accumulate") == std::string::npos) v.fault = r.outcome.message + both;
    v.honest = true;
    return v;
  }
  if (r.events.size() != expected.events.size()) {
    v.fault = std::to_string(r.events.size()) + " events, not " + std::to_string(expected.events.size()) + both;
    return v;
  }
  long double carried = 0;  // the shift of later events by events that graze
  for (std::size_t k = 0; k < r.events.size(); ++k) {
    const auto& e = expected.events[k];
    const long double miss = std::abs(std::strtold(r.events[k].t.text().c_str(), nullptr) - e.t);
    if (r.events[k].name != m.event_name(e.event) || miss > kTime + (kGrazing + kSpeed * carried) / e.slope) {
      v.fault = "event " + std::to_string(k) + " misses by " + number_text(static_cast<double>(miss), 3) + both;
      return v;
    }
    carried += kGrazing / e.slope;
  }
  for (std::size_t i = 0; i < m.bodies(); ++i) {
    const auto& names = rows.names();
    const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), m.name(i)) - names.begin());
    const long double x = std::strtold(rows.rows().back()[at].c_str(), nullptr);
    // If an event ends the motion, the last row is the one before it.
    if (!expected.stopped && std::abs(x - expected.x[i]) > (kEnd + kSpeed * carried) * (1 + std::abs(expected.x[i])))
      v.fault = m.name(i) + " ends elsewhere" + both;
  }
  return v;
}

class RandomEvents : public testing::TestWithParam<int> {};
constexpr int kShards = 4;

TEST_P(RandomEvents, AreThoseOfTheClosedForm) {
  const bool all = std::getenv("ANHOLON_LONG") != nullptr;
  const std::size_t count = all ? kAll : kFew;
  std::size_t decided = 0, honest = 0, wrong = 0, seen = 0;
  for (std::size_t seed = static_cast<std::size_t>(GetParam()) + 1; seed <= count; seed += kShards) {
    const Verdict v = judge(seed);
    ++seen;
    decided += v.decided;
    honest += v.honest;
    if (v.fault.empty()) continue;
    if (++wrong <= 3) ADD_FAILURE() << "model " << seed << ": " << v.fault;
  }
  EXPECT_EQ(wrong, 0U);
  EXPECT_GT(decided, seen * 3 / 4) << "the reference must be able to tell";
  EXPECT_LT(honest, seen / 10);
  RecordProperty("decided", static_cast<int>(decided));
  std::printf("%zu models, %zu decided, %zu ended by an outcome, %zu wrong\n", seen, decided, honest, wrong);
}

INSTANTIATE_TEST_SUITE_P(Shards, RandomEvents, testing::Range(0, kShards));

}  // namespace
}  // namespace anholon::random_events_test
