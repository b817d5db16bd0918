#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "base/diagnostic.h"
#include "result/parquet/inflate.h"
#include "result/parquet/page_values.h"
#include "result/parquet/parquet.h"
#include "result/parquet/table_text.h"
#include "result/parquet/thrift.h"

namespace anholon::parquet_test {

ParquetTable table_of(std::size_t rows) {
  std::vector<double> numbers;
  std::vector<std::int64_t> whole;
  Words words;
  for (std::size_t k = 0; k < rows; ++k) {
    numbers.push_back(k % 7 == 3 ? std::numeric_limits<double>::quiet_NaN() : std::sin(static_cast<double>(k)));
    whole.push_back(static_cast<std::int64_t>(k) * 1'000'000'007);
    words.add(k % 5 == 0 ? "singular" : k % 300 == 7 ? "größer" : "finished");
  }
  ParquetTable t;
  t.columns = {{"case", whole}, {"theta'", numbers}, {"outcome", words}};
  t.notes = {{"first", "17"}};
  return t;
}

std::string words_of(const ParquetTable& t) {
  const Words& w = std::get<Words>(t.columns[2].values);
  std::string out;
  for (const std::uint32_t k : w.rows) out += w.different[k] + " ";
  return out;
}

void expect_same(const ParquetTable& a, const ParquetTable& b) {
  ASSERT_EQ(a.columns.size(), b.columns.size());
  for (std::size_t c = 0; c < a.columns.size(); ++c) EXPECT_EQ(a.columns[c].name, b.columns[c].name);
  EXPECT_EQ(std::get<1>(a.columns[0].values), std::get<1>(b.columns[0].values));
  const auto &x = std::get<0>(a.columns[1].values), &y = std::get<0>(b.columns[1].values);
  ASSERT_EQ(x.size(), y.size());
  for (std::size_t k = 0; k < x.size(); ++k) EXPECT_TRUE(x[k] == y[k] || (std::isnan(x[k]) && std::isnan(y[k]))) << k;
  EXPECT_EQ(words_of(a), words_of(b));
  EXPECT_EQ(a.notes, b.notes);
}

TEST(Parquet, GivesBackWhatWasWritten) {
  for (const std::size_t rows : {0U, 1U, 2U, 1000U}) {
    const ParquetTable t = table_of(rows);
    const std::string bytes = parquet_bytes(t);
    expect_same(read_parquet(bytes), t);
    EXPECT_EQ(parquet_bytes(t), bytes);
  }
}

TEST(Parquet, HasMoreThanOneGroupOfRows) {
  constexpr std::size_t kRows = (std::size_t{1} << 20) + 5;
  const ParquetTable t = table_of(kRows), back = read_parquet(parquet_bytes(t));
  EXPECT_EQ(back.rows(), kRows);
  EXPECT_EQ(std::get<1>(back.columns[0].values), std::get<1>(t.columns[0].values));
  EXPECT_EQ(std::get<Words>(back.columns[2].values).rows, std::get<Words>(t.columns[2].values).rows);
}

TEST(Parquet, TellsItsEnd) {
  const std::string bytes = parquet_bytes(table_of(40));
  const std::size_t size = parquet_end(std::string_view(bytes).substr(bytes.size() - 8));
  const ParquetSummary end = parquet_summary(std::string_view(bytes).substr(bytes.size() - size));
  EXPECT_EQ(end.rows, 40U);
  EXPECT_EQ(end.notes[0].second, "17");
}

// Whichever byte is changed or missing, the file is refused or has the same content, and no read passes its end.
TEST(Parquet, RefusesWhatIsDamaged) {
  const ParquetTable t = table_of(20);
  const std::string bytes = parquet_bytes(t);
  std::size_t refused = 0;
  for (std::size_t k = 0; k < bytes.size(); ++k) {
    std::string other = bytes;
    other[k] = static_cast<char>(other[k] ^ 0x41);
    try {
      const ParquetTable read = read_parquet(other);
      EXPECT_EQ(read.rows(), t.rows()) << k;  // a name or a note
    } catch (const Failure&) {
      ++refused;
    }
    EXPECT_THROW(read_parquet(std::string_view(bytes).substr(0, k)), Failure) << k;
  }
  EXPECT_GT(refused, bytes.size() / 2);
}

TEST(Thrift, GivesBackWhatWasWritten) {
  thrift::Writer w;
  w.i32(1, -5).i64(40, std::int64_t{1} << 60).binary(41, "text");
  w.open(42).i32(3, 7).close().list(43, thrift::Type::i32, 20);
  for (int k = 0; k < 20; ++k) w.element(k);
  w.close();
  thrift::Reader r(w.text());
  r.open();
  EXPECT_EQ(r.next().number, 1);
  EXPECT_EQ(r.integer(), -5);
  EXPECT_EQ(r.next().number, 40);
  EXPECT_EQ(r.integer(), std::int64_t{1} << 60);
  EXPECT_EQ(r.next().number, 41);
  EXPECT_EQ(r.binary(), "text");
  EXPECT_EQ(r.next().number, 42);
  r.skip(thrift::Type::structure);
  EXPECT_EQ(r.next().number, 43);
  r.skip(thrift::Type::list);
  EXPECT_EQ(r.next().type, thrift::Type::stop);
  EXPECT_TRUE(r.good());
  EXPECT_EQ(r.at(), w.text().size());
}

TEST(Parquet, ReadsBlocksOfSnappy) {
  std::string bytes;
  // A length, literals, and copies that overlap their source.
  EXPECT_TRUE(parquet::read_snappy(std::string_view("\x05\x10hello", 7), 5, bytes));
  EXPECT_EQ(bytes, "hello");
  EXPECT_TRUE(parquet::read_snappy(std::string_view("\x0a\x00"
                                                    "a\x15\x01",
                                                    5),
                                   10, bytes));
  EXPECT_EQ(bytes, "aaaaaaaaaa");
  EXPECT_TRUE(parquet::read_snappy(std::string_view("\x07\x04"
                                                    "ab\x12\x02\x00",
                                                    7),
                                   7, bytes));
  EXPECT_EQ(bytes, "abababa");
  EXPECT_FALSE(parquet::read_snappy(std::string_view("\x07\x04"
                                                     "ab\x12\x03\x00",
                                                     7),
                                    7, bytes))
      << "before the begin";
  EXPECT_FALSE(parquet::read_snappy(std::string_view("\x05\x10hello", 7), 6, bytes)) << "another length";
  EXPECT_FALSE(parquet::read_snappy(std::string_view("\x05\x10hell", 6), 5, bytes)) << "cut off";
}

TEST(Parquet, ReadsRunsAndGroupsOfNumbers) {
  using List = std::vector<std::uint32_t>;
  EXPECT_EQ(parquet::run_lengths(std::string_view("\x06\x02", 2), 2, 3), (List{2, 2, 2}));
  EXPECT_EQ(parquet::run_lengths(std::string_view("\x03\x88\xc6\xfa", 4), 3, 8), (List{0, 1, 2, 3, 4, 5, 6, 7}));
  EXPECT_THROW(parquet::run_lengths(std::string_view("\x06\x02", 2), 2, 4), Failure);
}

TEST(Parquet, GivesTheTextOfACsvFile) {
  ParquetTable t;
  Words words;
  words.add("pi/2"), words.add("8 cm, \"about\"");
  t.columns = {{"m", std::vector<double>{0.1, 1e-300}}, {"P[1,2]", std::vector<std::int64_t>{-3, 4}}, {"l", words}};
  EXPECT_EQ(table_text_of_parquet(parquet_bytes(t)), "m,\"P[1,2]\",l\n0.1,-3,pi/2\n1e-300,4,\"8 cm, \"\"about\"\"\"\n");
  EXPECT_THROW(table_text_of_parquet(parquet_bytes(t).substr(0, 200)), Failure);
}

}  // namespace anholon::parquet_test
