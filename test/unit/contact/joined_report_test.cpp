// The order of events of contacts at one instant.
#include <gtest/gtest.h>

#include "contact/joined_report.h"

namespace anholon {
namespace joined_report_test {

std::vector<std::string> names(const SimulationReport& r) {
  std::vector<std::string> list;
  for (const EventReport& e : r.events) list.push_back(e.name);
  return list;
}

std::vector<Contact> named(const char* first, const char* second) {
  std::vector<Contact> contacts(2);
  contacts[0].name = first, contacts[1].name = second;
  return contacts;
}

TEST(JoinedReport, EventsOfOneInstantAreListedByCause) {
  Model model;
  const std::vector<Contact> contacts = named("floor", "floor.rolling");
  JoinedReport joined(model, contacts);
  joined.event("floor.rests", 1);
  joined.event("floor.sticks", 2);
  for (const char* name : {"floor.rests", "floor.rolling.stops", "half", "floor.sticks", "floor.hits"})
    joined.event(name, 3);
  joined.event("floor.hits", 4);
  // Events of the model, and those of other instants, keep their places.
  const std::vector<std::string> wanted = {"floor.rests", "floor.sticks", "floor.hits",  "floor.rolling.stops",
                                           "half",        "floor.sticks", "floor.rests", "floor.hits"};
  EXPECT_EQ(names(joined.report({}, 5, 0)), wanted);
}

TEST(JoinedReport, AnImpactIsToldWithItsOwnEvent) {
  Model model;
  const std::vector<Contact> contacts = named("b", "a");
  JoinedReport joined(model, contacts);
  joined.event("b.hits", 1);
  joined.event("a.sticks", 1);
  joined.set(1, {{"z'", {-10, ""}, {0, ""}}}, "b.hits");
  const SimulationReport r = joined.report({}, 2, 0);
  ASSERT_EQ(names(r), (std::vector<std::string>{"b.hits", "a.sticks"}));
  EXPECT_EQ(r.events[0].changes.size(), 1U);
  EXPECT_TRUE(r.events[1].changes.empty());
}

}  // namespace joined_report_test
}  // namespace anholon
