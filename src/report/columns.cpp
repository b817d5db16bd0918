#include "report/columns.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>

#include "base/base64.h"
#include "numeric/relative.h"
#include "print/print_names.h"
#include "report/rows/contact_bands.h"
#include "report/rows/frames.h"
#include "report/rows/page_rows.h"
#include "simulation/report_json.h"

namespace anholon {

namespace {

// Limits that keep a page small: numbers where all rows are plotted, where some are, and in the picture; columns in
// plots.
constexpr std::size_t kMostNumbers = 40000, kMostThinned = 120'000, kMostFrameNumbers = 240'000, kMostColumns = 96;
constexpr std::size_t kLeastRows = 200, kLeastFrames = 60, kMostFrames = 20'000;
// The largest part of the intervals between rows that may be doubtful; with more, paths are left out.
constexpr double kMostDoubtful = 0.05;

constexpr const char* kDerivatives[] = {"coordinates", "velocities", "accelerations", "third derivatives",
                                        "fourth derivatives"};

// The new value of a mode after an event; the run has no column for it.
struct ModeChange {
  double t;
  std::size_t parameter;
  double value;
};

std::vector<ModeChange> mode_changes(const Model& model, const std::optional<SimulationReport>& report) {
  std::vector<ModeChange> list;
  if (!report) return list;
  for (const EventReport& e : report->events)
    for (const EventReport::Change& c : e.changes)
      for (std::size_t k = 0; k < model.parameters.size(); ++k)
        if (model.parameters[k].mode && model.parameters[k].name == c.name)
          list.push_back({e.t.value, k, c.after.value});
  return list;
}

// The values of expressions at the rows of a table. A row at the time of an event is the one before the event; if there
// are two, the second is the one after it.
class AtRows {
 public:
  AtRows(const Model& model, const RunTable& table, const Column& es, std::vector<double> parameters,
         const std::vector<ModeChange>& modes)
      : tape_(compile(es)), parameters_(std::move(parameters)), modes_(modes), table_(table) {
    const ColumnOf column = column_of(model, table);
    for (const Input& in : tape_.inputs) columns_.push_back(column(model.graph->node(in.symbol)));
  }
  // True if every input is a column.
  bool possible() const {
    return std::all_of(columns_.begin(), columns_.end(), [](const auto& c) { return c.has_value(); });
  }
  void go(const std::function<void(std::size_t row, const Machine<double>&)>& see) {
    std::size_t next = 0;
    std::optional<Machine<double>> machine;
    for (std::size_t row = 0; row < table_.rows(); ++row) {
      const double t = table_.values[0][row];
      const bool after = row > 0 && table_.values[0][row - 1] == t;
      for (; next < modes_.size() && (modes_[next].t < t || (after && modes_[next].t == t)); ++next)
        parameters_[modes_[next].parameter] = modes_[next].value, machine.reset();
      if (!machine) machine.emplace(tape_, 0, parameters_);
      for (std::size_t k = 0; k < columns_.size(); ++k)
        machine->series(tape_.inputs[k].slot)[0] =
            table_.values[*columns_[k] < 0 ? 0 : static_cast<std::size_t>(*columns_[k])][row];
      machine->evaluate();
      see(row, *machine);
    }
  }

 private:
  Tape tape_;
  std::vector<double> parameters_;
  const std::vector<ModeChange>& modes_;
  const RunTable& table_;
  std::vector<std::optional<int>> columns_;
};

class Plots {
 public:
  Plots(Workspace& s, const std::vector<Conserved>& conserved, const RunFile& run, const Scene& scene,
        const std::vector<std::string>& chosen)
      : s_(s), model_(*s.model), run_(run), report_(read_report(run.report)), conserved_(conserved), scene_(scene),
        chosen_(chosen), parameters_(parameter_values<double>(model_)), modes_(mode_changes(model_, report_)),
        table_(rows_for_page(model_, run.table, events())) {}

  PlotData make() {
    if (!table_.values.empty()) data_.t = numbers(0);
    data_.rows = data_.t.size();
    given();
    leave_out_zero_reactions();
    groups_ = parted_groups(data_.columns, dimensions_);
    modes_as_steps();
    energies();
    residuals();
    steps();
    shorten();
    for (const PlotGroup& g : groups_)
      if (std::any_of(data_.columns.begin(), data_.columns.end(), [&](const PlotColumn& c) { return c.group == g.id; }))
        data_.groups.push_back(g), data_.groups.back().columns = size_[g.id];
    return std::move(data_);
  }

