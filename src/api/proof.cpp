#include "anholon/proof.h"

#include <algorithm>

#include "anholon/version.h"
#include "api/data.h"
#include "modelfile/hash.h"
#include "proof/checker/verify.h"
#include "proof/prove.h"
#include "setup/eliminate.h"

namespace anholon::v1 {

static_assert(static_cast<int>(Verdict::refuted) == static_cast<int>(inner::Verdict::refuted));

bool Proof::all_proved() const {
  return !stopped &&
         std::all_of(forms.begin(), forms.end(), [](const FormVerdict& f) { return f.verdict == Verdict::proved; });
}

// Describes the first difference that is not proved to vanish; empty if all are proved.
static std::string first_not_proved(const std::vector<inner::Difference>& differences) {
  for (const inner::Difference& d : differences)
    if (d.verdict != inner::Verdict::proved) return d.component + ": " + d.detail;
  return {};
}

Result<Proof> prove(const Model& model, const std::vector<std::string>& names) {
  return guarded(model.data().source, [&]() -> Result<Proof> {
    model.data().without_contacts("prove");
    const std::shared_ptr<const inner::Model> own = model.data().own_copy();
    const inner::Mechanics m = inner::mechanics(*own);
    std::vector<const inner::Formulation*> forms;
    for (const std::string& name : names) forms.push_back(&find_form(name, &m));
    if (names.empty())
      for (const inner::Formulation* f : inner::formulations())
        if (inner::obstacle(*f, m).empty()) forms.push_back(f);
    std::vector<inner::Eliminations> eliminations;
    for (const bool solve : {true, false})
      eliminations.push_back({inner::elimination_for(m, inner::Unknowns::coordinates, {}, {}, solve, 0),
                              inner::elimination_for(m, inner::Unknowns::quasi_velocities, {}, {}, solve, 0)});
    const inner::Proof p = inner::prove(m, forms, eliminations);
    Proof result;
    result.stopped = p.stopped;
    for (std::size_t i = 0; i < p.forms.size(); ++i) {
      const inner::FormProof& f = p.forms[i];
      FormVerdict& v = result.forms.emplace_back();
      v.form = f.form->name;
      v.verdict = static_cast<Verdict>(p.with_routh(i));
      v.detail = i < p.compared ? first_not_proved(f.differences) : "stopped";
      if (v.detail.empty() && v.verdict != Verdict::proved)
        v.detail = p.stopped ? "stopped" : "tangents of the constraints: " + first_not_proved(p.kernel);
    }
    if (p.stopped) return result;
    inner::Certificate c = inner::certificate(m, p, eliminations.front(), std::string("anholon ") + version(),
                                              inner::model_hash(model.data().model->source_text));
    std::vector<std::string> values;
    for (const auto& [name, value] : model.data().overrides) values.push_back(name + "=" + value);
    inner::add_reading(c, model.data().cases, values);
    result.certificate = inner::to_json(c);
    return result;
  });
}

Result<Verification> verify(const std::string& certificate) {
  const inner::SourceText source{"certificate", certificate};
  return guarded(source, [&]() -> Result<Verification> {
    const inner::Verification v = inner::verify(inner::read_certificate(certificate));
    Verification result;
    result.claims = v.claims.size();
    for (const inner::ClaimFinding& f : v.claims) result.confirmed += f.finding == inner::Finding::confirmed;
    return result;
  });
}

}  // namespace anholon::v1
