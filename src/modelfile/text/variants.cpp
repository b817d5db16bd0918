#include "modelfile/text/variants.h"

#include <algorithm>
#include <filesystem>

#include "base/read_file.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/shipped.h"

namespace anholon {

namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostFiles = 20;

// Sections that declare names: it is a mistake if a case gives a name that the file does not declare there.
const std::vector<std::string>& declaring() {
  static const std::vector<std::string> list = {"index", "parameters", "functions",   "define",
                                                "frame", "point",      "state",       "mode",
                                                "input", "potential",  "dissipation", "quasi"};
  return list;
}

bool of_tables(const Item& i) {
  return i.kind == Item::Kind::array && !i.items.empty() &&
         std::all_of(i.items.begin(), i.items.end(), [](const Item& e) { return e.kind == Item::Kind::table; });
}

std::string name_of(const Item& element) {
  const Item* name = element.find("name");
  return name && name->kind == Item::Kind::string ? normal_name(name->text()) : std::string();
}

Item* find(std::vector<Item>& items, const std::string& key) {
  const auto it = std::find_if(items.begin(), items.end(), [&](const Item& i) { return i.key == key; });
  return it == items.end() ? nullptr : &*it;
}

Item* find_named(Item& list, const std::string& name) {
  const auto it = std::find_if(list.items.begin(), list.items.end(),
                               [&](const Item& i) { return !name.empty() && name_of(i) == name; });
  return it == list.items.end() ? nullptr : &*it;
}

// True if P[2] is declared: it is written explicitly, or a family P[…] is.
bool is_declared(const std::string& name, const std::vector<std::string>& known) {
  const std::string family = name.substr(0, name.find('[') + 1);
  return std::any_of(known.begin(), known.end(),
                     [&](const std::string& k) { return k == name || (!family.empty() && k.rfind(family, 0) == 0); });
}

// Lists the first of the known names: "there is a, b".
std::string those_there(const std::vector<std::string>& known) {
  std::string list;
  for (std::size_t k = 0; k < known.size() && k < 12; ++k) list += (k ? ", " : "there is ") + known[k];
  return list;
}

[[noreturn]] void there_is_no(const std::string& what, const Item& at, const std::vector<std::string>& known,
                              const std::string& hint) {
  const std::string near = did_you_mean(at.key, known);
  throw Failure(at.key_span,
                "there is no " + what + " '" + at.key + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                hint);
}

// Returns the hint for a list `section` that has no element of this name.
std::string hint_of_element(const std::string& section, const std::string& name,
                            const std::vector<std::string>& known) {
  if (name.find('[') != std::string::npos)
    return "of a family the element goes by the name in the file; a member of its own is written out in [[" + section +
           "]]";
  if (!did_you_mean(name, known).empty()) return {};
  return "a new one stands in a list: " + section + " = [{name = \"" + name + "\", …}]" +
         (known.empty() ? "" : "; " + those_there(known));
}

class Overlay {
 public:
  Overlay(Diagnostics& diagnostics, bool scenario) : diagnostics_(diagnostics), scenario_(scenario) {}

  void root(Item& to, const Item& from) {
    for (const Item& i : from.items) collect(diagnostics_, [&] { section(to, i); }, i.key_span);
  }

 private:
  void section(Item& to, const Item& i) {
    if (i.key == "base") {
      if (scenario_) throw Failure(i.key_span, "'base' stands at the top of a file, not in a case");
      return;  // read
    }
    Item* there = find(to.items, i.key);
    if (!there) {
      if (scenario_ && i.kind == Item::Kind::table) {
        const bool declares = std::find(declaring().begin(), declaring().end(), i.key) != declaring().end();
        if (declares) throw Failure(i.key_span, "the file has no [" + i.key + "] that the case could change");
      }
      to.items.push_back(i);
      return;
    }
    const bool names = std::find(declaring().begin(), declaring().end(), i.key) != declaring().end();
    if (scenario_ && names && there->kind == Item::Kind::table && i.kind == Item::Kind::table) {
      std::vector<std::string> known;
      for (const Item& k : there->items) known.push_back(k.key);
      for (const Item& k : i.items)
        collect(
            diagnostics_,
            [&] {
              if (!is_declared(k.key, known)) there_is_no("name", k, known, "a case changes what the file declares");
              put(*there, k);
            },
            k.key_span);
      return;
    }
    put(to, i);
  }