 private:
  PlotColumn& add(std::string name, std::string math, std::string group, std::vector<double> values) {
    data_.columns.push_back({std::move(name), std::move(math), {}, std::move(group), {}, std::move(values)});
    return data_.columns.back();
  }

  std::vector<EventReport> events() const { return report_ ? report_->events : std::vector<EventReport>(); }

  std::vector<double> numbers(std::size_t column) const {
    const std::span<const double> list = table_.values[column];
    return {list.begin(), list.end()};
  }

  // The mode of a contact changes at events, not gradually from row to row.
  void modes_as_steps() {
    for (const ContactBand& b : contact_bands(table_, events()))
      for (PlotColumn& c : data_.columns) {
        if (c.name != b.name + ".mode") continue;
        c.values.clear();
        for (const ContactSpan& s : b.spans)
          for (const double t : {s.begin, s.end}) c.t.push_back(t), c.values.push_back(s.mode);
      }
  }

  // Adds the columns of the run, in its order (the scene refers to them by index).
  void given() {
    const RunTable& t = table_;
    std::map<std::string, std::pair<std::string, std::string>> known;  // name -> group, math
    std::map<std::string, std::string> scales;  // name -> its dimension, of a model without units
    const auto scale = [&](std::size_t unknown) {
      return unknown < model_.scales.size() ? std::to_string(model_.scales[unknown]) : std::string();
    };
    const auto knows = [&](const std::string& name, const char* group, ColumnKind kind, std::size_t index, unsigned k) {
      known[derivative_name(name, k, Format::text)] = {
          group, column_formula(model_, {name, kind, index, k, ""}, Format::mathml)};
    };
    for (std::size_t a = 0; a < model_.coordinates.size(); ++a) {
      const std::string& name = model_.coordinates[a].name;
      for (unsigned k = 0; k < std::size(kDerivatives); ++k) {
        knows(name, kDerivatives[k], ColumnKind::coordinate, a, k);
        scales[derivative_name(name, k, Format::text)] = scale(a);
      }
      knows("N." + name, "reactions", ColumnKind::reaction, a, 0);
      scales["N." + name] = scale(a);
    }
    for (std::size_t r = 0; r < model_.constraints.size(); ++r)
      for (unsigned k = 0; k < 3; ++k) knows(multiplier_name(model_, r), "multipliers", ColumnKind::multiplier, r, k);
    for (std::size_t k = 0; k < model_.states.size(); ++k) {
      knows(model_.states[k].name, "states", ColumnKind::state, k, 0);
      scales[model_.states[k].name] = scale(model_.coordinates.size() + k);
    }
    for (std::size_t k = 1; k < t.columns.size(); ++k) {
      const auto it = known.find(t.columns[k]);
      PlotColumn& c = it == known.end() ? add(t.columns[k], mathml_name(t.columns[k]), "monitors", numbers(k))
                                        : add(t.columns[k], it->second.second, it->second.first, numbers(k));
      if (const auto unit = run_.units.find(c.name); unit != run_.units.end()) c.unit = unit->second;
      dimensions_.push_back(run_.units.empty() ? scales[c.name] : c.unit);
    }
  }

  // Without a constraint that acts there are no reactions. Columns that were requested by name are shown.
  void leave_out_zero_reactions() {
    const auto acts = [](const PlotColumn& c) {
      return c.group == "reactions" && std::any_of(c.values.begin(), c.values.end(), [](double x) { return x != 0; });
    };
    if (!chosen_.empty() || std::any_of(data_.columns.begin(), data_.columns.end(), acts)) return;
    for (PlotColumn& c : data_.columns)
      if (c.group == "reactions") c.group.clear();
  }

  void energies() {
    Column es = {put_masses(model_, s_.mechanics->T)};
    std::vector<std::array<std::string, 3>> what = {{"T", "<mi>T</mi>", "energies"}};
    for (const Potential& p : model_.potentials) {
      es.push_back(put_masses(model_, p.value));
      what.push_back(
          {"V." + p.name, "<msub><mi>V</mi><mtext>" + markup_escape(p.name) + "</mtext></msub>", "energies"});
    }
    for (const Conserved& c : conserved_) {
      es.push_back(c.value);
      const bool energy = c.name == "energy" || c.name == "Jacobi integral";
      what.push_back({c.name, "<mtext>" + markup_escape(c.name) + "</mtext>", energy ? "energies" : "integrals"});
    }
    std::vector<std::vector<double>> values(es.size());
    AtRows rows(model_, table_, es, parameters_, modes_);
    if (!rows.possible()) return;
    rows.go([&](std::size_t, const Machine<double>& m) {
      for (std::size_t k = 0; k < es.size(); ++k) values[k].push_back(m.value(k));
    });
    for (std::size_t k = 0; k < es.size(); ++k) add(what[k][0], what[k][1], what[k][2], std::move(values[k]));
  }

