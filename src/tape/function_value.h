// The value of an elementary function in any number type: a double, a number of more digits, a ball.
#pragma once
#include "expr/expr.h"
#include "numeric/number.h"

namespace anholon {

template <class N>
N function_value(Function f, const N& u) {
  switch (f) {
#define ROW(name, ...)                                                                                                 \
  case Function::name:                                                                                                 \
    return name(u);
#include "expr/elementary.def"
#undef ROW
  }
  return u;
}

}  // namespace anholon
