// Shell elements on any quadrilateral mesh with clamped and prescribed coordinates, for element tests and published
// shell problems. The tests use the tire's elements and matrices, and their own assembly and statics. Coordinates: 6
// per node, position then director.
#pragma once

#include <Eigen/Dense>
#include <Eigen/SparseCholesky>
#include <array>
#include <functional>
#include <vector>

#include "tire/ancf/shell_matrices.hpp"

namespace furrow::test {

using Vector = Eigen::VectorXd;
using Sparse = Eigen::SparseMatrix<double>;

tire::ShellLayer isotropic_layer(double thickness, double young, double poisson);

/// E_L along the fibre; otherwise transversely isotropic, except for G_TT.
struct Ply {
  double e_l = 0.0, e_t = 0.0, g_lt = 0.0, g_tt = 0.0;  // Pa
  double nu_lt = 0.0, nu_tt = 0.0;
};
tire::ShellLayer ply_layer(double thickness, double angle_deg, const Ply& ply);

struct PatchMesh {
  std::vector<Vec3> position, director;
  std::vector<std::array<int, 4>> elements;  // counter-clockwise about the director

  int nodes() const { return static_cast<int>(position.size()); }
  /// Nodes with a position that satisfies `where`, ascending.
  std::vector<int> select(const std::function<bool(const Vec3&)>& where) const;
  int nearest(const Vec3& place) const;
};

/// (n + 1) × (m + 1) nodes, node(i, j) = i (m + 1) + j; elements' ξ runs with s = i/n, η with t = j/m.
/// `surface` gives position and director.
PatchMesh grid_mesh(int n, int m, const std::function<std::pair<Vec3, Vec3>(double s, double t)>& surface);
/// 0 … length by 0 … width in the plane z = 0.
PatchMesh plate_mesh(int n, int m, double length, double width);
/// 5 elements around a distorted inner quadrilateral of a 2 × 1 rectangle, nodes 0–3 outside, 4–7 inside.
PatchMesh distorted_mesh();

class ShellPatch {
 public:
  /// One vector of the 36 generalised strains or stresses per element.
  using ElementStrains = std::vector<tire::StrainVector>;

  ShellPatch(PatchMesh mesh, std::vector<tire::ShellLayer> layers);

  const PatchMesh& mesh() const { return mesh_; }
  const Vector& reference() const { return reference_; }
  int nodes() const { return mesh_.nodes(); }
  int coordinates() const { return 6 * mesh_.nodes(); }

  ElementStrains strains(const Vector& q) const;
  /// D̂ E.
  ElementStrains stresses(const ElementStrains& strains) const;
  double energy(const Vector& q) const;
  /// B(q)ᵀ S.
  Vector forces(const Vector& q, const ElementStrains& stress) const;
  Vector forces(const Vector& q) const { return forces(q, stresses(strains(q))); }
  /// material × Bᵀ D̂ B + geometric × Σ S_k H_k.
  Sparse tangent(const Vector& q, const ElementStrains& stress, double material = 1.0, double geometric = 1.0) const;
  Sparse tangent(const Vector& q) const { return tangent(q, stresses(strains(q))); }
  /// D̂ (E(q) + B(q) Δq).
  ElementStrains linear_stresses(const Vector& q, const Vector& change) const;

  /// Consistent mass for layers of one density, kg/m³.
  Sparse mass(double density) const;
  /// Means over element e of the membrane forces N₁₁, N₂₂, N₁₂ (N/m) and moments M₁₁, M₂₂, M₁₂ (N), from the
  /// layers' second Piola–Kirchhoff stresses; the first axis lies along g₁.
  Eigen::Matrix<double, 6, 1> resultants(const Vector& q, int e) const;

 private:
  using Gradient = Eigen::Matrix<double, tire::kStrains, 24>;
  using ElementTangent = Eigen::Matrix<double, 24, 24>;
  tire::ElementNodes gather(const Vector& q, int e) const;
  static Gradient gradient(const tire::ElementNodes& nodes);
  void make_pattern();

  PatchMesh mesh_;
  std::vector<tire::ShellLayer> layers_;
  Vector reference_;
  std::vector<tire::StrainMatrix> stiffness_;
  ElementStrains raw_;
  Sparse pattern_;          // with zeros
  std::vector<int> place_;  // of an element's entries in the pattern's values
};

/// The unknown coordinates: all that are not fixed.
class Supports {
 public:
  explicit Supports(int nodes) : fixed_(6 * nodes, 0) {}
  /// `which`: any of "xyz" for the position and "abc" for the director's components.
  Supports& fix(const std::vector<int>& nodes, const char* which);
  bool fixed(int coordinate) const { return fixed_[coordinate] != 0; }
  std::vector<int> free() const;

 private:
  std::vector<char> fixed_;
};

/// Sub-matrix of the free coordinates.
Sparse restrict_to(const Sparse& k, const std::vector<int>& free);
Vector restrict_to(const Vector& v, const std::vector<int>& free);

/// Statics along a path λ = 0 … 1 of loads λ F and prescribed coordinates. Newton's method has stresses as separate
/// unknowns: the geometric stiffness uses stresses extrapolated linearly from the previous iterate. Bending of thin
/// shells then converges in large steps; the solution is the same.
///   Magisano, Leonetti, Garcea (2017), Advantages of the mixed format in geometrically nonlinear analysis of beams
///   and shells using solid finite elements, Int. J. Numer. Methods Eng. 109, doi:10.1002/nme.5322.
class StaticPath {
 public:
  StaticPath(const ShellPatch& patch, const Supports& supports, Vector load)
      : patch_(patch), free_(supports.free()), load_(std::move(load)), q_(patch.reference()) {}

  /// Sets prescribed coordinates at λ.
  void prescribe(std::function<void(double, Vector&)> motion) { motion_ = std::move(motion); }
  /// Continues from a known equilibrium.
  void start(const Vector& q, double lambda) { q_ = q, lambda_ = lambda; }
  /// Moves to λ, in smaller steps if Newton's method fails. @returns false when the steps become too small
  bool go_to(double lambda);

  const Vector& q() const { return q_; }
  double lambda() const { return lambda_; }
  /// Internal forces minus loads: zero on free coordinates, reactions on the others.
  Vector reactions() const { return patch_.forces(q_) - lambda_ * load_; }

 private:
  bool newton(double lambda, Vector& q);

  const ShellPatch& patch_;
  std::vector<int> free_;
  Vector load_, q_;
  std::function<void(double, Vector&)> motion_;
  Eigen::SimplicialLDLT<Sparse> solver_;
  bool analyzed_ = false;
  double lambda_ = 0.0;
};

/// Solution of K u = f on the free coordinates, zero elsewhere.
Vector linear_solution(const ShellPatch& patch, const Supports& supports, const Vector& load);

/// Lowest eigenvalues ω² of K φ = ω² M φ, K positive definite, ascending, by subspace iteration.
Vector lowest_eigenvalues(const Sparse& k, const Sparse& m, int count);

}  // namespace furrow::test
