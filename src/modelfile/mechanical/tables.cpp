#include "modelfile/mechanical/tables.h"

#include <algorithm>
#include <filesystem>
#include <sstream>

#include "base/join.h"
#include "base/read_file.h"
#include "modelfile/text/collect.h"
#include "modelfile/text/keys.h"

namespace anholon {

namespace {

constexpr std::size_t kMostKnots = 10'000;
constexpr std::uintmax_t kLargestFile = 16U << 20;

// Returns the separator of the fields of a row of a text file: semicolons if there are any, else commas, else blanks.
char separator_of(const std::string& line) {
  return line.find(';') != std::string::npos ? ';' : line.find(',') != std::string::npos ? ',' : ' ';
}

// Splits a row into fields; a field in quotes may contain the separator.
std::vector<std::string> fields(const std::string& line) {
  std::vector<std::string> out;
  const char separator = separator_of(line);
  std::string field;
  bool quoted = false;
  const auto end = [&] {
    const auto from = field.find_first_not_of(" \t\r");
    const auto to = field.find_last_not_of(" \t\r");
    if (from != std::string::npos)
      out.push_back(field.substr(from, to - from + 1));
    else if (separator != ' ')
      out.push_back("");
    field.clear();
  };
  for (const char c : line) {
    if (c == '"')
      quoted = !quoted;
    else if (!quoted && (c == separator || (separator == ' ' && c == '\t')))
      end();
    else
      field += c;
  }
  end();
  return out;
}

// Returns the number of fields of a row without the empty ones at its end.
std::size_t width(const std::vector<std::string>& row) {
  const auto last = std::find_if(row.rbegin(), row.rend(), [](const std::string& field) { return !field.empty(); });
  return static_cast<std::size_t>(row.rend() - last);
}

// Removes the byte order mark of UTF-8 with which some programs begin a file.
void drop_byte_order_mark(std::string& line) {
  if (line.rfind("\xEF\xBB\xBF", 0) == 0) line.erase(0, 3);
}

class TableReader {
 public:
  TableReader(Scope& scope, Model& model, Diagnostics& diagnostics)
      : scope_(scope), model_(model), diagnostics_(diagnostics) {}

  void read(const Item& t) {
    check_keys(t, "a table", "table", diagnostics_);
    const Item* named = t.find("name");
    if (!named || named->kind != Item::Kind::string) throw Failure(t.span, "a table has no name", "name = \"Cd\"");
    Table table;
    table.name = normal_name(named->text());
    try {
      fill(t, *named, table);
    } catch (const Failure&) {
      // The table is declared all the same, so that formulas that use it do not report further errors.
      table.x = {0, 1}, table.y = {0, 0};
      declare(*named, std::move(table));
      throw;
    }
    declare(*named, std::move(table));
  }

 private:
  void fill(const Item& t, const Item& named, Table& table) {
    table.fit = choice<Fit>(t, "fit", {"hold", "linear", "monotone", "spline"}, Fit::linear);
    table.outside = choice<Outside>(t, "outside", {"hold", "linear", "error"}, Outside::hold);
    const Item *x = t.find("x"), *y = t.find("y"), *file = t.find("file");
    if (file && (x || y))
      throw Failure(file->span, "the table '" + table.name + "' has its values here and in a file",
                    "leave out one of them");
    if (file) {
      from_file(*file, t.find("columns"), table);
    } else {
      if (!x || !y)
        throw Failure(named.span, "the table '" + table.name + "' has no " + (x ? "y" : "x"),
                      "x = [0, 1, 2], y = [0, 1, 4]");
      table.x = numbers(*x);
      table.y = numbers(*y);
      if (table.x.size() != table.y.size())
        throw Failure(y->span,
                      std::to_string(table.y.size()) + " values for " + std::to_string(table.x.size()) + " knots");
    }
    const Span place = x ? x->span : file->span;
    if (table.x.size() < 2) throw Failure(place, "a table has at least two knots");
    if (table.x.size() > kMostKnots)
      throw Failure(place, "a table of more than " + std::to_string(kMostKnots) + " knots");
    for (std::size_t k = 1; k < table.x.size(); ++k)
      if (!(table.x[k - 1] < table.x[k]))
        throw Failure(
            x ? x->items[k].span : place,
            file ? "the knots of a table ascend; that in " + lines_[k] + " does not"
                 : "the knots of a table ascend; the " + std::to_string(k + 1) + ". does not",
            table.x[k - 1] == table.x[k]
                ? "a knot has one value; a jump there is piecewise of two tables, piecewise(t < 1, a(t), b(t)), and "
                  "steps alone are fit = \"hold\""
                : "");
  }

