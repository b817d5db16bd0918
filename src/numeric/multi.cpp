#include "numeric/multi.h"

namespace anholon {

mpfr_prec_t& Multi::working_bits() {
  thread_local mpfr_prec_t bits = 128;
  return bits;
}

std::string Multi::to_string(int digits) const {
  char* text = nullptr;
  mpfr_asprintf(&text, "%.*Re", digits - 1, v_);
  std::string r(text);
  mpfr_free_str(text);
  return r;
}

}  // namespace anholon
