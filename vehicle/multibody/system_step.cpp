// Assembly and the step of system.hpp.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

#include "protocol/core/assert.hpp"
#include "vehicle/multibody/rotation.hpp"
#include "vehicle/multibody/system.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kPositionTolerance = 1e-12;  // m or rad, at the end of every step, or
constexpr double kPositionRounding = 8.0;     // units of the last digit of the largest coordinate, if that is more
constexpr double kVelocityTolerance = 4e-16;  // relative to the largest speed: iterate down to round-off
constexpr double kVelocityLimit = 1e-9;       // relative to the largest speed; above it constraints conflict
constexpr int kMaxIterations = 60;
constexpr int kCleaningIterations = 3;

std::string scientific(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace

Outcome System::failure(const std::string& what, int row, double residual) const {
  return Outcome::failure(what, "worst is '" + row_name(row) + "' with " + scientific(residual));
}

void System::prepare() {
  if (prepared_) return;
  rows_ = constraint_rows_;
  for (const ForceElement& element : elements_) rows_.push_back(element.row);
  jacobians_.resize(rows_.size());
  const std::size_t all = rows_.size() + rates_.row_count();
  compliance_.assign(all, 0.0);
  damping_.assign(elements_.size(), 0.0);
  base_.resize(bodies_.size());
  targets_.resize(constraint_rows_.size());
  impulses_.setZero(all);
  residual_.setZero(all);
  correction_.setZero(all);
  rates_.prepare(static_cast<int>(rows_.size()), bodies_.size());
  solver_.analyze(rows_, rates_.sides());
  prepared_ = true;
}

void System::update_jacobians() {
  for (std::size_t i = 0; i < rows_.size(); ++i)
    jacobians_[i] = row_jacobian(rows_[i], pose(rows_[i].a), pose(rows_[i].b));
  if (!rates_.empty()) rates_.update_axes(bodies_);
}

// Compliance of a damper row: p = −(h c/2) g·v½ is a constraint row g·v½ + p · 2/(h c) = 0.
Outcome System::factorize(bool with_dampers) {
  FURROW_ASSERT(!with_dampers || step_ > 0.0, step_);
  FURROW_ASSERT(damping_.size() == elements_.size(), damping_.size(), elements_.size());
  const std::size_t first = constraint_rows_.size();
  for (std::size_t e = 0; e < elements_.size(); ++e)
    compliance_[first + e] = with_dampers && damping_[e] > 0.0 ? 2.0 / (step_ * damping_[e]) : -1.0;
  dampers_factored_ = with_dampers;
  rates_.fill_compliance(std::span(compliance_).subspan(rows_.size()));
  if (!solver_.factorize(jacobians_, bodies_, compliance_, rates_.sides(), rates_.shafts()))
    return Outcome::failure("has a constraint matrix that cannot be factored", "");
  return {};
}

double System::rate(int i) const {
  FURROW_ASSERT(in_range(i, rows_.size()), i, rows_.size());
  return row_rate(rows_[i], jacobians_[i]);
}

void System::begin_velocities(double h) {
  FURROW_ASSERT(base_.size() == bodies_.size(), base_.size(), bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const Body& body = bodies_[i];
    base_[i].position = body.state.position;
    base_[i].orientation = body.state.orientation;
    base_[i].R = body.R;
    base_[i].velocity = body.state.velocity + 0.5 * h * (gravity_ + body.force / body.mass);
    base_[i].angular_momentum = body.angular_momentum + 0.5 * h * body.moment;
  }
}

// First half (implicit): f½ = f(x₀, v₀) − c (ẋ½ − ẋ₀), whose part −c ẋ½ is left to the damper rows.
// Second half: f(x₁, v½). Both at the time of mid-step.
void System::element_forces(double h, bool implicit) {
  FURROW_ASSERT(jacobians_.size() == rows_.size(), jacobians_.size(), rows_.size());
  const std::size_t first = constraint_rows_.size();
  const double mid_time = time() + 0.5 * h;
  for (std::size_t e = 0; e < elements_.size(); ++e) {
    ForceElement& element = elements_[e];
    const RowJacobian& J = jacobians_[first + e];
    const double speed = rate(static_cast<int>(first + e));
    const ElementForce law =
        element.law(row_value(element.row, pose(element.row.a), pose(element.row.b)), speed, mid_time);
    double force = law.force;
    if (implicit) {
      damping_[e] = std::max(0.0, law.damping);
      force += damping_[e] * speed;
      element.last_force = 0.0;
    }
    element.last_force += 0.5 * force;
    for (Tracked& tracked : tracked_)
      if (tracked.element == static_cast<int>(e)) {
        tracked.rate_before = speed;
        tracked.elastic_impulse = 0.5 * h * law.elastic;
        tracked.other_impulse = 0.5 * h * (force - law.elastic);
      }
    each_side(element.row, J, [&](int body, const Vec3& v, const Vec3& w) {
      base_[body].velocity += (0.5 * h * force / bodies_[body].mass) * v;
      base_[body].angular_momentum += (0.5 * h * force) * w;
    });
  }
}

void System::apply_impulses() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    bodies_[i].state.velocity = base_[i].velocity;
    bodies_[i].angular_momentum = base_[i].angular_momentum;
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const double P = impulses_[i];
    if (P == 0.0) continue;
    each_side(rows_[i], jacobians_[i], [&](int body, const Vec3& v, const Vec3& w) {
      bodies_[body].state.velocity += (P / bodies_[body].mass) * v;
      bodies_[body].angular_momentum += P * w;
    });
  }
  if (!rates_.empty()) rates_.apply(rate_part(impulses_), bodies_);
}

