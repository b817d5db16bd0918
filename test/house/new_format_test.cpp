// A format of results is added by one file and its name in the table: this program is built with one more format, and
// its commands write, read and name the format.
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

#include "cli/command_line.h"
#include "cli/input.h"
#include "result/format.h"

namespace anholon {
namespace {

class NewFormat : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() / ("anholon-new-format-" + std::to_string(::getpid()));
    std::filesystem::create_directory(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  std::string text(const std::string& name) const {
    std::ifstream in(path(name));
    std::stringstream all;
    all << in.rdbuf();
    return all.str();
  }
  static int command(std::vector<std::string> words) {
    words.insert(words.begin(), "anholon");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    return cli::run_command_line(static_cast<int>(argv.size()), argv.data());
  }
  int simulate(const std::string& output) const {
    return command({"simulate", "chaplygin-sleigh", "--to", "1", "--every", "0.25", "--quiet", "-o", path(output)});
  }

  std::filesystem::path folder_;
};

TEST_F(NewFormat, IsWrittenAndConverted) {
  ASSERT_EQ(simulate("run.csv"), 0);
  ASSERT_EQ(simulate("run.tsv"), 0);
  EXPECT_NE(text("run.tsv").find('\t'), std::string::npos);
  ASSERT_EQ(command({"convert", path("run.tsv"), path("from_tsv.csv")}), 0);
  EXPECT_EQ(text("from_tsv.csv"), text("run.csv"));
  ASSERT_EQ(command({"convert", path("run.csv"), path("from_csv.tsv")}), 0);
  EXPECT_EQ(text("from_csv.tsv"), text("run.tsv"));
}

TEST_F(NewFormat, IsRefusedWhereItHoldsNoSweeps) {
  try {
    command({"sweep", "chaplygin-sleigh", "--vary", "m=1,2", "--to", "1", "-o", path("cases.tsv")});
    FAIL();
  } catch (const cli::UsageError& e) {
    EXPECT_EQ(
        e.text,
        "error: .tsv files are not written yet\nhint: -o cases.h5, -o cases.csv, -o cases.json or -o cases.parquet\n");
  }
}

TEST_F(NewFormat, IsNamedInHelpAndMessages) {
  EXPECT_EQ(known_files("FILE"), "FILE.h5, FILE.csv, FILE.json, FILE.parquet or FILE.tsv");
  EXPECT_EQ(known_formats(), "HDF5, CSV, JSON, Parquet or TSV");
  EXPECT_EQ(held_by_formats(), "HDF5 holds the model, the rows and the report, JSON the rows and the report, "
                               "Parquet the rows and the report, CSV the rows, TSV the rows.");
  try {
    command({"convert", path("run.csv"), path("run.xls")});
    FAIL();
  } catch (const cli::UsageError& e) {
    EXPECT_NE(e.text.find("a name that ends in .h5, .csv, .json, .parquet or .tsv"), std::string::npos) << e.text;
  }
}

}  // namespace
}  // namespace anholon
