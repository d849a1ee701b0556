// A multibody system in maximal coordinates: rigid bodies, joints and imposed motions as constraints, springs
// and dampers, integrated with both position and velocity constraints satisfied at the end of every step.
//
// One step of size h, t₀ → t₁ (RATTLE [Andersen 1983] with implicit damping; ℓ the angular momenta):
//   M (v½ − v₀) = h/2 [f(x₀, v½) + G₀ᵀλ]     λ such that φ(x₁, t₁) = 0
//   x₁ = x₀ + h v½,  q₁ = exp(h ω½) q₀        R½ J R½ᵀ ω½ = ℓ½ (see rotation.hpp)
//   M (v₁ − v½) = h/2 [f(x₁, v½) + G₁ᵀμ]     μ such that G₁ v₁ + ∂φ/∂t = 0
// The rule is symmetric, so of second order. Springs are explicit (stable for h < 2 √(m/k)); dampers follow the
// implicit midpoint rule (stable for any h). There is no drift, because every step satisfies the constraints. Shafts
// and rows in speeds (rate_set.hpp) are part of the same two solutions. Loads are constant over a step. Reactions are
// means over the step, so that mass × change of velocity / h equals load + reaction to round-off. A drawbar pull
// corrected by m·a is therefore exact.
//
// H. C. Andersen, Rattle: a "velocity" version of the Shake algorithm, J. Comput. Phys. 52 (1983) 24–34,
// doi:10.1016/0021-9991(83)90014-1.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/outcome.hpp"
#include "vehicle/multibody/body.hpp"
#include "vehicle/multibody/force_element.hpp"
#include "vehicle/multibody/joint.hpp"
#include "vehicle/multibody/motion.hpp"
#include "vehicle/multibody/rate_set.hpp"
#include "vehicle/multibody/schur_solver.hpp"

namespace furrow::vehicle {

class System {
 public:
  explicit System(const Vec3& gravity = standard_gravity()) : gravity_(gravity) {}

  // Building. Indices count from 0 and refer to bodies and joints added before. Joints and elements are placed in the
  // bodies' present poses.
  /// @pre mass > 0, inertia symmetric positive definite
  int add_body(const std::string& name, double mass, const Mat3& inertia, const BodyState& state);
  void set_mass_properties(int body, double mass, const Mat3& inertia);
  int add_joint(JointKind kind, const std::string& name, int a, int b, const JointPlace& place);
  /// Imposes the free coordinate of a prismatic, cylindrical or revolute joint; it is zero in the pose in which the
  /// joint was placed.
  int add_motor(const std::string& name, int joint, MotionFunction motion);
  /// Acts on the free coordinate of a joint.
  int add_joint_element(const std::string& name, int joint, ForceLaw law);
  /// Acts on the distance between two points, W, m. @pre the points differ
  int add_line_element(const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b, ForceLaw law);
  /// Keeps the energies of an element whose law gives its elastic part.
  void track_energy(int element);

  // Shafts and rows in speeds: see shaft.hpp and rate_row.hpp.
  /// `axis` in W now; `speed` absolute, about the axis, rad/s. @throws Error(physics) for inertia ≤ 0
  int add_shaft(const std::string& name, double inertia, int carrier, const Vec3& axis, double speed = 0.0);
  int add_rate_row(const RateRow& row, const RateControl& control = {});
  int add_rate_law(const RateRow& row, RateLaw law);
  /// Adds one law for several rows, in this order.
  std::vector<int> add_rate_law(const std::vector<RateRow>& rows, RateLaw law);
  /// Sets a row's control from the next step on. Nothing is assembled again: see recheck_rank().
  void set_rate_control(int row, const RateControl& control) { rates_.set_control(row, control); }
  void set_rate_factor(int row, int term, double factor);
  void set_shaft_speed(int shaft, double speed) { rates_.set_speed(shaft, speed); }
  /// Finds redundant constraints with the rows in speeds as held now, after an event that changed them.
  void recheck_rank();

