#include "ensemble/store/sweep_store.h"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <set>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/assert.h"
#include "base/diagnostic.h"
#include "base/hash.h"
#include "base/json.h"
#include "base/read_file.h"
#include "ensemble/store/folder.h"

namespace anholon {

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPart = "part-", kEnding = ".parquet";
constexpr const char *kSweepNote = "anholon.sweep", *kFirstNote = "anholon.first", *kOutcomesNote = "anholon.outcomes",
                     *kEventsNote = "anholon.events", *kRuleNote = "anholon.rule";
// The characters between the words of a note and the next ones. The name of an event may contain a comma.
constexpr char kOutcomeEnds = ',', kEventEnds = '\n';
// Programs that read a folder as one table ignore names that begin with '_'. A folder may have the request under the
// second name, which pandas takes for a part.
constexpr const char *kRequest = "_sweep.json", *kOtherRequest = "sweep.json";
constexpr const char* kPlan = "_generation-";
constexpr const char* kJudgement = "_judgement.json";
constexpr const char* kRemove = "remove it; the same command of the sweep computes it again";

// Returns a text for a message; long texts are not printed.
std::string shown(const std::string& text) {
  constexpr std::size_t kMost = 60;
  if (text.empty()) return "not given";
  return text.size() > kMost || text.find('\n') != std::string::npos ? "another text" : "'" + text + "'";
}

// Throws Failure that names the first difference of two requests.
void must_agree(const std::string& folder, const SweepRequest& there, const SweepRequest& here) {
  const auto refuse = [&](const std::string& what, const std::string& old, const std::string& now) {
    throw Failure({},
                  folder + " holds another sweep: " + what +
                      (old == now ? " differs" : " is " + old + " there and " + now + " here"),
                  "give another folder; a sweep goes on by the same command");
  };
  // The order is that of the request with more texts, so that its message names what the other one lacks.
  const bool more_there = there.asked.size() > here.asked.size();
  std::set<std::string> names;
  for (const SweepRequest* r : {more_there ? &there : &here, more_there ? &here : &there})
    for (const auto& entry : r->asked) {
      const std::string& name = entry.first;
      if (!names.insert(name).second) continue;
      const auto text_in = [&](const SweepRequest& of) {
        const auto at = std::find_if(of.asked.begin(), of.asked.end(), [&](const auto& e) { return e.first == name; });
        return at == of.asked.end() ? std::string() : at->second;
      };
      const std::string old = text_in(there), now = text_in(here);
      if (old != now) refuse(name, shown(old), shown(now));
    }
  if (there.units != here.units) refuse("units of parameters", shown(there.units), shown(here.units));
  if (there.cases != here.cases) refuse("the number of cases", std::to_string(there.cases), std::to_string(here.cases));
  for (std::size_t k = 0; k < std::max(there.columns.size(), here.columns.size()); ++k) {
    const auto name = [&](const SweepRequest& r) { return k < r.columns.size() ? r.columns[k] : std::string(); };
    if (name(there) != name(here)) refuse("column " + std::to_string(k + 1), shown(name(there)), shown(name(here)));
  }
}

// Creates a folder, and those above it. Returns an empty string, or the reason of a failure.
std::string create_folder(const std::string& folder) {
  std::error_code why;
  fs::create_directories(folder, why);
  if (why && !fs::is_directory(folder)) return "cannot create the folder " + folder + ": " + why.message();
  return {};
}

// The name of the request in a folder.
const char* request_in(const std::string& folder) {
  std::error_code none;
  const bool other = !fs::exists(folder + "/" + kRequest, none) && fs::exists(folder + "/" + kOtherRequest, none);
  return other ? kOtherRequest : kRequest;
}

std::string without_slash(std::string folder) {
  while (folder.size() > 1 && folder.back() == '/') folder.pop_back();
  return folder;
}

std::string read_or_fail(const std::string& path) {
  std::string text, why;
  if (!read_file(path, text, &why)) throw Failure({}, "cannot read " + path + ": " + why);
  return text;
}

// The name of the file of a part.
std::string name_of(std::size_t part) {
  std::string number = std::to_string(part);
  constexpr std::size_t kDigits = 6;
  if (number.size() < kDigits) number.insert(0, kDigits - number.size(), '0');
  return std::string(kPart) + number + std::string(kEnding);
}

// The number of a part by the name of its file; nullopt for any other file, such as a copy part-2.parquet.
std::optional<std::size_t> part_of(std::string_view name) {
  if (!name.starts_with(kPart) || !name.ends_with(kEnding)) return std::nullopt;
  const std::string_view digits = name.substr(kPart.size(), name.size() - kPart.size() - kEnding.size());
  std::size_t number = 0;
  const auto [end, why] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (why != std::errc() || end != digits.data() + digits.size() || name_of(number) != name) return std::nullopt;
  return number;
}

// The words of a column with the number of cases that have each. A case is counted once, although it has a row at each
// of the requested times.
std::string words_of_cases(const ParquetTable& rows, std::string_view column, char ends) {
  std::map<std::string, std::size_t> count;
  const std::vector<std::int64_t>* numbers = nullptr;
  for (const ParquetColumn& c : rows.columns)
    if (c.name == "case" && !numbers) numbers = std::get_if<std::vector<std::int64_t>>(&c.values);
  for (const ParquetColumn& c : rows.columns)
    if (const auto* words = std::get_if<Words>(&c.values); words && c.name == column)
      for (std::size_t row = 0; row < words->rows.size(); ++row)
        if (row == 0 || !numbers || (*numbers)[row] != (*numbers)[row - 1]) ++count[words->different[words->rows[row]]];
  std::string text;
  for (const auto& [word, cases] : count)
    if (!word.empty()) text += (text.empty() ? "" : std::string(1, ends)) + word + " " + std::to_string(cases);
  return text;
}

void add_words(std::string_view text, char ends, std::map<std::string, std::size_t>& to) {
  while (!text.empty()) {
    const std::string_view entry = text.substr(0, text.find(ends));
    const std::size_t space = std::min(entry.rfind(' '), entry.size());
    std::size_t count = 0;
    if (space < entry.size()) std::from_chars(entry.data() + space + 1, entry.data() + entry.size(), count);
    to[std::string(entry.substr(0, space))] += count;
    text.remove_prefix(std::min(entry.size() + 1, text.size()));
  }
}

// The end of a file, with the metadata of a Parquet file, and when the file was written.
struct FileEnd {
  std::string bytes;  // empty if the file is incomplete
  double written = 0;
};

// Most ends are read by one call, because a folder may contain many parts.
FileEnd end_of(const std::string& path) {
  FileEnd end;
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) return end;
  struct stat info{};
  const auto last = [&](std::size_t count) {
    std::string text(count, '\0');
    const ssize_t got = ::pread(fd, text.data(), count, info.st_size - static_cast<off_t>(count));
    return got == static_cast<ssize_t>(count) ? text : std::string();
  };
  constexpr std::size_t kLast = 8, kUsual = 4096;
  if (::fstat(fd, &info) == 0 && info.st_size >= static_cast<off_t>(kLast)) {
    const auto size = static_cast<std::size_t>(info.st_size);
    end.written = static_cast<double>(info.st_mtim.tv_sec) + 1e-9 * static_cast<double>(info.st_mtim.tv_nsec);
    const std::string usual = last(std::min(size, kUsual));
    const std::size_t wanted = usual.empty() ? 0 : parquet_end(std::string_view(usual).substr(usual.size() - kLast));
    if (wanted > 0 && wanted <= size)
      end.bytes = wanted <= usual.size() ? usual.substr(usual.size() - wanted) : last(wanted);
  }
  ::close(fd);
  return end;
}

}  // namespace

