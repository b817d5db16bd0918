#include "modelfile/text/collect.h"

#include <algorithm>

namespace anholon {

Failure silent_failure() { return Failure(Span{}, ""); }
bool is_silent(const Diagnostic& d) { return d.message.empty(); }

bool collect(Diagnostics& diagnostics, const std::function<void()>& f, Span place) {
  try {
    f();
    return true;
  } catch (const Failure& failure) {
    Diagnostic d = failure.diagnostic;
    if (d.span.line == 0) d.span = place;
    if (!is_silent(d)) diagnostics.add(std::move(d));
    return false;
  }
}

// Returns "P" for "in P[3]: …"; empty for other messages.
static std::string family_of(const std::string& message) {
  const std::size_t open = message.find('[');
  if (message.rfind("in ", 0) != 0 || open == std::string::npos || message.find(' ', 3) < open) return {};
  return message.substr(3, open - 3);
}

bool is_repeated(const Diagnostics& diagnostics, const Diagnostic& d) {
  const std::string family = family_of(d.message);
  return !family.empty() &&
         std::any_of(diagnostics.list().begin(), diagnostics.list().end(), [&](const Diagnostic& before) {
           return before.span.line == d.span.line && before.span.column == d.span.column &&
                  before.span.file == d.span.file && family_of(before.message) == family;
         });
}

bool collect(Diagnostics& diagnostics, const std::function<void()>& f, const Item& element) {
  if (element.member.empty()) return collect(diagnostics, f, element.span);
  Diagnostics own;
  const bool good = collect(own, f, element.span);
  for (Diagnostic d : own.list()) {
    d.message = "in " + element.member + ": " + d.message;
    if (!is_repeated(diagnostics, d)) diagnostics.add(std::move(d));
  }
  return good;
}

void for_each_table(const Item& list, const std::string& what, Diagnostics& diagnostics,
                    const std::function<void(const Item&, std::size_t)>& f) {
  if (list.kind != Item::Kind::array) {
    diagnostics.error(list.key_span, "'" + what + "' is a list of tables", "write [[" + what + "]] with two brackets");
    return;
  }
  for (std::size_t k = 0; k < list.items.size(); ++k)
    collect(
        diagnostics,
        [&] {
          if (list.items[k].kind != Item::Kind::table)
            throw Failure(list.items[k].span, "an element of '" + what + "' is a table", "{name = \"…\", …}");
          f(list.items[k], k);
        },
        list.items[k]);
}

}  // namespace anholon
