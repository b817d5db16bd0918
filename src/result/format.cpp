#include "result/format.h"

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>

#include "base/assert.h"

namespace anholon {

namespace {

// Returns "a, b or c".
std::string alternatives(const std::vector<std::string>& words) {
  std::string out;
  for (std::size_t i = 0; i < words.size(); ++i)
    out += (i == 0 ? "" : i + 1 == words.size() ? " or " : ", ") + words[i];
  return out;
}

const char* held(Holds what) {
  switch (what) {
  case Holds::rows:
    return "the rows";
  case Holds::report:
    return "the rows and the report";
  case Holds::everything:
    return "the model, the rows and the report";
  }
  return "";
}

const ResultFormat& recognized(std::string_view beginning) {
  for (const ResultFormat* f : result_formats())
    if (f->recognizes && f->recognizes(beginning)) return *f;
  return plain_format();
}

// A file, or the standard input for "-", that is read in parts.
class Input {
 public:
  explicit Input(const std::string& path)
      : file_(std::fopen(path == "-" ? "/dev/stdin" : path.c_str(), "rb"), std::fclose) {
    check();
  }
  // Appends the next part to the text; returns false at the end.
  bool next(std::string& text) {
    constexpr std::size_t kPart = 1u << 20, kMost = std::size_t{16} << 30;  // far beyond the size of any run
    const std::size_t before = text.size();
    if (before > kMost) throw Failure(Span{}, "the file is too large");
    text.resize(before + kPart);
    const std::size_t n = std::fread(text.data() + before, 1, kPart, file_.get());
    text.resize(before + n);
    check();
    return n > 0;
  }

 private:
  void check() const {
    if (!file_ || std::ferror(file_.get()))
      throw Failure(Span{}, "the file cannot be read: " + std::string(std::strerror(errno)));
  }
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file_;
};

}  // namespace

std::string written_number(const SweepColumn& column, double number) {
  return column.holds == SweepColumn::Holds::whole_numbers ? std::to_string(static_cast<long long>(number))
                                                           : number_text(number);
}

std::vector<const ResultFormat*> sweep_formats() {
  std::vector<const ResultFormat*> list;
  for (const ResultFormat* f : result_formats())
    if (f->open_sweep) list.push_back(f);
  return list;
}

const ResultFormat* format_of(const std::string& path) {
  for (const ResultFormat* f : result_formats())
    if (std::any_of(f->endings.begin(), f->endings.end(), [&](const char* end) { return path.ends_with(end); }))
      return f;
  return nullptr;
}

const ResultFormat& plain_format() {
  const auto& all = result_formats();
  const auto it = std::find_if(all.begin(), all.end(), [](const ResultFormat* f) { return !f->recognizes; });
  ANHOLON_ASSERT(it != all.end());
  return **it;
}

const ResultFormat& report_format() {
  const auto& all = result_formats();
  const auto it = std::find_if(all.begin(), all.end(),
                               [](const ResultFormat* f) { return f->streams && f->holds == Holds::report; });
  ANHOLON_ASSERT(it != all.end());
  return **it;
}

std::string known_files(const std::string& stem, const std::vector<const ResultFormat*>& formats) {
  std::vector<std::string> words;
  for (const ResultFormat* f : formats) words.push_back(stem + f->endings[0]);
  return alternatives(words);
}

std::string known_formats() {
  std::vector<std::string> words;
  for (const ResultFormat* f : result_formats()) words.emplace_back(f->name);
  return alternatives(words);
}

std::string held_by_formats() {
  std::string out;
  for (const Holds what : {Holds::everything, Holds::report, Holds::rows})
    for (const ResultFormat* f : result_formats())
      if (f->holds == what)
        out += (out.empty() ? "" : ", ") + std::string(f->name) + (out.empty() ? " holds " : " ") + held(what);
  return out + ".";
}

RunFile read_run(const std::string& path, SourceText* source) {
  Input file(path);
  std::string text;
  bool more = file.next(text);
  const ResultFormat& format = recognized(text);
  if (format.read_file) {
    if (path == "-")
      throw Failure(Span{}, std::string(format.name) + " cannot be read from the standard input",
                    "the name of the file");
    return format.read_file(path);
  }
  while (more) more = file.next(text);
  try {
    return format.read_text(text);
  } catch (const Failure&) {
    if (source) source->text = std::move(text);
    throw;
  }
}

}  // namespace anholon
