// The data of a page for its viewer: columns, picture and observer of every case, as viewer/CONTRACT.md defines them.
#pragma once
#include "report/page.h"

namespace anholon {

// The title of the model, or the name of its file.
std::string page_title(const Page& page);

// JSON that is safe within a <script>.
std::string page_data(const Page& page);

}  // namespace anholon
