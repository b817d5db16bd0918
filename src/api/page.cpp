#include "anholon/page.h"

#include "anholon/version.h"
#include "api/run_data.h"
#include "mechanics/conserved.h"
#include "report/page/page_of.h"
#include "simulation/request.h"

namespace anholon::v1 {

Result<std::string> page(const Run& run, const PageOptions& options) {
  const System::Data& of = run.data().system.data();
  return guarded(of.model->source, [&]() -> Result<std::string> {
    if (run.rows() == 0) return mistake("the run has no rows");
    inner::Workspace s(of.scenario);
    inner::PageRequest request;
    request.choice = of.choice;
    for (const std::string& name : options.forms) request.forms.push_back(&find_form(name, &*s.mechanics));
    if (!options.proof) request.no_proof = "The proof was left out.";
    request.version = std::string("anholon ") + version();
    request.source = s.model->source_text;
    std::vector<inner::Conserved> conserved;
    if (!inner::sets_values(*s.model)) conserved = inner::conserved(*s.mechanics);
    return inner::page_of({{"", &s, std::move(conserved), run.data().run}}, of.model->model, request);
  });
}

}  // namespace anholon::v1