  void declare(const Item& named, Table table) {
    Scope::Declaration d;
    d.role = Scope::Role::table;
    d.span = named.formula.whole();
    d.index = scope_.add_table(std::move(table));
    scope_.declare(normal_name(named.text()), d);
  }

  template <class Choice>
  Choice choice(const Item& t, const char* key, const std::vector<std::string>& names, Choice usual) {
    const Item* i = t.find(key);
    if (!i) return usual;
    const std::string text = i->kind == Item::Kind::string ? i->text() : std::string();
    const auto it = std::find(names.begin(), names.end(), text);
    if (it != names.end()) return static_cast<Choice>(it - names.begin());
    throw Failure(i->span, std::string("'") + key + "' is one of " + joined(names));
  }

  Rational number(const Item& i) {
    const Expr e = scope_.number(i);
    if (!is_number(e)) throw Failure(i.span, "the entries of a table are plain numbers");
    return number_value(e);
  }

  std::vector<Rational> numbers(const Item& list) {
    if (list.kind != Item::Kind::array) throw Failure(list.span, "x and y of a table are lists of numbers");
    std::vector<Rational> out;
    for (const Item& i : list.items) out.push_back(number(i));
    return out;
  }

  // Returns the text of a data file, which the source text of the model keeps.
  const std::string& text_of(const Item& file, const std::string& name, const std::filesystem::path& path) {
    const std::string& model = model_.source_text.of(file.span).name;
    std::vector<SourceText>& known = model_.source_text.tables;
    const auto at = std::find_if(known.begin(), known.end(), [&](const SourceText& s) { return s.name == name; });
    if (at != known.end()) return at->text;
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
      throw Failure(file.span, "there is no file '" + path.string() + "'",
                    std::filesystem::exists(model, error)
                        ? "the name is relative to the file in which it stands"
                        : "the model is a text without a file: the name is relative to the working directory");
    if (std::filesystem::file_size(path, error) > kLargestFile)
      throw Failure(file.span, "the file '" + path.string() + "' is larger than 16 MiB");
    std::string text, why;
    if (!read_file(path.string(), text, &why))
      throw Failure(file.span, "cannot read the file '" + path.string() + "': " + why);
    return known.emplace_back(SourceText{name, std::move(text), path.string()}).text;
  }

  [[noreturn]] static void no_number(const Item& file, const std::string& path, std::size_t line,
                                     const std::vector<std::string>& row, std::size_t column,
                                     const std::vector<std::string>& names) {
    const std::string place = "line " + std::to_string(line) + " of '" + path + "'",
                      which = "column " + std::to_string(column + 1) +
                              (column < names.size() && !names[column].empty() ? ", '" + names[column] + "'" : "");
    if (column < row.size() && row[column].empty())
      throw Failure(file.span, place + " has an empty cell in " + which,
                    "a number in it, or leave out the line: values between knots follow from those beside them");
    throw Failure(file.span, place + " has no number in " + which,
                  column < row.size()
                      ? "'" + row[column] + "' stands there; numbers have a decimal point: 0.8"
                      : "the line has " + std::to_string(row.size()) + (row.size() == 1 ? " column" : " columns"));
  }

  // Refuses a name that occurs twice in the heading, because it does not identify a column.
  static void must_be_one(const Item& columns, std::size_t k, const std::string& path,
                          const std::vector<std::string>& heading, std::size_t first) {
    const auto again =
        std::find(heading.begin() + static_cast<std::ptrdiff_t>(first) + 1, heading.end(), heading[first]);
    if (again == heading.end()) return;
    const std::string one = std::to_string(first + 1), other = std::to_string(again - heading.begin() + 1);
    throw Failure(columns.items[k].span,
                  "the heading of '" + path + "' names two columns '" + heading[first] + "', column " + one +
                      " and column " + other,
                  "the number of the column in place of the name, \"" + one + "\" or \"" + other + "\"");
  }

