#include <chrono>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <thread>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "result/csv.h"
#include "result/file.h"
#include "support/rows.h"

namespace anholon::file_test {
namespace {

namespace fs = std::filesystem;

class File : public testing::Test {
 protected:
  void SetUp() override {
    std::string pattern = (fs::temp_directory_path() / "anholon-file-XXXXXX").string();
    folder_ = mkdtemp(pattern.data());
    path_ = (folder_ / "rows.csv").string();
  }
  void TearDown() override { fs::remove_all(folder_); }
  static std::string text(const fs::path& path) {
    std::ifstream in(path, std::ios::binary);
    std::ostringstream all;
    all << in.rdbuf();
    return all.str();
  }
  std::size_t files() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder_), fs::directory_iterator()));
  }

  fs::path folder_;
  std::string path_;
};

TEST_F(File, HasItsNameWhenItIsWhole) {
  std::ofstream(path_) << "old";
  {
    CsvRunWriter rows(path_);
    test::set_columns(rows, {"t", "x"});
    test::add_row(rows, {"0", "1"});
    rows.flush();
    EXPECT_EQ(text(path_), "old");
    EXPECT_EQ(text(path_ + ".part"), "t,x\n0,1\n");
    EXPECT_EQ(rows.close({}), "");
  }
  EXPECT_EQ(text(path_), "t,x\n0,1\n");
  EXPECT_EQ(files(), 1u);
}

TEST_F(File, ALinkStaysWhereItsTargetIsMissing) {
  fs::create_symlink("target.csv", path_);
  EXPECT_EQ(write_whole(path_, std::string("t\n0\n")), "");
  EXPECT_TRUE(fs::is_symlink(path_));
  EXPECT_EQ(text(folder_ / "target.csv"), "t\n0\n");
  EXPECT_EQ(files(), 2u);
}

TEST_F(File, WhatWasNotBegunLeavesNothing) {
  std::ofstream(path_) << "old";
  {
    GrowingFile file(path_);
  }
  EXPECT_EQ(text(path_), "old");
  EXPECT_EQ(files(), 1u);
}

TEST_F(File, RowsGoThereWhole) {
  const pid_t child = fork();
  if (child == 0) {
    CsvRunWriter rows(path_);
    test::set_columns(rows, {"t", "x"});
    for (int k = 0; k < 200000; ++k) test::add_row(rows, {std::to_string(k), "0.123456789"});
    while (fs::file_size(path_ + ".part") < 1'000'000) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    raise(SIGKILL);
  }
  waitpid(child, nullptr, 0);
  EXPECT_FALSE(fs::exists(path_));
  const std::string rows = text(path_ + ".part");
  EXPECT_EQ(rows.back(), '\n');
}

TEST_F(File, IsWrittenByOneProcess) {
  int ready[2], done[2];
  ASSERT_EQ(pipe(ready) | pipe(done), 0);
  const pid_t child = fork();
  if (child == 0) {
    GrowingFile file(path_);
    file.write("x");
    char c = file.error().empty() ? 'y' : 'n';
    c = ::write(ready[1], &c, 1) == 1 ? c : 'n';
    _exit(::read(done[0], &c, 1) == 1 ? 0 : 1);  // as if killed
  }
  char c = 0;
  ASSERT_EQ(::read(ready[0], &c, 1), 1);
  EXPECT_EQ(c, 'y');
  EXPECT_EQ(GrowingFile(path_).error(), "cannot write " + path_ + ": another process writes it");
  fs::create_symlink(path_, folder_ / "link");
  EXPECT_EQ(GrowingFile((folder_ / "." / "rows.csv").string()).error(),
            "cannot write " + (folder_ / "." / "rows.csv").string() + ": another process writes it");
  ASSERT_EQ(::write(done[1], &c, 1), 1);
  waitpid(child, nullptr, 0);
  EXPECT_EQ(GrowingFile(path_).error(), "") << "its end ends the claim";
  for (const int fd : {ready[0], ready[1], done[0], done[1]}) ::close(fd);
}

TEST_F(File, ALinkStaysOne) {
  const fs::path real = folder_ / "real";
  std::ofstream(real) << "old";
  ASSERT_EQ(::chmod(real.c_str(), 0640), 0);
  fs::create_symlink(real, path_);
  EXPECT_EQ(write_whole(path_, "new"), "");
  EXPECT_TRUE(fs::is_symlink(path_));
  EXPECT_EQ(text(real), "new");
  struct stat info{};
  ASSERT_EQ(::stat(real.c_str(), &info), 0);
  EXPECT_EQ(info.st_mode & 0777, 0640u) << "the mode of what was there";
  EXPECT_EQ(files(), 2u);
}

// A link that somebody else has put at the name of the part is not followed.
TEST_F(File, FollowsNoLinkForItsPart) {
  const fs::path victim = folder_ / "victim";
  std::ofstream(victim) << "precious";
  fs::create_symlink(victim, path_ + ".part");
  EXPECT_NE(write_whole(path_, "new"), "");
  EXPECT_NE(GrowingFile(path_).error(), "");
  EXPECT_EQ(text(victim), "precious");
}

TEST_F(File, DevicesAreWrittenAsTheyAre) {
  EXPECT_EQ(write_whole("/dev/null", "x"), "");
  EXPECT_EQ(write_whole("/dev/full", "x"), "cannot write /dev/full: No space left on device");
  EXPECT_FALSE(fs::exists("/dev/null.part"));
  CsvRunWriter rows("/dev/full");
  test::set_columns(rows, {"t"});
  EXPECT_EQ(rows.close({}), "cannot write /dev/full: No space left on device");
  EXPECT_EQ(obstacle_to_writing("/dev/null"), "");
}

TEST_F(File, SaysWhatIsInTheWay) {
  EXPECT_EQ(write_whole((folder_ / "no" / "x").string(), "x"),
            "cannot write " + (folder_ / "no" / "x").string() + ": No such file or directory");
  EXPECT_EQ(write_whole(folder_.string(), "x"), "cannot write " + folder_.string() + ": Is a directory");
  EXPECT_EQ(obstacle_to_writing(folder_.string()), "cannot write " + folder_.string() + ": Is a directory");
  EXPECT_FALSE(fs::exists(folder_.string() + ".part"));
}

}  // namespace
}  // namespace anholon::file_test
