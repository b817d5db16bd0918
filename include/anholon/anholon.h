// All of the library.
#pragma once
#include "anholon/compare.h"
#include "anholon/dynamics.h"
#include "anholon/equations.h"
#include "anholon/evaluate.h"
#include "anholon/linear.h"
#include "anholon/model.h"
#include "anholon/motion.h"
#include "anholon/page.h"
#include "anholon/proof.h"
#include "anholon/sweep.h"
#include "anholon/system.h"
#include "anholon/version.h"
