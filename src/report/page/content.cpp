#include "report/page/content.h"

namespace anholon {

std::string page_title(const Page& page) {
  const std::string& title = page.cases[0].scenario->model->title;
  return title.empty() ? page.source.name : title;
}

}  // namespace anholon
