#include "structure/state.h"

namespace anholon {

const char* name(Origin origin) {
  switch (origin) {
  case Origin::given:
    return "given";
  case Origin::derived:
    return "derived";
  case Origin::chosen:
    return "chosen";
  case Origin::guessed:
    return "guess";
  case Origin::corrected:
    return "corrected";
  }
  return "";
}

}  // namespace anholon
