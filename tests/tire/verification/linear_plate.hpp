// A plate pressed on an inflated tire with a linear response, u = C f with C = K⁻¹ of the tangent K as inflated:
//   depth_s = δ − g_s − Σ_n w_sn u_n,   f_n = Σ_s w_sn κ A_s ⟨depth_s⟩,
// points s, gaps g_s and stiffness κ as in PressSolver. K is inverted order by order (cyclic.hpp), so neither the
// assembly nor the solution of PressSolver is used; the active points are found by a primal–dual active set.
//   Hintermüller, Ito & Kunisch (2002), SIAM J. Optim. 13:865, doi:10.1137/S1052623401383558.
// It is the limit of PressSolver for small deflections. It has no wrinkles, and also exists if K is not definite.
#pragma once

#include <vector>

#include "tests/tire/verification/cyclic.hpp"

namespace furrow::test {

class LinearPlate {
 public:
  /// @param reach gaps above it never close, m
  LinearPlate(const InflatedCarcass& ring, double reach);

  struct Answer {
    bool found = false;       // whether the active set converged
    double deflection = 0.0;  // δ, m
    double force = 0.0;       // N
    double tangent = 0.0;     // dF/dδ, N/m
  };
  Answer at_deflection(double deflection) const;
  Answer at_load(double load) const;

 private:
  struct Point {
    int node[4];
    double weight[4], gap, stiffness;  // m, N/m
  };
  void make_compliance(const InflatedCarcass& ring);
  void make_points(const InflatedCarcass& ring);
  int node(int column, int row) const { return column * rows_ + row; }

  int first_column_ = 0, columns_ = 0, first_row_ = 0, rows_ = 0;  // the nodes within reach
  Eigen::MatrixXd compliance_;                                     // vertical, of these nodes, m/N
  std::vector<Point> points_;
};

}  // namespace furrow::test