SweepStore::SweepStore(std::string folder, SweepRequest request)
    : folder_(std::move(folder)), request_(std::move(request)) {
  SweepRequest distinguished = request_;
  distinguished.recipe.clear(), distinguished.model_name.clear();
  id_ = sha256_text(request_json(distinguished, ""));
  add(request_.cases, {});
}

bool SweepStore::is_there(const std::string& folder) {
  std::error_code none;
  return fs::is_regular_file(folder + "/" + request_in(folder), none);
}

SweepStore SweepStore::open(const std::string& named) {
  const std::string folder = without_slash(named);
  if (!is_there(folder))
    throw Failure({}, folder + " is no folder of a sweep: it holds no " + kRequest,
                  "anholon sweep MODEL --vary … -o " + folder + "/ makes one");
  const std::string path = folder + "/" + request_in(folder);
  SweepStore store{folder, request_of(read_or_fail(path), path)};
  store.look_for_generations();
  return store;
}

SweepStore SweepStore::open(const std::string& named, const SweepRequest& wanted, const std::string& program) {
  ANHOLON_ASSERT(wanted.chunk > 0);
  const std::string folder = without_slash(named);
  bool made = false;
  if (!is_there(folder)) {
    // A folder with more files takes minutes to list, and their numbers fill the memory.
    constexpr std::size_t kMostParts = 10'000'000;
    if (wanted.cases / wanted.chunk > kMostParts)
      throw Failure({},
                    std::to_string(wanted.cases) + " cases in parts of " + std::to_string(wanted.chunk) +
                        " are more than " + std::to_string(kMostParts) + " parts",
                    "larger parts: --chunk " + std::to_string(wanted.cases / kMostParts + 1));
    if (std::string why = create_folder(folder); !why.empty()) throw Failure({}, why);
    for (const std::string& name : files_of(folder))
      if (part_of(name) || name.starts_with(kPlan) || name == kJudgement)
        throw Failure({}, "the folder " + folder + " holds parts of a sweep, and its " + kRequest + " is missing",
                      "give another folder, or put " + std::string(kRequest) + " back");
      else if (!name.starts_with(".tmp-") && name != kRequest)
        throw Failure({}, "the folder " + folder + " holds other files ('" + name + "') and no sweep",
                      "give the name of a new folder, or of an empty one");
    const Committed done = commit_file(folder, kRequest, request_json(wanted, program));
    if (done.how == Committed::How::failed) throw Failure({}, done.error);
    made = done.how == Committed::How::mine;
  }
  SweepStore store = open(folder);
  if (store.request_.units.empty() && !wanted.units.empty()) refuse_si_units(folder, wanted.units);
  must_agree(folder, store.request_, wanted);
  store.made_here_ = made;
  clear_unfinished(folder);
  return store;
}

