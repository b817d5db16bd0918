#include "plot/terminal.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "base/escape.h"

namespace anholon::plot {

namespace {

constexpr const char* kInk[] = {"36", "33", "32", "35",
                                // ANSI colours that are readable on light and dark backgrounds
                                "31", "34", "37", "90"};
constexpr std::size_t kInks = std::size(kInk);

std::string braille(std::uint8_t dots) {
  const unsigned code = 0x2800u + dots;
  return {static_cast<char>(0xE0 | code >> 12), static_cast<char>(0x80 | (code >> 6 & 63)),
          static_cast<char>(0x80 | (code & 63))};
}

// A canvas of dots, two by four per character; a character has the colour of the curve drawn there last.
class Canvas {
 public:
  Canvas(int columns, int rows)
      : columns_(columns), rows_(rows), dots_(static_cast<std::size_t>(columns * rows)), owner_(dots_.size()),
        letter_(dots_.size(), 0) {}
  int width() const { return 2 * columns_; }
  int height() const { return 4 * rows_; }

  // The y axis points upwards.
  void dot(int x, int y, std::size_t owner) {
    if (x < 0 || y < 0 || x >= width() || y >= height()) return;
    static constexpr std::uint8_t kBit[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};
    const int row = height() - 1 - y;
    const std::size_t cell = static_cast<std::size_t>(row / 4 * columns_ + x / 2);
    dots_[cell] = static_cast<std::uint8_t>(dots_[cell] | kBit[row % 4][x % 2]);
    owner_[cell] = owner;
  }

  void line(int x0, int y0, int x1, int y1, std::size_t owner) {
    const int n = std::max(std::abs(x1 - x0), std::abs(y1 - y0));
    for (int k = 0; k <= n; ++k) dot(n ? x0 + (x1 - x0) * k / n : x0, n ? y0 + (y1 - y0) * k / n : y0, owner);
  }

  // Puts a letter on the curve near this column, at a place without letters of other curves.
  void mark(int column, std::size_t owner, char letter) {
    for (int d = 0; d < columns_ / 8; ++d) {
      const int c = column + (d % 2 ? -1 : 1) * (d + 1) / 2;
      if (c < 0 || c >= columns_) continue;
      for (int row = 0; row < rows_; ++row) {
        const std::size_t cell = static_cast<std::size_t>(row * columns_ + c);
        if (dots_[cell] == 0 || owner_[cell] != owner || letter_[cell]) continue;
        letter_[cell] = letter;
        return;
      }
    }
  }

  std::string row(int r, bool colours) const {
    std::string out;
    std::size_t ink = kInks;
    for (int c = 0; c < columns_; ++c) {
      const std::size_t cell = static_cast<std::size_t>(r * columns_ + c);
      const bool empty = dots_[cell] == 0;
      const std::size_t wanted = empty ? kInks : owner_[cell] % kInks;
      if (colours && wanted != ink) {
        if (ink != kInks) out += "\033[0m";
        if (wanted != kInks) out += std::string("\033[") + kInk[wanted] + "m";
        ink = wanted;
      }
      out += letter_[cell] ? std::string(1, letter_[cell]) : empty ? std::string(" ") : braille(dots_[cell]);
    }
    if (ink != kInks)
      out += "\033[0m";
    else
      while (!out.empty() && out.back() == ' ') out.pop_back();
    return out;
  }

 private:
  int columns_, rows_;
  std::vector<std::uint8_t> dots_;
  std::vector<std::size_t> owner_;
  std::vector<char> letter_;
};

std::string padded(const std::string& s, std::size_t width) {
  const std::size_t w = shown_width(s);
  return w < width ? std::string(width - w, ' ') + s : s;
}

void stripped(std::string& out, std::string line) {
  while (!line.empty() && line.back() == ' ') line.pop_back();
  out += line + "\n";
}

class Terminal {
 public:
  Terminal(const Figure& f, const TerminalSize& size)
      : own_(f.equal ? std::optional<Figure>(f) : std::nullopt), f_(own_ ? *own_ : f), size_(size) {}

  std::string draw() {
    std::vector<Ticks> y_ticks = scales();
    // Dots are as wide as they are high.
    for (int round = 0; own_ && round < 2; ++round) {
      make_equal(*own_, 2 * columns_ - 1, 4 * size_.rows - 1);
      const int columns = columns_;
      y_ticks = scales();
      if (round == 1) columns_ = columns;
    }
    x_ticks_ = ticks(f_.x_axis, std::max(2, columns_ / 12));
    if (!f_.title.empty())
      stripped(out_,
               padded(shown(f_.title), (static_cast<std::size_t>(size_.columns) + shown_width(shown(f_.title))) / 2));
    for (std::size_t i = 0; i < f_.panels.size(); ++i) panel(f_.panels[i], y_ticks[i], i + 1 == f_.panels.size());
    x_labels();
    return std::move(out_);
  }

