// Decides claims of papers: true ones are proved, false ones are refuted, and a mutant of each true one is refuted.
#pragma once
#include <functional>
#include <map>

#include "published/claims.h"
#include "published/subject.h"

namespace anholon {

// The result of one check.
struct Decision {
  const ClaimCheck* check = nullptr;
  Verdict verdict = Verdict::unknown;  // verdict on the statement
  Verdict mutant = Verdict::unknown;   // verdict on its mutant, if there is one, which must be refuted
  bool has_mutant = false;
  // The kind of a true statement, the counterexample of a false one, or the reason if nothing is decided.
  std::string detail;
  double seconds = 0;

  // True if the result is that of the table, and the mutant, if there is one, is refuted.
  bool as_expected() const {
    return verdict == (check->expected ? Verdict::proved : Verdict::refuted) &&
           (!has_mutant || mutant == Verdict::refuted);
  }
};

class Decider {
 public:
  // Loads the model with the name that a table gives; throws Failure if there is none.
  using Load = std::function<OpenModel(const std::string& name)>;
  explicit Decider(Load load) : load_(std::move(load)) {}

  Decision decide(const ClaimCheck& check);

 private:
  Subject& subject(const ClaimCheck& check);
  void equation(const ClaimCheck& check, Decision& out);
  void forms(const ClaimCheck& check, Decision& out);
  void points(const ClaimCheck& check, Decision& out);

  Load load_;
  // by the name of the model and the definitions of the check
  std::map<std::string, std::unique_ptr<Subject>> subjects_;
};

}  // namespace anholon
