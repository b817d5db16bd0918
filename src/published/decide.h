// Claims of papers decided by the machine: what is true is proved, what is false is refuted, and a mutant of what is
// true is refuted.
#pragma once
#include <functional>
#include <map>

#include "published/claims.h"
#include "published/subject.h"

namespace anholon {

// What came out of one check.
struct Decision {
  const ClaimCheck* check = nullptr;
  Verdict verdict = Verdict::unknown;  // of the statement
  Verdict mutant = Verdict::unknown;   // of its mutant; refuted where it must be
  bool has_mutant = false;
  std::string detail;  // what a true statement is; the counterexample of a false one; why nothing was decided
  double seconds = 0;

  // As the table says, and not for a reason that lets anything pass.
  bool as_expected() const {
    return verdict == (check->expected ? Verdict::proved : Verdict::refuted) &&
           (!has_mutant || mutant == Verdict::refuted);
  }
};

class Decider {
 public:
  // The model of a name that a table gives; throws Failure if there is none.
  using Load = std::function<OpenModel(const std::string& name)>;
  explicit Decider(Load load) : load_(std::move(load)) {}

  Decision decide(const ClaimCheck& check);

 private:
  Subject& subject(const ClaimCheck& check);
  void equation(const ClaimCheck& check, Decision& out);
  void forms(const ClaimCheck& check, Decision& out);
  void points(const ClaimCheck& check, Decision& out);

  Load load_;
  std::map<std::string, std::unique_ptr<Subject>> subjects_;  // by the model's name and the definitions of the check
};

}  // namespace anholon
