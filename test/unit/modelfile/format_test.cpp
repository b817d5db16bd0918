// `anholon fmt` keeps the content of a file, its order and its comments, and formatting twice changes nothing.
#include <gtest/gtest.h>

#include "modelfile/text/format.h"

namespace anholon::format_test {
namespace {

std::string format(const std::string& text) { return formatted(SourceText{"test.toml", text}); }

TEST(Format, WhatIsDecidedOfTheLayout) {
  const std::pair<const char*, const char*> cases[] = {
      {"", ""},
      {"\n\n\n", ""},
      {"a=1", "a = 1\n"},
      {"a=1\nlong = 2\n", "a    = 1\nlong = 2\n"},
      {"a=1\n\nlong = 2\n", "a = 1\n\nlong = 2\n"},
      {"a=1\n\n\n\n# c\nlong = 2\n", "a = 1\n\n# c\nlong = 2\n"},
      {"a = 1\n[ s ]\n\nb = 2", "a = 1\n\n[s]\nb = 2\n"},
      {"a = 1\n# of s\n[[s]] # here\nb = 2", "a = 1\n\n# of s\n[[s]]  # here\nb = 2\n"},
      {"a = 1 # one\nbb = 22 # two\n", "a  = 1   # one\nbb = 22  # two\n"},
      {"a = 1      # one\nbb = 22 # two\n", "a  = 1     # one\nbb = 22    # two\n"},
      {"a.b . c=1\n\"x'\" = 2\n", "a.b.c = 1\n\"x'\"  = 2\n"},
      {"a = [ 1,2 , 3 ]\n", "a = [1, 2, 3]\n"},
      {"a = [\n\"p\", \"q\"]\n", "a = [\n  \"p\",\n  \"q\",\n]\n"},
      {"a = [] # none\nb = {}\nc = [\n]\n", "a = []  # none\nb = {}\nc = []\n"},
      {"a = [ # first\n1,\n\n# own\n2 # last\n, # after\n# end\n]\n",
       "a = [\n  # first\n  1,\n\n  # own\n  2,  # last\n  # after\n  # end\n]\n"},
      {"a = {b=1,c = { d = [1 ,2] } }", "a = {b = 1, c = {d = [1, 2]}}\n"},
      {"a = '''x'y'''\nb = \"\"\"q\\\"\"\"\" # c", "a = '''x'y'''\nb = \"\"\"q\\\"\"\"\"  # c\n"},
      {"a = \"# no comment\" # one\n", "a = \"# no comment\"  # one\n"},
      {"a = 1 \r\nb = 2\r\n", "a = 1\nb = 2\n"},
      {"\xEF\xBB\xBF"
       "a = 1\n",
       "a = 1\n"},
      {"\"a=b # [c]\" = 1\n'' = 2\n", "\"a=b # [c]\" = 1\n''          = 2\n"},
      {"a = 1979-05-27 07:32:00 # d\n", "a = 1979-05-27 07:32:00  # d\n"},
      {"\"\xCE\xB8\" = 1\nab = 2\n", "\"\xCE\xB8\" = 1\nab  = 2\n"},
  };
  for (const auto& [from, to] : cases) {
    EXPECT_EQ(format(from), to);
    EXPECT_EQ(format(to), to) << "the second time";
  }
}

TEST(Format, BlanksThatAlignTablesBelowEachOtherStay) {
  const std::string text = "a = [\n  {n = 1,    m = 2},\n  {n = 1000, m = 2},\n]\n";
  EXPECT_EQ(format(text), text);
  EXPECT_EQ(format("a = {n = 1,    m = 2}\n"), "a = {n = 1, m = 2}\n");
}

TEST(Format, AWideListHasALineForEachElementOfNumbersAsManyAsFit) {
  std::string words = "a = [", numbers = "b = [";
  for (int i = 0; i < 60; ++i)
    words += (i ? ", \"w" : "\"w") + std::to_string(i) + "\"", numbers += (i ? ", " : "") + std::to_string(1000 + i);
  const std::string w = format(words + "]\n"), n = format(numbers + "]\n");
  EXPECT_EQ(std::count(w.begin(), w.end(), '\n'), 62);
  EXPECT_EQ(std::count(n.begin(), n.end(), '\n'), 6);
  EXPECT_EQ(format(w), w);
  EXPECT_EQ(format(n), n);
}

TEST(Format, NothingIsMadeOfWhatIsNoToml) {
  for (const char* text : {"a = ", "a = [1", "= 1", "a = \"x", "[a", "a = 1 b = 2"})
    EXPECT_THROW(format(text), Failure) << text;
}

// The comparison at run time must notice each of these differences.
TEST(Format, ContentIsComparedToTheLastCharacterAndInOrder) {
  const auto tree = [](const std::string& text) { return read_toml(SourceText{"test.toml", text}); };
  const std::string text = "a = 1\nb = [\"x\", true]\n[c]\nd = {e = \"f\"}\n";
  EXPECT_TRUE(same_content(tree(text), tree("a   =   1 # c\nb = [\n\"x\",\ntrue]\nc.d.e = \"f\"\n")));
  for (const char* other :
       {"a = 1.0\nb = [\"x\", true]\n[c]\nd = {e = \"f\"}\n", "a = \"1\"\nb = [\"x\", true]\n[c]\nd = {e = \"f\"}\n",
        "b = [\"x\", true]\na = 1\n[c]\nd = {e = \"f\"}\n", "a = 1\nb = [\"x\", false]\n[c]\nd = {e = \"f\"}\n",
        "a = 1\nb = [\"x\", true]\n[c]\nd = {e = \"f \"}\n", "a = 1\nb = [\"x\", true]\n[c]\nd = {g = \"f\"}\n",
        "a = 1\nb = [\"x\"]\n[c]\nd = {e = \"f\"}\n"})
    EXPECT_FALSE(same_content(tree(text), tree(other))) << other;
}

}  // namespace
}  // namespace anholon::format_test
