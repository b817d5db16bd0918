#include "report/rows/contact_bands.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace anholon {

namespace {

constexpr std::size_t kMostSpans = 2000;

// Returns the name of the contact whose mode is in the column.
std::optional<std::string> contact_of(const RunTable& table, const std::string& column) {
  const std::string ending = ".mode";
  if (column.size() <= ending.size() || !column.ends_with(ending)) return std::nullopt;
  const std::string name = column.substr(0, column.size() - ending.size());
  for (const char* other : {".gap", ".normal", ".friction"})
    if (std::find(table.columns.begin(), table.columns.end(), name + other) == table.columns.end()) return std::nullopt;
  return name;
}

// Returns the mode that begins with an event of a contact; nullopt for an impact, after which the next row shows the
// mode.
std::optional<int> mode_after(const std::string& event) {
  if (event == ".leaves") return 0;
  if (event == ".slips") return 1;
  if (event == ".sticks") return 2;
  return std::nullopt;
}

class BandMaker {
 public:
  BandMaker(const std::string& name, const std::vector<EventReport>& events) : band_{name, {}} {
    for (const EventReport& e : events)
      if (e.name.starts_with(name + ".")) events_.push_back({e.t.value, e.name.substr(name.size())});
  }

  void row(double t, int mode) {
    double change = t;
    for (; next_ < events_.size() && events_[next_].t < t; ++next_) {
      change = std::max(events_[next_].t, last_);
      if (const auto after = mode_after(events_[next_].what)) begin(change, *after);
    }
    begin(change, mode);
    band_.spans.back().end = last_ = t;
  }
  ContactBand take() { return std::move(band_); }

 private:
  struct Happening {
    double t;
    std::string what;
  };

  void begin(double t, int mode) {
    if (!band_.spans.empty() && band_.spans.back().mode == mode) return;
    if (!band_.spans.empty()) band_.spans.back().end = t;
    band_.spans.push_back({t, t, mode});
  }

  ContactBand band_;
  std::vector<Happening> events_;
  std::size_t next_ = 0;
  double last_ = -std::numeric_limits<double>::infinity();  // time of the last row
};

}  // namespace

bool has_contacts(const RunTable& table) {
  return std::any_of(table.columns.begin(), table.columns.end(),
                     [&](const std::string& column) { return contact_of(table, column).has_value(); });
}

std::vector<ContactBand> contact_bands(const RunTable& table, const std::vector<EventReport>& events) {
  std::vector<ContactBand> bands;
  for (std::size_t k = 1; k < table.columns.size(); ++k) {
    const auto name = contact_of(table, table.columns[k]);
    if (!name || table.rows() == 0) continue;
    BandMaker maker(*name, events);
    for (std::size_t row = 0; row < table.rows(); ++row)
      maker.row(table.values[0][row], static_cast<int>(std::lround(table.values[k][row])));
    ContactBand band = maker.take();
    if (band.spans.size() <= kMostSpans) bands.push_back(std::move(band));
  }
  return bands;
}

}  // namespace anholon