  /// Sets a body's state; assemble() must follow.
  void set_state(int body, const BodyState& state);
  /// Sets the clock, projects positions and velocities onto the constraints (mass-weighted), and finds redundant
  /// constraints. @throws Error(physics) naming a constraint that cannot be satisfied.
  void assemble(double time);

  /// Sets force and moment about the centre of mass, W, until changed.
  void set_load(int body, const Vec3& force, const Vec3& moment);

  /// Advances by h, in integer steps: t = t₀ + i h while h stays the same.
  /// @returns failure when constraints cannot be satisfied or the state is not finite
  /// @pre assembled; h > 0
  Outcome step(double h);

  double time() const { return start_time_ + static_cast<double>(count_) * step_; }
  /// Rows of joints and motors.
  int constraint_count() const { return static_cast<int>(constraint_rows_.size()); }
  int body_count() const { return static_cast<int>(bodies_.size()); }
  const Body& body(int index) const {
    FURROW_ASSERT(in_range(index, bodies_.size()), index, bodies_.size());
    return bodies_[index];
  }
  const Joint& joint(int index) const {
    FURROW_ASSERT(in_range(index, joints_.size()), index, joints_.size());
    return joints_[index];
  }

  // Means over the last step.
  const Reaction& reaction(int joint) const {
    FURROW_ASSERT(in_range(joint, reactions_.size()), joint, reactions_.size());
    return reactions_[joint];
  }                                      // in the axes of the joint's frame on A
  double motor_force(int motor) const {  // on B, N or N m
    FURROW_ASSERT(in_range(motor, motors_.size()), motor, motors_.size());
    return motors_[motor].last_force;
  }
  double element_force(int element) const {
    FURROW_ASSERT(in_range(element, elements_.size()), element, elements_.size());
    return elements_[element].last_force;
  }

  /// @pre track_energy() was called
  ElementEnergy element_energy(int element) const;
  const Shaft& shaft(int index) const {
    FURROW_ASSERT(in_range(index, rates_.shafts().size()), index, rates_.shafts().size());
    return rates_.shafts()[index];
  }
  int shaft_count() const { return static_cast<int>(rates_.shafts().size()); }
  int rate_row_count() const { return rates_.row_count(); }
  const RateRow& rate_row(int row) const { return rates_.row(row); }
  const RateControl& rate_control(int row) const { return rates_.control(row); }
  const RateState& rate_state(int row) const { return rates_.state(row); }
  /// u of a row now, rad/s.
  double rate_speed(int row) const;

  // For statics.hpp.
  const Vec3& gravity() const { return gravity_; }
  Pose pose(int body) const;
  const Row& constraint_row(int row) const {
    FURROW_ASSERT(in_range(row, constraint_rows_.size()), row, constraint_rows_.size());
    return constraint_rows_[row];
  }
  /// Value and rate that a constraint row must have at a time, s.
  Motion target(int row, double time) const;
  std::string row_name(int row) const;
  int element_count() const { return static_cast<int>(elements_.size()); }
  const ForceElement& element(int index) const {
    FURROW_ASSERT(in_range(index, elements_.size()), index, elements_.size());
    return elements_[index];
  }

  /// Value and rate of a joint's free coordinate now (angles in (−π, π]).
  Motion coordinate(int joint) const;
  /// Largest violation of a position constraint now, m or rad (dot rows: sine of the angle).
  double max_violation() const;
  double kinetic_energy() const;                   // with the shafts', J
  double gravity_energy() const;                   // −Σ m g·x, J
  Vec3 momentum() const;                           // kg m/s
  Vec3 angular_momentum(const Vec3& about) const;  // kg m²/s

  /// Number of redundant constraint rows found by the last assemble(), and the joints or motors that hold
  /// them. Their reactions are those of minimum Euclidean norm of the multipliers (N and N m).
  int redundant_count() const { return redundant_count_; }
  const std::vector<std::string>& redundant_names() const { return redundant_names_; }

