// The figure that `anholon plot` shows of a sweep in a folder.
#include "anholon/page.h"
#include "api/pictures/sweep_picture.h"
#include "plot/drawing.h"
#include "result/choose_columns.h"

namespace anholon::v1 {

Result<std::string> figure(const SweepFolder& folder, const SweepFigureOptions& o) {
  return guarded(inner::SourceText(), [&]() -> Result<std::string> {
    const SweepCases cases(folder.path());
    SweepPictureRequest asked{{}, o.x, o.y, "", "", ""};
    for (const std::size_t k : inner::chosen_columns(cases.names(), o.columns))
      asked.columns.push_back(cases.names()[k]);
    const SweepPicture picture = picture_of_sweep(cases, asked);
    if (picture.map) return inner::plot::draw_svg(lay_out(*picture.map), picture.map->title);
    return inner::plot::draw_svg(inner::plot::make_figure(picture.curves, picture.options));
  });
}

}  // namespace anholon::v1