void SweepStore::refuse_si_units(const std::string& folder, const std::string& units) {
  throw Failure({},
                folder +
                    " was made by an earlier build, and its columns of parameters are in SI units; now a column is in "
                    "the unit that the file declares: " +
                    units,
                "compute the sweep again in another folder; the build that made this one reads it");
}

const std::string& SweepStore::asked(const std::string& name) const {
  static const std::string none;
  for (const auto& [key, text] : request_.asked)
    if (key == name) return text;
  return none;
}

std::size_t generation_of(const std::vector<Generation>& generations, std::size_t number) {
  std::size_t g = generations.size() - 1;
  while (g > 0 && generations[g].first_case > number) --g;
  return g;
}

void SweepStore::add(std::size_t cases, std::string rule) {
  Generation g{0, cases, 0, (cases + request_.chunk - 1) / request_.chunk, std::move(rule)};
  if (!generations_.empty()) g.first_case = this->cases(), g.first_part = parts();
  generations_.push_back(std::move(g));
}

std::string SweepStore::plan_path(std::size_t generation) const {
  const std::string number = std::to_string(generation);
  return folder_ + "/" + kPlan + (number.size() < 2 ? "0" : "") + number + std::string(kEnding);
}

void SweepStore::look_for_generations() {
  std::error_code none;
  for (std::string path; fs::exists(path = plan_path(generations_.size()), none);) try {
      const FileEnd read = end_of(path);
      const ParquetSummary end = parquet_summary(read.bytes);
      ParquetTable notes;
      notes.notes = end.notes;
      if (notes.note(kSweepNote) != id_ || notes.note(kFirstNote) != std::to_string(cases()) || end.rows == 0)
        throw Failure({}, "it belongs to another sweep");
      add(end.rows, std::string(notes.note(kRuleNote)));
    } catch (const Failure& f) {
      throw Failure({}, path + ": " + f.diagnostic.message, "remove it; the same command of the sweep plans it again");
    }
}

