#include "cli/models/conserved.h"

#include <algorithm>

#include "cli/say.h"

namespace anholon::cli {

// The length of the longest formula that is printed, in characters; --json has all formulas.
static constexpr std::size_t kLongest = 160;

static bool cyclic(const Conserved& c) { return c.name.rfind("momentum of ", 0) == 0; }

// Returns the modes of contacts and of constraints with 'active' for which the equations hold; empty if the model has
// none.
static std::string modes(const Model& model) {
  for (const ModelNote& note : model.notes)
    if (note.of_modes())
      return note.about == ModelNote::About::open_contacts ? "no contact touches" : "the modes are those of the start";
  return "";
}

// Prints the integrals of the list that may jump, or those that may not; `where` names the part of a motion in which
// they are conserved.
static void print_conserved(const Mechanics& m, const std::vector<Conserved>& list, bool jumps,
                            const std::string& where) {
  std::string names;
  if (std::none_of(list.begin(), list.end(), [&](const Conserved& c) { return c.jumps == jumps; })) return;
  for (const Conserved& c : list)
    if (c.jumps == jumps && cyclic(c)) names += (names.empty() ? "" : ", ") + c.name.substr(12);
  say(stdout, "\nconserved along every motion%s (proved)%s\n", where.c_str(),
      names.empty() ? "" : (", cyclic: " + names).c_str());
  for (const Conserved& c : list) {
    if (c.jumps != jumps) continue;
    const std::string formula = print(c.value, m.model->names, Format::text);
    const std::string unit = unit_of(*m.model, c);
    say(stdout, "  %s%s%s\n", c.name.c_str(), unit.empty() || unit == "1" ? "" : (" (" + unit + ")").c_str(),
        formula.size() > kLongest ? "" : (" = " + formula).c_str());
  }
}

void print_conserved(const Mechanics& m) {
  const std::vector<Conserved> list = conserved(m);
  const bool resets =
      std::any_of(m.model->events.begin(), m.model->events.end(), [](const Event& e) { return !e.set.empty(); });
  const std::string in = modes(*m.model), in_modes = in.empty() ? "" : " while " + in;
  print_conserved(m, list, false, (resets ? " between events" : "") + in_modes);
  print_conserved(m, list, true,
                  (resets ? " between events and jumps of the formula" : " between jumps of the formula") + in_modes);
}

void write_conserved(JsonWriter& j, const Mechanics& m) {
  j.key("conserved").open_array();
  for (const Conserved& c : conserved(m)) {
    j.open_object().key("name").string(c.name).key("cyclic").boolean(cyclic(c));
    j.key("formula").string(print(c.value, m.model->names, Format::text)).key("because").string(c.because);
    if (c.jumps) j.key("jumps").boolean(true);
    if (const std::string in = modes(*m.model); !in.empty()) j.key("while").string(in);
    if (const std::string unit = unit_of(*m.model, c); !unit.empty()) j.key("unit").string(unit);
    j.close();
  }
  j.close();
}

}  // namespace anholon::cli