 private:
  std::vector<Ticks> scales() {
    std::vector<Ticks> y_ticks;
    for (const Panel& p : f_.panels) {
      y_ticks.push_back(ticks(p.y, std::max(2, size_.rows / 4)));
      for (const std::string& l : y_ticks.back().labels) margin_ = std::max(margin_, shown_width(l));
    }
    columns_ = std::max(10, size_.columns - static_cast<int>(margin_) - 3);
    return y_ticks;
  }

  int column(double x) const { return static_cast<int>(std::lround(f_.x_axis.place(x) * (columns_ - 1))); }
  char letter(const Series& s) const { return static_cast<char>(s.number < 26 ? 'a' + s.number : 'A' + s.number % 26); }

  void legend(const Panel& p, const std::string& note) {
    const bool lettered = !size_.colours && p.series.size() > 1;
    const std::string indent(margin_ + 2, ' ');
    std::string line = indent;
    std::size_t width = indent.size();
    for (const Series& s : p.series) {
      const std::string label = series_text(s, f_.labels), sign = lettered ? std::string(1, letter(s)) : "──";
      const std::size_t w = shown_width(label) + shown_width(sign) + 3;
      if (width > indent.size() && width + w > static_cast<std::size_t>(size_.columns))
        stripped(out_, line), line = indent, width = indent.size();
      if (size_.colours)
        line += std::string("\033[") + kInk[s.number % kInks] + "m" + sign + "\033[0m " + label + "  ";
      else
        line += (p.series.size() > 1 ? sign + " " : "") + label + "  ";
      width += w;
    }
    if (!note.empty()) line += " [" + note + "]";
    stripped(out_, line);
  }

  void panel(const Panel& p, const Ticks& y_ticks, bool last) {
    legend(p, y_ticks.note);
    Canvas canvas(columns_, size_.rows);
    const int w = canvas.width() - 1, h = canvas.height() - 1;
    for (const Series& s : p.series)
      for (const auto& piece : curve(f_, p, s, w, h))
        for (std::size_t i = 0; i < piece.size(); ++i) {
          const Point &a = piece[i == 0 ? 0 : i - 1], &b = piece[i];
          canvas.line(static_cast<int>(std::lround(a.x)), static_cast<int>(std::lround(a.y)),
                      static_cast<int>(std::lround(b.x)), static_cast<int>(std::lround(b.y)), s.number);
        }
    if (!size_.colours && p.series.size() > 1)
      for (const Series& s : p.series) {
        const int n = static_cast<int>(p.series.size()), shift = static_cast<int>(s.number) * columns_ / (4 * n);
        for (int k = 0; k < 4; ++k) canvas.mark(columns_ * (2 * k + 1) / 10 + shift, s.number, letter(s));
      }
    for (int r = 0; r < size_.rows; ++r) {
      std::string label, edge = "│";
      // Finds the tick whose dot is in this row.
      for (std::size_t k = 0; k < y_ticks.at.size(); ++k)
        if (const int y = static_cast<int>(std::lround(p.y.place(y_ticks.at[k]) * h)); (h - y) / 4 == r)
          label = y_ticks.labels[k], edge = "┤";
      stripped(out_, padded(label, margin_) + " " + edge + canvas.row(r, size_.colours));
    }
    std::string axis(margin_ + 1, ' ');
    axis += "└";
    std::vector<bool> tick(static_cast<std::size_t>(columns_), false);
    for (const double x : x_ticks_.at)
      if (const int c = column(x); c >= 0 && c < columns_) tick[static_cast<std::size_t>(c)] = true;
    for (const bool t : tick) axis += t ? (last ? "┬" : "┴") : "─";
    out_ += axis + "\n";
  }

  void x_labels() {
    std::string line;
    std::size_t width = 0;
    for (std::size_t k = 0; k < x_ticks_.at.size(); ++k) {
      const std::string& l = x_ticks_.labels[k];
      const int begin = static_cast<int>(margin_) + 2 + column(x_ticks_.at[k]) - static_cast<int>(shown_width(l)) / 2;
      // Omits labels that would touch.
      if (begin < static_cast<int>(width) + (width > 0 ? 1 : 0) ||
          begin + static_cast<int>(shown_width(l)) > size_.columns)
        continue;
      line += std::string(static_cast<std::size_t>(begin) - width, ' ') + l;
      width = static_cast<std::size_t>(begin) + shown_width(l);
    }
    stripped(out_, line);
    const std::string name =
        text_label(f_.x_name, f_.x_unit, f_.labels) + (x_ticks_.note.empty() ? "" : " [" + x_ticks_.note + "]");
    stripped(out_, padded(name, margin_ + 2 + (static_cast<std::size_t>(columns_) + shown_width(name)) / 2));
  }

  std::optional<Figure> own_;  // a copy with equal axes
  const Figure& f_;
  TerminalSize size_;
  std::string out_;
  std::size_t margin_ = 1;
  int columns_ = 0;
  Ticks x_ticks_;
};

}  // namespace

std::string draw_terminal(const Figure& figure, const TerminalSize& size) { return Terminal(figure, size).draw(); }

}  // namespace anholon::plot