void SweepStore::add_generation(const std::vector<std::int64_t>& places, std::size_t axes, const std::string& rule) {
  ParquetTable table;
  for (std::size_t axis = 0; axis < axes; ++axis) {
    std::vector<std::int64_t> along;
    for (std::size_t k = axis; k < places.size(); k += axes) along.push_back(places[k]);
    table.columns.push_back({"axis " + std::to_string(axis + 1), std::move(along)});
  }
  table.notes = {{kSweepNote, id_}, {kFirstNote, std::to_string(cases())}, {kRuleNote, rule}};
  const std::string bytes = parquet_bytes(table), path = plan_path(generations_.size());
  const Committed done = commit_file(folder_, fs::path(path).filename().string(), bytes);
  if (done.how == Committed::How::failed) throw Failure({}, done.error);
  if (done.how == Committed::How::other && read_or_fail(path) != bytes)
    throw Failure({}, path + " has other points than those planned here",
                  "another process refines the folder by another rule, or it was changed");
  add(places.size() / axes, rule);
}

std::vector<std::int64_t> SweepStore::points_of(std::size_t generation) const {
  const std::string path = plan_path(generation);
  const std::string bytes = read_or_fail(path);
  ParquetTable table;
  try {
    table = read_parquet(bytes);
  } catch (const Failure& f) {
    throw Failure({}, path + ": " + f.diagnostic.message, "remove it; the same command of the sweep plans it again");
  }
  std::vector<std::int64_t> places(table.rows() * table.columns.size());
  for (std::size_t axis = 0; axis < table.columns.size(); ++axis) {
    const auto* along = std::get_if<std::vector<std::int64_t>>(&table.columns[axis].values);
    if (!along) throw Failure({}, path + " holds no points");
    for (std::size_t k = 0; k < along->size(); ++k) places[k * table.columns.size() + axis] = (*along)[k];
  }
  return places;
}

std::size_t SweepStore::cases() const { return generations_.back().first_case + generations_.back().cases; }

std::size_t SweepStore::parts() const { return generations_.back().first_part + generations_.back().parts; }

std::pair<std::size_t, std::size_t> SweepStore::range(std::size_t part) const {
  std::size_t g = generations_.size() - 1;
  while (g > 0 && generations_[g].first_part > part) --g;
  const Generation& of = generations_[g];
  const std::size_t from = of.first_case + (part - of.first_part) * request_.chunk;
  return {from, std::min(of.first_case + of.cases, from + request_.chunk)};
}

std::string SweepStore::path_of(std::size_t part) const { return folder_ + "/" + name_of(part); }

std::vector<std::size_t> SweepStore::present() const {
  std::vector<std::size_t> list;
  for (const std::string& name : files_of(folder_))
    if (const auto part = part_of(name); part && *part < parts()) list.push_back(*part);
  std::sort(list.begin(), list.end());
  return list;
}

std::vector<std::size_t> SweepStore::missing() const {
  const std::vector<std::size_t> there = present();
  std::vector<std::size_t> list;
  for (std::size_t part = 0; part < parts(); ++part)
    if (!std::binary_search(there.begin(), there.end(), part)) list.push_back(part);
  return list;
}

