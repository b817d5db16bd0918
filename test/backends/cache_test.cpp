// Compiled code on disk: whatever happens to the folder, the code is right, and no trouble is reported.
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include "jit/trust.h"
#include "kernel/kernel.h"
#include "simulation/simulate.h"
#include "support/compiler.h"
#include "support/models.h"

namespace anholon::cache_test {
namespace {

#ifdef ANHOLON_COMPILER_BUILT

namespace fs = std::filesystem;
using namespace std::chrono_literals;

struct Subject {
  explicit Subject(const std::string& name) {
    if (!make_scenario(test::shipped(name), *find_formulation("routh"), {}, prepared).ok())
      throw std::runtime_error(name);
    scenario.emplace(prepared);
    stepping = std::make_shared<const Program>(program(scenario->system, scenario->structure));
    parameters = parameter_values<long double>(*scenario->model);
    Start<long double> start;
    if (!initial_state(*scenario, {}, start).ok()) throw std::runtime_error(name);
    state.assign(start.state.begin(), start.state.end());
    leading.assign(start.leading.begin(), start.leading.end());
  }
  std::shared_ptr<const KernelPlan> plan(int stages = 6) const {
    return KernelPlan::make(stepping, stages, parameters, 0, state);
  }

  // Compares the coefficients of code that is compiled with this folder with those of the tables. Returns an empty text
  // if they agree, else the mistake.
  std::string check(const std::string& cache, int stages = 6) const {
    const auto plain = plan(stages), compiled = plan(stages);
    if (const std::string why = compiled->compile(cache); !why.empty()) return why;
    Kernel a(plain), b(compiled);
    for (Kernel* k : {&a, &b}) {
      k->set_parameters(0, parameters);
      k->load(0, 0, state, leading);
      k->expand();
    }
    const Plan& p = plain->plan();
    for (std::size_t j = 0; j < p.x.size(); ++j)
      for (int k = 0; k <= p.stages + p.d[j]; ++k)
        if (a.coefficient(j, k) != b.coefficient(j, k)) return "another coefficient";
    return {};
  }

