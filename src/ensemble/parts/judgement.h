// Judges how far a sweep in a folder can be trusted: the error and the residuals of some of its cases, as for a sweep
// without a folder. They are computed when all parts are there, and kept in a file beside them (theory: integrals,
// certificate).
#pragma once
#include "ensemble/parts/fill.h"
#include "simulation/request.h"

namespace anholon {

// Judges the cases of a piece that a sweep without a folder would judge; the numbers in the report are those of the
// piece.
EnsembleReport judge_piece(const SweepPiece& piece, const std::function<bool()>& cancelled);

// Adds the report of cases that follow those of `all`.
void add_report(EnsembleReport& all, const EnsembleReport& next);

// The values of a report as JSON objects, to be put into another object.
std::string error_json(const CasesError& error);
std::string residuals_json(const CasesResiduals& residuals);

// Returns sentences about initial values of the file that give way to others, and about each reduction that has no value
// in some of the finished cases, for each cause.
std::vector<std::string> notes_on_cases(const EnsembleReport& report, const Asker& asker);
// Returns sentences that tell how far the cases can be trusted.
std::vector<std::string> judgement_lines(const EnsembleReport& report);
// Returns the error, the residuals and these sentences: the text that the folder keeps.
std::string judgement_json(const EnsembleReport& report);

}  // namespace anholon
