// Solves for constraint impulses: S P = r with S = G M⁻¹ Gᵀ + Σ, sparse, symmetric, positive semi-definite.
// M is block-diagonal (one block per body), so S couples two rows exactly when they share a body, and its
// pattern is fixed by the topology: one symbolic analysis, then numeric factorizations only. Shafts are blocks of one
// unknown, J⁻¹; rows in speeds (rate_row.hpp) come after the others and may share any number of bodies and shafts.
//
// Redundant rows make S singular. The factored matrix is S + εI, and the caller repeats P += (S + εI)⁻¹ r(P) from P = 0
// (the proximal-point iteration): P stays in the range of S, so it tends to the solution of minimum Euclidean norm.
// Each repetition reduces the error along a singular value σ by the factor ε/(σ + ε).
#pragma once

#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "vehicle/multibody/rate_row.hpp"
#include "vehicle/multibody/row.hpp"
#include "vehicle/multibody/shaft.hpp"

namespace furrow::vehicle {

/// Rows in speeds, numbered after the other rows.
struct RateSides {
  int count = 0;  // rows
  std::span<const SpinSide> spins;
  std::span<const ShaftSide> shafts;
};

class SchurSolver {
 public:
  /// Symbolic analysis for rows with fixed bodies. @pre no row joins a body with itself; no side occurs twice
  void analyze(std::span<const Row> rows, const RateSides& rates = {});

  /// Builds S from the rows' Jacobians at the bodies' present poses and factors it. compliance[i] ≥ 0 is added to the
  /// diagonal; a negative value switches row i off; its impulse is then r_i itself, so set r_i = 0.
  /// @return false when the factorization fails. @pre one Jacobian and one compliance for each row analysed
  bool factorize(std::span<const RowJacobian> jacobians, std::span<const Body> bodies,
                 std::span<const double> compliance, const RateSides& rates = {}, std::span<const Shaft> shafts = {});

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
  // For a pair in which at least one row is in speeds: the side of each row on which the shared body is.
  struct SpinEntry {
    int i, j, value, body;
    int i_side, j_side;  // index into the sides, or kSideA, kSideB of other rows
  };
  struct ShaftEntry {
    int i, j, value;
    int i_side, j_side;
  };
  static constexpr int kSideA = -1, kSideB = -2;
  void find_rate_entries(std::span<const Row> rows, const RateSides& rates, int body_count);
  void add_rate_entries(std::span<const RowJacobian> jacobians, std::span<const Body> bodies,
                        std::span<const double> compliance, const RateSides& rates, std::span<const Shaft> shafts);

  std::vector<Entry> entries_;
  std::vector<SpinEntry> spin_entries_;
  std::vector<ShaftEntry> shaft_entries_;
  std::vector<int> diagonal_;      // value index of S_ii
  Eigen::SparseMatrix<double> S_;  // with εI, lower half
  double epsilon_ = 0.0;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> ldlt_;
};

}  // namespace furrow::vehicle
