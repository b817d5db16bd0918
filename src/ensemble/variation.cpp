#include "ensemble/variation.h"

#include <algorithm>

#include "formula/indices.h"
#include "modelfile/contacts.h"
#include "modelfile/names/constant.h"
#include "numeric/random/philox.h"
#include "numeric/random/sobol.h"
#include "setup/words/mistake_in_word.h"

namespace anholon {

namespace {

constexpr std::size_t kMostPoints = 1'000'000'000;  // points of one grid; 2^30 places between two of them have numbers

constexpr const char* kVaryHint =
    "--vary m=1:3:5 (from, to, how many), m=1..3:0.5 (step), m=1,2,5, 'm~normal(1,0.1)' or 'm~uniform(0,2)'";

// The hint for a name that is not known: "; did you mean …"; "" if no name is near.
std::string meant_by(const std::string& name, std::vector<std::string> known) {
  const bool member = name.find('[') != std::string::npos;
  if (const std::string members = members_known(member ? name : name + "[", known); !members.empty()) return members;
  known.emplace_back("case");  // "case" varies the scenario
  // A table of a sweep calls an initial value x(0).
  constexpr std::string_view kAtStart = "(0)";
  const std::string base = name.ends_with(kAtStart) ? name.substr(0, name.size() - kAtStart.size()) : name;
  const std::string near =
      std::find(known.begin(), known.end(), base) != known.end() ? base : did_you_mean(base, known);
  return near.empty() ? "" : "; did you mean '" + near + "'?";
}

// Refuses to vary initial values that the file gives as formulas: a parameter in the formula has to be varied.
void refuse_initial_formula(const std::string& word, const std::string& text, const std::string& name, bool multiplier,
                            const Model& model) {
  const auto knows = [&](const std::vector<std::string>& names) {
    return std::find(names.begin(), names.end(), name) != names.end();
  };
  if (multiplier && knows(model.names.multipliers))
    mistake_in(word, 0, text.size(), "the initial value of a multiplier varies by a parameter",
               "parameters = {l0 = 0} in the file, and " + text + " = \"l0\" in [initial]; then l0 varies");
  if (!multiplier && knows(model.names.states))
    mistake_in(word, 0, text.size(), "the initial value of the state '" + name + "' varies by a parameter",
               "parameters = {" + name + "0 = 0} in the file, and initial = \"" + name + "0\" in the state; then " +
                   name + "0 varies");
}

Varied named(const std::string& word, const std::string& text, const Model& model) {
  const auto [name, primes, multiplier] = initial_name(text);
  const auto& coordinates = model.names.coordinates;
  if (const auto q = std::find(coordinates.begin(), coordinates.end(), name); q != coordinates.end() && !multiplier) {
    const unsigned determined = first_determined_order(model);
    if (primes >= determined)
      mistake_in(word, 0, text.size(),
                 determined == 2 ? "accelerations follow from the state"
                                 : "derivatives of order " + std::to_string(primes) + " follow from the state",
                 "vary " + name + ", " + name + "' or a parameter");
    return {Varied::Kind::initial, static_cast<std::size_t>(q - coordinates.begin()), primes,
            derivative_name(name, primes, Format::text)};
  }
  std::vector<std::string> known;
  for (std::size_t i = 0; i < model.parameters.size(); ++i) {
    if (model.parameters[i].name == name && primes > 0)
      mistake_in(word, 0, text.size(), "'" + name + "' is a parameter, which has no velocity", "vary " + name);
    if (model.parameters[i].name == name)
      return {Varied::Kind::parameter, i, 0, name, declared_unit(model.parameters[i])};
    known.push_back(model.parameters[i].name);
  }
  known.insert(known.end(), coordinates.begin(), coordinates.end());
  refuse_initial_formula(word, text, name, multiplier, model);
  const std::string coefficient = hint_for_coefficient(name);
  if (!coefficient.empty())
    mistake_in(word, 0, text.size(), "there is no parameter and no coordinate '" + name + "'", coefficient);
  const bool family = std::any_of(coordinates.begin(), coordinates.end(),
                                  [](const std::string& q) { return q.find('[') != std::string::npos; });
  mistake_in(word, 0, text.size(), "there is no parameter and no coordinate '" + name + "'" + meant_by(name, known),
             "the names in [parameters], coordinates, and velocities such as " +
                 (coordinates.empty() ? std::string("x") : coordinates[0]) + "'" +
                 (family ? "; an integer of [index] makes another model: a sweep of its own with --set" : ""));
}

}  // namespace

// Reads the law of random values, NAME~normal(MEAN,DEVIATION) or NAME~uniform(FROM,TO).
Variation::Values Variation::law(const std::string& word, std::size_t sign, GivenQuantity& of) {
  Values values;
  const std::size_t open = word.find('(', sign);
  const std::string law = word.substr(sign + 1, (open == std::string::npos ? word.size() : open) - sign - 1);
  if (law != "normal" && law != "uniform") {
    const std::string near = law.starts_with("gauss") ? "normal" : did_you_mean(law, {"normal", "uniform"});
    mistake_in(word, sign + 1, law.size(),
               "there is no law '" + law + "'" + (near.empty() ? "" : "; did you mean '" + near + "'?"),
               "normal(MEAN,DEVIATION) or uniform(FROM,TO)");
  }
  if (open == std::string::npos || word.back() != ')')
    mistake_in(word, word.size(), 1, "a bracket is missing here", "normal(MEAN,DEVIATION) or uniform(FROM,TO)");
  const auto list = parts_of(word, open + 1, word.size() - 1, ',');
  if (list.size() != 2)
    mistake_in(word, open, word.size() - open, "two numbers are expected here",
               "normal(MEAN,DEVIATION) or uniform(FROM,TO)");
  const Rational a = number_of(word, list[0], of), b = number_of(word, list[1], of);
  values.law = law == "normal" ? Values::Law::normal : Values::Law::uniform;
  if (values.law == Values::Law::normal ? b < 0 : b < a)
    mistake_in(word, list[1].at, list[1].text.size(),
               law == "normal" ? "a deviation is not negative" : "the range ends before it begins",
               "normal(MEAN,DEVIATION) or uniform(FROM,TO)");
  values.a = from_rational<double>(a);
  values.b = from_rational<double>(b);
  values.stream = streams_++;
  return values;
}

GivenQuantity Variation::name(const std::string& word, std::size_t sign, const Model& model) {
  const Varied v = named(word, word.substr(0, sign), model);
  for (const Varied& before : varied_)
    if (before.name == v.name) mistake_in(word, 0, sign, "'" + v.name + "' is varied twice", "each name varies once");
  varied_.push_back(v);
  return v.kind == Varied::Kind::parameter ? GivenQuantity::of_parameter(model, v.index)
                                           : GivenQuantity::of_coordinate(model, v.index, v.order);
}

std::size_t Variation::new_axis(std::size_t size) {
  if (size > kMostCases / grid_)
    throw Failure({}, "the grids have more than " + std::to_string(kMostCases) + " points", "fewer values");
  grid_ *= size;
  axes_.push_back(size);
  return axes_.size() - 1;
}

void Variation::add(const std::string& word, const Model& model) {
  const std::size_t sign = word.find_first_of("=~");
  if (sign == std::string::npos || sign == 0)
    mistake_in(word, 0, word.size(), "this is not of the form NAME=VALUES or NAME~LAW(…)", kVaryHint);
  GivenQuantity of = name(word, sign, model);
  if (word[sign] == '~') {
    values_.push_back(law(word, sign, of));
    return;
  }
  Values& values = values_.emplace_back();
  values.range = read_value_range(word, sign, of, kMostPoints);
  values.axis = new_axis(values.range->size());
}

void Variation::add(const std::string& name, const std::vector<Constant>& values, const Model& model) {
  GivenQuantity of = this->name(name, name.size(), model);
  if (values.empty()) mistake_in(name, 0, name.size(), "there are no values to take", "one value at least");
  if (together_ && common_ && axes_[*common_] != values.size())
    mistake_in(name, 0, name.size(),
               std::to_string(values.size()) + " values do not go together with " + std::to_string(axes_[*common_]),
               "as many values of each name");
  Values& listed = values_.emplace_back();
  std::vector<Rational> list;
  listed.axis = together_ && common_ ? *common_ : new_axis(values.size());
  if (together_) common_ = listed.axis;
  for (const Constant& value : values) {
    if (const auto wrong = of.misfit(value)) mistake_in(name, 0, name.size(), wrong->message, wrong->hint(""));
    list.push_back(of.number(value));
  }
  listed.range = ValueRange(std::move(list));
}

void Variation::add(std::shared_ptr<const CaseTable> table, const Model& model) {
  const auto is_case = [](const auto& quantity) { return quantity.name == "case"; };
  table->must_number_cases(model.cases, std::any_of(model.parameters.begin(), model.parameters.end(), is_case) ||
                                            std::any_of(model.coordinates.begin(), model.coordinates.end(), is_case));
  const std::size_t axis = new_axis(table->rows());
  std::vector<GivenQuantity> quantities;
  for (std::size_t k = 0; k < table->names().size(); ++k) {
    try {
      quantities.push_back(name(table->names()[k], table->names()[k].size(), model));
    } catch (const MistakeInWord& m) {
      if (table->names()[k].empty())
        table->mistake_in_header(k, "this column has no name",
                                 "the name of what varies in it, or leave out the column");
      const bool unit = table->names()[k].find_first_of("([") != std::string::npos;
      table->mistake_in_header(k, m.diagnostic.message,
                               unit ? "the first line holds names alone; a unit belongs to each number: 8 cm"
                                    : m.diagnostic.hint);
    }
    Values& cell = values_.emplace_back();
    cell.cell = k;
    cell.axis = axis;
  }
  table_ = std::move(table);
  for (std::size_t row = 0; row < table_->rows(); ++row) {
    const std::vector<std::string> cells = table_->cells(row);
    for (std::size_t k = 0; k < cells.size(); ++k) {
      if (cells[k].find_first_not_of(" \t") == std::string::npos)
        table_->mistake(row, k,
                        "case " + std::to_string(row) + " has no '" + table_->names()[k] + "': this cell is empty",
                        "a number in it, or leave out the line; the value of the file is not taken");
      try {
        number_of(cells[k], {0, cells[k]}, quantities[k]);
      } catch (const MistakeInWord& m) {
        table_->mistake(row, k, m.diagnostic.message, "a number, pi/2, or a number with a unit: 8 cm");
      }
    }
  }
}

void Variation::finish(std::optional<std::size_t> cases, const std::string& called) {
  if (varied_.empty()) throw Failure({}, "nothing is varied", kVaryHint);
  if (draws_ == Draws::sobol && streams_ > kSobolDimensions)
    throw Failure({}, "a Sobol sequence has at most " + std::to_string(kSobolDimensions) + " dimensions here",
                  "fewer drawn values, or random ones");
  if (draws_ == Draws::sobol && streams_ == 0)
    throw Failure({}, "nothing is drawn from a Sobol sequence", "'m~uniform(0,2)' or 'm~normal(1,0.1)'");
  if (!cases) {
    if (streams_ > 0) throw Failure({}, "how many cases are to be drawn?", called + " 1000");
    cases_ = grid_;
    return;
  }
  cases_ = *cases;
  if (streams_ == 0 && cases_ != grid_)
    throw Failure({},
                  "nothing is random, and the grid has " + std::to_string(grid_) + (grid_ == 1 ? " point" : " points"),
                  "leave out " + called);
  if (cases_ < grid_)
    throw Failure({},
                  called + " " + std::to_string(cases_) + " leaves out points of the grid, which has " +
                      std::to_string(grid_),
                  called + " " + std::to_string(grid_) + " or more");
}

double Variation::draw(const Values& v, std::size_t number) const {
  const bool normal = v.law == Values::Law::normal;
  double x = 0;
  if (draws_ == Draws::sobol) {
    const Draw of_stream(seed_, 0, v.stream);
    const double p = sobol(number / grid_, v.stream, of_stream.bits());
    x = normal ? normal_quantile(p) : p;
  } else {
    const Draw of_case(seed_, number, v.stream);
    x = normal ? of_case.normal() : of_case.uniform();
  }
  return normal ? v.a + v.b * x : v.a + (v.b - v.a) * x;
}

std::vector<Rational> Variation::operator()(std::size_t number) const {
  std::vector<std::size_t> points(axes_.size());
  std::size_t point = number % grid_;
  for (std::size_t i = axes_.size(); i-- > 0;) {
    points[i] = point % axes_[i];
    point /= axes_[i];
  }
  std::vector<Rational> out(values_.size());
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Values& v = values_[i];
    if (v.drawn()) {
      out[i] = Rational(draw(v, number));
    } else if (v.cell) {
      if (cells.empty()) cells = table_->cells(points[v.axis]);
      const Constant c = constant_of(cells[*v.cell], {0, cells[*v.cell]});
      out[i] = c.dimension ? varied_[i].unit.number(c.value) : c.value;
    } else {
      out[i] = (*v.range)[points[v.axis]];
    }
  }
  return out;
}

