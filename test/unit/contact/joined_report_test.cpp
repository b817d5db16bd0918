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

TEST(JoinedReport, EventsOfOneInstantAreListedByCause) {
  Model model;
  std::vector<Contact> contacts(2);
  contacts[0].name = "floor", contacts[1].name = "floor.rolling";
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

}  // namespace joined_report_test
}  // namespace anholon
