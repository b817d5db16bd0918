// The latency of one stage of a plan.
//
// Every stage needs the solution of the stage before: along that chain operations wait for one another, however many a
// processor can execute in parallel. For a single small system the latency is most of the time; in many lanes the
// number of operations (Plan::work) is.
#pragma once
#include "kernel/plan/plan.h"
#include "program/sparse_lu.h"

namespace anholon {

// The length of the chain, in operations.
int latency(const Plan& plan, const SparseLu& elimination);

}  // namespace anholon
