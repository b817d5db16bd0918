#include "anholon/stop.h"

#include "base/stop.h"

namespace anholon::v1 {

struct StopRequest::Data {
  ::anholon::StopScope scope;
};

StopRequest::StopRequest(std::function<bool()> asked) : data_(new Data{::anholon::StopScope(std::move(asked))}) {}
StopRequest::~StopRequest() = default;

}  // namespace anholon::v1
