// How long one stage of a plan waits for itself.
//
// Every stage needs what the one before has solved for: along that chain one operation waits for the other, however
// many a processor can make side by side. Of a small system computed alone that is most of the time; in many lanes the
// number of operations is (Plan::work).
#pragma once
#include "kernel/plan.h"
#include "kernel/sparse_lu.h"

namespace anholon {

// In operations that wait for one another.
int latency(const Plan& plan, const SparseLu& elimination);

}  // namespace anholon
