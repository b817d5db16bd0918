// The bands of contacts, from the columns of a run.
#include <gtest/gtest.h>

#include "report/rows/contact_bands.h"

namespace anholon::contact_bands_test {
namespace {

RunTable table() {
  RunTable t;
  t.columns = {"t", "x", "belt.mode", "belt.gap", "belt.normal", "belt.friction", "gear.mode"};
  t.values = NumberColumns({{0, 1, 2, 2, 3},
                            {0, 0, 0, 0, 0},
                            {2, 2, 2, 1, 1},
                            {0, 0, 0, 0, 0},
                            {9, 9, 9, 9, 9},
                            {1, 2, 3, 2, 2},
                            {1, 1, 1, 1, 1}});
  return t;
}

TEST(ContactBands, AreThoseOfTheRows) {
  const std::vector<ContactBand> bands = contact_bands(table(), {});
  ASSERT_EQ(bands.size(), 1u) << "gear.mode is a monitor of the user";
  EXPECT_EQ(bands[0].name, "belt");
  ASSERT_EQ(bands[0].spans.size(), 2u);
  EXPECT_EQ(bands[0].spans[0].mode, 2);
  EXPECT_EQ(bands[0].spans[0].end, 2);
  EXPECT_EQ(bands[0].spans[1].begin, 2);
  EXPECT_EQ(bands[0].spans[1].mode, 1);
  EXPECT_EQ(bands[0].spans[1].end, 3);
}

EventReport event(const std::string& name, double t) {
  EventReport e;
  e.name = name;
  e.t = {t, ""};
  return e;
}

TEST(ContactBands, ChangeAtTheEventsBetweenRows) {
  // The contact slips from 0.2 to 0.7 and from 1.4 on. The row at 2 says that it sticks, so it slips up to the impact
  // at 1.9.
  const std::vector<ContactBand> bands =
      contact_bands(table(), {event("belt.slips", 0.2), event("belt.sticks", 0.7), event("belts.slips", 0.8),
                              event("belt.slips", 1.4), event("belt.hits", 1.9)});
  ASSERT_EQ(bands.size(), 1u);
  std::string modes;
  for (const ContactSpan& s : bands[0].spans) modes += std::to_string(s.mode);
  EXPECT_EQ(modes, "212121");
  const double begins[] = {0, 0.2, 0.7, 1.4, 1.9, 2};
  for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(bands[0].spans[k].begin, begins[k]) << k;
}

TEST(ContactBands, NeedAllColumnsOfAContact) {
  RunTable t = table();
  t.columns[3] = "belt.distance";
  EXPECT_TRUE(contact_bands(t, {}).empty());
}

}  // namespace
}  // namespace anholon::contact_bands_test
