// Writes the rows of a run, in its number type, to a sink of doubles, with texts for the digits beyond those of a
// double.
#pragma once
#include <string>
#include <vector>

#include "numeric/quad.h"
#include "result/table.h"

namespace anholon {

template <Number N>
class RowWriter {
 public:
  using W = Wider<N>;
  RowWriter(RowSink& sink, int digits) : sink_(sink), digits_(digits) {}

  void columns(const std::vector<RunColumn>& columns) { sink_.columns(columns); }
  // `label`: the time as it is to be written; empty if its number is to be written.
  void row(const W& t, const std::string& label, const std::vector<W>& numbers) {
    values_.assign(1, to_double(t));
    for (const W& x : numbers) values_.push_back(to_double(x));
    texts_.clear();
    if (kWide) {
      texts_.push_back(text(t));
      for (const W& x : numbers) texts_.push_back(text(x));
    }
    if (!label.empty()) texts_.resize(std::max<std::size_t>(1, texts_.size())), texts_[0] = label;
    sink_.row({values_, texts_});
    ++rows_;
  }
  // Writes a row of numbers in doubles.
  void row(const W& t, const std::string& label, const std::vector<double>& numbers)
    requires std::same_as<N, double>
  {
    values_.assign(1, to_double(t));
    values_.insert(values_.end(), numbers.begin(), numbers.end());
    texts_.clear();
    if (!label.empty()) texts_.assign(1, label);
    sink_.row({values_, texts_});
    ++rows_;
  }
  void step(const W& end) {
    sink_.step(to_double(end));
    ++steps_;
  }

  // A number with all its digits.
  WrittenNumber written(const W& x) const { return {to_double(x), kWide ? text(x) : std::string()}; }

  // Rows and steps since the start of the motion, also those before a continued run.
  std::size_t rows() const { return rows_; }
  std::size_t steps() const { return steps_; }
  void go_on(std::size_t rows, std::size_t steps) { rows_ = rows, steps_ = steps; }

 private:
  static constexpr bool kWide = !std::same_as<N, double>;

  std::string text(const W& x) const {
    if constexpr (std::same_as<N, Multi>)
      return number_text(x, digits_ + 2);
    else if constexpr (std::same_as<N, Quad>)
      return quad_text(x, digits_);
    else
      return number_text(convert<N>(x));
  }

  RowSink& sink_;
  int digits_;
  std::size_t rows_ = 0, steps_ = 0;
  std::vector<double> values_;
  std::vector<std::string> texts_;
};

}  // namespace anholon