  // |phi^(k)| for all derivatives that must vanish at every row, and the deviation of integrals from their first value,
  // relative to their terms.
  void residuals() {
    constexpr std::size_t kMost = 40;
    const Mechanics& m = *s_.mechanics;
    Column es;
    std::vector<std::pair<std::string, std::string>> names;
    for (std::size_t r = 0; r < m.phi.size() && names.size() < kMost; ++r) {
      if (m.order[r] > 2) continue;
      for (int k = 0; k <= 2 - m.order[r]; ++k) {
        const std::string name = model_.constraints[r].name;
        es.push_back(put_masses(model_, total_derivative(m.phi[r], static_cast<unsigned>(k))));
        names.push_back({"|" + derivative_name("phi." + name, static_cast<unsigned>(k), Format::text) + "|",
                         "<mo>|</mo>" +
                             derivative_name("<msub><mi>φ</mi><mtext>" + markup_escape(name) + "</mtext></msub>",
                                             static_cast<unsigned>(k), Format::mathml) +
                             "<mo>|</mo>"});
      }
    }
    std::vector<std::size_t> first(conserved_.size());
    for (std::size_t c = 0; c < conserved_.size(); ++c) {
      first[c] = es.size();
      es.insert(es.end(), conserved_[c].terms.begin(), conserved_[c].terms.end());
    }
    if (es.empty()) return;
    AtRows rows(model_, table_, es, parameters_, modes_);
    if (!rows.possible()) return;
    std::vector<std::vector<double>> values(names.size()), integral(conserved_.size());
    std::vector<double> size(conserved_.size(), 0), made_of(conserved_.size(), 0), made;
    rows.go([&](std::size_t, const Machine<double>& machine) {
      for (std::size_t k = 0; k < names.size(); ++k) values[k].push_back(std::abs(machine.value(k)));
      if (!conserved_.empty()) machine.made_of(made);
      for (std::size_t c = 0; c < conserved_.size(); ++c) {
        double sum = 0, terms = 0;
        for (std::size_t k = 0; k < conserved_[c].terms.size(); ++k)
          sum += machine.value(first[c] + k), terms += std::abs(machine.value(first[c] + k));
        integral[c].push_back(sum);
        size[c] = std::max(size[c], terms);
        double of_terms = 0;
        for (std::size_t k = 0; k < conserved_[c].terms.size(); ++k)
          of_terms += made[machine.tape().roots[first[c] + k]];
        made_of[c] = std::max(made_of[c], of_terms);
      }
    });
    for (std::size_t k = 0; k < names.size(); ++k)
      add(names[k].first, names[k].second, "residuals", std::move(values[k]));
    for (std::size_t c = 0; c < conserved_.size(); ++c) {
      if (!(size[c] > 0)) continue;
      std::vector<double> change;
      for (double x : integral[c])
        change.push_back(relative_miss(x - integral[c][0], size[c], [&] { return made_of[c]; }));
      add("change of " + conserved_[c].name, "<mtext>change of " + markup_escape(conserved_[c].name) + "</mtext>",
          "residuals", std::move(change));
    }
  }

  void steps() {
    if (run_.steps.empty() || data_.t.empty()) return;
    std::vector<double> t, h;
    double before = data_.t[0];
    for (double end : run_.steps) {
      if (end != before) t.push_back(end), h.push_back(std::abs(end - before));
      before = end;
    }
    add("h", "<mi>h</mi>", "steps", std::move(h)).t = std::move(t);
  }

  // Keeps the chosen columns, or as many of every group as there is room for.
  void fewer_columns() {
    for (const PlotColumn& c : data_.columns)
      if (!c.group.empty()) ++size_[c.group];
    const bool all = chosen_.empty() && data_.columns.size() <= kMostColumns;
    const std::size_t each = std::max<std::size_t>(kMostColumns / std::max<std::size_t>(size_.size(), 1), 4);
    const std::size_t given = table_.columns.size() - 1;
    std::map<std::string, std::size_t> seen;
    for (std::size_t k = 0; k < data_.columns.size() && !all; ++k) {
      PlotColumn& c = data_.columns[k];
      if (c.group.empty()) continue;
      const bool stays = k < given && !chosen_.empty()
                             ? std::find(chosen_.begin(), chosen_.end(), c.name) != chosen_.end()
                             : ++seen[c.group] <= each;
      if (!stays) c.group.clear(), ++data_.left_out;
    }
  }

