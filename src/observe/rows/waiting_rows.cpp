#include "observe/rows/waiting_rows.h"

namespace anholon {

std::unique_ptr<WaitingRows> WaitingRows::make(Workspace& s, const std::vector<Conserved>& conserved, int stages,
                                               const std::vector<long double>& parameters, const RowPlace& start,
                                               double end) {
  Column terms;
  for (const Conserved& c : conserved) terms.insert(terms.end(), c.terms.begin(), c.terms.end());
  RowExpressions expressions(s, terms);
  auto kernel = RowKernel::make(s, expressions.all, stages, parameters, start, end);
  return kernel ? std::unique_ptr<WaitingRows>(new WaitingRows(s, std::move(expressions), std::move(kernel))) : nullptr;
}

WaitingRows::WaitingRows(const Scenario& s, RowExpressions expressions, std::unique_ptr<RowKernel> kernel)
    : expressions_(std::move(expressions)), kernel_(std::move(kernel)), multipliers_(s.model->constraints.size()),
      places_(kernel_->lanes()), labels_(places_.size()) {
  for (std::size_t i = 0; i < s.system.constraints.size(); ++i)
    multipliers_[s.system.constraints[i]] = s.system.coordinates + i;
}

void WaitingRows::add(const Stepper<double>& stepper, long double t, const std::string& label) {
  if (count_ == 0) since_ = std::chrono::steady_clock::now();
  RowPlace& place = places_[count_];
  place.t = t;
  stepper.foretell(t, place.state, place.leading);
  labels_[count_] = label;
  ++count_;
}

}  // namespace anholon