void System::set_angular_velocities() {
  for (Body& body : bodies_) body.state.angular_velocity = body.inertia_inverse_W * body.angular_momentum;
}

Outcome System::move(double h) {
  FURROW_ASSERT(h > 0.0, h);
  if (!rates_.empty()) rates_.move(h), rates_.update_rotors();
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    const Vec3* rotor = rates_.rotor_momentum(static_cast<int>(i));
    Vec3& omega = body.state.angular_velocity;
    const Mat3& R = base_[i].R;
    if (!(rotor ? midpoint_angular_velocity(R, body.inertia_inverse, body.angular_momentum, *rotor, h, omega)
                : midpoint_angular_velocity(R, body.inertia_inverse, body.angular_momentum, h, omega)))
      return Outcome::failure("has a body that turns too fast",
                              "'" + body.name + "', for a step of " + scientific(h) + " s");
    body.state.position = base_[i].position + h * body.state.velocity;
    body.state.orientation = rotated(base_[i].orientation, body.state.angular_velocity, h);
    body.R = body.state.orientation.toRotationMatrix();
  }
  return {};
}

// Quasi-Newton for φ(x₁(P), t₁) = 0: ∂φ/∂P = h G₁ M⁻¹ G₀ᵀ ≈ h S₀; the factor is kept, and each iteration reduces the
// error by h|ω|.
Outcome System::solve_positions(double h, double end_time) {
  const int constraints = static_cast<int>(constraint_rows_.size());
  const int count = static_cast<int>(rows_.size());
  for (int i = 0; i < constraints; ++i) targets_[i] = target(i, end_time);
  impulses_.setZero();
  rates_.known_impulses(rate_part(impulses_));
  const double tolerance = position_tolerance();
  double scale = 0.0, worst = 0.0, worst_rate = 0.0, worst_damper = 0.0;
  int worst_row = 0;
  for (const Base& base : base_) scale = std::max(scale, base.velocity.cwiseAbs().maxCoeff());
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    apply_impulses();
    if (Outcome outcome = move(h); !outcome.ok) return outcome;
    worst = 0.0;
    bool done = true;
    for (int i = 0; i < constraints; ++i) {
      const Row& row = rows_[i];
      const double violation = row_difference(row, row_value(row, pose(row.a), pose(row.b)), targets_[i].value);
      residual_[i] = -violation / h;
      if (!(std::abs(violation) <= worst)) worst = std::abs(violation), worst_row = i;
    }
    done = worst <= tolerance;
    if (count > constraints && !dampers_done(scale, worst_damper, iteration)) done = false;
    if (rate_count() > 0 && !rates_done(worst_rate, iteration)) done = false;
    if (done) return {};
    if (!std::isfinite(worst)) break;
    solver_.solve(residual_, correction_);
    impulses_ += correction_;
  }
  return failure("cannot satisfy its constraints", worst_row, worst);
}

