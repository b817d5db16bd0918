#include "report/page/page_of.h"

#include <algorithm>
#include <map>

#include "base/stop.h"
#include "mechanics/notes_on_rank.h"
#include "modelfile/hash.h"
#include "observe/rows/quantity_units.h"
#include "proof/checker/verify.h"
#include "report/page/data.h"
#include "report/page/page.h"
#include "setup/eliminate.h"

namespace anholon {

namespace {

// Limits: a proof of all forms takes long, and equations of more coordinates are too long to read.
constexpr std::size_t kMostProved = 12, kMostNodesProved = 600, kMostRead = 24;

// Returns the requested forms, or Routh's, that of the motion, and Maggi's if there are constraints to eliminate.
std::vector<const Formulation*> shown_forms(const PageRequest& request, const Workspace& scenario) {
  const Mechanics& m = *scenario.mechanics;
  std::vector<const Formulation*> list;
  const auto add = [&](const Formulation* f) {
    if (f && obstacle(*f, m).empty() && std::find(list.begin(), list.end(), f) == list.end()) list.push_back(f);
  };
  for (const Formulation* f : request.forms) add(f);
  if (!list.empty()) return list;
  add(find_formulation("routh"));
  add(scenario.system.form);
  if (!m.phi.empty() && m.q.size() <= kMostRead) add(find_formulation("maggi"));
  return list;
}

// Equations longer than kLong are not printed on the page; the steps of the derivation are shown if the result is
// shorter than kShort.
constexpr std::size_t kLong = 40000, kShort = 6000, kMostArranged = 320;

std::size_t length(const Derivation& d) {
  std::size_t n = 0;
  for (const Line& l : d.equations) {
    if (l.left) n += print(*l.left, d.names, Format::text).size();
    n += print(l.right, d.names, Format::text).size();
  }
  return n;
}

// The number of nodes to arrange and to prove.
std::size_t nodes(const Mechanics& m, const Formulation& f, const Elimination& e) {
  const Equations raw = f.equations(m, e);
  Column all = raw.left;
  all.insert(all.end(), raw.right.begin(), raw.right.end());
  return reachable(all).size();
}

Derivation derived(const Mechanics& m, const Formulation& f, const Elimination& e, Arranger& arranger) {
  const auto in_parts = [&] {
    Arranger parts("parts");
    return derivation(m, f, e, parts, false);
  };
  if (nodes(m, f, e) > kMostArranged) return in_parts();
  Derivation d = derivation(m, f, e, arranger, false);
  const std::size_t n = length(d);
  if (n > kLong) return in_parts();
  return f.eliminates() && n < kShort ? derivation(m, f, e, arranger, true) : d;
}

std::string eliminated(const Elimination& e, const Model& model) {
  std::string list;
  for (std::size_t k : e.dependent) list += (list.empty() ? "" : ", ") + model.coordinates[k].name;
  if (list.empty()) return "";
  std::string text = "The constraints are solved for derivatives of " + list + ".";
  for (const std::string& n : notes_on_rank(model, e)) text += " Note: " + n + ".";
  return text;
}

// The equations of the page; returns the number of nodes of the first ones.
std::size_t add_equations(Page& page, const PageRequest& request, const Workspace& scenario) {
  const Mechanics& m = *scenario.mechanics;
  Arranger arranger("auto");
  std::map<Unknowns, Elimination> eliminations;
  std::size_t first_size = 0;
  for (const Formulation* f : shown_forms(request, scenario)) {
    if (!eliminations.count(f->unknowns))
      eliminations.emplace(f->unknowns,
                           elimination_for(m, f->unknowns, request.choice.overrides, request.choice.eliminate));
    const Elimination& e = eliminations.at(f->unknowns);
    const std::size_t size = nodes(m, *f, e);
    if (page.equations.empty())
      first_size = size;
    else if (size > kMostArranged && request.forms.empty())
      continue;  // the form was not requested, and its equations are too long to read
    page.equations.push_back(derived(m, *f, e, arranger));
    page.eliminations.push_back(f->eliminates() ? eliminated(e, *scenario.model) : "");
  }
  return first_size;
}

// Proves all forms, and checks the certificate as a recipient would: from its text. A fresh graph is used, because the
// graph of the motion and of the printed equations has grown.
Proof add_proof(Page& page, const PageRequest& request, const Model& fresh) {
  const Mechanics own = mechanics(fresh);
  std::vector<const Formulation*> forms;
  for (const Formulation* f : formulations())
    if (obstacle(*f, own).empty()) forms.push_back(f);
  const StateChoice& choice = request.choice;
  std::vector<Eliminations> offered;
  for (const bool solve : {true, false})
    offered.push_back({elimination_for(own, Unknowns::coordinates, choice.overrides, choice.eliminate, solve),
                       elimination_for(own, Unknowns::quasi_velocities, choice.overrides, choice.eliminate, solve)});
  ProofOptions options;
  std::size_t done = 0;
  if (request.progress)
    options.progress = [&](const Formulation& f) { request.progress(++done, forms.size(), f.name); };
  Proof proof = prove(own, forms, offered, options);
  if (proof.stopped) throw StopRequested{};
  const Certificate c = certificate(own, proof, offered.front(), page.version, page.model_hash);
  page.hypotheses = c.hypotheses;
  page.meaning = c.meaning;
  page.certificate = to_json(c);
  const Verification checked = verify(read_certificate(page.certificate));
  page.claims = checked.claims.size();
  page.confirmed =
      static_cast<std::size_t>(std::count_if(checked.claims.begin(), checked.claims.end(),
                                             [](const ClaimFinding& f) { return f.finding == Finding::confirmed; }));
  return proof;
}

}  // namespace

PageInParts::PageInParts(std::vector<PagedRun> runs, std::shared_ptr<const Model> model, PageRequest request)
    : model_(std::move(model)), request_(std::move(request)) {
  for (PagedRun& r : runs) {
    if (!r.run.units.empty()) add_units(*r.scenario->model, r.conserved, r.run.units);
    page_.cases.push_back(
        {r.name, r.scenario, constraint_facts(*r.scenario), std::move(r.conserved), std::move(r.run)});
  }
  page_.version = request_.version;
  page_.model_hash = model_hash(request_.source);
  page_.source = request_.source;
  page_.command = request_.command;
}

void PageInParts::add_plots() {
  for (PageCase& c : page_.cases) {
    c.plots = std::make_shared<PlotData>(plots_of(c, request_.columns));
    if (request_.note && !c.plots->caution.empty()) request_.note(c.plots->caution);
  }
}

void PageInParts::add_equations() { size_ = anholon::add_equations(page_, request_, *page_.cases.front().scenario); }

void PageInParts::add_proof() {
  page_.no_proof = request_.no_proof;
  if (page_.no_proof.empty() &&
      (page_.cases.front().scenario->mechanics->q.size() > kMostProved || size_ > kMostNodesProved))
    page_.no_proof = "For equations of this length a proof takes its time: anholon prove " + request_.source.name;
  if (!page_.no_proof.empty()) return;
  fresh_ = clone(*model_);
  proof_ = anholon::add_proof(page_, request_, *fresh_);
  page_.proof = &*proof_;
}

std::string page_of(std::vector<PagedRun> runs, const std::shared_ptr<const Model>& model, const PageRequest& request) {
  PageInParts parts(std::move(runs), model, request);
  parts.add_plots();
  parts.add_equations();
  parts.add_proof();
  return html(parts.page());
}

}  // namespace anholon