std::string SweepStore::commit(std::size_t part, ParquetTable rows) const {
  std::vector<std::pair<std::string, std::string>> notes{
      {kSweepNote, id_},
      {kFirstNote, std::to_string(range(part).first)},
      {kOutcomesNote, words_of_cases(rows, "outcome", kOutcomeEnds)}};
  if (std::string events = words_of_cases(rows, "event", kEventEnds); !events.empty())
    notes.emplace_back(kEventsNote, std::move(events));
  rows.notes.insert(rows.notes.begin(), notes.begin(), notes.end());
  const std::string bytes = parquet_bytes(rows), path = path_of(part);
  const Committed done = commit_file(folder_, fs::path(path).filename().string(), bytes);
  if (done.how != Committed::How::other) return done.error;
  std::string there;
  if (!read_file(path, there, nullptr) || there != bytes)
    return path +
           " has other numbers than those computed here: it was changed, or another version of the program wrote it";
  return {};
}

void SweepStore::check(std::size_t part, const std::string& path, std::string_view belongs,
                       std::string_view first) const {
  if (belongs != id_ || first != std::to_string(range(part).first))
    throw Failure({}, path + " belongs to another sweep, or " + request_in(folder_) + " was changed", kRemove);
}

ParquetTable SweepStore::read(std::size_t part) const {
  const std::string path = path_of(part);
  const std::string bytes = read_or_fail(path);
  try {
    ParquetTable table = read_parquet(bytes);
    check(part, path, table.note(kSweepNote), table.note(kFirstNote));
    return table;
  } catch (const Failure& f) {
    if (f.diagnostic.message.starts_with(path)) throw;
    throw Failure({}, path + ": " + f.diagnostic.message, kRemove);
  }
}

std::string SweepStore::judgement() const {
  const std::string path = folder_ + "/" + kJudgement;
  std::string text;
  if (!read_file(path, text, nullptr)) return {};
  if (!judgement_text(text))
    throw Failure({}, path + " is damaged", "remove it; the same command of the sweep writes it again");
  return text;
}

std::string SweepStore::add_judgement(const std::string& json) const {
  return commit_file(folder_, kJudgement, json).error;
}

SweepStore::Progress SweepStore::progress() const {
  Progress p;
  p.all_parts = parts(), p.all_cases = cases();
  p.parts_there.resize(generations_.size());
  std::vector<std::pair<double, std::size_t>> written;  // when, how many cases
  std::vector<std::size_t> there;
  for (const std::string& name : files_of(folder_)) {
    p.unfinished += name.starts_with(".tmp-");
    if (const auto part = part_of(name); part && *part < p.all_parts) there.push_back(*part);
  }
  for (const std::size_t part : there) {
    const std::string path = path_of(part);
    const FileEnd read = end_of(path);
    ParquetSummary end;
    try {
      end = parquet_summary(read.bytes);
    } catch (const Failure& f) {
      throw Failure({}, path + ": " + f.diagnostic.message, kRemove);
    }
    ParquetTable notes;
    notes.notes = std::move(end.notes);
    check(part, path, notes.note(kSweepNote), notes.note(kFirstNote));
    const auto [from, to] = range(part);
    ++p.parts, p.cases += to - from;
    ++p.parts_there[generation_of(generations_, from)];
    add_words(notes.note(kOutcomesNote), kOutcomeEnds, p.outcomes);
    add_words(notes.note(kEventsNote), kEventEnds, p.events);
    if (const std::string_view stopped = notes.note(kStoppedNote); !stopped.empty()) p.stopped.emplace_back(stopped);
    written.emplace_back(read.written, to - from);
  }
  // A case may have several rows in a table, so cases are counted by ranges.
  std::sort(written.begin(), written.end());
  constexpr std::size_t kLast = 64;
  if (written.size() > 1) {
    const std::size_t from = written.size() > kLast ? written.size() - kLast : 0;
    std::size_t cases = 0;
    for (std::size_t k = from + 1; k < written.size(); ++k) cases += written[k].second;
    const double seconds = written.back().first - written[from].first;
    if (seconds > 0) p.cases_per_second = static_cast<double>(cases) / seconds;
  }
  return p;
}

}  // namespace anholon
