#include "modelfile/check/unknown_names.h"

#include <algorithm>
#include <set>
#include <string_view>
#include <tuple>

#include "modelfile/language/language.h"

namespace anholon {

namespace {

// The limit of mistakes that are looked for; fewer are printed.
constexpr std::size_t kMostReports = 1000;

// Sections whose values are no formulas, or those of other files and parts of the program.
constexpr std::string_view kWithoutFormulas[] = {"index", "case", "table", "notation", "simulate", "view"};

class NameCheck {
 public:
  NameCheck(Scope& scope, const std::map<std::string, std::string>& overrides, Diagnostics& diagnostics)
      : scope_(scope), overrides_(overrides), diagnostics_(diagnostics) {
    for (const Diagnostic& d : diagnostics.list()) reported_.insert(place(d.span));
    for (const std::string& f : function_names()) functions_.insert(f);
    for (const FunctionRow& f : kinematic_functions()) functions_.insert(f.name);
  }

  void file(const Item& root) {
    for (const LanguageSection& s : language()) {
      if (std::find(std::begin(kWithoutFormulas), std::end(kWithoutFormulas), s.name) != std::end(kWithoutFormulas))
        continue;
      if (const Item* item = *s.name ? root.find(s.name) : nullptr) section(s, *item);
    }
  }

 private:
  using Place = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t>;
  static Place place(const Span& s) { return {s.file, s.line, s.column}; }

  void section(const LanguageSection& s, const Item& item) {
    using Form = LanguageSection::Form;
    switch (s.form) {
    case Form::top:
    case Form::part:
      return;
    case Form::keys:
      return keys(s, item);
    case Form::elements:
      for (const Item& element : item.items) member_ = element.member, keys(s, element);
      break;
    case Form::named:
      for (const Item& i : item.items) named(s, i);
      break;
    }
    member_.clear();
  }

  void keys(const LanguageSection& s, const Item& table) {
    for (const LanguageKey& k : s.keys)
      if (const Item* value = table.find(k.name)) content(s, k, *value);
  }

  void named(const LanguageSection& s, const Item& item) {
    const std::string_view name = s.name;
    if (name == "parameters" && overrides_.count(item.key)) return;
    member_ = item.member;
    arguments_.clear();
    if (name == "functions") read_arguments(item.key);
    if (name == "initial") {
      const auto of_item = [&](const LanguageKey& k) { return item.key == k.name; };
      const auto key = std::find_if(s.keys.begin(), s.keys.end(), of_item);
      if (item.key != "branch") key == s.keys.end() ? formulas(item) : content(s, *key, item);
    } else if (item.kind == Item::Kind::table && !s.keys.empty()) {
      keys(s, item);
    } else {
      formulas(item);
    }
    arguments_.clear();
  }

  // Reads the names h and v of a key "rho(h, v)".
  void read_arguments(const std::string& key) {
    std::string name;
    for (std::size_t k = std::min(key.find('('), key.size()); k < key.size(); ++k)
      if (const char c = key[k]; c == '(' || c == ',' || c == ')')
        arguments_.insert(name), name.clear();
      else if (c != ' ')
        name += c;
  }

  void content(const LanguageSection& s, const LanguageKey& key, const Item& value) {
    switch (key.content) {
    case Content::formula:
    case Content::vector:
    case Content::rotation:
    case Content::number:
    case Content::inertia:
    case Content::any:
      return formulas(value);
    case Content::formulas:
    case Content::values:
      if (value.kind == Item::Kind::table) formulas(value);
      return;
    case Content::equation:
    case Content::equations:
      return formulas(value, true);
    case Content::place:
      if (value.kind == Item::Kind::string) return body(value);
      if (const Item* b = value.find("body")) body(*b);
      if (const Item* at = value.find("at")) formulas(*at);
      return;
    case Content::name:
      if (std::string_view(s.name) == "contact" && std::string_view(key.name) == "body") body(value);
      return;
    case Content::text:  // of these texts only shapes hold formulas, the sizes
      if (std::string_view(key.name) == "shape" || std::string_view(key.name) == "on") shape(value);
      return;
    case Content::names:
    case Content::numbers:
    case Content::truth:
    case Content::choice:
    case Content::columns:
      return;
    }
  }

