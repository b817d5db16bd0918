// The numbers of rows in doubles, several rows side by side: a kernel projects the states on the hidden constraints,
// solves for the leading derivatives, and computes the other columns of a row.
//
// A row depends on its own time and state alone: its bits are the same in any lane, beside any other rows, and with or
// without machine code.
#pragma once
#include <memory>

#include "motion/code_for_long_runs.h"
#include "setup/scenario.h"

namespace anholon {

// A time of a motion, the state there (x_j^(k), k < d_j) and a guess of the leading derivatives.
using RowPlace = Start<long double>;

class RowKernel {
 public:
  // `outputs`: expressions whose values the rows need. `stages`: the orders beyond the leading derivatives. `here`: the
  // start of the motion; `end`: its end; `rows`: about how many there will be, 0 if unknown. Many rows are computed in
  // fewer lanes, whose machine code is ready sooner.
  // Returns nullptr if rows need the reference: the form eliminates coordinates, constraints are redundant, an
  // expression contains derivatives that are not solved for, or there is no kernel for the equations.
  static std::unique_ptr<RowKernel> make(Workspace& scenario, const Column& outputs, int stages,
                                         const std::vector<long double>& parameters, const RowPlace& here, double end,
                                         std::size_t rows = 0);

  // Sets the parameters of the motion, and its end, for the rows that follow.
  void set_parameters(const std::vector<long double>& parameters);
  void set_end(double end) { end_ = end; }

  std::size_t lanes() const { return static_cast<std::size_t>(kernel_.lanes()); }
  // Puts a place into a lane; every lane needs one before compute().
  void place(std::size_t lane, const RowPlace& place);
  void compute();

  // True if the pivots of a lane are large enough for its numbers; otherwise the reference has to make the row.
  bool good(std::size_t lane) const;
  // Returns x_j^(k), k <= d_j + stages.
  double derivative(std::size_t j, int k, std::size_t lane) const {
    return kernel_.derivative(j, k, static_cast<int>(lane));
  }
  double output(std::size_t i, std::size_t lane) const { return kernel_.quadrature(i, 0, static_cast<int>(lane)); }

 private:
  RowKernel(std::shared_ptr<const KernelPlan> plan, int lanes, bool with_series,
            const std::vector<long double>& parameters, double end);

  bool with_series_;  // with orders beyond the leading derivatives
  std::shared_ptr<const KernelPlan> plan_;
  Kernel kernel_;
  double end_, spent_ = 0, at_ = 0;  // the end of the motion; seconds; the time in the first lane
  std::size_t computed_ = 0;         // the number of computations
  CodeForLongRuns code_;
};

}  // namespace anholon
