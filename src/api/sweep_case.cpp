#include "api/sweep_case.h"

#include <algorithm>
#include <cmath>

#include "base/json.h"
#include "ensemble/variation.h"
#include "formula/formula.h"
#include "numeric/number.h"
#include "observe/rows/quantity_units.h"
#include "report/columns.h"
#include "result/table.h"
#include "setup/choice.h"

namespace anholon::v1 {

namespace {

using inner::Failure;
using inner::SweepStore;

// The options that give initial values, by their order.
constexpr const char* kOrders[] = {"q", "qdot", "qddot", "qdddot"};
constexpr const char* kMultipliers[] = {"lambda", "lambdadot"};
constexpr std::string_view kInitial = "(0)";
// The beginning of the names under which Python and C++ keep the varied values.
constexpr std::string_view kVary = "vary ";

// Splits "a=1 b=8 cm,c=2" into words of one name each; a name ends at = or, if it is drawn at random, at ~. A comma in
// brackets belongs to a name: k[1,2].
std::vector<std::string> words_of(const std::string& text) {
  std::vector<std::string> words;
  const auto separator = [&](std::size_t at) {
    for (int depth = 0; at < text.size(); ++at) {
      if (text[at] == '[' || text[at] == '(') ++depth;
      if (text[at] == ']' || text[at] == ')') --depth;
      if (depth <= 0 && (text[at] == ' ' || text[at] == ',')) return at;
    }
    return std::string::npos;
  };
  std::size_t from = 0;
  for (std::size_t at = separator(0); at != std::string::npos; at = separator(at + 1)) {
    const std::size_t sign = text.find_first_of("=~", at), next = separator(at + 1);
    if (sign == std::string::npos || sign > next) continue;
    words.push_back(text.substr(from, at - from));
    from = at + 1;
  }
  if (from < text.size()) words.push_back(text.substr(from));
  return words;
}

std::string name_in(const std::string& word) { return word.substr(0, word.find_first_of("=~")); }
std::string value_in(const std::string& word) { return word.substr(std::min(word.find('='), word.size() - 1) + 1); }

// Returns the option that gives an initial value to a name with primes: {"qdot", "phi=5"} for phi'.
AskedWord initial_word(std::string name, const std::string& value) {
  const auto primes = static_cast<std::size_t>(std::count(name.begin(), name.end(), '\''));
  std::erase(name, '\'');
  return {kOrders[std::min(primes, std::size(kOrders) - 1)], name + "=" + value};
}

// Returns the parameter of the name; nullptr if the model has none.
const inner::Parameter* parameter_of(const inner::Model& model, const std::string& name) {
  const auto& all = model.parameters;
  const auto found = std::find_if(all.begin(), all.end(), [&](const inner::Parameter& p) { return p.name == name; });
  return found == all.end() ? nullptr : &*found;
}

AskedWord set_word(const std::string& name, const std::string& number) { return {"set", name + "=" + number}; }

// Splits a list at its commas; a name that holds a comma is quoted.
std::vector<std::string> listed(const std::string& text) {
  return text.empty() ? std::vector<std::string>() : inner::csv_cells(text);
}

// Returns the scenarios that --vary case=a,b runs through.
std::vector<std::string> scenarios_of_command(const SweepStore& store) {
  for (const std::string& word : words_of(store.asked("vary")))
    if (name_in(word) == "case") return listed(value_in(word));
  return {};
}

// Returns the scenarios that vary in a sweep of the command line, of Python or of C++.
std::vector<std::string> varied_scenarios(const SweepStore& store) {
  const std::vector<std::string> of_library = listed(store.asked("vary case"));
  return of_library.empty() ? scenarios_of_command(store) : of_library;
}

// Returns the names that vary beside the scenarios.
std::vector<std::string> varied(const SweepStore& store) {
  std::vector<std::string> names;
  for (const std::string& word : words_of(store.asked("vary")))
    if (name_in(word) != "case") names.push_back(inner::normal_name(name_in(word)));
  for (const auto& [what, text] : store.request().asked)
    if (what.starts_with(kVary) && what != "vary case") names.push_back(inner::normal_name(what.substr(kVary.size())));
  if (const std::string& table = store.asked("table of cases"); !table.empty()) {
    const inner::CaseTable cases(table, "of the sweep");
    for (const std::string& name : cases.names()) names.push_back(inner::normal_name(name));
  }
  return names;
}

// Returns the scenarios that the sweep applies to all cases. Their names are separated by spaces and may hold spaces,
// so the names in the model tell where each one ends.
std::vector<std::string> scenarios(const SweepStore& store) {
  std::string text = store.asked("case");
  // The first scenario that varies is among them.
  if (const std::vector<std::string> names = scenarios_of_command(store); !names.empty() && text.ends_with(names[0])) {
    text.erase(text.size() - names[0].size());
    while (text.ends_with(' ')) text.pop_back();
  }
  if (text.empty()) return {};
  if (text.find(' ') == std::string::npos) return {text};
  std::vector<std::string> known, list;
  if (const auto model = opened(model_asked(store.request()), {})) known = model->cases();
  std::sort(known.begin(), known.end(), [](const auto& a, const auto& b) { return a.size() > b.size(); });
  while (!text.empty()) {
    const auto at = std::find_if(known.begin(), known.end(), [&](const std::string& name) {
      return text.starts_with(name) && (text.size() == name.size() || text[name.size()] == ' ');
    });
    list.push_back(at == known.end() ? text.substr(0, text.find(' ')) : *at);
    text.erase(0, std::min(text.size(), list.back().size() + 1));
  }
  return list;
}

// Returns the end of the motions of a sweep that gives only the times of its rows.
std::string last_time(const SweepStore& store) {
  std::vector<std::string> times;
  const std::string& text = store.asked("at");
  for (std::size_t from = 0; from < text.size();) {
    const std::size_t space = std::min(text.find(' ', from), text.size());
    times.push_back(text.substr(from, space - from));
    from = space + 1;
  }
  if (times.empty()) return {};
  const auto number = [](const std::string& word) { return Number(word); };
  const std::string& start = store.asked("start");
  const bool forwards =
      start.empty() || constant(number(times.back()), "at").value > constant(number(start), "start").value;
  return forwards ? times.back() : times.front();
}

std::size_t part_with(const SweepStore& store, std::size_t number) {
  if (number >= store.cases())
    throw Failure({}, "there is no case " + std::to_string(number),
                  "the cases are numbered from 0 to " + std::to_string(store.cases() - 1));
  const inner::Generation& g = store.generations()[generation_of(store.generations(), number)];
  const std::size_t part = g.first_part + (number - g.first_case) / store.request().chunk;
  const std::vector<std::size_t> there = store.present();
  if (!std::binary_search(there.begin(), there.end(), part))
    throw Failure({}, "the part of case " + std::to_string(number) + " is missing: " + store.path_of(part),
                  "the command of the sweep computes it");
  return part;
}

const inner::ParquetColumn* column(const inner::ParquetTable& rows, const std::string& name) {
  const auto at = std::find_if(rows.columns.begin(), rows.columns.end(), [&](const auto& c) { return c.name == name; });
  return at == rows.columns.end() ? nullptr : &*at;
}

std::size_t row_of(const inner::ParquetTable& rows, std::size_t number) {
  if (const inner::ParquetColumn* c = column(rows, "case"))
    if (const auto* numbers = std::get_if<std::vector<std::int64_t>>(&c->values)) {
      const auto at = std::find(numbers->begin(), numbers->end(), static_cast<std::int64_t>(number));
      if (at != numbers->end()) return static_cast<std::size_t>(at - numbers->begin());
    }
  throw Failure({}, "the part of case " + std::to_string(number) + " does not hold the case",
                "a sweep without --columns keeps the numbers of the cases");
}

// Returns the value of an option among the words of a case; the last one counts.
std::string word(const std::vector<AskedWord>& words, std::string_view option) {
  std::string text;
  for (const AskedWord& w : words)
    if (w.option == option) text = w.word;
  return text;
}

// Sets the part of the initial state that an option gives.
void give(PrepareOptions& options, const AskedWord& w) {
  const std::string name = name_in(w.word), value = value_in(w.word);
  for (std::size_t order = 0; order < std::size(kOrders); ++order)
    if (w.option == kOrders[order]) {
      // --qdot "x'=2" also means x'.
      std::string plain = name;
      if (order > 0) std::erase(plain, '\'');
      options.initial.insert_or_assign(plain + std::string(order, '\''), Number(value));
    }
  for (std::size_t order = 0; order < std::size(kMultipliers); ++order)
    if (w.option == kMultipliers[order])
      options.initial.insert_or_assign("lambda." + name + std::string(order, '\''), Number(value));
}

// Quotes a word for a shell.
std::string quoted(const std::string& word) {
  if (word.find_first_not_of("abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_=.,+-/:") ==
      std::string::npos)
    return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
  return text + "'";
}

bool is_motion_option(const std::string& name) {
  const auto& rows = inner::motion_options();
  return std::any_of(rows.begin(), rows.end(), [&](const inner::MotionOption& o) { return o.name == name; });
}

// Reads the model of the sweep with its scenarios, of those that vary the first one.
Result<Model> model_of(const SweepStore& store) {
  ReadOptions reading;
  reading.mode = words_of(store.asked("mode"));
  reading.cases = scenarios(store);
  if (const std::vector<std::string> all = varied_scenarios(store); !all.empty()) reading.cases.push_back(all.front());
  return opened(model_asked(store.request()), reading);
}

// Returns the units in which columns of varied parameters would be now: "m in g, a in deg"; empty if the model cannot be
// read, or if all of them are in SI units.
std::string units_now(const SweepStore& store) {
  const auto& asked = store.request().asked;
  const auto tells_units = [](const auto& text) { return text.second.find("unit") != std::string::npos; };
  if (std::none_of(asked.begin(), asked.end(), tells_units)) return {};
  const Result<Model> model = model_of(store);
  if (!model) return {};
  std::string units;
  for (const std::string& column : store.request().columns)
    if (const inner::Parameter* p = parameter_of(*model->data().model, column))
      if (const std::string unit = inner::declared_unit(*p).name; !unit.empty())
        units += (units.empty() ? "" : ", ") + column + " in " + unit;
  return units;
}

}  // namespace

SweepStore opened_to_read(const std::string& folder) {
  SweepStore store = SweepStore::open(folder);
  if (!store.request().units.empty()) return store;
  if (const std::string units = units_now(store); !units.empty()) SweepStore::refuse_si_units(store.folder(), units);
  return store;
}

std::vector<AskedWord> words_of_sweep(const SweepStore& store) {
  std::vector<AskedWord> list;
  const auto each = [&](const char* option) {
    for (const std::string& w : words_of(store.asked(option))) list.push_back({option, w});
  };
  const auto one = [&](const char* option, const std::string& text) {
    if (!text.empty()) list.push_back({option, text});
  };
  each("set");
  for (const std::string& name : scenarios(store)) one("case", name);
  one("t", store.asked("t"));
  for (const char* option : kOrders) each(option);
  for (const char* option : kMultipliers) each(option);
  // Python names initial values like a model file.
  std::string initial = store.asked("initial");
  constexpr std::string_view kMultiplier = " as multiplier";
  for (std::size_t at; (at = initial.find(kMultiplier)) != std::string::npos;) {
    const std::size_t from = initial.rfind(' ', at - 1);
    initial.erase(at, kMultiplier.size());
    initial.insert(from == std::string::npos ? 0 : from + 1, "lambda.");
  }
  for (const std::string& w : words_of(initial)) list.push_back(initial_word(name_in(w), value_in(w)));
  for (std::string rest = store.asked("eliminate"); !rest.empty();) {
    const std::size_t end = std::min(rest.find_first_of(" ,"), rest.size());
    one("eliminate", rest.substr(0, end));
    rest.erase(0, end + 1);
  }
  for (const inner::MotionOption& o : inner::motion_options())
    if (std::string_view(o.name) != "at") one(o.name, store.asked(o.name));
  if (store.asked("to").empty()) one("to", last_time(store));
  return list;
}

std::vector<AskedWord> words_of_case(const SweepStore& store, std::size_t number) {
  const inner::ParquetTable rows = store.read(part_with(store, number));
  const std::size_t row = row_of(rows, number);
  std::vector<AskedWord> list;
  const auto keeps = [&](const inner::ParquetColumn* c, const std::string& name) {
    if (!c)
      throw Failure({}, "the folder does not keep '" + name + "', which varies",
                    "a sweep without --columns keeps all that varies");
    return c;
  };
  if (!varied_scenarios(store).empty()) {
    const auto& names = std::get<inner::Words>(keeps(column(rows, "case_name"), "case")->values);
    list.push_back({"case", names.different[names.rows[row]]});
  }
  for (const std::string& name : varied(store)) {
    const inner::ParquetColumn* at_start = column(rows, name + std::string(kInitial));
    const inner::ParquetColumn* c = keeps(at_start ? at_start : column(rows, name), name);
    const auto* numbers = std::get_if<std::vector<double>>(&c->values);
    if (!numbers || !std::isfinite((*numbers)[row]))
      throw Failure({}, "the folder holds no number of '" + name + "' in case " + std::to_string(number));
    const std::string value = inner::number_text((*numbers)[row]);
    list.push_back(at_start ? initial_word(name, value) : set_word(name, value));
  }
  return list;
}

std::vector<AskedWord> words_of_numbers(const inner::Model& model,
                                        const std::vector<std::pair<std::string, std::string>>& numbers,
                                        bool of_scenarios) {
  std::vector<AskedWord> list;
  for (const auto& number : numbers) {
    const std::string &name = number.first, &value = number.second;
    const bool parameter = parameter_of(model, name);
    if (of_scenarios && name == "case" && list.empty())
      list.push_back({name, value});
    else
      list.push_back(parameter ? set_word(name, value) : initial_word(name, value));
  }
  return list;
}

std::string command_of_sweep(const SweepStore& store) {
  const std::string& name = store.request().model_name;
  std::string text = "anholon report " + quoted(name.empty() ? "model.toml" : name);
  for (const AskedWord& w : words_of_sweep(store)) text += " --" + w.option + " " + quoted(w.word);
  return text;
}

std::string command_of_case(const SweepStore& store, std::size_t number) {
  if (!store.asked("mode").empty()) {
    const std::string of = std::to_string(number);
    inner::JsonWriter folder;
    folder.string(store.folder());
    return "python3 -c " + quoted("import anholon; anholon.open_sweep(" + folder.text() + ").run(" + of +
                                  ").page(\"case-" + of + ".html\")");
  }
  std::string text = command_of_sweep(store);
  for (const AskedWord& w : words_of_case(store, number)) text += " --" + w.option + " " + quoted(w.word);
  return text + " -o case-" + std::to_string(number) + ".html";
}

Result<System> system_of_case(const SweepStore& store, std::size_t number) {
  return guarded(model_asked(store.request()), [&] { return system_of_words(store, words_of_case(store, number)); });
}

Result<System> system_of_words(const SweepStore& store, const std::vector<AskedWord>& of_case) {
  const inner::SourceText source = model_asked(store.request());
  return guarded(source, [&]() -> Result<System> {
    std::vector<AskedWord> words = words_of_sweep(store);
    words.insert(words.end(), of_case.begin(), of_case.end());
    ReadOptions reading;
    PrepareOptions options;
    for (const AskedWord& w : words) {
      if (w.option == "set") reading.set.insert_or_assign(name_in(w.word), Number(value_in(w.word)));
      if (w.option == "case") reading.cases.push_back(w.word);
      if (w.option == "eliminate") options.eliminate.push_back(w.word);
      if (w.option == "t") options.initial.insert_or_assign("t", Number(w.word));
      give(options, w);
    }
    reading.mode = words_of(store.asked("mode"));
    const Result<Model> model = opened(source, reading);
    if (!model) return model.error();
    options.form = model->data().model->simulate.form.value_or("routh");
    if (const std::string form = word(words, "form"); !form.empty()) options.form = form;
    return prepare(*model, options);
  });
}

std::map<std::string, std::string> units_of_columns(const SweepStore& store) {
  std::map<std::string, std::string> units;
  const Result<Model> model = model_of(store);
  if (!model) return units;
  const std::map<std::string, std::string> known = inner::quantity_units(*model->data().model, model->data().contacts);
  for (const std::string& column : store.request().columns) {
    const std::string name = column.ends_with(kInitial) ? column.substr(0, column.size() - kInitial.size()) : column;
    if (const auto unit = known.find(name); unit != known.end()) units[column] = unit->second;
  }
  return units;
}

std::map<std::string, std::vector<double>> points_of_axes(const SweepStore& store) {
  constexpr std::size_t kMostPoints = 65536;
  std::map<std::string, std::vector<double>> points;
  const Result<Model> model = model_of(store);
  if (!model) return points;
  const inner::Model& of = *model->data().model;
  const auto take = [&](const auto& add) {
    try {
      inner::Variation variation;
      add(variation);
      variation.finish({}, "cases");
      if (variation.cases() > kMostPoints) return;
      for (std::size_t k = 0; k < variation.cases(); ++k) {
        const std::vector<inner::Rational> values = variation(k);
        for (std::size_t i = 0; i < values.size(); ++i) {
          const inner::Varied& v = variation.varied()[i];
          const std::string column = v.name + (v.kind == inner::Varied::Kind::initial ? std::string(kInitial) : "");
          points[column].push_back(inner::from_rational<double>(values[i]));
        }
      }
    } catch (const Failure&) {  // the values are drawn
    } catch (const inner::MistakeInWord&) {
    }
  };
  std::vector<std::string> words = words_of(store.asked("vary"));
  for (const auto& [what, text] : store.request().asked)
    if (what.starts_with(kVary)) words.push_back(text);
  for (const std::string& word : words)
    if (name_in(word) != "case") take([&](inner::Variation& v) { v.add(word, of); });
  if (const std::string& table = store.asked("table of cases"); !table.empty())
    take([&](inner::Variation& v) { v.add(std::make_shared<const inner::CaseTable>(table, "of the sweep"), of); });
  return points;
}

MotionOptions options_of_case(const SweepStore& store, const MotionOptions& given) {
  MotionOptions options = given;
  const OptionWords members = words_of_members(given);
  const auto is_given = [&](const std::string& name) {
    return std::any_of(members.begin(), members.end(), [&](const auto& each) { return each.first == name; });
  };
  for (const AskedWord& w : words_of_sweep(store))
    if (w.option != "form" && is_motion_option(w.option) && !is_given(w.option))
      options.others.emplace(w.option, w.word);
  return options;
}

MotionOptions with_intervals(const System& system, MotionOptions options, int count) {
  options.others.erase("every");
  const auto end = options.others.find("to");
  if (end == options.others.end()) return options;
  const inner::Rational to = constant(Number(end->second), "to").value, start(system.data().scenario.state.t);
  if (to != start) options.every = Number(inner::Rational(abs(inner::Rational(to - start)) / count).get_str());
  return options;
}

MotionOptions drawn_case(const SweepStore& store, const System& system) {
  MotionOptions options = options_of_case(store, {});
  if (options.others.count("every") != 0) return options;
  const inner::Model& model = *system.data().model->model;
  return with_intervals(system, std::move(options),
                        inner::rows_to_look_at(model.coordinates.size(), model.constraints.size()));
}

}  // namespace anholon::v1
