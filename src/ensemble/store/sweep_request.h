// The request of a sweep in a folder, its file _sweep.json, and other texts in JSON that the folder keeps
// (doc/sweeps.md).
#pragma once
#include <cstddef>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "base/diagnostic.h"
#include "ensemble/store/stopped.h"

namespace anholon {

struct SweepRequest {
  // Everything on which the rows depend, in the order in which messages name differences: the texts of the model and of
  // the options by their names.
  std::vector<std::pair<std::string, std::string>> asked;
  std::vector<std::string> columns;
  std::size_t cases = 0;
  std::size_t chunk = 0;  // cases of a part
  // The data with which a program makes the request again, in the program's own format; they do not distinguish sweeps.
  std::string recipe = {};
  // The name by which a command found the model; it does not distinguish sweeps either.
  std::string model_name = {};
  // The version of the program that made the folder, if the request comes from one.
  std::string program = {};
  // The units of the varied parameters that have one other than the SI unit in the model, in which their columns are:
  // "m in g, a in deg".
  std::string units = {};
};

// Returns the text of the file. The version of the program is in it, but does not distinguish sweeps.
std::string request_json(const SweepRequest& request, const std::string& program);
// Throws Failure without a place; `path` names the file in messages.
SweepRequest request_of(const std::string& json, const std::string& path);

// Adds the files to which the text of a model refers, by name: its base files in their order, and the data files of its
// tables that are not in `asked` yet.
void add_files(std::vector<std::pair<std::string, std::string>>& asked, const SourceText& model);
// The text of the requested model, with these files. A model without a name is called "model", which is the name of no
// base file.
SourceText model_asked(const SweepRequest& request);

// The sentences of a judgement, which is kept as JSON; nullopt if the text is not a judgement.
std::optional<std::vector<std::string>> judgement_text(const std::string& json);

// Adds the cases of a list that stopped_json wrote. Throws Failure without a place if the text is no such list.
void add_stopped(StoppedByKind& all, const std::string& json);

}  // namespace anholon