  [[noreturn]] static void too_many(const Item& file, const std::string& path, std::size_t line, std::size_t cells,
                                    std::size_t first) {
    throw Failure(file.span,
                  "line " + std::to_string(line) + " of '" + path + "' has " + std::to_string(cells) +
                      " cells, and the first line has " + std::to_string(first),
                  "a cell for each column: numbers have a decimal point, and no commas between thousands");
  }

  void from_file(const Item& file, const Item* columns, Table& table) {
    if (file.kind != Item::Kind::string) throw Failure(file.span, "a file is a name in quotes");
    // The path is relative to the file that contains it, which may be a base of the model file.
    const SourceText& of = model_.source_text.of(file.span);
    const std::filesystem::path path = std::filesystem::path(of.name).parent_path() / file.text();
    const std::string name =
        file.span.file == 0 ? file.text() : file.text() + " of base " + std::to_string(file.span.file);
    model_.table_files.push_back(path.string());
    std::istringstream in(text_of(file, name, path));
    lines_.clear();
    std::vector<std::string> wanted = {"1", "2"};
    if (columns) {
      if (columns->kind != Item::Kind::array || columns->items.size() != 2)
        throw Failure(columns->span, "columns are two names or numbers", "columns = [\"mach\", \"Cd\"]");
      wanted = {columns->items[0].text(), columns->items[1].text()};
    }
    std::size_t at[2] = {0, 0}, number = 0;
    std::vector<std::string> column_names;
    std::size_t first_width = 0;
    char first_separator = ' ';
    bool placed = false;
    for (std::string line; std::getline(in, line);) {
      if (++number == 1) drop_byte_order_mark(line);
      const std::vector<std::string> row = fields(line);
      if (row.empty() || row[0].rfind('#', 0) == 0) continue;
      if (!placed) {
        placed = true;
        first_width = row.size(), first_separator = separator_of(line);
        bool heading = false;
        for (int k = 0; k < 2; ++k) {
          const auto it = std::find(row.begin(), row.end(), wanted[static_cast<std::size_t>(k)]);
          const auto index = parse_rational(wanted[static_cast<std::size_t>(k)]);
          if (it != row.end() && !index) {
            at[k] = static_cast<std::size_t>(it - row.begin()), heading = true;
            must_be_one(*columns, static_cast<std::size_t>(k), path.string(), row, at[k]);
          } else if (index && index->is_integer() && *index >= 1 && *index <= 1000) {
            at[k] = index->get_num().get_ui() - 1;
          } else {
            throw Failure(columns ? columns->items[static_cast<std::size_t>(k)].span : file.span,
                          "the file '" + path.string() + "' has no column '" + wanted[static_cast<std::size_t>(k)] +
                              "'",
                          "its first line has the columns " + joined(row));
          }
        }
        if (heading || !parse_rational(row[0])) {
          column_names = row;
          continue;
        }
      }
      // If fields are separated by blanks, a line may be a title in words, and so have fewer fields.
      if (first_separator != ' ' && first_separator == separator_of(line) && width(row) > first_width)
        too_many(file, path.string(), number, width(row), first_width);
      for (int k = 0; k < 2; ++k) {
        const auto v = at[k] < row.size() ? parse_rational(row[at[k]]) : std::nullopt;
        if (!v) no_number(file, path.string(), number, row, at[k], column_names);
        (k == 0 ? table.x : table.y).push_back(*v);
        if (k == 0)
          lines_.push_back("line " + std::to_string(number) + ", column " + std::to_string(at[0] + 1) + " of '" +
                           path.string() + "'");
      }
    }
  }

  Scope& scope_;
  Model& model_;
  Diagnostics& diagnostics_;
  std::vector<std::string> lines_;  // the place of each knot of a table that a file holds
};

}  // namespace

void declare_tables(const Item& root, Scope& scope, Model& model, Diagnostics& diagnostics) {
  const Item* list = root.find("table");
  if (!list) return;
  TableReader reader(scope, model, diagnostics);
  for_each_table(*list, "table", diagnostics, [&](const Item& t, std::size_t) { reader.read(t); });
}

}  // namespace anholon
