// The labels of columns: theta' as θ̇ or $\dot{\theta}$, lambda.blade as λ_blade, D(x,4) as x⁽⁴⁾.
#pragma once
#include <string>
#include <vector>

namespace anholon::plot {

enum class LabelStyle { unicode, latex, plain };

// A piece of a label for output with fonts; dots are set above its only letter.
struct TextPiece {
  std::string text;
  bool italic = false, sub = false;
  unsigned dots = 0;
};
using RichText = std::vector<TextPiece>;

// The unit may be empty.
RichText rich_label(const std::string& column, const std::string& unit, LabelStyle style);
// Like rich_label(), in one line of a terminal.
std::string text_label(const std::string& column, const std::string& unit, LabelStyle style);
std::string latex_label(const std::string& column, const std::string& unit);

// The width on a terminal; combining characters have no width.
std::size_t shown_width(const std::string& text);
std::string plain_text(const RichText& text);

}  // namespace anholon::plot