/// Far from the origin, the rounding of positions is larger than the tolerance of the constraints near it.
double System::position_tolerance() const {
  double largest = 0.0;
  for (const Body& body : bodies_) largest = std::max(largest, body.state.position.cwiseAbs().maxCoeff());
  return std::max(kPositionTolerance, kPositionRounding * std::numeric_limits<double>::epsilon() * largest);
}

/// The largest speed that the bodies would have without constraints: the scale of round-off if the constraints hold the
/// bodies at rest.
double System::base_speed() const {
  double largest = 0.0;
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    largest = std::max({largest, base_[i].velocity.cwiseAbs().maxCoeff(),
                        (bodies_[i].inertia_inverse_W * base_[i].angular_momentum).cwiseAbs().maxCoeff()});
  return largest;
}

// Linear: P += S⁻¹ (∂φ/∂t target − G₁ v₁) until round-off; the repetition also removes the regularization.
Outcome System::solve_velocities(double end_time) {
  const int constraints = static_cast<int>(constraint_rows_.size());
  for (int i = 0; i < constraints; ++i) targets_[i] = target(i, end_time);
  impulses_.setZero();
  residual_.setZero();
  rates_.known_impulses(rate_part(impulses_));
  double before = 0.0, worst_rate = 0.0;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    apply_impulses();
    set_angular_velocities();
    double scale = 0.0, worst = 0.0;
    int worst_row = 0;
    for (const Body& body : bodies_)
      scale = std::max(
          {scale, body.state.velocity.cwiseAbs().maxCoeff(), body.state.angular_velocity.cwiseAbs().maxCoeff()});
    for (int i = 0; i < constraints; ++i) {
      residual_[i] = targets_[i].rate - rate(i);
      scale = std::max(scale, std::abs(targets_[i].rate));
      if (!(std::abs(residual_[i]) <= worst)) worst = std::abs(residual_[i]), worst_row = i;
    }
    if (rate_count() > 0 && !rates_done(worst_rate, iteration)) {
      before = worst;
      solver_.solve(residual_, correction_);
      impulses_ += correction_;
      continue;
    }
    if (worst <= kVelocityTolerance * scale) return {};
    // No longer falling: round-off reached, or the rates contradict each other.
    if (!std::isfinite(worst) || (iteration > 1 && worst > 0.25 * before)) {
      if (worst <= kVelocityLimit * std::max(scale, 1e-6)) return {};
      if (!std::isfinite(worst) || worst > 0.9 * before) {
        if (worst <= kVelocityLimit * base_speed()) return {};  // at rest under large forces
        return failure("cannot satisfy the rates of its constraints", worst_row, worst);
      }
    }
    before = worst;
    solver_.solve(residual_, correction_);
    impulses_ += correction_;
  }
  return {};
}

// With redundant rows, P is determined up to any N with Gᵀ N = 0, and round-off in the residuals makes N grow. N
// changes the reactions but not the motion. The proximal-point iteration on (S + Σ)(P − P') from P' = 0, whose
// residuals lie in the range of S, gives P' → P without N.
void System::remove_null_impulses() {
  if (redundant_count_ == 0) return;
  const Eigen::VectorXd wanted = impulses_;
  impulses_.setZero();
  for (int iteration = 0; iteration < kCleaningIterations; ++iteration) {
    correction_ = wanted - impulses_;
    solver_.multiply(correction_, residual_);
    solver_.solve(residual_, correction_);
    impulses_ += correction_;
  }
}