void Variation::must_be_a_grid() const {
  for (std::size_t i = 0; i < values_.size(); ++i) {
    const Values& v = values_[i];
    const std::string& name = varied_[i].name;
    if (v.drawn() || v.cell)
      throw Failure(
          {}, "between the values of '" + name + "' lies no grid: they are " + (v.cell ? "those of a table" : "drawn"),
          "refine a grid: " + name + "=0:10:101");
    const ValueRange& r = *v.range;
    for (std::size_t k = 1; k < r.size() && (k == 1 || !r.is_grid()); ++k)
      if (cmp(r[k], r[k - 1]) * cmp(r[1], r[0]) <= 0)
        throw Failure({}, "between the values of '" + name + "' lies no grid: they neither ascend nor descend",
                      "refine a grid, or a list in ascending order");
  }
}

std::vector<Rational> Variation::between(std::span<const std::int64_t> places, unsigned halvings) const {
  std::vector<Rational> out;
  const std::int64_t fine = std::int64_t{1} << halvings;
  for (const Values& v : values_) {
    const std::int64_t place = places[v.axis];
    const auto k = static_cast<std::size_t>(place / fine);
    const Rational part(place % fine, fine);
    const ValueRange& r = *v.range;
    out.push_back(part == 0 ? r[k] : r[k] + (r[k + 1] - r[k]) * part);
  }
  return out;
}

void must_not_be_given(const std::vector<Varied>& varied, const StateChoice& state,
                       const std::vector<std::string>& parameters) {
  const auto refuse = [](const Varied& v) {
    throw Failure({}, "'" + v.name + "' is both given and varied", "leave out one of them");
  };
  for (const Varied& v : varied) {
    if (v.kind == Varied::Kind::parameter &&
        std::find(parameters.begin(), parameters.end(), v.name) != parameters.end())
      refuse(v);
    for (const StateOverride& given : state.overrides)
      if (v.kind == Varied::Kind::initial && !given.multiplier && given.coordinate == v.index && given.order == v.order)
        refuse(v);
  }
}

}  // namespace anholon
