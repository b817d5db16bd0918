// Results in HDF5: written data are read back, and the file under its final name is complete at every moment.
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <fcntl.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/diagnostic.h"
#include "numeric/number.h"
#include "result/format.h"
#include "result/hdf5/hdf5_sink.h"
#include "support/rows.h"

namespace anholon::hdf5_test {
namespace {

#ifndef ANHOLON_HDF5

TEST(Hdf5, IsRefusedWhereThereIsNone) {
  EXPECT_FALSE(has_hdf5());
  Hdf5Sink sink("run.h5", {});
  EXPECT_EQ(sink.error(), kNoHdf5);
  EXPECT_FALSE(std::filesystem::exists("run.h5"));
  EXPECT_THROW(read_hdf5("run.h5"), Failure);
}

#else

namespace fs = std::filesystem;

class Hdf5 : public ::testing::Test {
 protected:
  void SetUp() override {
    ASSERT_TRUE(has_hdf5());
    char name[] = "/tmp/anholon-hdf5-XXXXXX";
    ASSERT_NE(mkdtemp(name), nullptr);
    folder_ = name;
    path_ = (folder_ / "run.h5").string();
  }
  void TearDown() override {
    std::error_code ignored;
    if (!folder_.empty()) fs::remove_all(folder_, ignored);
  }
  static RunInfo info() {
    RunInfo i;
    i.title = "Scheibe θ";
    i.command = "anholon simulate disc";
    i.created_by = "anholon test";
    i.model = {{"disc.toml", "title = \"Scheibe θ\"\n"}, {"base.toml", std::string(100'000, '#') + "\n"}};
    i.settings = {{"set", {"m=2", "J=1"}}, {"tolerance", {"1/10"}}, {"case", {}}};
    i.units = {{"x", "m"}};
    return i;
  }
  // The bytes of the file of a run with `rows` rows.
  std::string bytes_of_a_run(int rows) const {
    Hdf5Sink sink(path_, info());
    test::set_columns(sink, {"t", "x"});
    for (int i = 0; i < rows; ++i) test::add_row(sink, {std::to_string(i), "0.50"});
    sink.close({});
    std::ostringstream bytes;
    bytes << std::ifstream(path_, std::ios::binary).rdbuf();
    return bytes.str();
  }
  void write_bytes(const std::string& bytes) const { std::ofstream(path_, std::ios::binary) << bytes; }

  fs::path folder_;
  std::string path_;
};

TEST_F(Hdf5, EverythingComesBack) {
  {
    Hdf5Sink sink(path_, info());
    test::set_columns(sink, {"t", "x", "θ'"});
    for (int i = 0; i < 2500; ++i) {
      test::add_row(sink, {std::to_string(i), i < 10 ? "0.1" : number_text(1.0 / i), i == 2000 ? "1/3" : "nan"});
      sink.step(i + 0.5);
      if (i == 3 || i == 1999) sink.flush();
    }
    EXPECT_EQ(sink.close("{\"a\": 1}"), "");
    EXPECT_EQ(sink.written(), 2500u);
  }
  const RunFile run = read_run(path_);
  const RunInfo expected = info();
  EXPECT_EQ(run.title, expected.title);
  EXPECT_EQ(run.command, expected.command);
  EXPECT_EQ(run.created_by, expected.created_by);
  ASSERT_EQ(run.model.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(run.model[i].name, expected.model[i].name);
    EXPECT_EQ(run.model[i].text, expected.model[i].text);
  }
  EXPECT_EQ(run.settings, expected.settings);
  EXPECT_EQ(run.units, expected.units);
  EXPECT_EQ(run.report, "{\"a\": 1}");
  EXPECT_EQ(run.table.columns, (std::vector<std::string>{"t", "x", "θ'"}));
  ASSERT_EQ(run.table.rows(), 2500u);
  ASSERT_EQ(run.steps.size(), 2500u);
  EXPECT_EQ(run.steps[2499], 2499.5);
  for (std::size_t i = 0; i < 2500; ++i) {
    EXPECT_EQ(run.table.values[0][i], static_cast<double>(i));
    EXPECT_EQ(run.table.values[1][i], i < 10 ? 0.1 : 1.0 / static_cast<double>(i));
    EXPECT_EQ(run.table.text(i, 2), i == 2000 ? "1/3" : "nan");
  }
  EXPECT_FALSE(fs::exists(path_ + ".part"));
}

// Texts may begin in any column at any row; earlier rows have none.
TEST_F(Hdf5, TextsOfSeveralColumns) {
  Hdf5Sink sink(path_, info());
  test::set_columns(sink, {"a", "b", "c"});
  std::vector<std::vector<std::string>> rows;
  for (int i = 0; i < 40; ++i) {
    rows.push_back({"1", i % 7 == 3 ? "0.10" : "0.1", i > 20 ? "1.00000000000000000000000000001" : "1"});
    test::add_row(sink, rows.back());
    if (i % 5 == 4) sink.flush();
  }
  ASSERT_EQ(sink.close({}), "");
  const RunTable t = read_run(path_).table;
  EXPECT_TRUE(t.texts[0].empty());
  for (std::size_t i = 0; i < 40; ++i)
    for (std::size_t j = 0; j < 3; ++j) EXPECT_EQ(t.text(i, j), rows[i][j]) << i << " " << j;
}

TEST_F(Hdf5, IsThereFromTheBeginning) {
  Hdf5Sink sink(path_, info());
  EXPECT_FALSE(fs::exists(path_));
  test::set_columns(sink, {"t"});
  const RunFile run = read_run(path_);
  EXPECT_EQ(run.table.rows(), 0u);
  EXPECT_EQ(run.model.at(0).name, "disc.toml");
  EXPECT_TRUE(run.report.empty());
  // Between checkpoints new rows are not visible.
  test::add_row(sink, {"1"});
  EXPECT_EQ(read_run(path_).table.rows(), 0u);
  sink.flush();
  EXPECT_EQ(read_run(path_).table.rows(), 1u);
}

// A run is not disturbed by a reader that has opened its file, or by a process that removes it.
TEST_F(Hdf5, GoesOnWhereItsFileWasTakenAway) {
  Hdf5Sink sink(path_, info());
  test::set_columns(sink, {"t"});
  test::add_row(sink, {"1"});
  sink.flush();
  fs::remove(path_);
  test::add_row(sink, {"2"});
  EXPECT_EQ(sink.close({}), "");
  const RunFile run = read_run(path_);
  ASSERT_EQ(run.table.rows(), 2u);
  EXPECT_EQ(run.table.values[0][0], 1);
  EXPECT_EQ(run.table.values[0][1], 2);
}

TEST_F(Hdf5, CheckpointsComeByTimeAndByBytes) {
  CheckpointPace pace;
  pace.seconds = 1000;
  pace.bytes = 8000;
  Hdf5Sink by_bytes(path_, info(), pace);
  test::set_columns(by_bytes, {"t"});
  for (int i = 0; i < 100'000; ++i) test::add_row(by_bytes, {"1"});
  EXPECT_GT(by_bytes.written(), 80'000u);
  pace = {};
  pace.seconds = 0.01;
  pace.share = 0;
  Hdf5Sink by_time((folder_ / "other.h5").string(), info(), pace);
  test::set_columns(by_time, {"t"});
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  test::add_row(by_time, {"1"});
  EXPECT_EQ(by_time.written(), 1u);
}

// Many rows go to the copy before the checkpoint: the complete file does not have them yet, the final one has all.
TEST_F(Hdf5, TheCopyGetsRowsAheadOfTheCheckpoint) {
  constexpr int kRows = 1'000'000;  // 16 MB
  CheckpointPace pace;
  pace.seconds = 1000;
  {
    Hdf5Sink sink(path_, info(), pace);
    test::set_columns(sink, {"t", "x"});
    for (int i = 0; i < kRows; ++i) {
      const double values[] = {static_cast<double>(i), 0.5 * i};
      sink.row({values});
      sink.step(i + 0.25);
    }
    EXPECT_EQ(sink.written(), 0U);
    EXPECT_EQ(read_run(path_).table.rows(), 0U);
    EXPECT_GT(fs::file_size(path_ + ".part"), 8'000'000U);
    EXPECT_EQ(sink.close("{}"), "");
    EXPECT_EQ(sink.written(), static_cast<std::size_t>(kRows));
  }
  const RunFile run = read_run(path_);
  ASSERT_EQ(run.table.rows(), static_cast<std::size_t>(kRows));
  ASSERT_EQ(run.steps.size(), static_cast<std::size_t>(kRows));
  for (int i = 0; i < kRows; i += 999) {
    const auto k = static_cast<std::size_t>(i);
    ASSERT_EQ(run.table.values[0][k], i);
    ASSERT_EQ(run.table.values[1][k], 0.5 * i);
    ASSERT_EQ(run.steps[k], i + 0.25);
  }
  EXPECT_FALSE(fs::exists(path_ + ".part"));
}

// A process that writes without end is killed at random times: each time the file opens, with all rows up to a
// checkpoint.
TEST_F(Hdf5, SurvivesKills) {
  unsigned random = 12345;
  std::size_t grown = 0;
  for (int kill_number = 0; kill_number < 20; ++kill_number) {
    int reports[2];
    ASSERT_EQ(pipe(reports), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      CheckpointPace pace;
      pace.seconds = 0;
      pace.share = 0;  // a checkpoint at every row, so that most kills fall into one
      Hdf5Sink sink(path_, info(), pace);
      test::set_columns(sink, {"t", "x"});
      for (std::uint64_t i = 0;; ++i) {
        test::add_row(sink, {std::to_string(i), i % 3 ? "0.25" : "0.250"});
        const std::uint64_t written = sink.written();
        if (!sink.error().empty() || write(reports[1], &written, sizeof written) != sizeof written) _exit(1);
      }
    }
    close(reports[1]);
    // The kill comes after the first row.
    std::uint64_t written = 0, next = 0;
    ASSERT_EQ(read(reports[0], &written, sizeof written), static_cast<ssize_t>(sizeof written));
    random = random * 1103515245u + 12345u;
    std::thread killer([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(200 + random / 65536 % 30'000));
      kill(child, SIGKILL);
    });
    while (read(reports[0], &next, sizeof next) == static_cast<ssize_t>(sizeof next)) written = next;
    killer.join();
    int status = 0;
    waitpid(child, &status, 0);
    close(reports[0]);
    ASSERT_TRUE(WIFSIGNALED(status));
    const RunFile run = read_run(path_);
    ASSERT_GE(run.table.rows(), written);
    ASSERT_EQ(run.table.values[1].size(), run.table.rows());
    for (std::size_t i = 0; i < run.table.rows(); ++i) {
      ASSERT_EQ(run.table.values[0][i], static_cast<double>(i));
      ASSERT_EQ(run.table.text(i, 1), i % 3 ? "0.25" : "0.250");
    }
    EXPECT_EQ(run.model.size(), 2u);
    grown += run.table.rows();
  }
  EXPECT_GT(grown, 20u);
}

// On a full disk the last complete file stays, the reason is reported, and no other file is left.
TEST_F(Hdf5, FullDiskLeavesTheLastFile) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    Hdf5Sink sink(path_, info());
    test::set_columns(sink, {"t"});
    for (int i = 0; i < 1000; ++i) test::add_row(sink, {std::to_string(i)});
    sink.flush();
    if (!sink.error().empty() || sink.written() != 1000) _exit(1);
    const rlimit little{3u << 20, 3u << 20};
    setrlimit(RLIMIT_FSIZE, &little);
    for (int i = 1000; i < 500'000; ++i) test::add_row(sink, {std::to_string(i)});
    const std::string why = sink.close("{}");
    if (why != "cannot write " + path_ + ": File too large") _exit(2);
    _exit(fs::exists(path_ + ".part") ? 3 : 0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFEXITED(status));
  EXPECT_EQ(WEXITSTATUS(status), 0);
  const RunFile run = read_run(path_);
  EXPECT_EQ(run.table.rows(), 1000u);
  EXPECT_TRUE(run.report.empty());
}

TEST_F(Hdf5, SaysWhereItCannotWrite) {
  EXPECT_EQ(Hdf5Sink((folder_ / "no" / "run.h5").string(), info()).error(),
            "cannot write " + (folder_ / "no" / "run.h5").string() + ": No such file or directory");
}

// A damaged file gives an error with a message, never a crash.
TEST_F(Hdf5, DamagedFilesAreRefused) {
  const std::string bytes = bytes_of_a_run(300);
  std::size_t refused = 0;
  for (std::size_t cut = 8; cut < bytes.size(); cut += bytes.size() / 40) {
    write_bytes(bytes.substr(0, cut));
    EXPECT_THROW(read_run(path_), Failure) << cut;
    ++refused;
  }
  EXPECT_GT(refused, 30u);
}

// The bytes may mislead the HDF5 library itself.
TEST_F(Hdf5, FlippedBytesAreNoCrash) {
  const std::string bytes = bytes_of_a_run(10);
  unsigned random = 1;
  std::size_t refused = 0;
  for (int k = 0; k < 400; ++k) {
    std::string damaged = bytes;
    for (int flips = 0; flips < 8; ++flips) {
      random = random * 1664525u + 1013904223u;
      damaged[(random >> 4) % damaged.size()] = static_cast<char>(random >> 24);
    }
    write_bytes(damaged);
    try {
      read_run(path_);
    } catch (const Failure& e) {
      EXPECT_NE(e.diagnostic.message, "");
      ++refused;
    }
  }
  EXPECT_GT(refused, 10u);
}

#endif

}  // namespace
}  // namespace anholon::hdf5_test
