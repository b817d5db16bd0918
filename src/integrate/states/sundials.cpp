#include "integrate/states/sundials.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <utility>

#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "base/assert.h"
#include "numeric/told_time.h"

namespace anholon {

namespace {

// Frees the objects that SUNDIALS makes by its own functions.
struct Free {
  void operator()(N_Vector v) const { N_VDestroy(v); }
  void operator()(SUNMatrix m) const { SUNMatDestroy(m); }
  void operator()(SUNLinearSolver s) const { SUNLinSolFree(s); }
  void operator()(SUNNonlinearSolver s) const { SUNNonlinSolFree(s); }
};
template <class Handle>
using Owned = std::unique_ptr<std::remove_pointer_t<Handle>, Free>;

// Making these objects fails only if memory is lacking.
template <class Handle>
Owned<Handle> owned(Handle made) {
  if (!made) throw std::bad_alloc();
  return Owned<Handle>(made);
}

void copy_to(N_Vector v, std::size_t from, const std::vector<double>& x) {
  std::copy(x.begin(), x.end(), N_VGetArrayPointer(v) + from);
}

bool all_finite(const double* x, std::size_t count) {
  return std::all_of(x, x + count, [](double v) { return is_finite(v); });
}

}  // namespace

struct Sundials::Work {
  Work(const Program& p, const std::vector<double>& parameters, const SundialsSettings& s,
       std::optional<StateRate> f = std::nullopt)
      : program(p), settings(s), field(std::move(f)), point(p, parameters, 0),
        ida(!field && s.integrator == Method::ida) {
    for (std::size_t j = 0; j < p.unknowns(); ++j)
      if (ida && p.d[j] == 0) algebraic.push_back(j);
    if (SUNContext_Create(nullptr, &context) != 0) throw std::bad_alloc();
  }
  ~Work() {
    if (memory) ida ? IDAFree(&memory) : CVodeFree(&memory);
    y.reset(), rate.reset(), id.reset(), matrix.reset(), linear.reset(), fixed_point.reset();
    SUNContext_Free(&context);
  }
  Work(const Work&) = delete;
  Work& operator=(const Work&) = delete;

  const char* title() const { return field ? "BDF" : ida ? "IDA" : "CVODE"; }
  std::size_t states() const { return point.state_size(); }
  std::size_t first_integral() const { return states() + algebraic.size(); }
  std::size_t size() const { return first_integral() + program.quadratures; }

  // Writes the rate of each state; the last of a chain is the leading derivative. The rate z' is not known, and not
  // needed.
  void put_rates(const double* from, const std::vector<double>& leading_now, double* out) const {
    for (std::size_t j = 0; j < program.unknowns(); ++j)
      for (std::size_t k = 0, d = static_cast<std::size_t>(program.d[j]), at = point.offset(j); k < d; ++k)
        out[at + k] = k + 1 < d ? from[at + k + 1] : leading_now[j];
  }
  void put_integrands(double* out) {
    point.evaluate_quadratures();
    for (std::size_t i = 0; i < program.quadratures; ++i) out[i] = point.quadrature(i)[0];
  }
  int refuse(Outcome why, bool for_good = false) {
    trouble = std::move(why);
    return for_good ? -1 : 1;  // otherwise SUNDIALS tries a smaller step
  }
  Outcome no_value() const {
    return {OutcomeKind::not_a_number,
            "a formula has no value (a root or logarithm of a negative number, or a division by zero)",
            "the motion leaves the region where the model is defined: stop it before, or change the formula"};
  }

  // Computes y' = f(t, y). Newton's method starts from the leading derivatives of the last accepted step, not from
  // those of a trial that may have been refused, so the motion keeps to its branch.
  int rates(double t, const double* from, double* out) {
    ++evaluations;
    now.assign(from, from + states());
    if (!all_finite(from, states())) return refuse(no_value());
    if (field) {
      if (Outcome o = field->evaluate(t, now); !o.ok()) return refuse(std::move(o), field->guarded());
      found = field->leading();
      std::copy(field->rate().begin(), field->rate().end(), out);
      std::copy(field->integrands().begin(), field->integrands().end(), out + first_integral());
      return 0;
    }
    point.load(t, now, branch);
    if (Outcome o = point.prepare(); !o.ok()) return refuse(std::move(o));
    if (Outcome o = point.solve(); !o.ok()) return refuse(std::move(o));
    point.leading(found);
    put_rates(from, found, out);
    put_integrands(out + first_integral());
    return all_finite(out, size()) ? 0 : refuse(no_value());
  }