  void save(Archive& archive) const;
  /// Restores into a system built in the same way; no assemble() needed.
  void restore(const Archive& archive);

 private:
  struct Motor {
    std::string name;
    int joint = 0;
    int row = 0;
    MotionFunction motion;
    double last_force = 0.0;
  };

  double rate(int row) const;  // G v of a row with the present velocities
  void prepare();              // symbolic analysis and storage, when the topology changed
  void update_jacobians();     // of all rows, at the present poses
  Outcome factorize(bool with_dampers);
  void begin_velocities(double h);  // base velocities ← present velocities + h/2 M⁻¹ f
  void apply_impulses();            // velocities, momenta ← base + M⁻¹ Gᵀ P
  void set_angular_velocities();    // ω ← R J⁻¹ Rᵀ ℓ
  Outcome solve_positions(double h, double end_time);
  Outcome solve_velocities(double end_time);
  Outcome move(double h);  // poses ← start poses moved by h v½
  void element_forces(double h, bool implicit);
  double base_speed() const;  // m/s or rad/s
  Row line_row(const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b) const;
  double row_rate(const Row& row, const RowJacobian& J) const;
  void finish_work(bool first_half);  // of tracked elements and rows in speeds
  void turn_rotors();                 // applies the gyroscopic moments of rotors to their carriers
  Outcome solve_half(bool first_half, double h, double end_time);
  bool rates_done(double& before, int iteration);
  bool dampers_done(double scale, double& before, int iteration);
  double position_tolerance() const;
  int rate_count() const { return rates_.row_count(); }
  int first_rate() const { return static_cast<int>(constraint_rows_.size() + elements_.size()); }
  std::span<double> rate_part(Eigen::VectorXd& all) const {
    return {all.data() + first_rate(), static_cast<std::size_t>(rate_count())};
  }
  void collect_reactions(double h, bool first_half);
  Outcome satisfy_constraints(double time);  // at the present poses and velocities, mass-weighted
  Outcome project_positions(double time);
  void find_redundancy();
  void remove_null_impulses();
  void save_drives(Archive& archive) const;  // writes nothing if there are none
  void restore_drives(const Archive& archive);
  Outcome check_finite() const;
  Outcome failure(const std::string& what, int row, double residual) const;

  Vec3 gravity_;
  std::vector<Body> bodies_;
  std::vector<Joint> joints_;
  std::vector<Motor> motors_;
  std::vector<ForceElement> elements_;
  RateSet rates_;
  std::vector<Row> constraint_rows_;  // of joints and motors
  std::vector<int> row_motor_;        // motor that drives the row, or −1
  std::vector<Reaction> reactions_;

  double start_time_ = 0.0, step_ = 0.0;  // s
  std::int64_t count_ = 0;                // steps since start_time_

  // Work space: rows_ = constraint rows, then element rows.
  struct Base {
    Vec3 position, velocity, angular_momentum;
    Quat orientation;
    Mat3 R;
  };
  bool prepared_ = false;
  bool dampers_factored_ = false;
  std::vector<Row> rows_;
  std::vector<RowJacobian> jacobians_;
  std::vector<double> compliance_;
  std::vector<double> damping_;  // of element rows, this step
  // A tracked element, with the data for its work in the present half step.
  struct Tracked {
    int element = 0;
    ElementEnergy energy;
    double elastic_impulse = 0.0, other_impulse = 0.0, rate_before = 0.0;
  };
  std::vector<Tracked> tracked_;
  std::vector<Base> base_;
  std::vector<Motion> targets_;
  Eigen::VectorXd impulses_, residual_, correction_;
  SchurSolver solver_;

  int redundant_count_ = 0;
  std::vector<std::string> redundant_names_;
};

}  // namespace furrow::vehicle