  void shorten() {
    const ColumnOf column = column_of(model_, table_);
    std::vector<int> needed = columns_of(scene_, *model_.graph, column);
    for (int& k : needed) --k;  // t is not a column of the page
    look_at_rows();
    fewer_columns();
    const auto plotted = static_cast<std::size_t>(std::count_if(data_.columns.begin(), data_.columns.end(),
                                                                [](const PlotColumn& c) { return !c.group.empty(); }));
    const bool all_rows = data_.rows * plotted <= kMostNumbers;
    data_.shown = data_.rows;
    if (!all_rows || data_.left_out > 0) take_frames(needed);
    const std::size_t most = std::max(kLeastRows, kMostThinned / std::max<std::size_t>(2 * plotted, 1));
    for (PlotColumn& c : data_.columns) {
      if (c.group.empty())
        c.values.clear();
      else if (!c.t.empty() || !all_rows)
        keep(c, most);
    }
    if (!all_rows) data_.t.clear(), data_.shown = most_kept_;
  }

  void keep(PlotColumn& c, std::size_t most) {
    const std::vector<double>& all = c.t.empty() ? data_.t : c.t;
    const std::vector<std::size_t> rows = keep_extremes(c.values, most);
    if (c.group != "steps") most_kept_ = std::max(most_kept_, rows.size());
    std::vector<double> t, values;
    for (std::size_t r : rows) t.push_back(all[r]), values.push_back(c.values[r]);
    c.t = std::move(t);
    c.values = std::move(values);
  }

  // Returns the positions that the picture interpolates.
  std::vector<MovingColumn> moving() const {
    const ColumnOf column = column_of(model_, table_);
    std::vector<MovingColumn> list;
    for (const Input& in : scene_.tape.inputs) {
      Node n = model_.graph->node(in.symbol);
      if (n.kind != Kind::jet || n.order != 0) continue;
      MovingColumn c;
      for (std::span<const double>* part : {&c.value, &c.first, &c.second}) {
        if (const auto k = column(n); k && *k > 0) *part = table_.values[static_cast<std::size_t>(*k)];
        ++n.order;
      }
      if (!c.value.empty()) list.push_back(c);
    }
    return list;
  }

  // Judges whether the motion is known between the rows.
  void look_at_rows() {
    if (data_.rows < 3) return;
    const std::size_t doubtful = doubtful_intervals(table_.values[0], moving());
    if (doubtful == 0) return;
    const std::size_t intervals = data_.rows - 1;
    data_.rough = static_cast<double>(doubtful) > kMostDoubtful * static_cast<double>(intervals);
    data_.caution = std::to_string(data_.rows) + " rows" + of_steps() + ": in " + std::to_string(doubtful) + " of " +
                    std::to_string(intervals) +
                    " intervals between them the motion is too fast for these rows, and is not drawn right";
  }

  std::string of_steps() const {
    const std::size_t steps = report_ ? report_->steps : 0;
    return steps > data_.rows ? " of " + std::to_string(steps) + " steps" : "";
  }

  void take_frames(const std::vector<int>& needed) {
    const std::size_t most =
        std::clamp<std::size_t>(kMostFrameNumbers / std::max<std::size_t>(needed.size(), 1), kLeastFrames, kMostFrames);
    if (data_.rows == 0) return;
    const ChosenFrames frames = choose_frames(data_.t, moving(), most);
    if (!frames.enough) {
      data_.rough = true;
      data_.caution = "The picture has " + std::to_string(frames.rows.size()) + " of " + std::to_string(data_.rows) +
                      " rows: between them the motion is not drawn right";
    }
    for (std::size_t r : frames.rows) data_.frame_t.push_back(data_.t[r]);
    for (int c : needed)
      for (std::size_t r : frames.rows) data_.frames[c].push_back(table_.values[static_cast<std::size_t>(c) + 1][r]);
  }

