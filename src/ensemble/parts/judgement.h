// How far a sweep in a folder can be trusted: the error and the residuals of some of its cases, as for a sweep without a
// folder. They are computed when all parts are there, and kept in a file beside them.  (theory: integrals, certificate)
#pragma once
#include "ensemble/parts/fill.h"

namespace anholon {

// Judges the same cases of a piece that a sweep without a folder judges; the numbers in the report are those of the piece.
EnsembleReport judge_piece(const SweepPiece& piece, const std::function<bool()>& cancelled);

// Adds the report of cases that follow on those of `all`.
void add_report(EnsembleReport& all, const EnsembleReport& next);

// The values of a report as JSON objects, for an object that holds them.
std::string error_json(const CasesError& error);
std::string residuals_json(const CasesResiduals& residuals);

// A sentence for each reduction that has no value in some of the finished cases.
std::vector<std::string> notes_without_value(const EnsembleReport& report);
// How far the cases can be trusted, in sentences.
std::vector<std::string> judgement_lines(const EnsembleReport& report);
// The error, the residuals and these sentences: the text that the folder keeps.
std::string judgement_json(const EnsembleReport& report);

}  // namespace anholon
