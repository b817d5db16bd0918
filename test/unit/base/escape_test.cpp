#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "base/diagnostic.h"
#include "base/escape.h"
#include "base/utf8.h"

namespace anholon::escape_test {
namespace {

const std::string kTexts[] = {"",
                              "plain",
                              "θ̇ = 3 mm² 中 😀",
                              "a\x1b[31mred\x1b[0m",
                              "bell\a back\b tab\t nul" + std::string(1, '\0') + "end",
                              "two\nlines\r\n",
                              "\x7f\xc2\x85\xc2\x9b",
                              "\u202eleft\u2066\u200b\ufeff\u2028\u061c",
                              "\xff\xfe\xc0\xaf\xed\xa0\x80\xf4\x90\x80\x80\xe2\x80",
                              "</script><b a='1' b=\"2\">&amp;]]>",
                              "*/ /* // \\ \"\"\" ''' ?\?/",
                              "\\input{x} $_^~%#&{}",
                              "a,b\"c",
                              "\U000E0041\U0001FFFE",
                              "Persian \u0645\u06cc\u200c\u062e\u0648\u0627\u0647\u0645"};

bool steers(const std::string& text, const std::string& but = "") {
  for (std::size_t i = 0; i < text.size(); i += utf8_width(text, i)) {
    const std::string c = text.substr(i, utf8_width(text, i));
    if (but.find(c) != std::string::npos) continue;
    if (c.size() == 1 && (static_cast<unsigned char>(c[0]) < 0x20 || static_cast<unsigned char>(c[0]) >= 0x7f))
      return true;
    if (c.size() == 2 && c[0] == '\xc2' && static_cast<unsigned char>(c[1]) < 0xa0) return true;
    for (const char* hidden : {"\u202e", "\u2066", "\u200b", "\u2028", "\ufeff", "\u061c", "\U000E0041"})
      if (c == hidden) return true;
  }
  return false;
}

TEST(Escape, ShowsEachCharacterAsOne) {
  EXPECT_EQ(shown("a\x1b[31m\n"), "a␛[31m␊");
  EXPECT_EQ(shown(std::string(1, '\0') + "\x7f"), "␀␡");
  EXPECT_EQ(shown("\u202e\u200b\xff\xc2\x9b"), "����");
  EXPECT_EQ(shown("θ̇ 中 😀 \u06cc\u200c"), "θ̇ 中 😀 \u06cc\u200c");
  EXPECT_EQ(shown("\xed\xa0\x80"), "���") << "a surrogate is no character";
  EXPECT_EQ(shown("\xc0\xaf"), "��") << "longer than it needs to be";
  EXPECT_EQ(shown_lines("a\r\nb\tc\rd\n"), "a\nb c␍d\n");
}

TEST(Escape, LetsNothingThroughThatSteers) {
  for (const std::string& t : kTexts) {
    for (const auto f :
         {shown, markup_escape, latex_escape, comment_line, code_string, csv_cell, json_escape, toml_escape})
      EXPECT_FALSE(steers(f(t))) << t;
    EXPECT_FALSE(steers(shown_lines(t), "\n")) << t;
    EXPECT_FALSE(steers(markup_lines(t), "\n\t")) << t;
    EXPECT_EQ(utf8_length(shown(t)), utf8_length(shown(shown(t)))) << "shown twice";
    EXPECT_EQ(shown(shown(t)), shown(t));
  }
}

TEST(Escape, JsonLosesNothing) {
  for (const std::string& t : kTexts) {
    const std::string back = nlohmann::json::parse('"' + json_escape(t) + '"').get<std::string>();
    if (t.find('\xff') == std::string::npos) {
      EXPECT_EQ(back, t);
    }
  }
  EXPECT_EQ(json_escape("\u202e\U000E0041\x1b"), "\\u202e\\udb40\\udc41\\u001b");
  EXPECT_EQ(toml_escape("\U000E0041\x1b"), "\\U000e0041\\u001b");
}

TEST(Escape, FormatsKeepTheirOwnSigns) {
  for (const std::string& t : kTexts) {
    EXPECT_EQ(markup_escape(t).find_first_of("<>\"'"), std::string::npos);
    EXPECT_EQ(comment_line(t).find("*/"), std::string::npos);
    EXPECT_EQ(comment_line(t).find('\n'), std::string::npos);
    const std::string code = code_string(t);
    for (std::size_t i = 0; i < code.size(); ++i) {
      if (code[i] == '\\') {
        ++i;
      } else {
        EXPECT_NE(code[i], '"') << t;
      }
    }
    const std::string cell = csv_cell(t);
    if (cell.find(',') != std::string::npos) {
      EXPECT_EQ(cell[0], '"');
    }
    EXPECT_EQ(hdf5_text(t).find('\0'), std::string::npos);
  }
  EXPECT_EQ(latex_escape("\\input{a_b} 5%"), "\\textbackslash{}input\\{a\\_b\\} 5\\%");
  EXPECT_EQ(comment_line("a*/b/*"), "a* /b/ *");
  EXPECT_EQ(comment_line("why?? a ?\?/ b ?\?\?= c"), "why?? a ?? / b ??? = c");
  EXPECT_EQ(csv_cell("D(x,4)"), "\"D(x,4)\"");
  EXPECT_EQ(csv_cell("a\"b"), "\"a\"\"b\"");
  EXPECT_EQ(csv_cell("x'"), "x'");
}

TEST(Escape, MessagesAreLinesOfOurs) {
  const SourceText source{"a\x1b.toml", "title = 1\n"};
  const std::string said =
      print(Diagnostic{Severity::error, Span{1, 1, 5}, "no 'x\nerror: y'", "write\x1b[2J"}, source);
  EXPECT_EQ(said, "a␛.toml:1:1: error: no 'x␊error: y'\n  1 | title = 1\n    | ^~~~~\nhint: write␛[2J\n");
}

}  // namespace
}  // namespace anholon::escape_test
