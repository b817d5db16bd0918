// A run saved in a file, from which it continues with the same bits: everything that steps and residuals carry, as
// exact text.
//
// The file is TOML, a list of texts for every name, and ends with the hash of everything before (theory: integrals).
#pragma once
#include <map>
#include <string>
#include <vector>

#include "base/diagnostic.h"
#include "numeric/exact_text.h"

namespace anholon {

class SavedRun {
 public:
  using Texts = std::vector<std::string>;

  bool has(const std::string& name) const { return entries_.count(name) > 0; }
  void set(const std::string& name, Texts texts) { entries_[name] = std::move(texts); }
  // Throws Failure if there is no such entry; `one` also if it is not a single text.
  const Texts& texts(const std::string& name) const;
  const std::string& one(const std::string& name) const;

  template <Number N>
  void set_numbers(const std::string& name, const std::vector<N>& numbers) {
    Texts t;
    for (const N& x : numbers) t.push_back(exact_text(x));
    set(name, std::move(t));
  }
  // Throws Failure unless there are `count` numbers; kAny: any number.
  static constexpr std::size_t kAny = static_cast<std::size_t>(-1);
  template <Number N>
  std::vector<N> numbers(const std::string& name, std::size_t count = kAny) const {
    std::vector<N> list;
    for (const std::string& text : texts(name)) {
      const auto x = parse_exact<N>(text);
      if (!x) unfit(name);
      list.push_back(*x);
    }
    if (count != kAny && list.size() != count) unfit(name);
    return list;
  }
  template <Number N>
  N number(const std::string& name) const {
    return numbers<N>(name, 1)[0];
  }

  [[noreturn]] static void unfit(const std::string& name);

 private:
  friend std::string print(const SavedRun&);
  std::map<std::string, Texts> entries_;
};

std::string print(const SavedRun& run);
// Throws Failure if the text is not what `print` wrote.
SavedRun read_saved(const SourceText& source);

}  // namespace anholon