// Reaction of a joint on B, about its point on B: F = Σ λ ∂φ/∂v_B, M = Σ λ ∂φ/∂ω_B − r_B × F; half of each
// stage.
void System::collect_reactions(double h, bool first_half) {
  FURROW_ASSERT(reactions_.size() == joints_.size(), reactions_.size(), joints_.size());
  for (std::size_t j = 0; j < joints_.size(); ++j) {
    const Joint& joint = joints_[j];
    const Mat3& R_a = joint.a == kGround ? *pose(kGround).R : (first_half ? base_[joint.a].R : bodies_[joint.a].R);
    const Mat3& R_b = joint.b == kGround ? *pose(kGround).R : (first_half ? base_[joint.b].R : bodies_[joint.b].R);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    for (int i = joint.first_row; i < joint.first_row + joint.row_count; ++i) {
      force += impulses_[i] * jacobians_[i].v_b;
      moment += impulses_[i] * jacobians_[i].w_b;
    }
    moment -= (R_b * joint.frame_b.origin).cross(force);
    const Mat3 axes = R_a * joint.frame_a.axes;
    if (first_half) reactions_[j] = {};
    reactions_[j].force += axes.transpose() * (force / h);
    reactions_[j].moment += axes.transpose() * (moment / h);
  }
  for (Motor& motor : motors_) motor.last_force = (first_half ? 0.0 : motor.last_force) + impulses_[motor.row] / h;
  for (std::size_t e = 0; e < elements_.size(); ++e)
    elements_[e].last_force += impulses_[constraint_rows_.size() + e] / h;
}

Outcome System::step(double h) {
  FURROW_ASSERT(h > 0.0, h);
  FURROW_ASSERT(prepared_, h);
  if (h != step_) {
    start_time_ = time();
    step_ = h;
    count_ = 0;
  }
  const double end_time = start_time_ + static_cast<double>(count_ + 1) * step_;
  begin_velocities(h);
  element_forces(h, true);
  if (!rates_.empty()) rates_.begin(RateStage::first_half, h, time() + 0.5 * h, bodies_);
  if (rate_count() > 0 || std::any_of(damping_.begin(), damping_.end(), [](double c) { return c > 0.0; }))
    if (Outcome outcome = factorize(true); !outcome.ok) return outcome;
  if (Outcome outcome = solve_half(true, h, end_time); !outcome.ok) return outcome;
  remove_null_impulses();
  collect_reactions(h, true);
  finish_work(true);

  if (!rates_.empty()) turn_rotors();
  for (Body& body : bodies_) body.refresh();
  update_jacobians();
  begin_velocities(h);
  element_forces(h, false);
  if (!rates_.empty()) rates_.begin(RateStage::second_half, h, time() + 0.5 * h, bodies_);
  if (Outcome outcome = factorize(false); !outcome.ok) return outcome;
  if (Outcome outcome = solve_half(false, h, end_time); !outcome.ok) return outcome;
  remove_null_impulses();
  collect_reactions(h, false);
  finish_work(false);
  ++count_;
  return check_finite();
}

Outcome System::check_finite() const {
  if (!rates_.finite()) return Outcome::failure("has a state that is not finite", "a shaft; try a smaller run.step");
  for (const Body& body : bodies_) {
    const double sum = body.state.position.sum() + body.state.velocity.sum() + body.angular_momentum.sum() +
                       body.state.orientation.coeffs().sum();
    if (!std::isfinite(sum))
      return Outcome::failure("has a state that is not finite", "body '" + body.name + "'; try a smaller run.step");
  }
  return {};
}

void System::assemble(double time) {
  FURROW_ASSERT(std::isfinite(time), time);
  start_time_ = time;
  count_ = 0;
  prepare();
  const Outcome outcome = satisfy_constraints(time);
  if (!outcome.ok) throw physics_error(outcome, "multibody system", " at t = " + scientific(time) + " s");
  find_redundancy();
}

