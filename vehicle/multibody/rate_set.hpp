// The shafts of a system and its rows in speeds (rate_row.hpp), within the step of system.hpp. Each half of the step
// solves them together with the joints:
//
//   first half    J (Ω½ − Ω₀) = Σ f P,   rows held: ½ (u at x₀ + u at x₁) = target with the speeds of mid-step,
//                 laws: P = h/2 f(u½), all implicit
//   second half   J (Ω₁ − Ω½) = Σ f P,   rows held: u = target with the speeds at the end; laws: P = h/2 f(u½)
//
// with the impulses of held rows between h/2 lower and h/2 upper in each half. Slipping rows are found by trial: a row
// whose impulse leaves its bounds is put at the bound; a row at its bound whose speed has passed the target holds
// again. After a few rounds only the first such row changes at a time [Murty 1974, doi:10.1016/0024-3795(74)90019-3].
// So a holding brake or clutch holds exactly, for any step.
//
// A rotor that keeps its momentum p while the axis turns from a₀ to a₁ gives its carrier the angular impulse −p (a₁ −
// a₀).
#pragma once

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "vehicle/multibody/rate_row.hpp"
#include "vehicle/multibody/schur_solver.hpp"
#include "vehicle/multibody/shaft.hpp"

namespace furrow::vehicle {

/// Stage in which the rows are solved. At the assembly only rows held without bounds count.
enum class RateStage { none, assembly, first_half, second_half };

class RateSet {
 public:
  // Building.
  int add_shaft(Shaft shaft);
  int add_row(RateRow row, const RateControl& control);
  void add_law(std::vector<int> rows, RateLaw law);
  void set_control(int row, const RateControl& control);
  void set_factor(int row, int term, double factor);
  void set_speed(int shaft, double speed);

  bool empty() const { return shafts_.empty() && rows_.empty(); }
  int row_count() const { return static_cast<int>(rows_.size()); }
  const std::vector<Shaft>& shafts() const { return shafts_; }
  const RateRow& row(int index) const { return rows_[index]; }
  const RateControl& control(int index) const { return controls_[index]; }
  const RateState& state(int index) const { return states_[index]; }
  /// Whether a row is held without bounds, and so counts for the rank.
  bool is_ideal(int row) const;

  // Within a step. Spans of impulses, residuals and compliances contain these rows alone.
  /// Finds the sides of the rows, numbered from first_row on, and allocates storage.
  void prepare(int first_row, std::size_t body_count);
  RateSides sides() const { return {row_count(), spin_sides_, shaft_sides_}; }
  /// Computes the axes at the present poses.
  void update_axes(std::span<const Body> bodies);
  /// Stores speeds and angles. In half steps it also evaluates the laws and the rows' speeds before the half step.
  void begin(RateStage stage, double h, double mid_time, std::span<const Body> bodies);
  /// Holds no row, while positions are projected.
  void rest() { stage_ = RateStage::none; }
  void fill_compliance(std::span<double> compliance) const;
  void known_impulses(std::span<double> impulses) const;
  /// Adds the rows' impulses to the bodies' angular momenta, and sets the speeds of the shafts.
  void apply(std::span<const double> impulses, std::span<Body> bodies);
  void move(double h);  // angles
  /// Residuals of held rows and laws. @return whether all are small; `worst` is the largest, relative to its scale
  bool residuals(std::span<double> impulses, std::span<const double> compliance, std::span<const Body> bodies,
                 std::span<double> residual, double& worst);
  double largest_speed() const;  // of the shafts, rad/s
  /// Moves rows between holding and slipping. @return whether any moved
  bool change_sides(std::span<const double> impulses, std::span<const Body> bodies, int round);
  /// Computes means and work of this half.
  void finish(std::span<const double> impulses, std::span<const Body> bodies);

  /// Momentum of the rotors that a body carries, in its axes; null if it carries none.
  const Vec3* rotor_momentum(int body) const;
  void update_rotors();

  double kinetic_energy() const;
  Vec3 angular_momentum(std::span<const Body> bodies) const;
  bool finite() const;

  void save(Archive& archive) const;
  void restore(const Archive& archive);

 private:
  struct Law {
    std::vector<int> rows;
    RateLaw function;
  };
  double speed(int row, const std::vector<SpinSide>& sides, std::span<const Body> bodies) const;
  double held_speed(int row, std::span<const Body> bodies) const;
  double scale(int row, std::span<const Body> bodies) const;  // Σ |terms| of its speed
  void turn(std::vector<SpinSide>& sides, std::span<const Body> bodies) const;
  void evaluate_laws(std::span<const Body> bodies);

  std::vector<Shaft> shafts_;
  std::vector<RateRow> rows_;
  std::vector<RateControl> controls_;
  std::vector<RateState> states_;
  std::vector<Law> laws_;

  // Of the present half step.
  RateStage stage_ = RateStage::none;
  double half_step_ = 0.0, mid_time_ = 0.0;  // s
  int first_row_ = 0;
  std::vector<SpinSide> spin_sides_, end_sides_;  // end_sides_: at the end of the first half's motion
  std::vector<int> first_spin_, first_shaft_;     // of each row, and one more
  std::vector<ShaftSide> shaft_sides_;
  std::vector<ShaftState> base_;
  std::vector<double> speed_before_;
  std::vector<ElementForce> law_forces_;  // of each row
  std::vector<double> law_damping_;       // of each row, kept over the half step, N m s
  std::vector<double> law_speeds_;        // work space
  std::vector<ElementForce> law_torques_;
  std::vector<Vec3> rotor_momentum_;  // of each body
  std::vector<bool> has_rotor_;
  double base_scale_ = 0.0;
};

}  // namespace furrow::vehicle