  void formulas(const Item& item, bool equations = false) {
    for (const Item& inner : item.items) formulas(inner, equations);
    if (item.kind != Item::Kind::string) return;
    std::vector<Syntax> sides;
    const auto parse = [&] {
      sides = equations ? parse_equation(item.formula) : std::vector{parse_formula(item.formula)};
    };
    if (report(parse))
      for (const Syntax& side : sides) names(side);
  }

  void shape(const Item& item) {
    if (item.kind != Item::Kind::string) return;
    try {
      for (const Syntax& size : parse_formula(item.formula).args) names(size);
    } catch (const Failure&) {
      // The reader of the section reports it.
    }
  }

  void body(const Item& item) {
    if (item.kind == Item::Kind::string) report([&] { scope_.body(normal_name(item.text()), item.formula.whole()); });
  }

  // Reports the unknown names of a formula, from left to right.
  void names(const Syntax& s) {
    if (s.op == Syntax::Op::name && !arguments_.count(s.text)) name(s);
    std::size_t first = 0;
    if (s.op == Syntax::Op::call) {
      if (s.text == "sum" || s.text == "prod") return;  // the letter has no range, which is reported
      if (s.text == "euler") first = 1;                 // its first argument names axes
      if (!functions_.count(s.text) && !scope_.declares(s.text) && !is_reaction(s.text))
        report([&] { refuse_unknown_function(s, scope_); });
    }
    for (std::size_t i = first; i < s.args.size(); ++i) names(s.args[i]);
  }

  // The words for a name are looked for once, as the names of a large file are many.
  void name(const Syntax& s) {
    if (is_reserved(s.text) || scope_.declares(s.text)) return;
    const auto known = words_.find(s.text);
    report([&] {
      if (known != words_.end()) throw Failure(s.span, known->second.message, known->second.hint);
      try {
        scope_.refuse_unknown(s.text, s.span);
      } catch (const Failure& f) {
        words_.emplace(s.text, f.diagnostic);
        throw;
      }
    });
  }

  // Adds the failure of f, unless its place has a report. Returns false if f failed.
  bool report(const std::function<void()>& f) {
    if (reports_ > kMostReports) return false;
    try {
      f();
      return true;
    } catch (const Failure& failure) {
      Diagnostic d = failure.diagnostic;
      ++reports_;
      // The limit of work is exceeded at a place that depends on what was read before.
      const auto same = [&](const Diagnostic& before) {
        return before.message == d.message && before.span.line == d.span.line && before.span.file == d.span.file;
      };
      const bool name = d.message.starts_with("unknown ");
      if (is_silent(d) || (!name && std::any_of(diagnostics_.list().begin(), diagnostics_.list().end(), same)) ||
          !reported_.insert(place(d.span)).second)
        return false;
      if (!member_.empty()) d.message = "in " + member_ + ": " + d.message;
      if (!is_repeated(diagnostics_, d)) diagnostics_.add(std::move(d));
      return false;
    }
  }

  Scope& scope_;
  const std::map<std::string, std::string>& overrides_;
  Diagnostics& diagnostics_;
  std::set<Place> reported_;
  std::set<std::string> functions_, arguments_;
  std::map<std::string, Diagnostic> words_;  // for the unknown names found so far
  std::size_t reports_ = 0;
  std::string member_;  // the member of a family whose formulas are looked at
};

}  // namespace

void report_unknown_names(const Item& root, Scope& scope, const std::map<std::string, std::string>& overrides,
                          Diagnostics& diagnostics) {
  NameCheck(scope, overrides, diagnostics).file(root);
}

}  // namespace anholon
