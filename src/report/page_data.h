// What a page gives its viewer: columns, picture and observer of every case, as viewer/CONTRACT.md has them.
#pragma once
#include "report/page.h"

namespace anholon {

// The title of the model, or the name of its file.
std::string page_title(const Page& page);

// JSON that may stand within a <script>.
std::string page_data(const Page& page);

}  // namespace anholon
