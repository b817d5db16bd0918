// The handles (Expr) that a value holds in any of its members. A value is copied to a clone of its graph by copying it
// and setting the graph of each of these handles to the new graph.
//
// A type that holds handles has an overload of for_each_expression, which names all of its members by a structured
// binding: a member that is added to the type later and forgotten there does not compile. So does a member whose type has
// neither an overload nor a row in kHoldsNoExpressions.
#pragma once
#include <functional>
#include <map>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/diagnostic.h"
#include "expr/expr.h"

namespace anholon {

using ExprVisitor = std::function<void(Expr&)>;

template <class T>
inline constexpr bool kHoldsNoExpressions = std::is_arithmetic_v<T> || std::is_enum_v<T>;
template <>
inline constexpr bool kHoldsNoExpressions<std::string> = true;
template <>
inline constexpr bool kHoldsNoExpressions<Rational> = true;
template <>
inline constexpr bool kHoldsNoExpressions<Span> = true;
template <>
inline constexpr bool kHoldsNoExpressions<SourceText> = true;

inline void for_each_expression(Expr& e, const ExprVisitor& f) { f(e); }

template <class T>
  requires kHoldsNoExpressions<T>
void for_each_expression(T&, const ExprVisitor&) {}
template <class T>
void for_each_expression(std::vector<T>& list, const ExprVisitor& f);
template <class T, std::size_t N>
void for_each_expression(T (&list)[N], const ExprVisitor& f);
template <class T>
void for_each_expression(std::optional<T>& value, const ExprVisitor& f);
template <class A, class B>
void for_each_expression(std::pair<A, B>& value, const ExprVisitor& f);

template <class T>
void for_each_expression(std::vector<T>& list, const ExprVisitor& f) {
  for (T& each : list) for_each_expression(each, f);
}
template <class T, std::size_t N>
void for_each_expression(T (&list)[N], const ExprVisitor& f) {
  for (T& each : list) for_each_expression(each, f);
}
template <class T>
void for_each_expression(std::optional<T>& value, const ExprVisitor& f) {
  if (value) for_each_expression(*value, f);
}
template <class A, class B>
void for_each_expression(std::pair<A, B>& value, const ExprVisitor& f) {
  for_each_expression(value.first, f);
  for_each_expression(value.second, f);
}

// Visits the handles of all members.
template <class... Members>
void for_each_expression_of(const ExprVisitor& f, Members&... members) {
  (for_each_expression(members, f), ...);
}

}  // namespace anholon
