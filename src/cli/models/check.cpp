#include "cli/input.h"
#include "cli/models/check_report.h"
#include "cli/models/show.h"
#include "contact/kept_gaps.h"
#include "modelfile/contacts.h"
#include "motion/start.h"

namespace anholon::cli {

int check(const SystemCommand& asked) {
  const Reader in = read(asked);
  if (asked.show == "cost") return show_cost(asked, in);
  const SystemCommand o = with_form(asked, in);
  Scenario s;
  Outcome outcome = ready(in, form(o, *in.model), state_choice(o, *in.model), s);
  if (outcome.ok() && !not_integrated(*in.model)) outcome = regular_at_start(s);
  if (outcome.ok() && o.mode.empty() && !not_integrated(*in.model))
    outcome = kept_by_constraints(s, contacts(*in.names));
  if (!o.show.empty()) return show(o, s, outcome);
  Workspace own(s);
  const Explanation x = explain(own);
  if (o.json)
    check_json(own, x, outcome);
  else
    check_text(own, x, outcome);
  if (outcome.ok()) return kOk;
  print_outcome(outcome, in.source);
  return kStopped;
}

}  // namespace anholon::cli