  // Lays an entry over a table.
  void put(Item& to, const Item& i) {
    Item* there = find(to.items, i.key);
    if (!there) {
      to.items.push_back(i);
    } else if (there->kind == Item::Kind::table && i.kind == Item::Kind::table) {
      for (const Item& k : i.items) put(*there, k);
    } else if (of_tables(*there) && of_tables(i)) {
      for (const Item& e : i.items) {
        if (Item* element = find_named(*there, name_of(e)))
          extend(*element, e);
        else
          there->items.push_back(e);
      }
    } else if (of_tables(*there) && i.kind == Item::Kind::table) {
      for (const Item& e : i.items)
        collect(
            diagnostics_,
            [&] {
              Item* element = find_named(*there, e.key);
              if (!element) {
                std::vector<std::string> known;
                for (const Item& k : there->items)
                  if (const std::string name = name_of(k); !name.empty()) known.push_back(name);
                there_is_no(i.key, e, known, hint_of_element(i.key, e.key, known));
              }
              if (e.kind != Item::Kind::table)
                throw Failure(e.span, "what is changed of " + i.key + " '" + e.key + "'?",
                              i.key + "." + e.key + ".KEY = …");
              extend(*element, e);
            },
            e.key_span);
    } else {
      const Span place = there->key_span;
      *there = i;
      if (place.line == 0) there->key_span = place;
    }
  }

  void extend(Item& element, const Item& by) {
    for (const Item& k : by.items)
      if (k.key != "name") put(element, k);
  }

  Diagnostics& diagnostics_;
  bool scenario_;
};

// Returns the file on which `source` builds: one beside it, or a shipped model by its name. `read`: with its text.
SourceText base_of(const SourceText& source, const fs::path& here, const Item& base, bool read) {
  SourceText below;
  below.name = (fs::path(source.name).parent_path() / base.text()).lexically_normal().string();
  below.path = (here.parent_path() / base.text()).string();
  std::string why;
  if (!read || read_file(below.path, below.text, &why)) return below;
  if (std::optional<SourceText> shipped = shipped_model(base.text())) return std::move(*shipped);
  throw Failure(base.formula.whole(), "cannot read the base '" + below.name + "': " + why,
                "a path from the folder of this file, or the name of a shipped model (anholon models)");
}

Item read_over(SourceText& all, std::size_t file, std::vector<fs::path>& open) {
  // Makes a copy, because the list of files grows.
  const SourceText source = file == 0 ? SourceText{all.name, all.text, all.path} : all.others[file - 1];
  Item root = read_toml(source, static_cast<std::uint32_t>(file));
  const Item* base = root.find("base");
  if (!base) return root;
  if (base->kind != Item::Kind::string) throw Failure(base->span, "base is the name of a file", "base = \"disc.toml\"");
  const fs::path here = source.path.empty() ? source.name : source.path;
  SourceText below = base_of(source, here, *base, file >= all.others.size());
  const fs::path path = below.path;
  open.push_back(fs::weakly_canonical(here));
  if (const auto again = std::find(open.begin(), open.end(), fs::weakly_canonical(path)); again != open.end()) {
    std::string way;
    for (auto it = again; it != open.end(); ++it) way += it->filename().string() + " -> ";
    throw Failure(base->formula.whole(), "the file builds on itself: " + way + path.filename().string());
  }
  if (file >= kMostFiles)
    throw Failure(base->formula.whole(), "more than " + std::to_string(kMostFiles) + " files that build on each other");
  // A text that is already in memory, such as that in the file of a run, is not read from disk.
  if (file >= all.others.size()) all.others.push_back(std::move(below));
  Item merged = read_over(all, file + 1, open);
  Diagnostics problems;
  Overlay(problems, false).root(merged, root);
  for (const Diagnostic& d : problems.list()) throw Failure(d);
  return merged;
}

}  // namespace

Item read_files(SourceText& source) {
  std::vector<fs::path> open;
  return read_over(source, 0, open);
}

Item take_cases(Item& root, Diagnostics& diagnostics) {
  Item cases;
  const auto it = std::find_if(root.items.begin(), root.items.end(), [](const Item& i) { return i.key == "case"; });
  if (it == root.items.end()) return cases;
  const auto wrong = [](const Item& i) { return i.kind != Item::Kind::table; };
  const auto bad = wrong(*it) ? it : std::find_if(it->items.begin(), it->items.end(), wrong);
  if (bad != it->items.end())
    diagnostics.error(bad->span, "'" + bad->key + "' is a section", "[case.NAME]");
  else
    cases = std::move(*it);
  root.items.erase(it);
  return cases;
}

void apply_case(Item& root, const Item& cases, const std::string& name, Diagnostics& diagnostics) {
  std::vector<std::string> known;
  std::string list;
  for (const Item& i : cases.items) {
    known.push_back(i.key);
    list += (list.empty() ? "there is " : ", ") + i.key;
    if (i.key == name) return Overlay(diagnostics, true).root(root, i);
  }
  const std::string near = did_you_mean(name, known);
  diagnostics.error({},
                    "--case: there is no case '" + name + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
                    !near.empty()  ? ""
                    : list.empty() ? "a case is a section [case.NAME] of the file"
                                   : list);
}

}  // namespace anholon
