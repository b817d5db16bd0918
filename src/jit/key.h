// The name of compiled code on disk: a hash of everything that determines the code. The hash is made of the plan's
// numbers, not of the IR, which takes long to build and print.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <type_traits>
#include <vector>

#include <llvm/ADT/StringRef.h>

#include "kernel/code.h"

namespace anholon::jit {

struct Key {
  std::array<std::uint64_t, 2> half{};
  bool operator==(const Key&) const = default;
  std::string text() const;
};

Key hash(llvm::StringRef bytes);

// Collects numbers one after the other.
class Writer {
 public:
  template <class T>
    requires std::is_arithmetic_v<T> || std::is_enum_v<T>
  void add(T x) {
    bytes_.append(reinterpret_cast<const char*>(&x), sizeof x);
  }
  void add(const std::string& text) { add(text.size()), bytes_ += text; }
  void add(const Key& key) { add(key.half[0]), add(key.half[1]); }
  template <class T>
  void add(const std::vector<T>& list) {
    add(list.size());
    for (const auto& x : list) add(x);
  }
  void add(const Place& place);
  void add(const Step& step);
  void add(const PlanTerm& term);
  void add(const Coefficient& coefficient);
  void add(const Partial& partial);
  void add(const Beyond& beyond);
  void add(const Entry& entry);
  void add(const Completion& completion);
  void add(const SparseLu::Pivot& pivot);
  void add(const SparseLu::Update& update);
  void add(const SparseLu::Forward& forward);
  void add(const SparseLu::Backward& backward);
  void add(const SparseLu::Own& own);
  void add(const SparseLu::Term& term);
  void add(const SparseLu::Influence& influence);
  void add(const JudgedPivot& pivot);
  void add(const Findings& found);
  void add(const KernelTables::Knots& knots);
  void add(const KernelTables::Divisors& divisors);
  void add(const Plan& plan);
  void add(const SparseLu& elimination);
  void add(const KernelTables& tables);
  Key key() const { return hash(bytes_); }

 private:
  template <class... T>
  void all(const T&... x) {
    (add(x), ...);
  }
  std::string bytes_;
};

}  // namespace anholon::jit