  Scenario prepared;
  std::optional<Workspace> scenario;
  std::shared_ptr<const Program> stepping;
  std::vector<long double> parameters;
  std::vector<double> state, leading;
};

const Subject& sleigh() {
  static const Subject s("zoo/chaplygin-sleigh");
  return s;
}

class Cache : public testing::TestWithParam<int> {
 protected:
  void SetUp() override {
    ASSERT_TRUE(compiler()) << "the module beside the program was built and cannot be loaded";
    std::string name = (fs::temp_directory_path() / "anholon-cache-XXXXXX").string();
    folder_ = mkdtemp(name.data());
  }
  void TearDown() override {
    std::error_code none;
    if (!folder_.empty()) fs::permissions(folder_, fs::perms::owner_all, none), fs::remove_all(folder_, none);
  }
  std::vector<fs::path> files() const {
    std::vector<fs::path> all;
    for (const auto& e : fs::directory_iterator(folder_)) all.push_back(e.path());
    return all;
  }
  // Compiles into the empty folder and returns the one file there.
  fs::path entry() const {
    EXPECT_EQ(sleigh().check(folder_), "");
    const auto all = files();
    EXPECT_EQ(all.size(), 1U);
    return all.at(0);
  }
  std::string folder_;
};

void put(const fs::path& file, const std::string& bytes) { std::ofstream(file, std::ios::binary) << bytes; }
fs::file_time_type ago(std::chrono::hours t) { return fs::file_time_type::clock::now() - t; }

TEST_P(Cache, IsUsed) {
  const fs::path file = entry();
  const auto inode = [&] {
    struct stat about{};
    stat(file.c_str(), &about);
    return about.st_ino;
  };
  const auto before = inode();
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_EQ(inode(), before) << "written again";
  EXPECT_EQ(files().size(), 1U);
  EXPECT_EQ(sleigh().check(folder_, 9), "");
  EXPECT_EQ(files().size(), 2U) << "other stages, other code";
}

TEST_P(Cache, TakesNoFileThatIsNotWhole) {
  const fs::path file = entry();
  const std::string good = test::file_text(file);
  std::vector<std::string> bad{"",
                               "x",
                               std::string(good.size(), '\0'),
                               good.substr(0, good.size() / 2),
                               good.substr(0, good.size() - 1),
                               good + "x",
                               "x" + good};
  for (const std::size_t at : {std::size_t{0}, good.size() / 3, good.size() - 20, good.size() - 1})
    bad.push_back(good), bad.back()[at] ^= 1;
  for (const std::string& bytes : bad) {
    put(file, bytes);
    EXPECT_EQ(sleigh().check(folder_), "");
    EXPECT_EQ(test::file_text(file), good) << "not made anew";
  }
}

// A whole file lies under the name of another key: the code has another number of stages, as that of a stale version
// could.
TEST_P(Cache, TakesNoCodeOfAnotherKey) {
  const fs::path file = entry();
  const std::string good = test::file_text(file);
  EXPECT_EQ(sleigh().check(folder_, 9), "");
  for (const fs::path& other : files())
    if (other != file) put(file, test::file_text(other));
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_EQ(test::file_text(file), good);
}

TEST_P(Cache, TakesNoCodeThatOthersMayWrite) {
  const fs::path file = entry();
  fs::permissions(file, fs::perms::others_write, fs::perm_options::add);
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_EQ(fs::status(file).permissions() & fs::perms::others_write, fs::perms::none) << "not made anew";
}

// A link may lead to a file that others wrote.
TEST_P(Cache, FollowsNoLink) {
  const fs::path file = entry(), elsewhere = folder_ + "/elsewhere";
  fs::rename(file, elsewhere);
  fs::create_symlink(elsewhere, file);
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_TRUE(fs::is_regular_file(fs::symlink_status(file))) << "not made anew";
}

TEST(Trust, IsInFilesOfTheUserAndOfRoot) {
  const auto trusted = [](uid_t owner, mode_t mode, uid_t user) {
    struct stat about{};
    about.st_uid = owner;
    about.st_mode = mode;
    return jit::trusted(about, user);
  };
  constexpr uid_t kUser = 1000, kOther = 1001;
  for (const uid_t owner : {uid_t{0}, kUser}) {
    EXPECT_TRUE(trusted(owner, S_IFREG | 0644, kUser));
    EXPECT_FALSE(trusted(owner, S_IFREG | 0664, kUser)) << "its group may write";
    EXPECT_FALSE(trusted(owner, S_IFREG | 0646, kUser)) << "all may write";
    for (const mode_t kind : {S_IFLNK, S_IFIFO, S_IFDIR, S_IFSOCK, S_IFCHR})
      EXPECT_FALSE(trusted(owner, kind | 0600, kUser));
  }
  EXPECT_FALSE(trusted(kOther, S_IFREG | 0600, kUser));
  EXPECT_FALSE(trusted(kOther, S_IFREG | 0600, 0)) << "root runs its own code only";
}

// Root can give the file to another owner. Other users cannot; for them it stays the file that was written.
TEST_P(Cache, TakesNoCodeOfAnotherOwner) {
  const fs::path file = entry();
  const std::string good = test::file_text(file);
  const bool given = chown(file.c_str(), 65534, 65534) == 0;
  EXPECT_EQ(given, geteuid() == 0) << "errno " << errno;
  EXPECT_EQ(sleigh().check(folder_), "");
  struct stat about{};
  ASSERT_EQ(stat(file.c_str(), &about), 0);
  EXPECT_EQ(about.st_uid, geteuid()) << "not made anew";
  EXPECT_EQ(test::file_text(file), good);
}

TEST_P(Cache, DoesWithoutAFolder) {
  put(folder_ + "/file", "x");
  for (const std::string& place : {folder_ + "/file", folder_ + "/file/below", std::string("/dev/full"),
                                   std::string("/proc/none"), folder_ + "/" + std::string(5000, 'x')})
    EXPECT_EQ(sleigh().check(place), "") << place;
  EXPECT_EQ(sleigh().check(folder_ + "/made/when/needed"), "");
  EXPECT_TRUE(fs::is_directory(folder_ + "/made/when/needed"));
  fs::create_directory(folder_ + "/locked");
  fs::permissions(folder_ + "/locked", fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(sleigh().check(folder_ + "/locked"), "");
  // A pipe and a folder take the name of the entry.
  const fs::path file = files().empty() ? fs::path() : *fs::directory_iterator(folder_ + "/made/when/needed");
  fs::remove(file);
  ASSERT_EQ(mkfifo(file.c_str(), 0600), 0);
  EXPECT_EQ(sleigh().check(folder_ + "/made/when/needed"), "") << "a pipe";
  fs::remove(file);
  fs::create_directory(file);
  EXPECT_EQ(sleigh().check(folder_ + "/made/when/needed"), "") << "a folder";
}

// A limit on the size of files ends a write in the middle, as a full disk does.
TEST_P(Cache, LeavesNothingOnAFullDisk) {
  const pid_t child = fork();
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    const rlimit little{3000, 3000};
    setrlimit(RLIMIT_FSIZE, &little);
    _exit(sleigh().check(folder_).empty() ? 0 : 1);
  }
  int status = 0;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_TRUE(files().empty());
}

// Six processes use the same entry for a while and spoil its file; two of them are killed at any moment.
TEST_P(Cache, SurvivesWritersAndKills) {
  const fs::path file = entry();
  std::vector<pid_t> children;
  for (int i = 0; i < 6; ++i) {
    const pid_t child = fork();
    if (child == 0) {
      std::error_code none;
      for (int k = 0; k < 3; ++k) {
        if (!sleigh().check(folder_).empty()) _exit(1);
        if (i % 2 == 0)
          fs::resize_file(file, 100 + 1000 * static_cast<unsigned>(k), none);
        else
          unlink(file.c_str());
      }
      _exit(0);
    }
    children.push_back(child);
  }
  for (int i = 0; i < 2; ++i)
    usleep(static_cast<useconds_t>(40000 + 70000 * i)), kill(children[static_cast<std::size_t>(i)], SIGKILL);
  for (std::size_t i = 0; i < children.size(); ++i) {
    int status = 0;
    ASSERT_EQ(waitpid(children[i], &status, 0), children[i]);
    EXPECT_TRUE(status == 0 || (i < 2 && WIFSIGNALED(status))) << i << ": " << status;
  }
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_EQ(sleigh().check(folder_), "");
}

// The files are sparse: large, without much space on the disk.
TEST_P(Cache, IsBounded) {
  const auto make = [&](const std::string& name, std::uintmax_t size, std::chrono::hours age) {
    const fs::path file = folder_ + "/" + name;
    put(file, "");
    fs::resize_file(file, size);
    fs::last_write_time(file, ago(age));
    return file;
  };
  const fs::path oldest = make("kernel-1.o", 100 << 20, 30h), old = make("kernel-2.o", 100 << 20, 20h),
                 recent = make("kernel-3.o", 100 << 20, 10h);
  const fs::path foreign = make("thesis.tex", 300 << 20, 1000h), part = make("kernel-4.o.abcdef", 10, 5h),
                 fresh = make("kernel-5.o.abcdef", 10, 0h);
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_FALSE(fs::exists(oldest));
  EXPECT_FALSE(fs::exists(old)) << "a quarter is left free";
  EXPECT_TRUE(fs::exists(recent));
  EXPECT_TRUE(fs::exists(foreign));
  EXPECT_FALSE(fs::exists(part)) << "of a process that is gone";
  EXPECT_TRUE(fs::exists(fresh)) << "of a process that may be writing";
}

// An entry that is used counts as new.
TEST_P(Cache, KeepsWhatIsUsed) {
  const fs::path file = entry();
  fs::last_write_time(file, ago(1000h));
  EXPECT_EQ(sleigh().check(folder_), "");
  EXPECT_GT(fs::last_write_time(file), ago(1h));
}

// The suite has one instance if the compiler is expected here, else none.
INSTANTIATE_TEST_SUITE_P(Folders, Cache, testing::Range(0, test::compiler_expected() ? 1 : 0));

#endif

TEST(CacheFolder, ComesFromTheEnvironment) {
  const std::string home = std::getenv("HOME") ? std::getenv("HOME") : "";
  setenv("ANHOLON_CACHE", "/a", 1);
  EXPECT_EQ(code_cache(), "/a");
  setenv("ANHOLON_CACHE", "", 1);
  EXPECT_EQ(code_cache(), "");
  unsetenv("ANHOLON_CACHE");
  setenv("XDG_CACHE_HOME", "/b", 1);
  EXPECT_EQ(code_cache(), "/b/anholon");
  setenv("HOME", "/c", 1);
  for (const char* none : {"", "relative"}) {
    setenv("XDG_CACHE_HOME", none, 1);
    EXPECT_EQ(code_cache(), "/c/.cache/anholon");
  }
  unsetenv("XDG_CACHE_HOME");
  unsetenv("HOME");
  EXPECT_EQ(code_cache(), "");
  setenv("ANHOLON_CACHE", "", 1);
  setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace anholon::cache_test
