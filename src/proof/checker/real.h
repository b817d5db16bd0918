// The nodes of a certificate as real functions: balls enclose their values and derivatives.
#pragma once
#include <optional>
#include <string>
#include <vector>

#include "numeric/ball.h"
#include "numeric/enclosure.h"
#include "proof/checker/certificate.h"

namespace anholon::verification {

// The nodes that some claims and equations need, in order.
class RealProgram {
 public:
  using Index = Certificate::Index;
  RealProgram(const Certificate& c, const std::vector<const Certificate::Claim*>& claims,
              const std::vector<Index>& others = {});

  // Computes the values of nodes, by their numbers, from the values of symbols, by their indices. The value of a node
  // that is not defined on all of the balls is not finite.
  void evaluate(const std::vector<Ball>& symbols);
  const Ball& value(Index node) const { return value_[local_[node]]; }
  Ball difference(const Certificate::Claim& claim) const;

  // Returns the derivatives of `nodes` with respect to some symbols, row by row. REQUIRES: evaluate() was called.
  std::vector<Ball> jacobian(const std::vector<Index>& nodes, const std::vector<Index>& symbols) const;

  const std::vector<Index>& symbols() const { return symbols_; }  // indices of the symbols that occur, ascending
  std::size_t size() const { return nodes_.size(); }

 private:
  void add(Index node);
  const Certificate& c_;
  std::vector<std::uint32_t> local_;
  std::vector<Index> nodes_, symbols_;
  std::vector<Ball> value_;
};

}  // namespace anholon::verification
