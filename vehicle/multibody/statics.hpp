// Postures and equilibria of a system, for a vehicle's trim and its suspension's kinematics. Coordinates are, for each
// body in turn, a displacement (m, W) and a small rotation (rad, W) from its present pose. With the rows φ(x) = target
// of the system and the additional held rows, G = ∂φ/∂x, forces Q(x) of bodies at rest and an orthonormal basis N of
// the null space of G:
//
//   posture      φ(x) = target          Newton with the shortest step, δ = G⁺ (target − φ)
//   equilibrium  Nᵀ Q = 0               Newton with K = −Nᵀ ∂(Q + Gᵀλ)/∂x N at constant λ, Gᵀλ ≈ −Q, by central
//                                       differences; the step is halved until the residual falls
//   modes        K v = ω² Nᵀ M N v      at the equilibrium
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "protocol/core/progress_call.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {

/// A row held in addition to the system's own constraints.
struct HeldRow {
  std::string name;
  Row row;
  double target = 0.0;
};

/// Adds forces and moments (about the centres of mass, W) of bodies at rest to the coordinates' forces, N and N m.
using StaticForces = std::function<void(const System& system, Eigen::VectorXd& forces)>;

/// A free vibration; `shape` in the coordinates of all bodies.
struct Mode {
  double frequency = 0.0;  // undamped, Hz; 0 without stiffness
  double damping = 0.0;    // vᵀ C v / (2 ω vᵀ M v)
  Eigen::VectorXd shape;   // vᵀ M v = 1
};

/// The shortest x for which |matrix x − right| is least; the rank counts pivots down to 1e-10 of the largest.
Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right);

class Statics {
 public:
  /// @pre the system was assembled; it outlives this
  explicit Statics(System& system) : system_(system) {}

  int hold(HeldRow row) {
    held_.push_back(std::move(row));
    return static_cast<int>(held_.size()) - 1;
  }
  void set_target(int held, double target) { held_[held].target = target; }
  void set_forces(StaticForces forces) { forces_ = std::move(forces); }

  /// Moves the bodies to a posture that satisfies all rows; their velocities become zero.
  Outcome close();
  /// Brings the bodies to rest in equilibrium. @param weight scale for the residual force, N @param progress may stop
  /// it
  Outcome settle(double weight, const ProgressCall& progress = {});

  int coordinate_count() const { return 6 * system_.body_count(); }
  int row_count() const { return system_.constraint_count() + static_cast<int>(held_.size()); }
  /// G now.
  Eigen::MatrixXd jacobian() const;
  /// N now: one column for each freedom.
  Eigen::MatrixXd freedoms() const;
  /// dx per unit change of a held row's target. @pre there is no other freedom
  Eigen::VectorXd tangent(int held) const;
  /// Q now.
  Eigen::VectorXd forces() const;
  /// Force in each row at the equilibrium, N or N m, by least squares.
  Eigen::VectorXd multipliers() const;
  /// Lowest first. @pre settled
  std::vector<Mode> modes() const;

 private:
  void displace(const Eigen::VectorXd& by);
  Eigen::VectorXd violations() const;  // target − φ
  Eigen::MatrixXd stiffness(const Eigen::MatrixXd& N) const;
  Eigen::MatrixXd mass() const;
  Eigen::MatrixXd damping() const;
  std::vector<BodyState> states() const;
  void put(const std::vector<BodyState>& states);
  double unbalance() const;  // largest component of Nᵀ Q

  System& system_;
  std::vector<HeldRow> held_;
  StaticForces forces_;
};

/// Row that keeps the offset of B's centre of mass from a point of A along an axis of A (both as they are now, W).
Row offset_row(const System& system, int a, int b, const Vec3& axis);
/// Rows that hold a body in its place: three offsets, three angles.
std::vector<HeldRow> held_body(const System& system, int body);
/// φ now.
double row_value(const System& system, const Row& row);

}  // namespace furrow::vehicle