Outcome System::satisfy_constraints(double time) {
  if (Outcome outcome = project_positions(time); !outcome.ok) return outcome;
  begin_velocities(0.0);
  if (!rates_.empty()) rates_.begin(RateStage::assembly, 0.0, time, bodies_);
  if (Outcome outcome = factorize(false); !outcome.ok) return outcome;
  if (Outcome outcome = solve_velocities(time); !outcome.ok) return outcome;
  return check_finite();
}

// Mass-weighted Newton: x ← x + M⁻¹ Gᵀ P with G M⁻¹ Gᵀ P = −φ.
Outcome System::project_positions(double time) {
  const int constraints = static_cast<int>(constraint_rows_.size());
  double worst = 0.0;
  int worst_row = 0;
  rates_.rest();
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    update_jacobians();
    worst = 0.0;
    residual_.setZero();
    for (int i = 0; i < constraints; ++i) {
      const Row& row = rows_[i];
      residual_[i] = -row_difference(row, row_value(row, pose(row.a), pose(row.b)), target(i, time).value);
      if (!(std::abs(residual_[i]) <= worst)) worst = std::abs(residual_[i]), worst_row = i;
    }
    if (worst <= position_tolerance()) return {};
    if (Outcome outcome = factorize(false); !outcome.ok) return outcome;
    solver_.solve(residual_, impulses_);
    for (int i = 0; i < constraints; ++i) {
      each_side(rows_[i], jacobians_[i], [&](int index, const Vec3& v, const Vec3& w) {
        Body& body = bodies_[index];
        body.state.position += (impulses_[i] / body.mass) * v;
        body.state.orientation = rotated(body.state.orientation, body.inertia_inverse_W * w, impulses_[i]);
      });
    }
    for (int i = 0; i < body_count(); ++i) set_state(i, bodies_[i].state);
  }
  return failure("cannot be assembled", worst_row, worst);
}

// Rank of G by a column-pivoted QR of its transpose; the remaining columns are the redundant rows.
void System::find_redundancy() {
  const int constraints = static_cast<int>(constraint_rows_.size());
  redundant_count_ = 0;
  redundant_names_.clear();
  std::vector<int> held;  // rows in speeds
  for (int i = 0; i < rate_count(); ++i)
    if (rates_.is_ideal(i)) held.push_back(first_rate() + i);
  const int all = constraints + static_cast<int>(held.size());
  const std::size_t freedoms = 6 * bodies_.size() + rates_.shafts().size();
  if (all == 0 || freedoms == 0) return;
  Eigen::MatrixXd G_transpose = Eigen::MatrixXd::Zero(freedoms, all);
  for (int k = 0; k < static_cast<int>(held.size()); ++k) {
    for (const SpinSide& side : rates_.sides().spins)
      if (side.row == held[k]) G_transpose.block<3, 1>(6 * side.body + 3, constraints + k) = side.w;
    for (const ShaftSide& side : rates_.sides().shafts)
      if (side.row == held[k]) G_transpose(6 * bodies_.size() + side.shaft, constraints + k) = side.factor;
  }
  for (int i = 0; i < constraints; ++i) {
    each_side(rows_[i], jacobians_[i], [&](int body, const Vec3& v, const Vec3& w) {
      G_transpose.block<3, 1>(6 * body, i) = v;
      G_transpose.block<3, 1>(6 * body + 3, i) = w;
    });
  }
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(G_transpose.rows(), G_transpose.cols());
  qr.setThreshold(1e-9);
  qr.compute(G_transpose);
  redundant_count_ = all - static_cast<int>(qr.rank());
  for (int k = static_cast<int>(qr.rank()); k < all; ++k) {
    const int column = qr.colsPermutation().indices()[k];
    const std::string name = row_name(column < constraints ? column : held[column - constraints]);
    if (std::find(redundant_names_.begin(), redundant_names_.end(), name) == redundant_names_.end())
      redundant_names_.push_back(name);
  }
}

}  // namespace furrow::vehicle
