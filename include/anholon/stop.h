// Requests to stop computations that keep nothing: reading, derivation, proof, comparison, linear models, pages.
#pragma once
#include <functional>
#include <memory>

#include "anholon/result.h"

namespace anholon::v1 {

// While it exists, functions of this library that are called in its thread ask `asked` again and again, and end within
// about a tenth of a second once it returns true. Their Result is then an Error with the outcome `interrupted`; `prove`
// returns what was proved until then. `asked` is called often, by this thread alone: a look at an atomic flag is cheap
// enough. Requests nest. Motions and sweeps have `cancelled` in their options, which keeps their rows.
//
//   std::atomic<bool> enough = false;  // another thread sets it
//   const anholon::StopRequest request([&] { return enough.load(); });
//   const auto proof = anholon::prove(model);
//   if (proof && proof->stopped) …
class ANHOLON_API StopRequest {
 public:
  explicit StopRequest(std::function<bool()> asked);
  ~StopRequest();
  StopRequest(const StopRequest&) = delete;
  StopRequest& operator=(const StopRequest&) = delete;

 private:
  struct Data;
  std::unique_ptr<Data> data_;
};

}  // namespace anholon::v1
