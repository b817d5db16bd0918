// The data of a page for its viewer: columns, picture and observer of every case, as viewer/CONTRACT.md defines them.
#pragma once
#include "report/page/content.h"

namespace anholon {

// JSON that is safe within a <script>.
std::string page_data(const Page& page);

}  // namespace anholon
