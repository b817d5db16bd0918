// The sections of a page, each as HTML. An empty text omits the section.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "observe/report.h"
#include "report/page/content.h"

namespace anholon {

// The reports of the cases, in their order; nullopt for an unfinished run.
using CaseReports = std::vector<std::optional<SimulationReport>>;

std::string motion_section(const Page& page, const CaseReports& reports);
std::string system_section(const Page& page);
std::string equations_section(const Page& page);
std::string structure_section(const Page& page);
std::string proof_section(const Page& page);
// Tells how far the motion can be trusted.
std::string trust_section(const Page& page, const CaseReports& reports);
// Tells how the page is made again: command, version, model files.
std::string again_section(const Page& page);

// Returns a warning in a box.
std::string warning_box(const Warning& warning);
// The text with a capital and a full stop.
std::string sentence(std::string text);

}  // namespace anholon
