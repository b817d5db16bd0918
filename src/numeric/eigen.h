// Eigenvalues and right eigenvectors of a real matrix in multiprecision, each with an error estimate.
//
//   A x = mu x,  by the QR algorithm (Arb's acb_mat_approx_eig_qr) at the working precision.
//
// A rounding of size u moves an eigenvalue of multiplicity m by u^(1/m). So A is solved a second time with its entries
// changed in their last digits: eigenvalues that are closer together than they moved are one multiple eigenvalue. It is
// replaced by their mean, which moves by u only, and `radius` is the spread of its members. A value smaller than the
// radius is zero.
#pragma once
#include <string>
#include <vector>

#include "numeric/linear.h"

namespace anholon {

struct Complex {
  Multi re{0}, im{0};
};

struct Eigenvalue {
  Complex value;
  int multiplicity = 1;
  Multi radius{0};              // the distance by which the last digits of A move it
  std::vector<Complex> vector;  // largest entry 1
};

// Computes the eigenvalues, sorted by decreasing real part, then by increasing frequency, + before -. There are as many
// eigenvalues as A has rows: a multiple one is listed several times. Returns false if the iteration does not converge
// or A contains a NaN.
bool eigenvalues(const Matrix<Multi>& a, std::vector<Eigenvalue>& out);

Multi modulus(const Complex& z);

}  // namespace anholon