  const Scenario& s_;
  const Model& model_;
  const RunFile& run_;
  std::optional<SimulationReport> report_;
  const std::vector<Conserved>& conserved_;
  const Scene& scene_;
  const std::vector<std::string>& chosen_;
  std::vector<double> parameters_;
  std::vector<ModeChange> modes_;
  RunTable table_;  // the rows of the run, with both sides of jumps
  PlotData data_;
  Dimensions dimensions_;                    // of the columns of the run
  std::vector<PlotGroup> groups_;            // the groups that may have columns
  std::map<std::string, std::size_t> size_;  // columns of each group
  std::size_t most_kept_ = 0;                // rows of the column with the most rows
};

}  // namespace

std::string column_formula(const Model& model, const RunColumn& column, Format format) {
  Graph& g = *model.graph;
  const auto k = static_cast<std::uint32_t>(column.index);
  const auto symbol = [&](Expr e) { return print(e, model.names, format); };
  const auto name = [&](const std::string& of) { return format == Format::latex ? latex_name(of) : mathml_name(of); };
  switch (column.kind) {
  case ColumnKind::coordinate:
  case ColumnKind::velocity:
  case ColumnKind::acceleration:
  case ColumnKind::higher_derivative:
    return symbol(g.jet(k, column.order));
  case ColumnKind::multiplier:
  case ColumnKind::multiplier_rate:
  case ColumnKind::input: {
    const std::optional<std::size_t> by = model.constraints[k].by;
    return symbol(by ? g.control(static_cast<std::uint32_t>(*by), column.order) : g.multiplier(k, column.order));
  }
  case ColumnKind::state:
    return symbol(g.state(k, 0));
  case ColumnKind::reaction: {
    const std::string of = name(model.coordinates[k].name);
    return format == Format::latex ? "N_{" + of + "}" : "<msub><mi>N</mi><mrow>" + of + "</mrow></msub>";
  }
  case ColumnKind::time:
  case ColumnKind::monitor:
  case ColumnKind::event_time:
    break;
  }
  return name(column.name);
}

ColumnOf column_of(const Model& model, const RunTable& table) {
  std::map<std::string, int> places;
  for (std::size_t k = 0; k < table.columns.size(); ++k) places.emplace(table.columns[k], static_cast<int>(k));
  return [&model, places](const Node& n) -> std::optional<int> {
    if (n.kind == Kind::time) return -1;
    std::string base;
    if (n.kind == Kind::jet)
      base = model.coordinates[n.index].name;
    else if (n.kind == Kind::multiplier)
      base = multiplier_name(model, n.index);
    else if (n.kind == Kind::state && n.order == 0)
      base = model.states[n.index].name;
    else
      return std::nullopt;
    const auto it = places.find(derivative_name(base, n.order, Format::text));
    return it == places.end() ? std::nullopt : std::optional<int>(it->second);
  };
}

bool at_rows(const Model& model, const RunFile& run, Expr e, std::vector<double>& values) {
  const std::vector<ModeChange> modes = mode_changes(model, read_report(run.report));
  AtRows rows(model, run.table, {e}, parameter_values<double>(model), modes);
  if (!rows.possible()) return false;
  rows.go([&](std::size_t, const Machine<double>& m) { values.push_back(m.value(0)); });
  return true;
}

PlotData plot_data(Workspace& scenario, const std::vector<Conserved>& conserved, const RunFile& run, const Scene& scene,
                   const std::vector<std::string>& chosen) {
  return Plots(scenario, conserved, run, scene, chosen).make();
}

int rows_to_look_at(std::size_t coordinates, std::size_t constraints) {
  constexpr std::size_t kNumbers = 22000;
  return static_cast<int>(std::clamp<std::size_t>(kNumbers / (4 * coordinates + 3 * constraints + 6), 250, 1000));
}

namespace {

// The bytes of a number, the least significant first.
template <class Bits>
void add_bytes(std::string& bytes, Bits bits) {
  for (std::size_t k = 0; k < sizeof bits; ++k) bytes += static_cast<char>(bits >> (8 * k) & 0xFF);
}

}  // namespace

std::string packed(const std::vector<double>& values) {
  std::string bytes;
  bytes.reserve(values.size() * sizeof(double));
  for (const double x : values) add_bytes(bytes, std::bit_cast<std::uint64_t>(x));
  return to_base64(bytes);
}

std::string packed_for_pictures(const std::vector<double>& values) {
  std::string bytes;
  bytes.reserve(values.size() * sizeof(float));
  for (const double x : values) add_bytes(bytes, std::bit_cast<std::uint32_t>(static_cast<float>(x)));
  return "f:" + to_base64(bytes);
}

}  // namespace anholon
