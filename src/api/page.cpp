#include "anholon/page.h"

#include "anholon/version.h"
#include "api/run_data.h"
#include "mechanics/conserved.h"
#include "plot/drawing.h"
#include "report/page/data.h"
#include "report/page/page_of.h"
#include "simulation/request.h"

namespace anholon::v1 {

namespace {

// Assignments of events, impacts and friction change integrals of the motion, so no integral is shown for such models.
std::vector<inner::Conserved> conserved_of(const System::Data& of, const inner::Workspace& s) {
  const bool kept = !inner::sets_values(*s.model) && of.model->contacts.empty();
  return kept ? inner::conserved(*s.mechanics) : std::vector<inner::Conserved>();
}

Error without_rows() { return mistake("the run has no rows"); }

}  // namespace

Result<std::string> page(const Run& run, const PageOptions& options) {
  const System::Data& of = run.data().system.data();
  return guarded(of.model->source, [&]() -> Result<std::string> {
    if (run.rows() == 0) return without_rows();
    inner::Workspace s(of.scenario);
    inner::PageRequest request;
    request.choice = of.choice;
    for (const std::string& name : options.forms) request.forms.push_back(&find_form(name, &*s.mechanics));
    if (!options.proof) request.no_proof = "The proof was left out.";
    request.version = std::string("anholon ") + version();
    request.source = s.model->source_text;
    return inner::page_of({{"", &s, conserved_of(of, s), run.data().run}}, of.model->model, request);
  });
}

Result<std::string> picture_data(const Run& run) {
  const System::Data& of = run.data().system.data();
  return guarded(of.model->source, [&]() -> Result<std::string> {
    if (run.rows() == 0) return without_rows();
    inner::Workspace s(of.scenario);
    inner::Page content;
    content.cases.push_back({"", &s, {}, conserved_of(of, s), run.data().run});
    content.source = s.model->source_text;
    return inner::page_data(content);
  });
}

Result<std::string> figure(const Run& run, const FigureOptions& options) {
  return guarded(run.data().system.data().model->source, [&]() -> Result<std::string> {
    inner::plot::FigureOptions o;
    o.names = options.columns, o.x = options.x, o.log = options.log;
    o.width = options.width, o.height = options.height;
    o.smooth = true;
    return inner::plot::draw_svg(inner::plot::make_figure(run.data().run, o));
  });
}

}  // namespace anholon::v1
