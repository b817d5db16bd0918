// Pictures of a motion or a sweep, which stand by themselves: no network, no other files. A page of HTML with equations, proof, plots,
// animation, trust; the data of its animation and plots; a figure of columns.
#pragma once
#include "anholon/motion.h"
#include "anholon/sweep.h"
#include "anholon/sweep_folder.h"

namespace anholon::v1 {

struct PageOptions {
  std::vector<std::string> forms = {};  // whose equations are shown; empty: chosen
  bool proof = true;                    // proves that the forms agree, where the equations are not too long
};

// The text of the page. Errors: unknown forms; a run without rows (diagnostics).
ANHOLON_API Result<std::string> page(const Run& run, const PageOptions& options = {});

// Returns the JSON that the viewer of the page reads: columns, events, and the bodies as formulas of the columns
// (viewer/CONTRACT.md). Errors: a run without rows (diagnostics).
ANHOLON_API Result<std::string> picture_data(const Run& run);

struct FigureOptions {
  std::vector<std::string> columns = {};  // names or patterns with * and ?; empty: the coordinates
  std::string x = {};                     // the column they are drawn over; empty: t
  bool log = false;                       // the vertical axis is logarithmic
  double width = 16, height = 9;          // cm
};

// The text of an SVG. Errors: columns that do not exist; a run without rows (diagnostics).
ANHOLON_API Result<std::string> figure(const Run& run, const FigureOptions& options = {});

struct SweepFigureOptions {
  std::vector<std::string> columns = {};  // names or patterns; empty: the coordinates, or the outcome in a map
  // Columns along the axes; empty: the first two that vary. An initial value that varies is called "theta(0)".
  std::string x = {}, y = {};
};

// The text of an SVG, which shows what `anholon plot` shows of a sweep: where one number varies, the columns at the end of
// the motions as curves over it, or their quantiles of 10, 50 and 90 % if several cases have the same value; where two vary,
// a map of one column. Errors: columns that do not exist; several columns in a map; no number varies (diagnostics).
ANHOLON_API Result<std::string> figure(const Sweep& sweep, const SweepFigureOptions& options = {});
// The same of the parts of a folder that are there; without columns the outcomes are drawn. If parts are missing, a map has
// the whole grid, with empty cells, and the title tells how many parts there are. If cases have rows at several times, columns
// are drawn over t, or over x: a curve for each of up to eight cases, of more the quantiles over t. Errors: as above; no part
// is there; a part is damaged.
ANHOLON_API Result<std::string> figure(const SweepFolder& folder, const SweepFigureOptions& options = {});

}  // namespace anholon::v1
