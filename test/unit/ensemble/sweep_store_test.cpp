#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>

#include <gtest/gtest.h>
#include <unistd.h>

#include "base/diagnostic.h"
#include "base/read_file.h"
#include "ensemble/store/folder.h"
#include "ensemble/store/sweep_store.h"

namespace anholon::sweep_store_test {

namespace fs = std::filesystem;

class SweepStoreTest : public testing::Test {
 protected:
  void SetUp() override {
    folder = fs::temp_directory_path() /
             ("anholon-store-" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder);
  }
  void TearDown() override { fs::remove_all(folder); }

  SweepRequest request() const {
    return {{{"model", "title = \"a\""}, {"tolerance", "1e-12"}}, {"case", "outcome"}, 10, 4};
  }
  ParquetTable part(std::size_t from, std::size_t to) const {
    std::vector<std::int64_t> numbers;
    Words words;
    for (std::size_t k = from; k < to; ++k)
      numbers.push_back(static_cast<std::int64_t>(k)), words.add(k == 5 ? "singular" : "finished");
    ParquetTable t;
    t.columns = {{"case", numbers}, {"outcome", words}};
    return t;
  }
  std::string message(const std::function<void()>& f) const {
    try {
      f();
    } catch (const Failure& e) {
      return e.diagnostic.message;
    }
    return "no failure";
  }
  fs::path folder;
};

TEST_F(SweepStoreTest, GoesOnWhereItStopped) {
  {
    const SweepStore store = SweepStore::open(folder.string() + "/", request(), "1");
    EXPECT_EQ(store.parts(), 3U);
    EXPECT_EQ(store.commit(1, part(4, 8)), "");
  }
  SweepRequest again = request();
  again.chunk = 5;  // the chunk of the folder is used
  const SweepStore store = SweepStore::open(folder, again, "2");
  EXPECT_EQ(store.request().chunk, 4U);
  EXPECT_EQ(store.missing(), (std::vector<std::size_t>{0, 2}));
  EXPECT_EQ(store.range(2), (std::pair<std::size_t, std::size_t>(8, 10)));
  EXPECT_EQ(std::get<1>(store.read(1).columns[0].values), (std::vector<std::int64_t>{4, 5, 6, 7}));
  EXPECT_EQ(store.asked("tolerance"), "1e-12");
  const SweepStore::Progress p = store.progress();
  EXPECT_EQ(p.parts, 1U);
  EXPECT_EQ(p.cases, 4U);
  EXPECT_EQ(p.outcomes, (std::map<std::string, std::size_t>{{"finished", 3}, {"singular", 1}}));
}

// A case has a row at each requested time.
TEST_F(SweepStoreTest, ACaseWithSeveralRowsCountsOnce) {
  const SweepStore store = SweepStore::open(folder, request(), "1");
  ParquetTable rows;
  Words words;
  for (const char* word :
       {"finished", "finished", "singular", "singular", "finished", "finished", "finished", "finished"})
    words.add(word);
  rows.columns = {{"case", std::vector<std::int64_t>{0, 0, 1, 1, 2, 2, 3, 3}}, {"outcome", words}};
  EXPECT_EQ(store.commit(0, rows), "");
  EXPECT_EQ(store.progress().outcomes, (std::map<std::string, std::size_t>{{"finished", 3}, {"singular", 1}}));
}

TEST_F(SweepStoreTest, APartCountsOnce) {
  const SweepStore store = SweepStore::open(folder, request(), "1");
  EXPECT_EQ(store.commit(0, part(0, 4)), "");
  EXPECT_EQ(store.commit(0, part(0, 4)), "") << "by another process";
  EXPECT_NE(store.commit(0, part(1, 5)), "") << "with other numbers";
  EXPECT_EQ(std::get<1>(store.read(0).columns[0].values)[0], 0);
  EXPECT_EQ(files_of(folder).size(), 2U) << "nothing unfinished is left";
}

TEST_F(SweepStoreTest, ACopyOfAPartIsNoPart) {
  const SweepStore store = SweepStore::open(folder, request(), "1");
  EXPECT_EQ(store.commit(2, part(8, 10)), "");
  for (const char* name : {"part-2.parquet", "part-0000002.parquet", "part-000002.parquet.parquet"})
    fs::copy_file(folder / "part-000002.parquet", folder / name);
  EXPECT_EQ(store.present(), (std::vector<std::size_t>{2}));
  EXPECT_EQ(store.progress().cases, 2U);
}

TEST_F(SweepStoreTest, TellsWhyCasesStopped) {
  const SweepStore store = SweepStore::open(folder, request(), "1");
  const auto commit = [&](std::size_t number, ParquetTable rows, std::size_t first, const std::string& message) {
    StoppedByKind stopped;
    count_stopped(stopped, first, {OutcomeKind::finished, "", ""});
    count_stopped(stopped, first, {OutcomeKind::singular, message, "a \"hint\""});
    count_stopped(stopped, first + 1, {OutcomeKind::singular, "another", "hint"});
    rows.notes.emplace_back(SweepStore::kStoppedNote, stopped_json(stopped));
    EXPECT_EQ(store.commit(number, std::move(rows)), "");
  };
  commit(1, part(4, 8), 5, "the second part");
  commit(0, part(0, 4), 2, "the first\npart");
  EXPECT_EQ(store.commit(2, part(8, 10)), "") << "a part without such cases";
  StoppedByKind all;
  const SweepStore::Progress p = store.progress();
  ASSERT_EQ(p.stopped.size(), 2U);
  for (const std::size_t k : {1U, 0U}) add_stopped(all, p.stopped[k]);
  ASSERT_EQ(all.size(), 1U);
  const StoppedCases& s = all.at(OutcomeKind::singular);
  EXPECT_EQ(s.count, 4U);
  EXPECT_EQ(s.first, 2U);
  EXPECT_EQ(s.outcome.message, "the first\npart");
  EXPECT_EQ(s.outcome.hint, "a \"hint\"");
  EXPECT_NE(message([&] { add_stopped(all, "[{}]"); }), "no failure");
}

TEST_F(SweepStoreTest, KeepsTheFilesOfTheModel) {
  SourceText model{"cart.toml",
                   "title = \"a\"",
                   {},
                   {{"below.toml", "base text"}},
                   {{"a.csv", "gr\xF6\xDF"
                              "e,1\n"}}};
  SweepRequest asked = request();
  add_files(asked.asked, model);
  model.others.clear();
  model.tables.push_back({"b.csv", "0,1\n"});
  add_files(asked.asked, model);
  SweepStore::open(folder, asked, "1");
  // Bytes that are not UTF-8 are lost, and the stored request equals itself.
  const SourceText kept = model_asked(SweepStore::open(folder, asked, "1").request());
  EXPECT_EQ(kept.text, "title = \"a\"");
  ASSERT_EQ(kept.others.size(), 1U);
  EXPECT_EQ(kept.others[0].text, "base text");
  ASSERT_EQ(kept.tables.size(), 2U);
  EXPECT_EQ(kept.tables[0].name, "a.csv");
  EXPECT_EQ(kept.tables[1].text, "0,1\n");
  model.tables[1].text = "0,2\n";
  SweepRequest changed = request();
  add_files(changed.asked, model);
  EXPECT_NE(message([&] { SweepStore::open(folder, changed, "1"); }).find("holds another sweep"), std::string::npos);
}

TEST_F(SweepStoreTest, ReadsAFolderOfAnEarlierVersion) {
  {
    EXPECT_EQ(SweepStore::open(folder, request(), "1").commit(0, part(0, 4)), "");
  }
  fs::rename(folder / "_sweep.json", folder / "sweep.json");
  EXPECT_TRUE(SweepStore::is_there(folder));
  EXPECT_EQ(SweepStore::open(folder, request(), "1").missing(), (std::vector<std::size_t>{1, 2}));
  EXPECT_EQ(files_of(folder), (std::vector<std::string>{"part-000000.parquet", "sweep.json"}));
}

// Columns of parameters of a folder without units are in SI units.
TEST_F(SweepStoreTest, RefusesAFolderWhoseColumnsHaveOtherUnits) {
  SweepStore::open(folder, request(), "1");
  std::string text;
  ASSERT_TRUE(read_file((folder / "_sweep.json").string(), text));
  EXPECT_NE(text.find("\"format_version\": 1"), std::string::npos) << text;
  SweepRequest with_units = request();
  with_units.units = "m in g, a in deg";
  EXPECT_NE(message([&] { SweepStore::open(folder, with_units, "2"); }).find("SI units"), std::string::npos);
  const fs::path other = folder / "other";
  EXPECT_EQ(SweepStore::open(other, with_units, "2").request().units, with_units.units);
  ASSERT_TRUE(read_file((other / "_sweep.json").string(), text));
  EXPECT_NE(text.find("\"format_version\": 2"), std::string::npos) << text;
  with_units.units = "m in kg";
  EXPECT_NE(message([&] { SweepStore::open(other, with_units, "2"); }).find("units of parameters"), std::string::npos);
  with_units.units.clear();
  EXPECT_NE(message([&] { SweepStore::open(other, with_units, "2"); }).find("units of parameters"), std::string::npos);
}

TEST_F(SweepStoreTest, RefusesAnotherSweep) {
  SweepStore::open(folder, request(), "1");
  SweepRequest other = request();
  other.asked[1].second = "1e-9";
  EXPECT_EQ(message([&] { SweepStore::open(folder, other, "1"); }),
            folder.string() + " holds another sweep: tolerance is '1e-12' there and '1e-9' here");
  other = request();
  other.asked[0].second = "title = \"b\"\n";
  EXPECT_NE(message([&] {
              SweepStore::open(folder, other, "1");
            }).find("model is 'title = \"a\"' there and another text here"),
            std::string::npos);
  other = request();
  other.asked.pop_back();
  EXPECT_NE(message([&] { SweepStore::open(folder, other, "1"); }).find("not given here"), std::string::npos);
  other = request();
  other.cases = 11;
  EXPECT_NE(message([&] { SweepStore::open(folder, other, "1"); }).find("number of cases is 10 there and 11 here"),
            std::string::npos);
  other = request();
  other.columns[1] = "t";
  EXPECT_NE(message([&] { SweepStore::open(folder, other, "1"); }).find("column 2 is 'outcome' there and 't' here"),
            std::string::npos);
}

TEST_F(SweepStoreTest, RefusesForeignFoldersAndParts) {
  fs::create_directories(folder);
  std::ofstream(folder / "thesis.tex") << "text";
  EXPECT_NE(message([&] { SweepStore::open(folder, request(), "1"); }).find("holds other files ('thesis.tex')"),
            std::string::npos);
  EXPECT_EQ(files_of(folder), std::vector<std::string>{"thesis.tex"});
  EXPECT_NE(message([&] { SweepStore::open(folder.string()); }).find("is no folder of a sweep"), std::string::npos);
  fs::remove(folder / "thesis.tex");
  const SweepStore store = SweepStore::open(folder, request(), "1");
  ASSERT_EQ(store.commit(0, part(0, 4)), "");
  // One part belongs to another place of the sweep, one was changed.
  fs::copy_file(store.path_of(0), store.path_of(1));
  EXPECT_NE(message([&] { store.read(1); }).find("belongs to another sweep"), std::string::npos);
  EXPECT_NE(message([&] { store.progress(); }).find("belongs to another sweep"), std::string::npos);
  std::string bytes;
  ASSERT_TRUE(read_file(store.path_of(0), bytes));
  bytes[60] = static_cast<char>(bytes[60] ^ 1);
  std::ofstream(store.path_of(0), std::ios::binary) << bytes;
  EXPECT_NE(message([&] { store.read(0); }), "no failure");
  for (const std::string text :
       {"", "{", "[]", "{\"format\": 3}", "{\"format\": \"anholon sweep\", \"format_version\": 9}",
        "{\"format\": \"anholon sweep\", \"format_version\": 1, \"cases\": -1}"}) {
    std::ofstream(folder / "_sweep.json") << text;
    EXPECT_NE(message([&] { SweepStore::open(folder.string()); }), "no failure") << text;
  }
}

TEST_F(SweepStoreTest, ClearsWhatAKillLeft) {
  SweepStore::open(folder, request(), "1");
  // No process has this number.
  char host[256] = {};
  ::gethostname(host, sizeof host - 1);
  std::string name(host);
  std::replace(name.begin(), name.end(), '-', '_');
  std::ofstream(folder / (".tmp-" + name + "-2147483646-1")) << "x";
  std::ofstream(folder / ".tmp-elsewhere-1-1") << "x";
  EXPECT_EQ(clear_unfinished(folder.string()), 1U) << "a process of another machine may be alive";
  EXPECT_EQ(files_of(folder.string()).size(), 2U);
}

TEST_F(SweepStoreTest, SaysThatItCannotWrite) {
  fs::create_directories(folder);
  EXPECT_EQ(commit_file(folder.string() + "/absent", "a", "x").how, Committed::How::failed);
  EXPECT_NE(message([&] { SweepStore::open("/proc/nowhere", request(), "1"); }).find("cannot create the folder"),
            std::string::npos);
}

}  // namespace anholon::sweep_store_test
