#include "anholon/compare.h"

#include "api/data.h"
#include "modelfile/text/shipped.h"
#include "published/findings/finding.h"
#include "published/subject.h"

namespace anholon::v1 {

namespace {

ComparedEquation compared_equation(const inner::EquationFinding& f) {
  ComparedEquation e{f.label,
                     f.text,
                     static_cast<Verdict>(f.verdict),
                     f.what,
                     f.difference.value_or(""),
                     f.detail,
                     f.point.value_or(""),
                     {},
                     f.with_numbers};
  for (const inner::FoundChange& c : f.changes) {
    Suggestion s{{}, c.reads, c.proved, c.text()};
    for (const inner::FoundPlace& p : c.places) s.places.push_back({p.from, p.to, p.place, p.span.line, p.span.column});
    e.suggestions.push_back(std::move(s));
  }
  return e;
}

Result<std::vector<ComparedEquation>> compared(const Model& model, const inner::SourceText& equations,
                                               const CompareOptions& options) {
  const Model::Data& data = model.data();
  return guarded(data.source, [&]() -> Result<std::vector<ComparedEquation>> {
    data.without_contacts("compare");
    inner::Diagnostics of_model, of_equations;
    const auto open = data.open_again(of_model);
    if (!open) return error_of(of_model, data.source);
    PrepareOptions near;
    near.initial = options.initial, near.eliminate = options.eliminate;
    inner::Subject subject(*open, state_choice(near, *open->model));
    const std::vector<inner::PublishedEquation> list = subject.read(equations, of_equations);
    if (of_equations.has_errors()) return error_of(of_equations, equations);
    std::vector<ComparedEquation> out;
    for (const inner::PublishedEquation& e : list)
      out.push_back(compared_equation(inner::finding_of(e, subject.compare(e), subject.names())));
    return out;
  });
}

}  // namespace

Result<std::vector<ComparedEquation>> compare(const Model& model, const std::string& equations,
                                              const CompareOptions& options) {
  return compared(model, {options.name, equations}, options);
}

Result<std::vector<ComparedEquation>> compare_file(const Model& model, const std::string& path,
                                                   const CompareOptions& options) {
  return guarded(model.data().source, [&] { return compared(model, inner::equation_text(path), options); });
}

}  // namespace anholon::v1
