#include "formula/indices.h"

#include <algorithm>
#include <charconv>

namespace anholon {

namespace {

// A larger index value is a mistake, and products of such values would overflow.
constexpr long kLargestIndex = 1'000'000;

Syntax number(long value, const Syntax& at) {
  Syntax s{Syntax::Op::number, std::to_string(value < 0 ? -value : value), {}, at.span, at.offset, at.end, {}};
  if (value >= 0) return s;
  Syntax minus{Syntax::Op::negate, "-", {}, at.span, at.offset, at.end, {}};
  minus.args.push_back(std::move(s));
  return minus;
}

std::size_t size(const Syntax& s) {
  std::size_t n = 1;
  for (const Syntax& a : s.args) n += size(a);
  return n;
}

bool is_repetition(const Syntax& s) { return s.op == Syntax::Op::call && (s.text == "sum" || s.text == "prod"); }

std::string element(const Syntax& index, const Indices* indices) {
  if (index.args.empty())
    throw Failure(index.span, "the bracket after '" + index.text + "' is empty", index.text + "[1]");
  std::vector<long> values;
  for (const Syntax& a : index.args) values.push_back(index_value(a, indices));
  return member_name(index.text, values);
}

// Returns the name T[2], or f.c0 for a member of a name.
std::string name_of_function(const Syntax& s, const Indices* indices) {
  if (s.op != Syntax::Op::member) return element(s, indices);
  return print(with_indices(s.args[0], indices)) + "." + s.text;
}

std::string letters(const Indices* indices) {
  std::string list;
  for (const Indices* i = indices; i; i = i->outer.get())
    for (const auto& [name, range] : i->ranges) list += (list.empty() ? "" : ", ") + name;
  return list;
}

// Expands sum(k, e), where k is a letter with a range: e occurs once for each value of k.
Syntax repeated(const Syntax& s, const Indices* indices) {
  const bool sum = s.text == "sum";
  const std::string usage = s.text + "(k, …) with k = \"1..n\" under [index]";
  if (s.args.size() != 2) throw Failure(s.span, s.text + " takes a letter of [index] and a formula", usage);
  const Syntax& letter = s.args[0];
  const IndexRange* range = nullptr;
  if (letter.op == Syntax::Op::name)
    for (const Indices* i = indices; i && !range; i = i->outer.get())
      if (const auto it = i->ranges.find(letter.text); it != i->ranges.end()) range = &it->second;
  if (!range) {
    const std::string known = letters(indices);
    throw Failure(letter.span,
                  s.text + " runs over a range of [index], and '" + print(letter).substr(0, 40) + "' is none",
                  known.empty() ? usage : "there is " + known);
  }
  if (range->size() == 0) return number(sum ? 0 : 1, s);
  if (std::size_t* room = indices->budget()) {
    const std::size_t cost = range->size() * size(s.args[1]);
    if (*room < cost)
      throw Failure(s.span, "sums and products over ranges become too long",
                    "a recursion such as P[i] = P[i-1] + … costs one term for each member");
    *room -= cost;
  }
  Syntax list{sum ? Syntax::Op::add : Syntax::Op::multiply, sum ? "+" : "*", {}, s.span, s.offset, s.end, {}};
  Indices bound;
  bound.outer = {std::shared_ptr<const Indices>(), indices};  // `indices` outlives this call
  for (long k = range->first; k <= range->last; ++k) {
    bound.values[letter.text] = k;
    list.args.push_back(with_indices(s.args[1], &bound));
    if (k > range->first) list.operators.push_back({list.op, s.span});
  }
  return list.args.size() == 1 ? std::move(list.args[0]) : list;
}

}  // namespace

const long* Indices::value(const std::string& name) const {
  for (const Indices* i = this; i; i = i->outer.get())
    if (const auto it = i->values.find(name); it != i->values.end()) return &it->second;
  return nullptr;
}

const IndexRange* Indices::range(const std::string& name) const {
  if (value(name)) return nullptr;
  for (const Indices* i = this; i; i = i->outer.get())
    if (const auto it = i->ranges.find(name); it != i->ranges.end()) return &it->second;
  return nullptr;
}

std::size_t* Indices::budget() const {
  for (const Indices* i = this; i; i = i->outer.get())
    if (i->room) return i->room.get();
  return nullptr;
}

long index_value(const Syntax& s, const Indices* indices) {
  const auto bounded = [&](long v) {
    if (v > kLargestIndex || v < -kLargestIndex)
      throw Failure(s.span, "an index beyond " + std::to_string(kLargestIndex));
    return v;
  };
  switch (s.op) {
  case Syntax::Op::number: {
    long v = 0;
    const char* const end = s.text.data() + s.text.size();
    const auto [read, error] = std::from_chars(s.text.data(), end, v);
    if (error == std::errc() && read == end) return bounded(v);
    throw Failure(s.span, "'" + s.text.substr(0, 40) + "' is no index: indices are whole numbers");
  }
  case Syntax::Op::name: {
    if (const long* v = indices ? indices->value(s.text) : nullptr) return *v;
    if (indices && indices->range(s.text))
      throw Failure(
          s.span, "'" + s.text + "' has no value here",
          "a letter of [index] has one in a family (the name of the element holds it in its bracket) and in sum(" +
              s.text + ", …)");
    throw Failure(s.span, "'" + s.text + "' is no index",
                  "[index] declares index integers and ranges: n = 10, i = \"1..n\"");
  }
  case Syntax::Op::negate:
    return -index_value(s.args[0], indices);
  case Syntax::Op::add:
  case Syntax::Op::multiply: {
    long v = index_value(s.args[0], indices);
    for (std::size_t k = 1; k < s.args.size(); ++k) {
      const long w = index_value(s.args[k], indices);
      const Syntax::Op op = s.operators[k - 1].op;
      if (op == Syntax::Op::divide) throw Failure(s.operators[k - 1].span, "an index is a whole number: + - * only");
      v = bounded(op == Syntax::Op::add ? v + w : op == Syntax::Op::subtract ? v - w : v * w);
    }
    return v;
  }
  default:
    throw Failure(s.span, "an index is a formula of whole numbers: + - * and brackets");
  }
}

Syntax with_indices(Syntax s, const Indices* indices) {
  switch (s.op) {
  case Syntax::Op::name:
    if (const long* v = indices ? indices->value(s.text) : nullptr) return number(*v, s);
    if (indices && indices->range(s.text)) index_value(s, indices);  // throws with the reason
    return s;
  case Syntax::Op::index:
    s.text = element(s, indices);
    s.op = Syntax::Op::name;
    s.args.clear();
    return s;
  case Syntax::Op::member:
    if (s.args.size() > 1) {
      Syntax name{Syntax::Op::index,
                  s.text,
                  {std::make_move_iterator(s.args.begin() + 1), std::make_move_iterator(s.args.end())},
                  s.span,
                  s.offset,
                  s.end,
                  {}};
      s.text = element(name, indices);
      s.args.resize(1);
    }
    break;
  case Syntax::Op::apply:
    s.text = name_of_function(s.args[0], indices);
    s.op = Syntax::Op::call;
    s.args.erase(s.args.begin());
    break;
  default:
    if (is_repetition(s)) return repeated(s, indices);
  }
  for (Syntax& a : s.args) a = with_indices(std::move(a), indices);
  return s;
}

void free_letters(const Syntax& s, const Indices& indices, Letters& letters) {
  const auto add = [&](const std::string& name, const IndexRange& range) {
    if (std::none_of(letters.begin(), letters.end(), [&](const auto& l) { return l.first == name; }))
      letters.push_back({name, range});
  };
  if (s.op == Syntax::Op::name)
    if (const IndexRange* range = indices.range(s.text)) add(s.text, *range);
  if (!is_repetition(s) || s.args.size() != 2) {
    for (const Syntax& a : s.args) free_letters(a, indices, letters);
    return;
  }
  Letters inside;
  free_letters(s.args[1], indices, inside);
  for (const auto& [name, range] : inside)
    if (name != s.args[0].text) add(name, range);
}

std::string equation_text(const FormulaText& text, const std::vector<Syntax>& sides) {
  const Indices* indices = text.indices().get();
  if (!indices || !indices->outer) return text.text();
  std::string out;
  for (const Syntax& s : sides) out += (out.empty() ? "" : " = ") + print(s);
  constexpr std::size_t kLongest = 400;  // sums are expanded
  if (out.size() <= kLongest) return out;
  std::string values;
  for (const auto& [letter, value] : indices->values)
    values += (values.empty() ? " (" : ", ") + letter + " = " + std::to_string(value);
  return text.text() + values + ")";
}

std::string member_name(const std::string& family, const std::vector<long>& values) {
  std::string name = family + "[";
  for (std::size_t k = 0; k < values.size(); ++k) name += (k > 0 ? "," : "") + std::to_string(values[k]);
  return name + "]";
}

bool is_element_name(std::string_view name) {
  const std::size_t open = name.find('[');
  if (open == std::string_view::npos) return is_identifier(name);
  if (!is_identifier(name.substr(0, open)) || name.back() != ']') return false;
  bool digit = false;
  for (const char c : name.substr(open + 1, name.size() - open - 2)) {
    const bool sign = c == '-' || c == ',';
    if (!sign && !(c >= '0' && c <= '9')) return false;
    if (c == ',' && !digit) return false;
    digit = !sign;
  }
  return digit;
}

std::string members_known(const std::string& name, const std::vector<std::string>& known) {
  const std::size_t open = name.find('[');
  if (open == std::string::npos) return {};
  const std::string family = name.substr(0, open + 1);
  std::vector<long> values;
  std::string first, last;
  for (const std::string& k : known) {
    if (k.rfind(family, 0) != 0) continue;
    (first.empty() ? first : last) = k;
    long v = 0;
    const char* const end = k.data() + k.size() - 1;
    if (std::from_chars(k.data() + family.size(), end, v).ptr == end) values.push_back(v);
  }
  if (first.empty()) return {};
  const std::string base = name.substr(0, open);
  if (values.empty())
    return last.empty() ? "; " + base + " has " + first : "; " + base + " has " + first + ", …, " + last;
  const auto [least, most] = std::minmax_element(values.begin(), values.end());
  return "; " + base + " has " + std::to_string(*least) + (*least == *most ? "" : ".." + std::to_string(*most));
}

}  // namespace anholon