  // Projects to the nearest state on the hidden constraints.
  int project(double t, const double* from, double* correction) {
    now.assign(from, from + states());
    if (Outcome o = field->evaluate(t, now, true); !o.ok()) return refuse(std::move(o), field->guarded());
    std::fill(correction, correction + size(), 0.0);
    for (std::size_t i = 0; i < states(); ++i) correction[i] = field->state()[i] - from[i];
    drift = std::max(drift, field->drift());
    return 0;
  }

  // Writes the reciprocals of the errors allowed.
  int weights(const double* from, double* out) {
    now.assign(from, from + states());
    scale_sizes(*field, now, sizes);
    for (std::size_t i = 0; i < states(); ++i) out[i] = 1 / (settings.tolerance * sizes[field->scale()[i]]);
    for (std::size_t i = first_integral(); i < size(); ++i)
      out[i] = 1 / (settings.integral_tolerance * std::max(1.0, std::abs(from[i])));
    return 0;
  }

  // Computes F(t, y, z, y', z').
  int residual(double t, const double* from, const double* from_rate, double* out) {
    ++evaluations;
    if (!all_finite(from, size()) || !all_finite(from_rate, size())) return refuse(no_value());
    now.assign(from, from + states());
    take_leading(from, from_rate, found);
    point.load(t, now, found);
    point.evaluate();
    std::size_t row = 0;
    for (std::size_t j = 0; j < program.unknowns(); ++j)
      for (std::size_t k = 0; k + 1 < static_cast<std::size_t>(program.d[j]); ++k, ++row)
        out[row] = from_rate[point.offset(j) + k] - from[point.offset(j) + k + 1];
    point.equations(equations);
    std::copy(equations.begin(), equations.end(), out + row);
    ANHOLON_ASSERT(row + equations.size() == first_integral());
    put_integrands(out + first_integral());
    for (std::size_t i = first_integral(); i < size(); ++i) out[i] = from_rate[i] - out[i];
    return all_finite(out, size()) ? 0 : refuse(no_value());
  }

  void take_leading(const double* from, const double* from_rate, std::vector<double>& out) const {
    out.resize(program.unknowns());
    for (std::size_t j = 0; j < program.unknowns(); ++j)
      if (program.d[j] > 0) out[j] = from_rate[point.offset(j + 1) - 1];
    for (std::size_t k = 0; k < algebraic.size(); ++k) out[algebraic[k]] = from[states() + k];
  }

  void start(double t, const std::vector<double>& leading_guess);
  bool start_stiff();
  Outcome step();
  Outcome interpolate(double t);
  Outcome pass(double behind);
  void start_anew(double t, const std::vector<double>& from, const std::vector<double>& leading_now,
                  const std::vector<double>& integrals_now);
  std::size_t refused() const;
  std::size_t setups() const;
  Outcome failed(int flag) const;

