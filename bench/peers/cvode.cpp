// SUNDIALS' CVODE (serve.h: how it is asked): Adams with fixed-point iteration, or BDF with Newton's and dense
// difference quotients, as ADAMS says. The solver is made once; a motion begins with CVodeReInit.
#include <algorithm>
#include <stdexcept>

#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_types.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "serve.h"

namespace {

void must(int flag) {
  if (flag < 0) throw std::runtime_error("CVODE: " + std::to_string(flag));
}

template <class System, class State>
class Cvode {
 public:
  Cvode(const System& system, double tolerance, double end) : system_(system), end_(end) {
    must(SUNContext_Create(nullptr, &context_));
    const auto n = static_cast<sunindextype>(State{}.size());
    y_ = N_VNew_Serial(n, context_);
    N_VConst(0, y_);
    memory_ = CVodeCreate(ADAMS ? CV_ADAMS : CV_BDF, context_);
    must(CVodeInit(memory_, rate, 0, y_));
    must(CVodeSStolerances(memory_, tolerance, tolerance));
    must(CVodeSetUserData(memory_, this));
    must(CVodeSetMaxNumSteps(memory_, 10'000'000));
    must(CVodeSetStopTime(memory_, end));
    if (ADAMS) {
      iteration_ = SUNNonlinSol_FixedPoint(y_, 0, context_);
      must(CVodeSetNonlinearSolver(memory_, iteration_));
    } else {
      matrix_ = SUNDenseMatrix(n, n, context_);
      solver_ = SUNLinSol_Dense(y_, matrix_, context_);
      must(CVodeSetLinearSolver(memory_, solver_, matrix_));
    }
  }
  Cvode(const Cvode&) = delete;
  Cvode& operator=(const Cvode&) = delete;
  ~Cvode() {
    CVodeFree(&memory_);
    if (iteration_) SUNNonlinSolFree(iteration_);
    if (solver_) SUNLinSolFree(solver_);
    if (matrix_) SUNMatDestroy(matrix_);
    N_VDestroy(y_);
    SUNContext_Free(&context_);
  }

  std::size_t operator()(State& x) {
    std::copy(x.begin(), x.end(), N_VGetArrayPointer(y_));
    must(CVodeReInit(memory_, 0, y_));
    must(CVodeSetStopTime(memory_, end_));
    realtype t = 0;
    must(CVode(memory_, end_, y_, &t, CV_NORMAL));
    std::copy_n(N_VGetArrayPointer(y_), x.size(), x.begin());
    long steps = 0;
    must(CVodeGetNumSteps(memory_, &steps));
    return static_cast<std::size_t>(steps);
  }

 private:
  static int rate(realtype t, N_Vector y, N_Vector rate, void* self) {
    State x, d{};
    std::copy_n(N_VGetArrayPointer(y), x.size(), x.begin());
    static_cast<const Cvode*>(self)->system_(x, d, t);
    std::copy(d.begin(), d.end(), N_VGetArrayPointer(rate));
    return 0;
  }

  const System& system_;
  double end_;
  SUNContext context_ = nullptr;
  N_Vector y_ = nullptr;
  void* memory_ = nullptr;
  SUNNonlinearSolver iteration_ = nullptr;
  SUNMatrix matrix_ = nullptr;
  SUNLinearSolver solver_ = nullptr;
};

}  // namespace

int main(int argc, char** argv) { return peers::serve<Cvode>(argc, argv); }
