// Eigenvalues and right eigenvectors of a real matrix in multiprecision, with what each can be trusted.
//
//   A x = mu x,  by the QR algorithm (Arb's acb_mat_approx_eig_qr) at the working precision.
//
// A rounding of size u moves an eigenvalue of multiplicity m by u^(1/m). So A is solved a second time with its entries
// changed in their last digits: the eigenvalues that lie nearer together than they moved are one multiple eigenvalue,
// for which their mean stands (it moves by u only), and `radius` says how far its members were spread. What is smaller
// than the radius is zero.
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
  Multi radius{0};              // how far the last digits of A move it
  std::vector<Complex> vector;  // largest entry 1
};

// By falling real part, then rising frequency, + before -. As many as A has rows: a multiple one stands several times.
// False if the iteration does not converge, or A holds what is no number.
bool eigenvalues(const Matrix<Multi>& a, std::vector<Eigenvalue>& out);

Multi modulus(const Complex& z);

}  // namespace anholon
