#include "setup/words/value_range.h"

#include "setup/words/mistake_in_word.h"

namespace anholon {

std::vector<WordPart> parts_of(const std::string& word, std::size_t from, std::size_t to, char separator) {
  std::vector<WordPart> list;
  std::size_t begin = from;
  int depth = 0;
  for (std::size_t at = from; at <= to; ++at) {
    if (at < to && (word[at] == '(' || word[at] == '[')) ++depth;
    if (at < to && (word[at] == ')' || word[at] == ']')) --depth;
    if (at < to && (word[at] != separator || depth > 0)) continue;
    list.push_back({begin, word.substr(begin, at - begin)});
    begin = at + 1;
  }
  return list;
}

namespace {

constexpr const char* kNumberHint =
    "a decimal such as 0.25 or 1e-12, a fraction 1/3, pi/2, or a number with a unit: '30 deg'";

Constant constant_in(const std::string& word, const WordPart& p) {
  try {
    return read_constant(p.text);
  } catch (const Failure& f) {
    const std::string& why = f.diagnostic.message;
    mistake_in(word, p.at, p.text.size(),
               "'" + p.text + "' is not a number" + (why.rfind("'" + p.text, 0) == 0 ? "" : ": " + why), kNumberHint);
  }
}

// Returns the part without blanks around it.
WordPart without_blanks(const std::string& word, const WordPart& p) {
  std::size_t skip = 0;
  while (skip < p.text.size() && p.text[skip] == ' ') ++skip;
  std::string text = p.text.substr(skip);
  while (!text.empty() && text.back() == ' ') text.pop_back();
  if (text.empty()) mistake_in(word, p.at + skip, 1, "a number is missing here", kNumberHint);
  return {p.at + skip, std::move(text)};
}

// Reads one range; messages show its place in the word.
class RangeReader {
 public:
  RangeReader(const std::string& word, std::size_t sign, GivenQuantity& of, std::size_t most)
      : word_(word), name_(word.substr(0, sign)), begin_(sign + 1), of_(of), most_(most) {}

  ValueRange read() const {
    if (const std::size_t dots = word_.find("..", begin_); dots != std::string::npos) return with_step(dots);
    if (word_.find(':', begin_) != std::string::npos) return with_count();
    std::vector<Rational> list;
    for (const WordPart& p : parts_of(word_, begin_, word_.size(), ',')) list.push_back(number_of(word_, p, of_));
    return ValueRange(std::move(list));
  }

 private:
  std::string count_hint() const { return "from, to, how many: " + name_ + "=0:10:101"; }
  std::string step_hint() const { return "from, to, step: " + name_ + "=0..10:0.1"; }

  ValueRange with_count() const {
    const auto list = parts_of(word_, begin_, word_.size(), ':');
    if (list.size() != 3)
      mistake_in(word_, begin_, word_.size() - begin_, "a range with colons has three numbers",
                 count_hint() + "; " + step_hint());
    const Rational from = number_of(word_, list[0], of_), to = number_of(word_, list[1], of_),
                   count = number_of(word_, list[2]);
    if (!count.is_integer() || count < 1 || count > static_cast<unsigned long>(most_) || (count == 1 && from != to))
      mistake_in(word_, list[2].at, list[2].text.size(),
                 "a range has between 2 and " + std::to_string(most_) + " values", count_hint());
    return {from, to, count.get_num().get_ui()};
  }

  ValueRange with_step(std::size_t dots) const {
    const std::size_t colon = word_.find(':', dots);
    if (colon == std::string::npos)
      mistake_in(word_, begin_, word_.size() - begin_, "this range has no step", step_hint());
    const auto part = [&](std::size_t from, std::size_t to) { return WordPart{from, word_.substr(from, to - from)}; };
    const WordPart steps = part(colon + 1, word_.size());
    const Rational from = number_of(word_, part(begin_, dots), of_), to = number_of(word_, part(dots + 2, colon), of_),
                   step = number_of(word_, steps, of_);
    const auto wrong = [&](const std::string& why, const std::string& hint) {
      mistake_in(word_, steps.at, steps.text.size(), why, hint);
    };
    if (step == 0 || (to - from) / step < 0)
      wrong("no step of " + to_string(step) + " leads from " + to_string(from) + " to " + to_string(to), step_hint());
    const Rational count = (to - from) / step;
    if (count >= static_cast<unsigned long>(most_))
      wrong("a range has at most " + std::to_string(most_) + " values", step_hint());
    if (count < 1 && count > 0)
      wrong("the first step of " + to_string(step) + " from " + to_string(from) + " goes beyond " + to_string(to),
            step.is_integer() && step > 1 ? name_ + "=" + part(begin_, dots).text + ":" + part(dots + 2, colon).text +
                                                ":" + steps.text + " has " + steps.text + " values; " + step_hint()
                                          : step_hint());
    const mpz_class whole = count.get_num() / count.get_den();
    return {from, from + step * Rational(whole), whole.get_ui() + 1};
  }

  const std::string& word_;
  std::string name_;
  std::size_t begin_;
  GivenQuantity& of_;
  std::size_t most_;
};

}  // namespace

Constant constant_of(const std::string& word, const WordPart& part) {
  return constant_in(word, without_blanks(word, part));
}

Rational number_of(const std::string& word, const WordPart& part) { return constant_of(word, part).value; }

Rational number_of(const std::string& word, const WordPart& part, GivenQuantity& of) {
  const WordPart p = without_blanks(word, part);
  const Constant c = constant_in(word, p);
  if (const auto wrong = of.misfit(c)) mistake_in(word, p.at, p.text.size(), wrong->message, wrong->hint("a number "));
  return of.number(c);
}

Rational ValueRange::operator[](std::size_t k) const {
  if (!is_grid()) return list_[k];
  const Rational part(k, std::max<std::size_t>(points_ - 1, 1));
  return from_ + (to_ - from_) * part;
}

ValueRange read_value_range(const std::string& word, std::size_t sign, GivenQuantity& of, std::size_t most) {
  return RangeReader(word, sign, of, most).read();
}

}  // namespace anholon