  const Program& program;
  SundialsSettings settings;
  std::optional<StateRate> field;  // of BDF
  Expansion<double> point;
  bool ida;
  std::vector<std::size_t> algebraic;  // unknowns of IDA that are no states
  SUNContext context = nullptr;
  void* memory = nullptr;
  Owned<N_Vector> y, rate, id;  // id: 1 for y, 0 for z
  Owned<SUNMatrix> matrix;
  Owned<SUNLinearSolver> linear;
  Owned<SUNNonlinearSolver> fixed_point;
  bool forward = true;
  double end = 0, reached = 0, shown = 0;  // the end of the motion; times of the last step and advance
  Outcome trouble;                         // the last failure inside f or F
  std::string last_error;                  // in the words of SUNDIALS
  std::size_t steps = 0, evaluations = 0;
  std::size_t refused_before = 0, setups_before = 0;  // before the method started anew
  bool jumped = false;                                // f, at the last kink
  double drift = 0;
  std::vector<double> now, found, equations, branch, sizes;
  std::vector<double> state, leading, integrals;
};

void Sundials::Work::start(double t, const std::vector<double>& leading_guess) {
  // F needs rates that fit the state; f needs a branch.
  point.load(t, state, leading_guess);
  if (Outcome o = point.prepare(); !o.ok())
    trouble = std::move(o);
  else if (o = point.solve(); !o.ok())
    trouble = std::move(o);
  point.leading(leading);
  branch = leading;
  const auto vector = [&] {
    Owned<N_Vector> v = owned(N_VNew_Serial(static_cast<sunindextype>(size()), context));
    N_VConst(0, v.get());
    return v;
  };
  y = vector();
  rate = vector();
  copy_to(y.get(), 0, state);
  for (std::size_t k = 0; k < algebraic.size(); ++k) N_VGetArrayPointer(y.get())[states() + k] = leading[algebraic[k]];
  copy_to(y.get(), first_integral(), integrals);
  put_rates(state.data(), leading, N_VGetArrayPointer(rate.get()));
  put_integrands(N_VGetArrayPointer(rate.get()) + first_integral());

  const auto keep_message = [](int, const char*, const char*, char* message, void* work) {
    static_cast<Work*>(work)->last_error = message;
  };
  const double tolerance = settings.tolerance;
  bool good = true;
  const auto set = [&](int flag) { good = good && flag == 0; };
  memory = ida ? IDACreate(context) : CVodeCreate(field ? CV_BDF : CV_ADAMS, context);
  if (!memory) throw std::bad_alloc();
  if (ida) {
    const auto f = [](realtype time, N_Vector from, N_Vector from_rate, N_Vector out, void* work) {
      return static_cast<Work*>(work)->residual(time, N_VGetArrayPointer(from), N_VGetArrayPointer(from_rate),
                                                N_VGetArrayPointer(out));
    };
    matrix = owned(SUNDenseMatrix(static_cast<sunindextype>(size()), static_cast<sunindextype>(size()), context));
    linear = owned(SUNLinSol_Dense(y.get(), matrix.get(), context));
    set(IDASetErrHandlerFn(memory, keep_message, this));
    set(IDAInit(memory, f, t, y.get(), rate.get()));
    set(IDASetUserData(memory, this));
    set(IDASStolerances(memory, tolerance, tolerance));
    set(IDASetLinearSolver(memory, linear.get(), matrix.get()));
    set(IDASetStopTime(memory, end));
    // An error of z does not affect later steps, but z depends on y', which has the noise of y / h. In the error test,
    // z would keep the order down and cost a hundred times as many steps.
    id = vector();
    N_VConst(1, id.get());
    for (std::size_t k = 0; k < algebraic.size(); ++k) N_VGetArrayPointer(id.get())[states() + k] = 0;
    set(IDASetId(memory, id.get()));
    set(IDASetSuppressAlg(memory, 1));
  } else {
    const auto f = [](realtype time, N_Vector from, N_Vector out, void* work) {
      return static_cast<Work*>(work)->rates(time, N_VGetArrayPointer(from), N_VGetArrayPointer(out));
    };
    set(CVodeSetErrHandlerFn(memory, keep_message, this));
    set(CVodeInit(memory, f, t, y.get()));
    set(CVodeSetUserData(memory, this));
    set(CVodeSetStopTime(memory, end));
    if (field) {
      good = good && start_stiff();
    } else {
      fixed_point = owned(SUNNonlinSol_FixedPoint(y.get(), 0, context));
      set(CVodeSStolerances(memory, tolerance, tolerance));
      set(CVodeSetNonlinearSolver(memory, fixed_point.get()));
    }
  }
  ANHOLON_ASSERT(good);
}

bool Sundials::Work::start_stiff() {
  const auto n = static_cast<sunindextype>(size());
  const auto weigh = [](N_Vector from, N_Vector out, void* work) {
    return static_cast<Work*>(work)->weights(N_VGetArrayPointer(from), N_VGetArrayPointer(out));
  };
  const auto onto = [](realtype time, N_Vector from, N_Vector correction, realtype, N_Vector, void* work) {
    return static_cast<Work*>(work)->project(time, N_VGetArrayPointer(from), N_VGetArrayPointer(correction));
  };
  matrix = owned(SUNDenseMatrix(n, n, context));
  linear = owned(SUNLinSol_Dense(y.get(), matrix.get(), context));
  bool good = CVodeWFtolerances(memory, weigh) == 0 && CVodeSetLinearSolver(memory, linear.get(), matrix.get()) == 0;
  if (field->constrained()) good = good && CVodeSetProjFn(memory, onto) == 0 && CVodeSetProjErrEst(memory, 0) == 0;
  // The limit on steps is checked here, for all steps together.
  return good && CVodeSetMaxNumSteps(memory, -1) == 0;
}

Outcome Sundials::Work::step() {
  if (settings.cancelled && settings.cancelled())
    return {OutcomeKind::interrupted, "interrupted", "what was computed is kept"};
  if (steps >= settings.most_steps)
    return {OutcomeKind::interrupted, std::string(title()) + " has reached the step limit",
            "allow more steps, or loosen the tolerance"};
  if (!trouble.ok()) return failed(0);
  const int flag = ida ? IDASolve(memory, end, &reached, y.get(), rate.get(), IDA_ONE_STEP)
                       : CVode(memory, end, y.get(), &reached, CV_ONE_STEP);
  if (flag < 0) return failed(flag);
  ++steps;
  trouble = {};
  if (!ida) branch = found;  // `found` is of the last evaluation, which belongs to this step
  return {};
}

Outcome Sundials::Work::failed(int flag) const {
  static_assert(CV_TOO_MUCH_ACC == IDA_TOO_MUCH_ACC && CV_ERR_FAILURE == IDA_ERR_FAIL &&
                CV_CONV_FAILURE == IDA_CONV_FAIL);
  if (flag == (ida ? IDA_MEM_FAIL : CV_MEM_FAIL)) throw std::bad_alloc();
  const std::string who = title(), when = at_time(reached);
  const std::string remedy =
      "loosen the tolerance, end the motion before, or leave the motion to Taylor's series: --integrator taylor";
  // The failure of the equations themselves comes first.
  if (!trouble.ok()) return told({trouble.kind, trouble.message + ", says " + who + when, trouble.hint}, reached);
  switch (flag) {
  case CV_TOO_MUCH_ACC:
    return told({OutcomeKind::step_collapse, who + " cannot keep the tolerance in double numbers" + when, remedy},
                reached);
  case CV_ERR_FAILURE:
    return told({OutcomeKind::step_collapse, who + " misses the tolerance with the smallest steps" + when, remedy},
                reached);
  case CV_CONV_FAILURE:
    return told(
        {OutcomeKind::no_convergence, who + "'s iteration does not converge with the smallest steps" + when, remedy},
        reached);
  default:
    return told({OutcomeKind::no_convergence, who + " cannot go on" + when + ": " + last_error, remedy}, reached);
  }
}

// Evaluates the polynomial of the last step.
Outcome Sundials::Work::interpolate(double t) {
  const int flag = ida ? IDAGetDky(memory, t, 0, y.get()) : CVodeGetDky(memory, t, 0, y.get());
  if (flag != 0)
    return told({OutcomeKind::interrupted, std::string(title()) + " has gone past t = " + number_text(t, 12),
                 "ask for rows in the order of time"},
                t);
  const double* values = N_VGetArrayPointer(y.get());
  if (ida) {
    IDAGetDky(memory, t, 1, rate.get());
    take_leading(values, N_VGetArrayPointer(rate.get()), leading);
  } else {
    leading = branch;
  }
  state.assign(values, values + states());
  integrals.assign(values + first_integral(), values + size());
  shown = t;
  return {};
}

Outcome Sundials::Work::pass(double behind) {
  if (Outcome o = interpolate(reached); !o.ok()) return o;
  if (Outcome o = field->evaluate(reached, state); !o.ok()) return o;
  const std::vector<double> rates_here = field->rate(), integrands_here = field->integrands();
  now = state;
  for (std::size_t i = 0; i < states(); ++i) now[i] += (behind - reached) * rates_here[i];
  if (Outcome o = field->evaluate(behind, now); !o.ok()) return o;
  state = now;
  for (std::size_t i = 0; i < integrals.size(); ++i) integrals[i] += (behind - reached) * integrands_here[i];
  leading = field->leading();
  shown = behind;
  std::vector<double> weight(size());
  weights(N_VGetArrayPointer(y.get()), weight.data());
  double h = 0, jump = 0;
  CVodeGetCurrentStep(memory, &h);
  for (std::size_t i = 0; i < states(); ++i)
    jump = std::max(jump, std::abs(h * (field->rate()[i] - rates_here[i])) * weight[i]);
  for (std::size_t i = 0; i < integrals.size(); ++i)
    jump = std::max(jump, std::abs(h * (field->integrands()[i] - integrands_here[i])) * weight[first_integral() + i]);
  jumped = jump > 1;
  return {};
}

void Sundials::Work::start_anew(double t, const std::vector<double>& from, const std::vector<double>& leading_now,
                                const std::vector<double>& integrals_now) {
  refused_before = refused(), setups_before = setups();
  copy_to(y.get(), 0, from);
  copy_to(y.get(), first_integral(), integrals_now);
  branch = leading_now;
  reached = t;
  const bool good = CVodeReInit(memory, t, y.get()) == 0;
  ANHOLON_ASSERT(good);
}

// The number of steps that the error test refused, or for which Newton's method failed.
std::size_t Sundials::Work::refused() const {
  long tests = 0, newton = 0;
  if (memory && field) CVodeGetNumErrTestFails(memory, &tests), CVodeGetNumStepSolveFails(memory, &newton);
  return refused_before + static_cast<std::size_t>(tests + newton);
}

// The number of set-ups, each of which makes the LU of a dense matrix.
std::size_t Sundials::Work::setups() const {
  long count = 0;
  if (memory && field) CVodeGetNumLinSolvSetups(memory, &count);
  return setups_before + static_cast<std::size_t>(count);
}

Sundials::Sundials(const Program& program, const std::vector<double>& parameters, const SundialsSettings& settings,
                   double t, double end, const std::vector<double>& state, const std::vector<double>& leading,
                   const std::vector<double>& integrals)
    : work_(std::make_unique<Work>(program, parameters, settings)) {
  begin(t, end, state, leading, integrals);
}

Sundials::Sundials(StateRate rate, const SundialsSettings& settings, double t, double end,
                   const std::vector<double>& state, const std::vector<double>& leading,
                   const std::vector<double>& integrals) {
  const Program& program = rate.program();
  const std::vector<double> parameters = rate.parameters();
  work_ = std::make_unique<Work>(program, parameters, settings, std::move(rate));
  begin(t, end, state, leading, integrals);
}

void Sundials::begin(double t, double end, const std::vector<double>& state, const std::vector<double>& leading,
                     const std::vector<double>& integrals) {
  Work& w = *work_;
  w.settings.tolerance = std::max(w.settings.tolerance, info(w.settings.integrator).least_tolerance);
  w.end = end;
  w.forward = end > t;
  w.reached = w.shown = t;
  w.state = state;
  w.integrals = integrals;
  w.integrals.resize(w.program.quadratures, 0);
  w.start(t, leading);
}

Sundials::~Sundials() = default;

Outcome Sundials::advance(double t) {
  Work& w = *work_;
  if (t == w.shown) return {};
  while (w.reached != w.end && (w.forward ? w.reached < t : w.reached > t))
    if (Outcome o = w.step(); !o.ok()) return o;
  return w.interpolate(t);
}

Outcome Sundials::step() {
  if (Outcome o = work_->step(); !o.ok()) return o;
  return work_->interpolate(work_->reached);
}

void Sundials::stop_at(double t) {
  const bool good = CVodeSetStopTime(work_->memory, t) == 0;
  ANHOLON_ASSERT(good);
}
Outcome Sundials::pass(double behind) { return work_->pass(behind); }
void Sundials::go_on_from(double t, const std::vector<double>& state, const std::vector<double>& leading,
                          const std::vector<double>& integrals) {
  if (std::exchange(work_->jumped, false)) work_->start_anew(t, state, leading, integrals);
}

std::size_t Sundials::refused() const { return work_->refused(); }
std::size_t Sundials::setups() const { return work_->setups(); }

StateRate& Sundials::rate() { return *work_->field; }

double Sundials::time() const { return work_->shown; }
const std::vector<double>& Sundials::state() const { return work_->state; }
const std::vector<double>& Sundials::leading() const { return work_->leading; }
const std::vector<double>& Sundials::integrals() const { return work_->integrals; }
std::size_t Sundials::steps() const { return work_->steps; }
std::size_t Sundials::evaluations() const { return work_->evaluations; }
double Sundials::drift() const { return work_->drift; }

}  // namespace anholon
