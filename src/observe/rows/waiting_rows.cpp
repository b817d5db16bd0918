#include "observe/rows/waiting_rows.h"

namespace anholon {

void WaitingBlock::add(const Motion<double>& motion, long double t, const std::string& label) {
  Waiting& row = next();
  row.place.t = t;
  motion.stepper().foretell(t, row.place.state, row.own, row.place.leading);
  if (!row.own.empty() && row.plan != motion.plan()) row.plan = motion.plan();
  row.label = label;
}

void WaitingBlock::add(const RowPlace& place) {
  Waiting& row = next();
  row = {};
  row.place = place;
}

std::unique_ptr<WaitingRows> WaitingRows::make(Workspace& s, const std::vector<Conserved>& conserved, int stages,
                                               const std::vector<long double>& parameters, const RowPlace& start,
                                               double end, std::size_t rows) {
  Column terms;
  for (const Conserved& c : conserved) terms.insert(terms.end(), c.terms.begin(), c.terms.end());
  RowExpressions expressions(s, terms);
  auto kernel = RowKernel::make(s, expressions.all, stages, parameters, start, end, rows);
  if (!kernel) return nullptr;
  return std::unique_ptr<WaitingRows>(new WaitingRows(s, std::move(expressions), std::move(kernel), parameters));
}

// Finds the sources of the numbers: row_values() is called with a point that returns the number of each request.
WaitingRows::WaitingRows(const Scenario& s, RowExpressions expressions, std::unique_ptr<RowKernel> kernel,
                         const std::vector<long double>& parameters)
    : expressions_(std::move(expressions)), kernel_(std::move(kernel)), parameters_(parameters),
      multipliers_(s.model->constraints.size()) {
  for (std::size_t i = 0; i < s.system.constraints.size(); ++i)
    multipliers_[s.system.constraints[i]] = s.system.coordinates + i;
  struct Asked {
    const WaitingRows& rows;
    mutable std::vector<Source> sources = {Source{Source::From::zero}};
    double note(Source source) const {
      sources.push_back(source);
      return static_cast<double>(sources.size() - 1);
    }
    double derivative(std::size_t j, int k) const { return note({Source::From::derivative, j, k}); }
    double multiplier(std::size_t constraint) const {
      const auto& j = rows.multipliers_[constraint];
      return j ? derivative(*j, 0) : 0;
    }
    double reaction(std::size_t coordinate) const { return note({Source::From::output, coordinate}); }
    double monitor(std::size_t i) const { return note({Source::From::output, rows.expressions_.monitors[i].at}); }
  };
  const Asked asked{*this};
  std::vector<double> questions;
  row_values(s, largest_order(s, s.structure.d), asked, asked, questions);
  for (const double q : questions) sources_.push_back(asked.sources[static_cast<std::size_t>(q)]);
}

void WaitingRows::set_parameters(const std::vector<long double>& parameters) {
  if (parameters == parameters_) return;
  parameters_ = parameters;
  kernel_->set_parameters(parameters);
  mapped_.reset();
}

// States in unknowns of the motion's kernel are converted first. Rows of another plan, which a motion leaves behind
// when it rewrites its equations, are converted separately.
void WaitingRows::compute(WaitingBlock& block, std::size_t first, std::size_t count) {
  for (std::size_t from = 0; from < count;) {
    WaitingBlock::Waiting& row = block[first + from];
    std::size_t to = from + 1;
    if (!row.own.empty()) {
      while (to < count && !block[first + to].own.empty() && block[first + to].plan == row.plan) ++to;
      convert(&row, to - from);
    }
    from = to;
  }
  for (std::size_t lane = 0; lane < lanes(); ++lane)
    kernel_->place(lane, block[first + std::min(lane, count - 1)].place);
  kernel_->compute();
}

void WaitingRows::convert(WaitingBlock::Waiting* rows, std::size_t count) {
  if (mapped_ != rows->plan) {
    mapped_ = rows->plan;
    readers_.emplace(*mapped_->map(), parameters_, static_cast<int>(lanes()));
  }
  for (std::size_t lane = 0; lane < lanes(); ++lane) {
    const WaitingBlock::Waiting& row = rows[std::min(lane, count - 1)];
    readers_->load(static_cast<int>(lane), row.place.t, row.own);
  }
  readers_->convert();
  for (std::size_t lane = 0; lane < count; ++lane)
    readers_->motion(static_cast<int>(lane), rows[lane].own, rows[lane].place.state);
}

void WaitingRows::Computed::numbers(std::vector<double>& values) const {
  values.resize(rows_.sources_.size());
  double* to = values.data();
  for (const Source& source : rows_.sources_)
    *to++ = source.from == Source::From::derivative ? derivative(source.index, source.order)
            : source.from == Source::From::output   ? output(source.index)
                                                    : 0;
}

}  // namespace anholon
