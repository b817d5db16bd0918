#include "studio/motion_on_page.h"

#include <chrono>

#include "api/run_data.h"
#include "mechanics/conserved.h"
#include "report/page/data.h"
#include "report/page/sections.h"
#include "simulation/report_json.h"
#include "simulation/request.h"
#include "studio/answer_json.h"

namespace anholon {

namespace {

constexpr std::chrono::seconds kLongestMotion{4};

// Integrals of the motion between events are not conserved by values that events set, by impacts and by friction.
std::vector<Conserved> conserved_of(const v1::Run& run, const Workspace& workspace) {
  const bool kept = !sets_values(*workspace.model) && run.data().system.data().model->contacts.empty();
  return kept ? conserved(*workspace.mechanics) : std::vector<Conserved>();
}

std::vector<PagedRun> paged(const v1::Run& run, Workspace& workspace) {
  return {{"", &workspace, conserved_of(run, workspace), run.data().run}};
}

PageRequest request_of(const v1::Run& run, const std::string& command) {
  PageRequest request;
  request.choice = run.data().system.data().choice;
  request.version = "anholon " ANHOLON_VERSION;
  request.command = command;
  request.source = run.data().system.data().model->model->source_text;
  return request;
}

}  // namespace

MotionOnPage::MotionOnPage(const v1::Run& run, const std::string& command)
    : workspace_(run.data().system.data().scenario),
      parts_(paged(run, workspace_), run.data().system.data().model->model, request_of(run, command)) {
  parts_.add_plots();
}

void MotionOnPage::write(JsonWriter& json) const {
  const Page& page = parts_.page();
  const std::optional<SimulationReport> report = read_report(page.cases.front().run.report);
  json.key("title").string(page_title(page)).key("sections").open_array();
  section(json, "motion", "Motion", motion_section(page, {report}));
  section(json, "report", "How far the motion can be trusted", trust_section(page, {report}));
  json.close().key("data").string(page_data(page));
}

std::function<bool()> end_of_motion() {
  const auto deadline = std::chrono::steady_clock::now() + kLongestMotion;
  return [deadline] { return std::chrono::steady_clock::now() > deadline; };
}

v1::Error without_rows(const v1::Run& run) {
  v1::Error none = v1::mistake("the motion has no rows");
  none.outcome = run.outcome();
  none.diagnostics.clear();
  return none;
}

}  // namespace anholon
