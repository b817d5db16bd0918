// Figures in PDF and PNG.
#include "plot/drawing.h"

#ifdef ANHOLON_CAIRO
#include "plot/cairo_library.h"
#endif

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>

namespace anholon::plot {

#ifndef ANHOLON_CAIRO

const char* const kCairoRemedy = "build it where libcairo2-dev is installed";
const std::string& no_cairo() {
  static const std::string why = "this build of anholon draws no PDF and PNG";
  return why;
}
std::string draw_cairo(const Figure&, CairoFormat, const std::string&) { return no_cairo(); }
std::string draw_cairo(const Drawing&, const std::string&, CairoFormat, const std::string&) { return no_cairo(); }

#else

const char* const kCairoRemedy = "install cairo (on Debian libcairo2)";
const std::string& no_cairo() { return cairo::load_cairo(); }

namespace {

using cairo::library;

void colour(cairo_t* c, const char* hex) {
  const unsigned long rgb = std::strtoul(hex + 1, nullptr, 16);
  library().cairo_set_source_rgb(c, static_cast<double>(rgb >> 16) / 255, static_cast<double>(rgb >> 8 & 255) / 255,
                                 static_cast<double>(rgb & 255) / 255);
}

void stroke(cairo_t* c, const Stroke& s) {
  library().cairo_set_dash(c, nullptr, 0, 0);
  switch (s.role) {
  case Role::grid:
    colour(c, "#e4e4e4"), library().cairo_set_line_width(c, 0.5);
    break;
  case Role::axis:
    colour(c, "#222222"), library().cairo_set_line_width(c, 0.6);
    break;
  case Role::series: {
    const Dash& dash = dash_of(s.series);
    colour(c, kColour[s.series % kColours]);
    library().cairo_set_line_width(c, 1.1);
    library().cairo_set_dash(c, dash.on_off.data(), static_cast<int>(dash.lengths()), 0);
    break;
  }
  }
  for (std::size_t i = 0; i < s.points.size(); ++i)
    i == 0 ? library().cairo_move_to(c, s.points[i].x, s.points[i].y)
           : library().cairo_line_to(c, s.points[i].x, s.points[i].y);
  library().cairo_stroke(c);
}

// Fills a patch. If the picture has pixels, the corners are rounded to borders of pixels, so that patches that share an
// edge share it there, too, and no row of pixels between them stays white.
void rectangle(cairo_t* c, const Patch& p, double pixels_per_point) {
  const auto at = [&](double x) {
    return pixels_per_point > 0 ? std::round(x * pixels_per_point) / pixels_per_point : x;
  };
  const Point from = {at(p.from.x), at(p.from.y)}, to = {at(p.to.x), at(p.to.y)};
  library().cairo_move_to(c, from.x, from.y);
  library().cairo_line_to(c, to.x, from.y);
  library().cairo_line_to(c, to.x, to.y);
  library().cairo_line_to(c, from.x, to.y);
  library().cairo_fill(c);
}

void font(cairo_t* c, const Word& w, const TextPiece& p) {
  library().cairo_select_font_face(c, "serif", p.italic ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL,
                                   CAIRO_FONT_WEIGHT_NORMAL);
  library().cairo_set_font_size(c, p.sub ? 0.7 * w.size : w.size);
}

// Draws the dots separately, because the position of a combining mark depends on the font.
void dots(cairo_t* c, const Word& w, double x, double y, const cairo_text_extents_t& letter, unsigned count) {
  const double radius = 0.055 * w.size, apart = 0.2 * w.size;
  const double middle = x + letter.x_bearing + letter.width / 2 + 0.04 * w.size,
               height = y + letter.y_bearing - 0.16 * w.size;
  for (unsigned k = 0; k < count; ++k) {
    library().cairo_new_path(c);
    library().cairo_arc(c, middle + apart * (k - (count - 1) / 2.0), height, radius, 0, 2 * M_PI);
    library().cairo_fill(c);
  }
}

void word(cairo_t* c, const Word& w) {
  double width = 0;
  for (const TextPiece& p : w.text) {
    cairo_text_extents_t e;
    font(c, w, p);
    library().cairo_text_extents(c, p.text.c_str(), &e);
    width += e.x_advance;
  }
  colour(c, "#222222");
  library().cairo_save(c);
  library().cairo_translate(c, w.at.x, w.at.y);
  if (w.upwards) library().cairo_rotate(c, -M_PI / 2);
  double x = w.anchor == Anchor::start ? 0 : w.anchor == Anchor::middle ? -width / 2 : -width;
  for (const TextPiece& p : w.text) {
    cairo_text_extents_t e;
    font(c, w, p);
    library().cairo_text_extents(c, p.text.c_str(), &e);
    const double y = p.sub ? 0.22 * w.size : 0;
    library().cairo_move_to(c, x, y);
    library().cairo_show_text(c, p.text.c_str());
    if (p.dots > 0) dots(c, w, x, y, e, p.dots);
    x += e.x_advance;
  }
  library().cairo_restore(c);
}

}  // namespace

std::string draw_cairo(const Figure& figure, CairoFormat format, const std::string& path) {
  return draw_cairo(lay_out(figure), figure.title, format, path);
}

std::string draw_cairo(const Drawing& d, const std::string& title, CairoFormat format, const std::string& path) {
  if (!no_cairo().empty()) return no_cairo();
  // cairo reports neither why a file cannot be written nor that its last bytes are missing, so the figure is drawn into
  // memory.
  std::FILE* file = std::fopen(path.c_str(), "wb");
  if (!file) return std::strerror(errno);
  std::string bytes;
  const auto keep = [](void* to, const unsigned char* data, unsigned length) {
    static_cast<std::string*>(to)->append(reinterpret_cast<const char*>(data), length);
    return CAIRO_STATUS_SUCCESS;
  };
  constexpr double kPixelsPerPoint = 200.0 / 72;
  const double pixels = format == CairoFormat::png ? kPixelsPerPoint : 0;
  cairo_surface_t* surface = nullptr;
  if (format == CairoFormat::pdf) {
    surface = library().cairo_pdf_surface_create_for_stream(keep, &bytes, d.width, d.height);
    if (library().cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
      if (!title.empty()) library().cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_TITLE, title.c_str());
      // Without a creation date, the same figure has the same bytes.
      library().cairo_pdf_surface_set_metadata(surface, CAIRO_PDF_METADATA_CREATE_DATE, "");
    }
  } else {
    surface =
        library().cairo_image_surface_create(CAIRO_FORMAT_RGB24, static_cast<int>(std::ceil(d.width * kPixelsPerPoint)),
                                             static_cast<int>(std::ceil(d.height * kPixelsPerPoint)));
  }
  cairo_t* c = library().cairo_create(surface);
  if (format == CairoFormat::png) {
    library().cairo_scale(c, kPixelsPerPoint, kPixelsPerPoint);
    colour(c, "#ffffff");
    library().cairo_paint(c);
  }
  library().cairo_set_line_join(c, CAIRO_LINE_JOIN_ROUND);
  library().cairo_set_line_cap(c, CAIRO_LINE_CAP_ROUND);
  // Antialiasing would show the paper between patches that share a border.
  library().cairo_set_antialias(c, CAIRO_ANTIALIAS_NONE);
  for (const Patch& p : d.patches) {
    library().cairo_set_source_rgb(c, static_cast<double>(p.rgb >> 16 & 255U) / 255,
                                   static_cast<double>(p.rgb >> 8 & 255U) / 255,
                                   static_cast<double>(p.rgb & 255U) / 255);
    rectangle(c, p, pixels);
  }
  library().cairo_set_antialias(c, CAIRO_ANTIALIAS_DEFAULT);
  for (const Stroke& s : d.strokes) stroke(c, s);
  for (const Word& w : d.words) word(c, w);
  cairo_status_t status = library().cairo_status(c);
  library().cairo_destroy(c);
  if (status == CAIRO_STATUS_SUCCESS && format == CairoFormat::png)
    status = library().cairo_surface_write_to_png_stream(surface, keep, &bytes);
  library().cairo_surface_finish(surface);
  if (status == CAIRO_STATUS_SUCCESS) status = library().cairo_surface_status(surface);
  library().cairo_surface_destroy(surface);
  std::string why = status == CAIRO_STATUS_SUCCESS ? "" : library().cairo_status_to_string(status);
  if (why.empty() && (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size() || std::fflush(file) != 0))
    why = std::strerror(errno);
  if (std::fclose(file) != 0 && why.empty()) why = std::strerror(errno);
  return why;
}

#endif

}  // namespace anholon::plot
