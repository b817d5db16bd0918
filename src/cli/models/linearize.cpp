#include <algorithm>
#include <cstdio>

#include "base/json.h"
#include "cli/contacts.h"
#include "cli/input.h"
#include "cli/models/show.h"
#include "cli/say.h"
#include "linear/study.h"
#include "observe/rows/quantity_units.h"

namespace anholon::cli {

namespace {

constexpr int kDigits = 16;  // of printed numbers, unless others are asked for

// The shortest text of the double nearest to x, or more digits if they were asked for.
std::string text(const Multi& x, int digits) {
  return digits > kDigits ? number_text(x, digits) : number_text(to_double(x));
}

// ---- output -----------------------------------------------------------------------------------------

// Returns "; with --eliminate x,y the motion is steady"; empty if no elimination makes the motion steady.
std::string remedy(const LinearModel& m) {
  std::string list;
  for (const std::string& name : m.eliminate) list += (list.empty() ? "" : ",") + name;
  return list.empty() ? "" : "; with --eliminate " + list + " the motion is steady";
}

std::string motion_text(const LinearModel& m) {
  std::string cyclic;
  for (std::size_t i : m.cyclic) cyclic += (cyclic.empty() ? "" : ", ") + m.states[i];
  switch (m.motion) {
  case LinearModel::Motion::equilibrium:
    return "an equilibrium" + (cyclic.empty() ? "" : "; without influence: " + cyclic);
  case LinearModel::Motion::steady:
    return "a steady motion; without influence: " + cyclic;
  case LinearModel::Motion::unsteady:
    return "a state that is not steady: " + m.why +
           "; A holds for this instant, and its eigenvalues say nothing about stability" + remedy(m);
  case LinearModel::Motion::unchecked:
    return "a motion that could not be checked to be steady: " + m.why;
  }
  return "";
}

void write_matrix(JsonWriter& j, const Matrix<Multi>& a, int digits) {
  j.open_array();
  for (std::size_t r = 0; r < a.rows; ++r) {
    j.open_array();
    for (std::size_t c = 0; c < a.cols; ++c) j.number(text(a(r, c), digits));
    j.close();
  }
  j.close();
}

void write_complex(JsonWriter& j, const Complex& z, int digits) {
  j.open_array().number(text(z.re, digits)).number(text(z.im, digits)).close();
}

void write_strings(JsonWriter& j, const std::vector<std::string>& list) {
  j.open_array();
  for (const std::string& s : list) j.string(s);
  j.close();
}

void write_names(JsonWriter& j, const LinearModel& m, const std::vector<std::size_t>& which) {
  j.open_array();
  for (std::size_t i : which) j.string(m.states[i]);
  j.close();
}

void write_model(JsonWriter& j, const LinearModel& m, int digits) {
  j.key("motion").string(name(m.motion));
  if (!m.why.empty()) j.key("why").string(m.why);
  if (!m.eliminate.empty()) {
    j.key("eliminate");
    write_strings(j, m.eliminate);
  }
  j.key("t").number(text(m.t, digits));
  j.key("states");
  write_strings(j, m.states);
  j.key("dependent");
  write_strings(j, m.dependent);
  j.key("state").open_object();
  for (std::size_t i = 0; i < m.states.size(); ++i) j.key(m.states[i]).number(text(m.values[i], digits));
  j.close();
  j.key("inputs");
  write_strings(j, m.inputs);
  j.key("outputs");
  write_strings(j, m.outputs);
  for (const auto& [key, matrix] : {std::pair{"A", &m.A}, {"B", &m.B}, {"C", &m.C}, {"D", &m.D}}) {
    j.key(key);
    write_matrix(j, *matrix, digits);
  }
  j.key("notes");
  write_strings(j, m.notes);
  j.key("cyclic");
  write_names(j, m, m.cyclic);
  j.key("core");
  write_names(j, m, m.core);
  j.key("eigenvalues").open_array();
  for (const Eigenvalue& e : m.spectrum) write_complex(j, e.value, digits);
  j.close();
  j.key("multiplicities").open_array();
  for (const Eigenvalue& e : m.spectrum) j.integer(e.multiplicity);
  j.close();
  j.key("modes").open_array();
  for (const Eigenvalue& e : m.spectrum) {
    j.new_line().open_array();
    for (const Complex& z : e.vector) write_complex(j, z, digits);
    j.close();
  }
  j.close();
}

void write_outcome(JsonWriter& j, const Outcome& o) {
  j.key("outcome").string(name(o.kind));
  if (!o.ok()) j.key("message").string(o.message).key("hint").string(o.hint);
}

std::string json(const Scenario& s, const Linearization& l, const std::optional<ParameterRange>& range, int digits) {
  JsonWriter j;
  j.open_object();
  j.key("model").string(s.model->title);
  j.key("form").string(s.system.form->name);
  if (!range) {
    if (l.results[0].outcome.ok()) write_model(j, l.results[0].model, digits);
    write_outcome(j, l.results[0].outcome);
    return j.close().text() + "\n";
  }
  const std::string& parameter = s.model->parameters[range->parameter].name;
  j.key("parameter").string(parameter);
  j.key("values").open_array();
  for (std::size_t k = 0; k < l.results.size(); ++k) {
    j.new_line().open_object().key(parameter).number(text(Multi(range->values[k]), digits));
    if (l.results[k].outcome.ok()) write_model(j, l.results[k].model, digits);
    write_outcome(j, l.results[k].outcome);
    j.close();
  }
  j.close();
  j.key("crossings").open_array();
  for (const Crossing& c : l.crossings)
    j.new_line()
        .open_object()
        .key(parameter)
        .number(text(c.value, digits))
        .key("frequency")
        .number(text(c.frequency, digits))
        .key("eigenvalues")
        .integer(c.eigenvalues)
        .key("destabilizes")
        .boolean(c.destabilizes)
        .key("meaning")
        .string(meaning(c))
        .close();
  j.close();
  j.key("notes");
  write_strings(j, l.notes);
  return j.close().text() + "\n";
}

// Returns "-0.5 ± 2i" for a pair of complex conjugates; the second of the pair is not printed again.
std::string pair_text(const Eigenvalue& e, int digits) {
  if (e.value.im == Multi(0)) return text(e.value.re, digits);
  return (e.value.re == Multi(0) ? "" : text(e.value.re, digits) + " ") + "± " + text(abs(e.value.im), digits) + "i";
}

// True if an earlier eigenvalue of the list has the same text: the conjugate of this one, or an equal one.
bool told(const std::vector<Eigenvalue>& list, std::size_t i) {
  for (std::size_t k = 0; k < i; ++k)
    if (list[k].value.re == list[i].value.re && abs(list[k].value.im) == abs(list[i].value.im)) return true;
  return false;
}

void print_table(const std::vector<std::vector<std::string>>& rows) {
  std::vector<std::size_t> width;
  for (const auto& row : rows)
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (c == width.size()) width.push_back(0);
      width[c] = std::max(width[c], row[c].size());
    }
  for (const auto& row : rows) {
    std::string line;
    for (std::size_t c = 0; c < row.size(); ++c)
      line += "  " + std::string(c ? width[c] - row[c].size() : 0, ' ') + row[c] +
              std::string(c ? 0 : width[c] - row[c].size(), ' ');
    say(stdout, "%s\n", line.c_str());
  }
}

std::string short_text(const Multi& x) { return number_text(to_double(x), 6); }

// Returns a number of a table, with few digits unless the user asks for a number of digits.
std::string table_text(const Multi& x, std::optional<int> digits, int few) {
  if (x == Multi(0)) return "0";
  return digits ? text(x, *digits) : number_text(to_double(x), few);
}

void print_matrix(const char* name, const std::vector<std::string>& rows, const std::vector<std::string>& columns,
                  const Matrix<Multi>& a, std::optional<int> digits) {
  std::vector<std::vector<std::string>> table{{""}};
  table[0].insert(table[0].end(), columns.begin(), columns.end());
  for (std::size_t r = 0; r < rows.size(); ++r) {
    table.push_back({rows[r]});
    for (std::size_t c = 0; c < columns.size(); ++c) table.back().push_back(table_text(a(r, c), digits, 6));
  }
  say(stdout, "\n%s\n", name);
  print_table(table);
}

void print_modes(const LinearModel& m, std::optional<int> digits) {
  if (m.spectrum.empty()) return;
  say(stdout, "\nmodes (largest entry 1)\n");
  std::vector<std::vector<std::string>> rows{{""}};
  for (std::size_t i : m.core) rows[0].push_back(m.states[i]);
  for (const Eigenvalue& e : m.spectrum) {
    if (e.value.im < Multi(0)) continue;  // the conjugate of a printed one
    rows.push_back({short_text(e.value.re) + (e.value.im > Multi(0) ? " + " + short_text(e.value.im) + "i" : "")});
    for (const Complex& z : e.vector) {
      const double im = to_double(z.im);
      rows.back().push_back(table_text(z.re, digits, 4) +
                            (im == 0 ? "" : (im < 0 ? " - " : " + ") + table_text(abs(z.im), digits, 4) + "i"));
    }
  }
  print_table(rows);
}

void print_model(const LinearModel& m, std::optional<int> asked) {
  const int digits = asked.value_or(kDigits);
  say(stdout, "about %s\n\n%zu %s at t = %s", motion_text(m).c_str(), m.states.size(),
      m.states.size() == 1 ? "state" : "states", text(m.t, digits).c_str());
  if (!m.dependent.empty()) {
    std::string list;
    for (const std::string& d : m.dependent) list += (list.empty() ? "" : ", ") + d;
    say(stdout, "; %s %s from them", list.c_str(), m.dependent.size() == 1 ? "follows" : "follow");
  }
  say(stdout, "\n");
  for (std::size_t i = 0; i < m.states.size(); ++i)
    say(stdout, "  %-14s %24s\n", m.states[i].c_str(), text(m.values[i], digits).c_str());
  print_matrix("A", m.states, m.states, m.A, asked);
  if (!m.inputs.empty()) print_matrix("B", m.states, m.inputs, m.B, asked);
  if (!m.outputs.empty()) print_matrix("C", m.outputs, m.states, m.C, asked);
  if (!m.inputs.empty() && !m.outputs.empty()) print_matrix("D", m.outputs, m.inputs, m.D, asked);
  for (const std::string& n : m.notes) say(stdout, "note: %s\n", n.c_str());
  say(stdout, "\neigenvalues");
  if (!m.cyclic.empty()) say(stdout, " of the states with influence; the %zu without add as many 0", m.cyclic.size());
  say(stdout, "\n");
  const auto width = [&](const Eigenvalue& e) {
    return pair_text(e, digits).size() - (e.value.im == Multi(0) ? 0 : 1);
  };  // "±" has two bytes
  std::size_t widest = 0;
  for (const Eigenvalue& e : m.spectrum) widest = std::max(widest, width(e));
  for (std::size_t i = 0; i < m.spectrum.size(); ++i) {
    const Eigenvalue& e = m.spectrum[i];
    if (told(m.spectrum, i)) continue;
    std::string note;
    if (e.multiplicity > 1)
      note += "  " + std::to_string(e.multiplicity) + "-fold (spread " + number_text(to_double(e.radius), 1) + ")";
    if (e.value.im > Multi(0)) {
      note += "  period " + short_text(Multi(2) * pi<Multi>() / e.value.im);
      if (!(e.value.re == Multi(0))) note += ", damping ratio " + short_text(-e.value.re / modulus(e.value));
    } else if (!(e.value.re == Multi(0))) {
      note += "  time constant " + short_text(Multi(1) / abs(e.value.re));
    }
    if (!note.empty()) note.insert(0, widest - width(e), ' ');
    say(stdout, "  %s%s\n", pair_text(e, digits).c_str(), note.c_str());
  }
  print_modes(m, asked);
}

const char* none_found(const Linearization& l) {
  if (l.searched == l.intervals) return ": none between these values";
  return l.searched == 0 ? ": not searched for, because no two neighbouring values have a linear model"
                         : ": none between neighbouring values that have a linear model";
}

void print_range(const Scenario& s, const Linearization& l, const ParameterRange& range, int digits) {
  const std::string& parameter = s.model->parameters[range.parameter].name;
  const auto units = quantity_units(*s.model, {});
  const auto unit = units.find(parameter);
  const std::string in = unit != units.end() && !unit->second.empty() ? " " + unit->second : "";
  say(stdout, "eigenvalues over %s%s%s\n", parameter.c_str(), in.empty() ? "" : ", in", in.c_str());
  std::string before;
  for (std::size_t k = 0; k < l.results.size(); ++k) {
    const LinearResult& r = l.results[k];
    const std::string about = r.outcome.ok()
                                  ? "about " + motion_text(r.model)
                                  : "no linear model (" + std::string(name(r.outcome.kind)) + "): " + r.outcome.message;
    if (about != before) say(stdout, "%s\n", about.c_str());
    before = about;
    std::string line = text(Multi(range.values[k]), digits);
    if (r.outcome.ok()) {
      if (line.size() < 8) line.resize(8, ' ');
      for (std::size_t i = 0; i < r.model.spectrum.size(); ++i) {
        const Eigenvalue& e = r.model.spectrum[i];
        if (!told(r.model.spectrum, i))
          line += "   " + pair_text(e, digits) +
                  (e.multiplicity > 1 ? " (" + std::to_string(e.multiplicity) + "-fold)" : "");
      }
    }
    say(stdout, "  %s\n", line.c_str());
  }
  say(stdout, "\ncrossings of the imaginary axis%s\n", l.crossings.empty() ? none_found(l) : "");
  for (const Crossing& c : l.crossings)
    say(stdout, "  %s = %s%s   %s, %s\n", parameter.c_str(), text(c.value, digits).c_str(), in.c_str(),
        c.frequency > Multi(0) ? ("± " + text(c.frequency, digits) + "i").c_str() : "0", meaning(c).c_str());
  for (const std::string& n : l.notes) say(stdout, "note: %s\n", n.c_str());
}

void print_csv(const Scenario& s, const Linearization& l, const std::optional<ParameterRange>& range, int digits) {
  std::size_t most = 0;
  for (const LinearResult& r : l.results) most = std::max(most, r.model.spectrum.size());
  std::string line = range ? s.model->parameters[range->parameter].name : "t";
  for (std::size_t i = 1; i <= most; ++i) line += ",re." + std::to_string(i) + ",im." + std::to_string(i);
  say(stdout, "%s\n", line.c_str());
  const auto unsteady = std::find_if(l.results.begin(), l.results.end(), [](const LinearResult& r) {
    return r.outcome.ok() && r.model.motion == LinearModel::Motion::unsteady;
  });
  if (unsteady != l.results.end())
    say(stderr, "note: %sthe state is not steady, and its eigenvalues say nothing about stability%s\n",
        range ? "at some values " : "", remedy(unsteady->model).c_str());
  for (std::size_t k = 0; k < l.results.size(); ++k) {
    const LinearModel& m = l.results[k].model;
    line = text(range ? Multi(range->values[k]) : m.t, digits);
    for (std::size_t i = 0; i < most; ++i)
      line += i < m.spectrum.size()
                  ? "," + text(m.spectrum[i].value.re, digits) + "," + text(m.spectrum[i].value.im, digits)
                  : ",,";
    say(stdout, "%s\n", line.c_str());
  }
}

}  // namespace

