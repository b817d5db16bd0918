// A mechanical system as it is written in a model file.  (doc/language.md)
#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "anholon/result.h"

namespace anholon::v1 {

struct ReadOptions {
  std::map<std::string, Number> set = {};  // parameters by name, instead of the values of the file
  std::vector<std::string> cases = {};     // [case.NAME] sections that are laid over the file, one after the other
  // The mode of the contacts, {"floor=sticks"} (open, slips or sticks; open without a word), or of constraints with
  // 'active', {"caught=1"}: the model is then the one of this mode, in which contacts exert ideal forces and nothing
  // changes. Derivations, proofs, comparisons and linear models of contacts need it; motions, also in folders, may have it.
  std::vector<std::string> mode = {};
};

struct Coordinate {
  std::string name;
  std::string unit;  // SI; empty where the file names none
};

struct Parameter {
  std::string name;
  // In the unit that the file declares for the parameter, as in {value = 500, unit = "g"}, else SI; so is a bare number
  // in ReadOptions::set and Vary. NaN if the file gives the parameter no value.
  double value = 0;
  std::string unit;  // of the value; empty where the file names none
};

struct Constraint {
  std::string name;  // its multiplier is lambda.NAME
  int order = 0;     // the highest derivative of a coordinate in it; 0: holonomic
};

// A classical form of the equations of motion.
struct Form {
  std::string name;      // "routh", "chaplygin", …
  std::string title;     // "Chaplygin's equations, generalized to order m"
  std::string equation;  // its number in the source, "(3.13)"
  std::string source;
  bool applies = true;   // to this model
  std::string obstacle;  // why it does not
};

// Immutable, cheap to copy, and safe to use from many threads.
class ANHOLON_API Model {
 public:
  const std::string& title() const;
  std::vector<Coordinate> coordinates() const;
  std::vector<Parameter> parameters() const;
  std::vector<Constraint> constraints() const;
  std::vector<std::string> states() const;    // further states with rates of their own
  std::vector<std::string> inputs() const;    // of [input]
  std::vector<std::string> monitors() const;  // of [monitor], then the numbers of [output]
  std::vector<std::string> cases() const;     // of [case.NAME]
  // All forms, with whether they apply. Errors: equations that have no value, such as a division by zero.
  Result<std::vector<Form>> forms() const;
  // Warnings and notes of the reader.
  const std::vector<Diagnostic>& remarks() const;
  // The text it was read from.
  const std::string& text() const;
  // How many further files that text refers to.
  std::size_t base_files() const;

  struct Data;
  explicit Model(std::shared_ptr<const Data> data) : data_(std::move(data)) {}
  const Data& data() const { return *data_; }

 private:
  std::shared_ptr<const Data> data_;
};

// Reads a model file, or a shipped model by its name. Errors: diagnostics of the file, all at once.
ANHOLON_API Result<Model> read_file(const std::string& path, const ReadOptions& options = {});
// The same of a text; `name` stands in its diagnostics.
ANHOLON_API Result<Model> read_text(const std::string& text, const ReadOptions& options = {},
                                    const std::string& name = "model");

struct ShippedModel {
  std::string name, path, title;
};
// The models that come with the library, in the order of their paths.
ANHOLON_API std::vector<ShippedModel> shipped_models();

}  // namespace anholon::v1
