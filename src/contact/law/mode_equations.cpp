#include "contact/law/mode_equations.h"

#include <limits>

#include "contact/law/pivoted_equations.h"

namespace anholon {

std::vector<HeldComponent> held_components(const ContactProblem& p, const ContactModes& modes) {
  std::vector<HeldComponent> list;
  for (std::size_t c = 0; c < modes.size(); ++c)
    for (std::size_t a = 0; modes[c].touch == Touch::sticks && a < p.contacts[c].tangential.size(); ++a)
      if (!modes[c].shares[a].shared) list.push_back({c, a});
  return list;
}

std::vector<std::size_t> held_gaps(const ContactProblem& p, const ContactModes& modes) {
  std::vector<std::size_t> list;
  for (std::size_t c = 0; c < modes.size(); ++c)
    if (modes[c].touch != Touch::open && !p.contacts[c].under && !modes[c].load.shared) list.push_back(c);
  return list;
}

long double size_of_forces(const ContactProblem& p, const ContactSolution& f) {
  const long double given = largest(p.b);
  return std::max(given > 0 ? given : largest(f.normal), std::numeric_limits<long double>::min());
}

bool shares_friction(const ContactModes& modes) {
  return std::any_of(modes.begin(), modes.end(), [](const ContactMode& m) {
    return m.touch == Touch::sticks && (m.shares[0].shared || m.shares[1].shared);
  });
}

namespace {

using Real = long double;
using Numbers = ContactNumbers;

// The linear equations of given modes. Unknowns: x, lambda, the holding loads and the holding friction.
class ModeEquations {
 public:
  ModeEquations(const ContactProblem& p, const ContactModes& modes)
      : p_(p), modes_(modes), gaps_(held_gaps(p, modes)), held_(held_components(p, modes)),
        loads_(p.b.size() + p.beta.size()), forces_(loads_ + gaps_.size()), m_(forces_ + held_.size()) {
    smooth();
    for (std::size_t c = 0; c < modes.size(); ++c)
      if (modes[c].touch != Touch::open) contact(c);
    for (std::size_t k = 0; k < gaps_.size(); ++k) {
      const ContactRows& rows = p.contacts[gaps_[k]];
      std::copy(rows.normal.begin(), rows.normal.end(), m_[loads_ + k]);
      m_.right()[loads_ + k] = -rows.normal_rate;
    }
    for (std::size_t k = 0; k < held_.size(); ++k) {
      const ContactRows& rows = p.contacts[held_[k].contact];
      const Numbers& t = rows.tangential[held_[k].component];
      std::copy(t.begin(), t.end(), m_[forces_ + k]);
      m_.right()[forces_ + k] = -rows.tangential_rate[held_[k].component];
    }
  }

  std::optional<ContactSolution> solve() {
    const auto found = m_.solve();
    if (!found) return std::nullopt;
    ContactSolution f;
    f.modes = modes_;
    f.x.assign(found->begin(), found->begin() + static_cast<std::ptrdiff_t>(p_.b.size()));
    for (std::size_t c = 0; c < modes_.size(); ++c) {
      Real N = p_.contacts[c].pressed;
      for (std::size_t k = 0; k < gaps_.size(); ++k) N += load(c, k) * (*found)[loads_ + k];
      f.normal.push_back(N);
      std::array<Real, 2> t{};
      for (std::size_t a = 0; modes_[c].touch == Touch::sticks && a < p_.contacts[c].tangential.size(); ++a) {
        t[a] = modes_[c].shares[a].given;
        for (std::size_t k = 0; k < held_.size(); ++k) t[a] += part(c, a, k) * (*found)[forces_ + k];
      }
      f.friction.push_back(t);
    }
    return f;
  }

 private:
  // The part of the holding load k in the load of a contact, or in the load that presses a resistance.
  Real load(std::size_t c, std::size_t k) const {
    const std::size_t of = p_.contacts[c].under.value_or(c);
    const ForceShare& share = modes_[of].load;
    if (modes_[of].touch == Touch::open) return 0;
    if (share.shared) return k < share.of.size() ? share.of[k] : 0;
    return gaps_[k] == of ? 1 : 0;
  }
  // The part of the holding force k in component a of the friction of a contact.
  Real part(std::size_t c, std::size_t a, std::size_t k) const {
    const ForceShare& share = modes_[c].shares[a];
    if (share.shared) return k < share.of.size() ? share.of[k] : 0;
    return held_[k].contact == c && held_[k].component == a ? 1 : 0;
  }

  void smooth() {
    const std::size_t n = p_.b.size();
    PivotedEquations& m = m_;
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t j = 0; j < n; ++j) m[i][j] = p_.A[i][j];
      for (std::size_t r = 0; r < p_.beta.size(); ++r) m[i][n + r] = -p_.Phi[r][i], m[n + r][i] = p_.Phi[r][i];
      m.right()[i] = -p_.b[i];
    }
    for (std::size_t r = 0; r < p_.beta.size(); ++r) m.right()[n + r] = -p_.beta[r];
  }

  void contact(std::size_t c) {
    const ContactRows& rows = p_.contacts[c];
    PivotedEquations& m = m_;
    for (std::size_t i = 0; i < p_.b.size(); ++i) {
      Real along = rows.under ? 0 : -rows.normal[i];  // the effect of a unit of the load, with its friction
      for (std::size_t a = 0; a < rows.tangential.size(); ++a) {
        const Real t = rows.tangential[a][i];
        if (modes_[c].touch == Touch::sticks) {
          for (std::size_t k = 0; k < held_.size(); ++k) m[i][forces_ + k] -= part(c, a, k) * t;
          m.right()[i] += modes_[c].shares[a].given * t;
          continue;
        }
        const Real friction = rows.friction * modes_[c].direction[a] * t;
        along += friction;
        m.right()[i] -= friction * rows.pressed;
      }
      for (std::size_t k = 0; k < gaps_.size(); ++k)
        if (const Real of = load(c, k); of != 0) m[i][loads_ + k] += of * along;
    }
  }

  const ContactProblem& p_;
  const ContactModes& modes_;
  std::vector<std::size_t> gaps_;
  std::vector<HeldComponent> held_;
  std::size_t loads_, forces_;  // the first unknown of each kind
  PivotedEquations m_;
};

}  // namespace

std::optional<ContactSolution> of_modes(const ContactProblem& p, const ContactModes& modes) {
  return ModeEquations(p, modes).solve();
}

}  // namespace anholon
