#include "anholon/sweep_folder.h"

#include <algorithm>

#include "api/sweep_case.h"
#include "api/sweep_request.h"
#include "base/escape.h"
#include "base/join.h"
#include "base/json.h"
#include "ensemble/parts/judgement.h"
#include "ensemble/refine/refine.h"
#include "result/choose_columns.h"

namespace anholon::v1 {

struct SweepFolder::Data {
  inner::SweepStore store;
  // Null if the folder was opened by its name alone.
  std::shared_ptr<const PreparedSweep> prepared;
  // Returns the folder with the generations that it holds now. Throws Failure.
  inner::SweepStore now() const {
    inner::SweepStore fresh = store;
    fresh.look_for_generations();
    return fresh;
  }
};

namespace {

// Returns the form of the equations; if the pieces have different forms, all of them one after the other.
std::string forms_of(const PreparedSweep& p) {
  std::vector<std::string> forms;
  for (const PreparedPiece& piece : p.pieces) forms.push_back(piece.system.form());
  const bool same = std::all_of(forms.begin(), forms.end(), [&](const auto& form) { return form == forms.front(); });
  return same ? forms.front() : inner::joined(forms, " ");
}

// Returns everything on which the rows depend.
std::vector<std::pair<std::string, std::string>> asked_of(const PreparedSweep& p) {
  std::vector<std::pair<std::string, std::string>> all;
  const auto add = [&](const std::string& name, const std::string& text) {
    if (!text.empty()) all.emplace_back(name, text);
  };
  const Model::Data& model = *p.model;
  const PreparedPiece& first = p.pieces.front();
  const System::Data& system = first.system.data();
  const SweepOptions& o = p.asked;
  // The mode comes first: messages name the mode before the title, which contains it.
  add("mode", inner::joined(model.mode, " ")), add("title", system.model->model->title),
      add("model", model.source.text);
  for (const PreparedPiece& piece : p.pieces) {
    // Each scenario may have tables of its own; the base files are the same.
    inner::SourceText source = piece.system.data().model->model->source_text;
    if (&piece != &first) source.others.clear();
    add_files(all, source);
  }
  std::string set;
  for (const auto& [name, value] : model.overrides) set += (set.empty() ? "" : " ") + name + "=" + value;
  add("set", set), add("case", inner::joined(model.cases, " ")), add("form", forms_of(p));
  if (system.choice.t) add("t", system.choice.t->get_str());
  std::string initial, eliminate;
  for (const inner::StateOverride& s : system.choice.overrides)
    initial += (initial.empty() ? "" : " ") +
               (s.multiplier ? system.scenario.model->constraints[s.coordinate].name
                             : system.scenario.model->coordinates[s.coordinate].name) +
               (s.multiplier ? " as multiplier" : "") + std::string(s.order, '\'') + "=" + s.value.get_str();
  for (const std::size_t k : system.choice.eliminate)
    eliminate += (eliminate.empty() ? "" : " ") + system.scenario.model->coordinates[k].name;
  add("initial", initial), add("eliminate", eliminate), add("start", inner::number_text(first.scenario->state.t));
  // Each scenario has settings of its own, which follow from its name.
  const inner::MotionSettings settings =
      p.scenarios.empty() ? inner::merged(first.settings, system.scenario.model->simulate) : first.settings;
  for (const inner::MotionOption& m : inner::motion_options())
    if (std::string_view(m.name) != "error-estimate" && std::string_view(m.name) != "form")
      add(m.name, inner::joined(inner::words(settings, m), " "));
  std::vector<std::string> names;
  for (const std::string& name : p.scenarios) names.push_back(inner::csv_cell(name));
  add("vary case", inner::joined(names, ","));
  for (const Vary& v : o.vary) add("vary " + v.name, text_of(v));
  add("table of cases", o.table), add("together", o.together ? "yes" : ""),
      add("cases", o.cases ? std::to_string(*o.cases) : "");
  add("draw", o.draw), add("seed", std::to_string(o.seed)), add("reduce", inner::joined(o.reduce, " "));
  return all;
}

template <class F>
auto told(const F& f) -> decltype(f()) {
  return guarded(inner::SourceText(), f);
}

// Appends the values of a column of a part.
void append(FolderColumn& to, const inner::ParquetColumn& from) {
  if (const auto* numbers = std::get_if<std::vector<double>>(&from.values)) {
    auto& all = std::get<std::vector<double>>(to.values);
    all.insert(all.end(), numbers->begin(), numbers->end());
  } else if (const auto* whole = std::get_if<std::vector<std::int64_t>>(&from.values)) {
    auto& all = std::get<std::vector<std::int64_t>>(to.values);
    all.insert(all.end(), whole->begin(), whole->end());
  } else {
    const inner::Words& words = std::get<inner::Words>(from.values);
    auto& all = std::get<FolderColumn::Words>(to.values);
    std::vector<std::uint32_t> places;
    for (const std::string& word : words.different) {
      const auto at = std::find(all.different.begin(), all.different.end(), word);
      places.push_back(static_cast<std::uint32_t>(at - all.different.begin()));
      if (at == all.different.end()) all.different.push_back(word);
    }
    for (const std::uint32_t k : words.rows) all.rows.push_back(places[k]);
  }
}

FolderColumn empty_column(const inner::ParquetColumn& like) {
  FolderColumn c{like.name, {}};
  if (std::holds_alternative<std::vector<std::int64_t>>(like.values)) c.values = std::vector<std::int64_t>();
  if (std::holds_alternative<inner::Words>(like.values)) c.values = FolderColumn::Words();
  return c;
}

}  // namespace

std::map<std::string, std::vector<double>> SweepFolder::points() const { return points_of_axes(data_->store); }
std::map<std::string, std::string> SweepFolder::units() const { return units_of_columns(data_->store); }
const std::string& SweepFolder::path() const { return data_->store.folder(); }
// These functions have no way to report an error: if the plan is damaged, they use what was read when the folder was
// opened.
std::size_t SweepFolder::cases() const {
  const auto now = told([&]() -> Result<std::size_t> { return data_->now().cases(); });
  return now ? *now : data_->store.cases();
}
std::size_t SweepFolder::parts() const {
  const auto now = told([&]() -> Result<std::size_t> { return data_->now().parts(); });
  return now ? *now : data_->store.parts();
}
std::size_t SweepFolder::chunk() const { return data_->store.request().chunk; }
const std::vector<std::string>& SweepFolder::columns() const { return data_->store.request().columns; }
const std::string& SweepFolder::recipe() const { return data_->store.request().recipe; }
const std::string& SweepFolder::asked(const std::string& name) const { return data_->store.asked(name); }

bool SweepFolder::keeps_files() const {
  const inner::SourceText source = model_asked(data_->store.request());
  return !source.others.empty() || !source.tables.empty();
}

Result<Model> SweepFolder::model(const ReadOptions& options) const {
  const inner::SourceText source = model_asked(data_->store.request());
  return guarded(source, [&] { return v1::opened(source, options); });
}

Result<std::vector<std::size_t>> SweepFolder::missing() const {
  return told([&]() -> Result<std::vector<std::size_t>> { return data_->now().missing(); });
}
Result<std::vector<std::size_t>> SweepFolder::present() const {
  return told([&]() -> Result<std::vector<std::size_t>> { return data_->now().present(); });
}

Result<FolderProgress> SweepFolder::progress() const {
  return told([&]() -> Result<FolderProgress> {
    const inner::SweepStore store = data_->now();
    const inner::SweepStore::Progress p = store.progress();
    FolderProgress all{p.parts, p.all_parts, p.cases, p.all_cases, p.unfinished, p.outcomes, p.cases_per_second};
    for (std::size_t g = 0; g < store.generations().size(); ++g) {
      const inner::Generation& of = store.generations()[g];
      all.generations.push_back({of.first_case, of.cases, p.parts_there[g], of.parts});
    }
    inner::StoppedByKind stopped;
    for (const std::string& note : p.stopped) inner::add_stopped(stopped, note);
    for (const auto& [kind, cases] : stopped) all.notes.push_back(inner::stopped_note(kind, cases));
    all.events = p.events;
    return all;
  });
}

Result<std::vector<FolderColumn>> SweepFolder::read(const std::vector<std::string>& names) const {
  return told([&]() -> Result<std::vector<FolderColumn>> {
    const std::vector<std::size_t> places =
        names.empty() ? chosen_places(names, columns()) : inner::chosen_columns(columns(), names);
    std::vector<FolderColumn> all;
    const inner::SweepStore store = data_->now();
    for (const std::size_t part : store.present()) {
      const inner::ParquetTable table = store.read(part);
      if (table.columns.size() != columns().size())
        throw inner::Failure({}, data_->store.path_of(part) + " has other columns than the sweep");
      for (std::size_t k = 0; k < places.size(); ++k) {
        if (all.size() <= k) all.push_back(empty_column(table.columns[places[k]]));
        append(all[k], table.columns[places[k]]);
      }
    }
    for (std::size_t k = all.size(); k < places.size(); ++k) all.push_back({columns()[places[k]], {}});
    return all;
  });
}

// Throws Failure if the folder was opened by its name alone.
static const PreparedSweep& prepared(const SweepFolder::Data& data) {
  if (!data.prepared)
    throw inner::Failure({}, "this sweep was opened to be read", "sweep_into opens it for a computation");
  return *data.prepared;
}

// Throws Failure if the sweep runs through several scenarios.
static const inner::Variation& grid_of(const PreparedSweep& p) {
  if (!p.variation())
    throw inner::Failure({}, "the cases of a file are no grid, and there is nothing to halve",
                         "a sweep of each case refines its borders");
  return *p.variation();
}

// Returns the rule by which the borders of a sweep with these columns are refined. Throws Failure.
static inner::RefineRule rule_for(const PreparedSweep& p, const std::vector<std::string>& columns,
                                  const std::string& word) {
  inner::RefineRule rule;
  try {
    rule = inner::refine_rule(word);
  } catch (const inner::MistakeInWord& m) {
    throw inner::Failure({}, "refine by " + m.word + ": " + m.diagnostic.message, "COLUMN:BOUND, such as theta:0.1");
  }
  must_be_refinable(grid_of(p), columns, rule);
  return rule;
}

Result<FolderDone> SweepFolder::fill(const FolderWork& work) const {
  return told([&]() -> Result<FolderDone> {
    const PreparedSweep& p = prepared(*data_);
    if (work.shares == 0 || work.share < 1 || work.share > work.shares)
      return mistake("there is no share " + std::to_string(work.share) + " of " + std::to_string(work.shares),
                     "shares are numbered from 1");
    const inner::SweepStore store = data_->now();
    inner::FillOptions o;
    o.parts = work.parts ? *work.parts : parts_to_do(store, work.share, work.shares);
    for (const std::size_t part : o.parts)
      if (part >= store.parts())
        return mistake("there is no part " + std::to_string(part),
                       "there are " + std::to_string(store.parts()) + " parts");
    if (o.parts.empty()) return FolderDone{0, 0, true, {}, {}};
    o.cancelled = work.cancelled, o.progress = work.progress;
    TabledPieces tabled(p);
    for (inner::EnsembleOptions& options : tabled.options) options.threads = work.threads;
    if (store.generations().size() > 1) {
      tabled.options.front().cases = store.cases();
      tabled.options.front().numbers = numbers_of(store, grid_of(p));
    }
    const inner::Filled done = inner::fill(store, tabled.pieces, o);
    return FolderDone{done.parts, done.report.done, done.parts == o.parts.size(),
                      inner::notes_on_cases(done.report, {}), done.error};
  });
}

Result<std::size_t> SweepFolder::refine(const std::string& word, std::optional<std::size_t> number) const {
  return told([&]() -> Result<std::size_t> {
    const PreparedSweep& p = prepared(*data_);
    inner::SweepStore store = data_->now();
    const inner::RefineRule rule = rule_for(p, columns(), word);
    must_go_on(store, rule);
    const std::size_t next = store.generations().size();
    if (number && *number < next) return store.generations()[*number].cases;
    if (number && *number > next)
      return mistake("generation " + std::to_string(*number) + " cannot follow on generation " +
                         std::to_string(next - 1),
                     "plan generation " + std::to_string(next) + " before it");
    if (const std::size_t missing = store.missing().size(); missing > 0)
      return mistake(std::to_string(missing) + " parts are missing, and borders follow from all cases",
                     "fill() computes them");
    return add_generation(store, grid_of(p), rule);
  });
}

using Numbers = std::vector<std::pair<std::string, std::string>>;

// Returns the numbers of a case of a prepared sweep. Throws Failure.
static Numbers numbers_in(const PreparedSweep& p, const inner::SweepStore& store, std::size_t number) {
  if (number >= store.cases())
    throw inner::Failure({}, "there is no case " + std::to_string(number),
                         "the cases are numbered from 0 to " + std::to_string(store.cases() - 1));
  std::size_t place = number;  // the place of the case in its piece
  auto piece = p.pieces.begin();
  if (!p.variation())
    for (; place >= piece->options.cases; ++piece) place -= piece->options.cases;
  const inner::EnsembleCase of =
      p.variation() ? numbers_of(store, *p.variation())(number) : piece->options.numbers(place);
  Numbers list;
  if (!piece->word.empty()) list.emplace_back("case", piece->word);
  for (std::size_t k = 0; k < of.values.size(); ++k)
    list.emplace_back(piece->options.varied[k].name, of.values[k].get_str());
  return list;
}

// Returns the words of a case: exact ones if the sweep is prepared, else those that the folder keeps. Throws Failure.
static std::vector<AskedWord> own_words(const SweepFolder::Data& data, const inner::SweepStore& store,
                                        std::size_t number) {
  if (!data.prepared) return words_of_case(store, number);
  const PreparedSweep& p = *data.prepared;
  return words_of_numbers(*p.model->model, numbers_in(p, store, number), !p.scenarios.empty());
}

Result<std::vector<std::pair<std::string, std::string>>> SweepFolder::numbers(std::size_t number) const {
  return told([&]() -> Result<Numbers> { return numbers_in(prepared(*data_), data_->now(), number); });
}

Result<std::vector<std::pair<std::string, std::string>>> SweepFolder::words(std::size_t number) const {
  using Words = std::vector<std::pair<std::string, std::string>>;
  return told([&]() -> Result<Words> {
    const inner::SweepStore store = data_->now();
    Words list;
    for (const AskedWord& w : words_of_sweep(store)) list.emplace_back(w.option, w.word);
    for (const AskedWord& w : own_words(*data_, store, number)) list.emplace_back(w.option, w.word);
    return list;
  });
}

Result<Run> SweepFolder::run(std::size_t number, const MotionOptions& options) const {
  return told([&]() -> Result<Run> {
    const inner::SweepStore store = data_->now();
    const Result<System> system = system_of_words(store, own_words(*data_, store, number));
    if (!system) return system.error();
    return simulate(*system, options_of_case(store, options));
  });
}

Result<std::string> SweepFolder::judge(const std::function<bool()>& cancelled) const {
  return told([&]() -> Result<std::string> {
    const inner::SweepStore store = data_->now();
    if (std::string kept = store.judgement(); !kept.empty()) return kept;
    const PreparedSweep& p = prepared(*data_);
    if (const std::size_t parts = store.missing().size(); parts > 0)
      return mistake(std::to_string(parts) + " of " + std::to_string(store.parts()) + " parts are missing",
                     "fill computes them");
    TabledPieces tabled(p);
    for (inner::EnsembleOptions& options : tabled.options) options.estimate = inner::ErrorEstimate::always;
    inner::EnsembleReport all;
    for (const inner::SweepPiece& piece : tabled.pieces) {
      add_report(all, judge_piece(piece, cancelled));
      if (!all.outcome.ok()) return error_of(all.outcome);
    }
    const std::string json = judgement_json(all);
    if (const std::string error = store.add_judgement(json); !error.empty()) return mistake(error);
    return json;
  });
}

// Opens or makes the folder of a prepared sweep.
static Result<SweepFolder> opened(std::shared_ptr<const PreparedSweep> prepared, const std::string& folder,
                                  std::size_t chunk, const std::string& recipe,
                                  const std::optional<std::string>& refine) {
  if (folder.empty()) return mistake("the sweep needs the name of a folder");
  TabledPieces tabled(*prepared);
  inner::SweepRequest request{asked_of(*prepared), {}, prepared->cases, chunk, recipe};
  for (const inner::SweepColumn& c : tabled.tables.front().columns()) request.columns.push_back(c.name);
  request.units = tabled.tables.front().units();
  std::optional<inner::RefineRule> rule;
  if (refine) rule = rule_for(*prepared, request.columns, *refine);
  if (chunk > inner::kMostInPart) return mistake("a part has at most " + std::to_string(inner::kMostInPart) + " cases");
  if (chunk == 0) request.chunk = inner::SweepStore::is_there(folder) ? 1 : inner::cases_in_part(tabled.pieces);
  inner::SweepStore store = inner::SweepStore::open(folder, request, "anholon " ANHOLON_VERSION);
  if (rule) must_go_on(store, *rule);
  return SweepFolder(
      std::make_shared<const SweepFolder::Data>(SweepFolder::Data{std::move(store), std::move(prepared)}));
}

Result<SweepFolder> sweep_into(const System& system, const SweepOptions& asked, const std::string& folder,
                               std::size_t chunk, const std::string& recipe, const std::optional<std::string>& refine) {
  const auto prepared = prepared_sweep(system, asked);
  if (!prepared) return prepared.error();
  return guarded(system.data().model->source, [&] { return opened(*prepared, folder, chunk, recipe, refine); });
}

Result<SweepFolder> sweep_into(const Model& model, const SweepOptions& asked, const std::string& folder,
                               std::size_t chunk, const std::string& recipe, const PrepareOptions& prepare,
                               const std::optional<std::string>& refine) {
  const auto prepared = prepared_sweep(model, prepare, asked);
  if (!prepared) return prepared.error();
  return guarded(model.data().source, [&] { return opened(*prepared, folder, chunk, recipe, refine); });
}

Result<SweepFolder> open_sweep(const std::string& folder) {
  return told([&]() -> Result<SweepFolder> {
    return SweepFolder(std::make_shared<const SweepFolder::Data>(SweepFolder::Data{opened_to_read(folder), {}}));
  });
}

}  // namespace anholon::v1
