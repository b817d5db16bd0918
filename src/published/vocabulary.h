// The words of published equations: the names of the model, and those of the quantities that are derived from it.
//
//   T_r, S_r, V_O, V_omega           energies of the relative motion, with frozen masses      [L 2.7, 3.18]
//   Q.x, QR.x, QD.x, Qomega.x, minus_dVO.x, minus_dVomega.x, Gamma.x, G.x                      generalized forces of x; G is their sum
//   inertia_term.x, N.x              sum m a . dr/dx and sum lambda dphi/dx^(m)                [L 2.2, 2.6]
//   phi.NAME, lambda.NAME            a constraint (left - right) and its multiplier; phi and lambda, if there is only one
//   f.y, C.y.x                       y^(m) = f.y solved from the constraints, and df.y/dx^(m)  [L 3.8]
//   g.x, B.x.u                       x^(m) as a function of quasi-velocities, and dg.x/du      [N 4.2]
//   f.c0(x), f.c1(x), …, f.knot(x)   the pieces of a table f, as derive prints them: f(x) is their polynomial in x - f.knot(x)
//   mu.NAME, m_NAME                  the frozen mass of a body, and its mass
//   FORM.x, FORM.left.x, FORM.right.x   left - right of a form's equation, with _ for the - of its name
//   partial(e, v)                    the partial derivative by a derivative of a coordinate, by t, or by another symbol
//   Dt(e), Dt(e, k)                  the total derivative with masses regarded as constant (D/Dt of the papers)
//   frozen(e)                        e with frozen masses
//   reduced(e), star(e)              e with the constraints substituted: by f [L 3.11, N 3.9], and in quasi-velocities [N 4.6]
//   along(Q, x)                      Q.x + sum over the dependent y of Q.y C.y.x; for a quasi-velocity u: sum over all x of Q.x B.x.u
//
// The names of the model take precedence; derived.NAME always is the derived quantity. Local definitions (let) take
// precedence over both.
#pragma once
#include <map>

#include "formulation/formulation.h"
#include "modelfile/read.h"

namespace anholon {

class Vocabulary final : public Names {
 public:
  // Returns the elimination of coordinates, or (true) of quasi-velocities; called when a word needs it. May throw
  // Failure.
  using EliminationOf = std::function<const Elimination&(bool quasi)>;
  Vocabulary(const Mechanics& mechanics, std::shared_ptr<Names> model, EliminationOf elimination);

  // Joins dotted names of this vocabulary into one name each: every formula must pass through it once before it is
  // evaluated.
  void join(Syntax& s) const;
  // Adds a definition. Throws Failure if the name is taken. `value` is joined.
  void let(const std::string& name, Syntax value, Span span);
  // Returns the names of the definitions so far.
  std::vector<std::string> local_names() const;

  // Returns the value of a joined formula along the motion, with masses substituted, quasi-velocities expressed in
  // coordinates, and rates in place of the derivatives of states.
  Expr number(const Syntax& s);
  Value value(const Syntax& s);
  // Returns the same value, in which derivatives of states are symbols.
  Expr number_before_rates(const Syntax& s);

  Graph& graph() override { return mechanics_.graph(); }
  Value name(const std::string& name, Span span) override;
  std::optional<Value> call(const std::string& function, const std::vector<Value>& arguments,
                            const Syntax& syntax) override;
  Value member(const Value& object, const Syntax& syntax) override { return model_->member(object, syntax); }
  std::vector<std::string> functions() const override;
  bool declares(const std::string& name) const override { return model_->declares(name); }
  std::optional<Vector> point(const BodyName& body, Span use) override { return model_->point(body, use); }
  std::optional<Rotation> frame(const BodyName& body, Span use) override { return model_->frame(body, use); }
  std::string body_name(const BodyName& body) const override { return model_->body_name(body); }
  Expr in_time(Expr e) override;

 private:
  struct Let {
    Syntax syntax;
    Value value;
  };
  // Splits lambda.blade.x into {"lambda", "blade", "x"}.
  static std::vector<std::string> split(const std::string& path);
  bool is_word(const std::string& first) const;
  std::optional<Value> word(const std::string& first, const std::vector<std::string>& rest, Span span);
  const Column* column(const std::string& name);
  std::size_t coordinate(const std::string& name, Span span) const;
  std::size_t coordinate(const Value& v, Span span) const;
  std::optional<Expr> piece_of_table(const std::string& name, const std::vector<Value>& arguments, const Syntax& s);
  Expr along(const Column& column, const std::string& direction, Span span);
  Expr of_form(const Formulation& form, const std::vector<std::string>& rest, Span span);
  Expr solved(const std::string& y, Span span);
  std::optional<Expr> quasi_velocity(const std::string& name);
  Value partial_of(const Syntax& s, const Value& what);
  Expr partial_by(Expr e, Expr by, Span span);
  Expr partial_along(Expr e, Expr by, bool quasi, Span span);
  const Syntax* reduced_argument(const Syntax& s, bool& quasi) const;
  bool holds_reduced(const Syntax& s, bool quasi) const;
  Value each(const Value& v, Span span, const std::function<Expr(Expr)>& f) const;
  Expr with_frozen_masses(Expr e) const;
  Expr finished(Expr e);

  const Mechanics& mechanics_;
  std::shared_ptr<Names> model_;
  EliminationOf elimination_;
  bool used_quasi_ = false;
  bool by_symbols_ = false;  // while the second argument of partial(e, v) is read
  std::map<std::string, Let> lets_;
  std::map<std::string, Column> columns_;
  std::map<std::string, Equations> forms_;
};

}  // namespace anholon
