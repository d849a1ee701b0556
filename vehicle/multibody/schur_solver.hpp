// Solves for constraint impulses: S P = r with S = G M⁻¹ Gᵀ + Σ, sparse, symmetric, positive semi-definite.
// M is block-diagonal (one block per body), so S couples two rows exactly when they share a body, and its
// pattern is fixed by the topology: one symbolic analysis, then numeric factorizations only.
//
// Redundant rows make S singular. The factored matrix is S + εI, and the caller repeats P += (S + εI)⁻¹ r(P)
// from P = 0 (the proximal-point iteration): P stays in the range of S, so it tends to the solution of
// minimum Euclidean norm; the error in the range falls by ε/(σ + ε) each time.
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "vehicle/multibody/row.hpp"

namespace furrow::vehicle {

class SchurSolver {
 public:
  /// Symbolic analysis for rows with fixed bodies. @pre no row joins a body with itself
  void analyze(std::span<const Row> rows);

  /// Builds S from the rows' Jacobians at the bodies' present poses and factors it. compliance[i] ≥ 0 is
  /// added to the diagonal; a negative value switches row i off (its impulse is then r_i itself: give it 0).
  /// @return false when the factorization fails. @pre one Jacobian and one compliance for each row analysed
  bool factorize(std::span<const RowJacobian> jacobians, std::span<const Body> bodies,
                 std::span<const double> compliance);

  /// P = (S + εI)⁻¹ r.
  void solve(const Eigen::VectorXd& r, Eigen::VectorXd& P) const;

  /// r = S P.
  void multiply(const Eigen::VectorXd& P, Eigen::VectorXd& r) const;

 private:
  struct Entry {
    int i, j;   // rows, i ≥ j
    int value;  // index into the matrix values
    int body;
    bool i_is_b, j_is_b;  // the shared body is B of the row
  };

  std::vector<Entry> entries_;
  std::vector<int> diagonal_;      // value index of S_ii
  Eigen::SparseMatrix<double> S_;  // with εI, lower half
  double epsilon_ = 0.0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt_;
};

}  // namespace furrow::vehicle