int linearize(const LinearizeCommand& o) {
  if (o.json && o.csv) throw UsageError{"error: --json and --csv are two formats\nhint: leave out one of them\n"};
  const Reader in = in_mode(read(o), o, "linearize");
  LinearRequest request;
  try {
    if (!o.vary.empty()) request.range = read_range(o.vary, *in.model);
  } catch (const MistakeInWord& m) {
    refuse(m, "--vary");
  }
  request.form = &form(o, *in.model);
  must_have_motions(in, *request.form);
  request.equilibrium = o.about == "equilibrium";
  request.choice = state_choice(o, *in.model);
  request.digits = o.digits();
  const auto study_of = [&] {
    try {
      return LinearStudy(in.model, request);
    } catch (const Failure& e) {
      if (e.diagnostic.span.line == 0) throw;
      throw UsageError{print(e.diagnostic, in.source)};
    }
  };
  const LinearStudy study = study_of();
  const Scenario& s = study.scenario();
  if (!o.show.empty()) return show(o, s);
  const std::optional<ParameterRange>& values = request.range;
  const PrecisionScope scope(study.working_digits());
  Linearization l = study.compute();
  for (LinearResult& r : l.results) hint_at_state_of_mode(r.outcome, o, *in.model, request.choice);
  Outcome failed;  // the first outcome that failed
  for (const LinearResult& r : l.results)
    if (failed.ok()) failed = r.outcome;
  if (o.json)
    hand_out(json(s, l, values, o.digits()));
  else if (o.csv)
    print_csv(s, l, values, o.digits());
  else if (failed.ok() || l.results.size() > 1) {
    if (!s.model->title.empty()) say(stdout, "%s\n", s.model->title.c_str());
    say(stdout, "%s, %s\n\n", s.system.form->title, s.system.form->equation);
    if (values)
      print_range(s, l, *values, o.digits());
    else
      print_model(l.results[0].model, o.motion.digits);
  }
  if (failed.ok()) return kOk;
  print_outcome(failed);
  return kStopped;
}

}  // namespace anholon::cli
