#include <cmath>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/diagnostic.h"
#include "base/escape.h"
#include "result/csv.h"
#include "result/json_run.h"
#include "result/table.h"

namespace anholon::table_test {
namespace {

std::string trouble(const std::string& text, bool json = false) {
  try {
    if (json)
      read_json_run(text);
    else
      read_csv(text);
    return "none";
  } catch (const Failure& f) {
    return std::to_string(f.diagnostic.span.line) + ":" + std::to_string(f.diagnostic.span.column) + ": " +
           f.diagnostic.message;
  }
}

RunTable table_of(const std::string& text) {
  const RunFile run = read_csv(text);
  EXPECT_TRUE(run.notes.empty());
  return run.table;
}

TEST(RunTable, KeepsTheDigitsThatADoubleHasNot) {
  const RunTable t = table_of("t,x\n0.50,1.5\n1/3,1.00000000000000000000000000000001e+00\n1e0,nan\n");
  ASSERT_EQ(t.rows(), 3u);
  EXPECT_EQ(t.values[0][0], 0.5);
  EXPECT_EQ(t.values[0][1], 1.0 / 3);
  EXPECT_EQ(t.values[1][1], 1.0);
  EXPECT_EQ(t.text(0, 0), "0.50");
  EXPECT_EQ(t.text(1, 0), "1/3");
  EXPECT_EQ(t.text(0, 1), "1.5");
  EXPECT_EQ(t.text(1, 1), "1.00000000000000000000000000000001e+00");
  EXPECT_TRUE(std::isnan(t.values[1][2]));
  EXPECT_EQ(t.text(2, 1), "nan");
}

TEST(RunTable, HoldsNoTextsWhereTheNumbersSayItAll) {
  const RunTable t = table_of("t,x\n0,0.1\n1,1e-300\n2,-inf\n");
  EXPECT_TRUE(t.texts[0].empty());
  EXPECT_TRUE(t.texts[1].empty());
}

// RFC 4180: a word that holds a comma or a quote is quoted, in each line.
TEST(Csv, QuotedWordsOfRows) {
  const std::string text = "case,case_name,\"q[1,2]\"\n0,\"heavy, big\",1.5\n1,\"q\"\"uote\",2\n2,plain (,3\n";
  const RunTable t = table_of(text);
  EXPECT_EQ(t.columns, (std::vector<std::string>{"case", "case_name", "q[1,2]"}));
  ASSERT_EQ(t.rows(), 3u);
  EXPECT_EQ(t.text(0, 1), "heavy, big");
  EXPECT_EQ(t.text(1, 1), "q\"uote");
  EXPECT_EQ(t.text(2, 1), "plain (");
  EXPECT_EQ(t.values[2][0], 1.5);
  EXPECT_EQ(csv_cells("a[1,2],\"b,\"\"c\","), (std::vector<std::string>{"a[1", "2]", "b,\"c", ""}));
  EXPECT_EQ(trouble("t,a\n0,\"x,y\",1\n"), "2:10: this row has 3 entries, the first line has 2 names");
}

TEST(Csv, CommasInBracketsAndQuotesBelongToNames) {
  EXPECT_EQ(split_csv("t,P[1,2],D(x,4),\"a,\"\"b\",y'"),
            (std::vector<std::string>{"t", "P[1,2]", "D(x,4)", "a,\"b", "y'"}));
  EXPECT_EQ(csv_cell("D(x,4)"), "\"D(x,4)\"");
  EXPECT_EQ(split_csv(csv_cell("a,\"b")), std::vector<std::string>{"a,\"b"});
  EXPECT_EQ(csv_cell("x'"), "x'");
}

TEST(Csv, ForeignFilesAreRead) {
  const RunTable t = table_of("\xEF\xBB\xBFt,x\r\n0,1\r\n1,\r\n");
  EXPECT_EQ(t.columns[0], "t");
  ASSERT_EQ(t.rows(), 2u);
  EXPECT_TRUE(std::isnan(t.values[1][1]));
}

TEST(Csv, WordsMakeAColumnOfWords) {
  const RunTable t = table_of("m,outcome\n1,finished\n2,singular\n");
  EXPECT_EQ(t.text(1, 1), "singular");
  EXPECT_TRUE(std::isnan(t.values[1][1]));
}

// The first cases of a sweep may have no event.
TEST(Csv, AColumnOfWordsMayBeginEmpty) {
  const RunTable t = table_of("case,event,x\n0,,1\n1,far,\n2,,3\n");
  EXPECT_EQ(t.text(1, 1), "far");
  EXPECT_EQ(t.values[2][2], 3);
  EXPECT_EQ(trouble("case,x\n0,1\n1,\n2,far\n"), "4:3: 'far' is not a number");
}

// The rest of a row that a kill leaves is no row.
TEST(Csv, TheRestOfAKilledRun) {
  const RunFile run = read_csv("t,x,y\n0,1,2\n0.5,1.2");
  EXPECT_EQ(run.table.rows(), 1u);
  ASSERT_EQ(run.notes.size(), 1u);
  EXPECT_EQ(run.notes[0], "the file ends in the middle of line 3, which is left out");
  EXPECT_EQ(read_csv("t,x\n0,1\n1,2").notes.size(), 1u);
  EXPECT_EQ(read_csv("t,x\n0,1\n1,2").table.rows(), 2u);
}

TEST(Csv, SaysWhereSomethingIsWrong) {
  EXPECT_EQ(trouble(""), "0:0: the file is empty");
  EXPECT_EQ(trouble("0,1\n2,3\n"), "1:1: the first line has no names of columns");
  EXPECT_EQ(trouble("t,θ,y\n0,1,2\n1,2,oh\n"), "3:5: 'oh' is not a number");
  EXPECT_EQ(trouble("t,x\n0,1\n1\n"), "3:2: this row has 1 entry, the first line has 2 names");
  EXPECT_EQ(trouble("t,x\n0,1\n1,2,3\n"), "3:5: this row has 3 entries, the first line has 2 names");
  EXPECT_EQ(trouble("t,x\n0,1\n\n1,2\n"), "3:1: an empty line between the rows");
  EXPECT_EQ(trouble("t,x\n0,1\n\n"), "none");
}

TEST(Json, KeepsNumbersAndReportAsTheyAreWritten) {
  const std::string report = "{\n  \"model\": \"a \\\"disc\\\"\",\n  \"form\": \"routh\",\n  \"residuals\": {\n    "
                             "\"newton\": 1e-19\n  },\n  \"outcome\": \"finished\"\n}";
  const std::size_t place = report.find("\n  \"residuals\"");
  const std::string text = report.substr(0, place) +
                           "\n  \"columns\": [\"t\", \"x\"],\n  \"rows\": [[0, 1.50], [1, null]]," +
                           report.substr(place) + "\n";
  const RunFile run = read_json_run(text);
  EXPECT_EQ(run.title, "a \"disc\"");
  EXPECT_EQ(run.report, report);
  EXPECT_EQ(run.table.text(0, 1), "1.50");
  EXPECT_TRUE(std::isnan(run.table.values[1][1]));
}

// The outcomes and events of a sweep.
TEST(Json, KeepsWords) {
  RunFile run;
  run.table = table_of("case,outcome,event,x\n0,finished,,1.5\n1,\"a, \"\"b\"\"\",far,\n");
  const std::string text = json_run(run);
  EXPECT_NE(text.find("[[0, \"finished\", null, 1.5], [1, \"a, \\\"b\\\"\", \"far\", null]]"), std::string::npos)
      << text;
  const RunTable again = read_json_run(text).table;
  EXPECT_EQ(again.text(0, 1), "finished");
  EXPECT_EQ(again.text(1, 1), "a, \"b\"");
  EXPECT_TRUE(std::isnan(again.values[2][0]));
}

TEST(Json, SaysWhereSomethingIsWrong) {
  EXPECT_EQ(trouble("{\"columns\": [\"t\"], \"rows\": [[0], [1, 2]]}", true),
            "1:38: this row is longer than the list of columns");
  EXPECT_EQ(trouble("{\"columns\": [\"t\", \"x\"],\n \"rows\": [[0]]}", true),
            "2:14: this row is shorter than the list of columns");
  EXPECT_EQ(trouble("{\"columns\": [\"t\"],\n \"rows\": [[a]]}", true), "2:12: a number is missing");
  EXPECT_EQ(trouble("{\"model\": \"x\"}", true), "0:0: this is not the JSON of a run: it has no columns");
  EXPECT_EQ(trouble("{\"columns\": [\"t\"", true), "1:17: a comma is missing");
  EXPECT_EQ(trouble("{\"a\": " + std::string(100'000, '['), true).substr(0, 2), "1:");
}

TEST(Json, NumbersAreThoseOfJson) {
  for (const char* good : {"0", "-0.5", "1e-300", "1.00000000000000000000000000000001e+00", "12.25E3"})
    EXPECT_EQ(json_number(good), good);
  EXPECT_EQ(json_number(".5"), "0.5");
  EXPECT_EQ(json_number("1/4"), "0.25");
  EXPECT_EQ(json_number("5."), "5");
  EXPECT_EQ(json_number("01"), "1");
}

}  // namespace
}  // namespace anholon::table_test
