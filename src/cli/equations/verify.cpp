// anholon verify: src/proof/checker/verify.h reads and checks a certificate; no other part of the program takes part.
#include "proof/checker/verify.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>

#include "base/json.h"
#include "cli/input.h"
#include "cli/say.h"

namespace anholon::cli {

namespace {

using Claim = Certificate::Claim;

struct Count {
  int all = 0, confirmed = 0;
  double log2_chance = -INFINITY;  // of the weakest claim
};

// "8.7e-19" from its binary logarithm, which may be far below the range of a double; rounded upwards.
std::string chance_text(double log2_chance) {
  if (!std::isfinite(log2_chance)) return "0";
  const double decimal = log2_chance * 0.30102999566398120;
  double exponent = std::floor(decimal), mantissa = std::ceil(std::pow(10, decimal - exponent) * 10) / 10;
  if (mantissa >= 10) mantissa /= 10, exponent += 1;
  char buffer[64];
  std::snprintf(buffer, sizeof buffer, "%.1fe%.0f", mantissa, exponent);
  return buffer;
}

std::string describe(const Claim& c) {
  switch (c.kind) {
  case Certificate::ClaimKind::agree:
    return c.a + " and " + c.b + " agree";
  case Certificate::ClaimKind::differ:
    return c.a + " and " + c.b + " differ";
  case Certificate::ClaimKind::kernel:
    return "kernel of the constraints";
  case Certificate::ClaimKind::pivot:
    return "pivots";
  }
  return "";
}

void text(const Certificate& c, const Verification& v) {
  say(stdout, "certificate of %s, written by %s\n", c.model.c_str(), c.program.c_str());
  if (!c.source_hash.empty()) say(stdout, "source: %s\n", c.source_hash.c_str());
  if (!c.hypotheses.empty()) say(stdout, "\nhypotheses\n");
  for (const std::string& h : c.hypotheses) say(stdout, "  %s\n", h.c_str());
  if (!c.meaning.empty()) say(stdout, "\nmeaning\n  %s\n", c.meaning.c_str());

  // The counts in the order of the certificate.
  std::vector<std::pair<std::string, Count>> table;
  std::map<std::string, std::size_t> row;
  double weakest = -INFINITY;
  std::size_t longest = 0;
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    const std::string what = shown(describe(c.claims[k]));
    const auto [it, is_new] = row.emplace(what, table.size());
    if (is_new) table.push_back({what, {}});
    Count& count = table[it->second].second;
    ++count.all;
    longest = std::max(longest, what.size());
    const ClaimFinding& f = v.claims[k];
    if (f.finding != Finding::confirmed) continue;
    ++count.confirmed;
    if (!f.proved) weakest = std::max(weakest, f.log2_chance);
  }
  say(stdout, "\nclaims\n");
  for (const auto& [what, count] : table)
    say(stdout, "  %-*s  %d of %d confirmed\n", static_cast<int>(longest), what.c_str(), count.confirmed, count.all);
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    const ClaimFinding& f = v.claims[k];
    if (f.finding == Finding::confirmed) continue;
    say(stdout, "%s\n",
        (std::string(name(f.finding)) + ": " + describe(c.claims[k]) + ", component " + c.claims[k].component + ": " +
         f.detail)
            .c_str());
  }
  say(stdout, "\n");
  if (c.claims.empty())
    say(stdout, "nothing is claimed\n");
  else if (!v.all_confirmed())
    say(stdout, "NOT verified\n");
  else if (!std::isfinite(weakest))
    say(stdout, "verified\n");
  else
    say(stdout, "verified; the chance that a false claim passed is below %s for each\n", chance_text(weakest).c_str());
  if (v.all_confirmed())
    say(stdout, "The forms agree given the same energy, forces and constraints; the model itself is not proved.\n");
}

void json(const Certificate& c, const Verification& v) {
  JsonWriter j;
  j.open_object()
      .key("model")
      .string(c.model)
      .key("program")
      .string(c.program)
      .key("source_hash")
      .string(c.source_hash);
  j.key("hypotheses").open_array();
  for (const std::string& h : c.hypotheses) j.string(h);
  j.close().key("meaning").string(c.meaning).key("verified").boolean(v.all_confirmed());
  j.key("claims").open_array();
  for (std::size_t k = 0; k < c.claims.size(); ++k) {
    const Claim& claim = c.claims[k];
    const ClaimFinding& f = v.claims[k];
    j.open_object().key("kind").string(name(claim.kind)).key("a").string(claim.a).key("b").string(claim.b);
    j.key("component").string(claim.component).key("finding").string(name(f.finding));
    if (f.finding == Finding::confirmed) j.key("chance").number(f.proved ? "0" : chance_text(f.log2_chance));
    if (!f.detail.empty()) j.key("detail").string(f.detail);
    j.close();
  }
  j.close().close();
  hand_out(j.text() + "\n");
}

}  // namespace

int verify(const VerifyCommand& o) {
  SourceText source{o.certificate, {}};
  std::string why;
  if (!read_file(o.certificate, source.text, &why))
    throw UsageError{"error: cannot read the certificate '" + o.certificate + "': " + why +
                     "\nhint: `anholon prove MODEL -o FILE` writes one\n"};
  Certificate certificate;
  try {
    certificate = read_certificate(source.text);
  } catch (const Failure& f) {
    throw UsageError{"error: " + o.certificate + ": " + f.what() + "\n"};
  }
  VerifyOptions options;
  options.points = o.points;
  options.seed = o.seed;
  options.digits = o.digits;
  const Verification v = anholon::verify(certificate, options);
  if (o.json)
    json(certificate, v);
  else if (!o.quiet)
    text(certificate, v);
  return v.all_confirmed() ? kOk : kStopped;
}

}  // namespace anholon::cli
