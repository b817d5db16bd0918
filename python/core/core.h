// The binding of the public headers to Python: one file for each header, and shared code.
//
// The classes here hold the C++ values unchanged. What a user of Python sees is written in Python on top of these
// classes (python/anholon): names, defaults, conversions, pictures.
#pragma once
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <span>
#include <string>
#include <thread>

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/array.h>
#include <nanobind/stl/complex.h>
#include <nanobind/stl/map.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/vector.h>

#include "anholon/anholon.h"
#include "ending.h"

namespace anholon::python {

namespace nb = nanobind;
using namespace nb::literals;

// Python passes numbers as the texts of exact decimals or formulas.
using Numbers = std::map<std::string, std::string>;
std::map<std::string, Number> numbers(const Numbers& texts);
using Words = std::vector<std::string>;
inline ReadOptions read_options(const Numbers& set, const Words& cases, const Words& mode) {
  return {numbers(set), cases, mode};
}

// Adds the method by which a notebook shows an object: a function of that name in anholon._display.
template <class C>
void shown(nb::class_<C>& c, const char* name) {
  c.def("_repr_html_", [function = std::string(name)](nb::handle self) {
    return nb::cast<std::string>(nb::module_::import_("anholon._display").attr(function.c_str())(self));
  });
}

// An error of the library, which becomes an exception of the Python package.
struct Trouble {
  Error error;
};

// Returns the value of the result, or throws its error as Trouble.
template <class T>
T value_of(Result<T> result) {
  if (!result) throw Trouble{result.error()};
  return *std::move(result);
}

// Calls f without the interpreter's lock.
template <class F>
auto unlocked(const F& f) {
  const Unlocked without_lock;
  return f();
}

// Attends to a computation that runs in a thread of its own, while this thread waits for it with the interpreter's lock
// released. Every 20 ms it runs Python's signal handlers, one of which raises KeyboardInterrupt, calls `stop`, whose
// value counts as in Python's `if`, and calls `progress` (functions of the user, or None). If any of them raises, or
// the process ends, the computation is stopped.
class Attendant {
 public:
  Attendant(nb::object stop, nb::object progress) : stop_(std::move(stop)), progress_(std::move(progress)) {}

  // For the computation: cancelled() is true if it is to stop, tell() reports its progress. Any thread may call them.
  bool cancelled() const { return ends_.load(std::memory_order_relaxed) || process_ends(); }
  void tell(double done, std::size_t count) {
    done_.store(done, std::memory_order_relaxed);
    count_.store(count, std::memory_order_relaxed);
  }

  // Computes f() and returns its value.
  template <class F>
  auto attend(const F& f) {
    std::optional<decltype(f())> value;
    std::exception_ptr failed;
    std::mutex mutex;
    std::condition_variable changed;
    bool ready = false;
    {
      const Unlocked without_lock;
      std::thread computing([&] {
        const Running running;
        try {
          value.emplace(f());
        } catch (...) {
          failed = std::current_exception();
        }
        const std::lock_guard lock(mutex);
        ready = true;
        changed.notify_one();
      });
      for (std::unique_lock lock(mutex); !changed.wait_for(lock, kPause, [&] { return ready; });) {
        lock.unlock();
        look();
        lock.lock();
      }
      computing.join();
    }
    if (!failed) failed = failed_;
    if (failed) std::rethrow_exception(failed);
    return *std::move(value);
  }
  // Returns the object that a handler, `stop` or `progress` raised; None if nothing was raised.
  nb::object raised() const { return raised_; }

 private:
  static constexpr std::chrono::milliseconds kPause{20};
  void look();
  bool process_ends() const { return !at_the_end_ && Ending::begun(); }

  nb::object stop_, progress_, raised_ = nb::none();
  std::exception_ptr failed_;                // an exception of look() that is no exception of Python
  const bool at_the_end_ = Ending::begun();  // functions that are called at the end of the process may compute
  std::atomic<bool> ends_{false};
  std::atomic<double> done_{0};
  std::atomic<std::size_t> count_{0};
};

// Returns a view of numbers that `owner` holds, without a copy; the array keeps the owner alive, and cannot be written
// to.
using View = nb::ndarray<nb::numpy, const double, nb::ndim<1>>;
View view(std::span<const double> numbers, nb::handle owner);

// Returns an array that owns the numbers.
template <int dimensions>
nb::ndarray<nb::numpy, double, nb::ndim<dimensions>> array(std::vector<double> numbers,
                                                           std::initializer_list<std::size_t> shape) {
  auto* held = new std::vector<double>(std::move(numbers));
  const nb::capsule owner(held, [](void* p) noexcept { delete static_cast<std::vector<double>*>(p); });
  return {held->data(), shape, owner};
}

void bind_analysis(nb::module_& m);
void bind_arrow(nb::module_& m);
void bind_dynamics(nb::module_& m);
void bind_results(nb::module_& m);
void bind_models(nb::module_& m);
void bind_motions(nb::module_& m);
void bind_sweeps(nb::module_& m);
void bind_sweep_folders(nb::module_& m);

// Pickle keeps the value of an enumeration as its number.
template <class V>
auto kept(const V& value) {
  if constexpr (std::is_enum_v<V>)
    return static_cast<int>(value);
  else
    return value;
}

// Makes a class of numbers and texts picklable.
template <class T, class... Members>
void picklable(nb::class_<T>& c, Members T::*... members) {
  c.def("__getstate__", [members...](const T& of) { return std::make_tuple(kept(of.*members)...); });
  c.def("__setstate__", [members...](T& of, const std::tuple<decltype(kept(std::declval<Members>()))...>& state) {
    new (&of) T{};
    std::apply([&](const auto&... values) { ((of.*members = static_cast<Members>(values)), ...); }, state);
  });
}

}  // namespace anholon::python
