#include "tire/ancf/inflation.hpp"

#include <fmt/format.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <memory>

#include "protocol/core/error.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"

namespace furrow::tire {
namespace {

constexpr double kCreepTime = 5e-3;  // τ, s
constexpr double kFirstStep = 1e-3;  // s
constexpr double kMaxStep = 10.0;    // s
constexpr double kTolerance = 1e-8;  // of the static residual, relative to the full pressure's forces
constexpr double kNewton = 1e-9;     // of a step's residual, relative to the same forces
constexpr double kRounding = 1e-11;  // m, of coordinates: Newton's corrections below it are rounding errors
constexpr double kAccepted = 1e-2;   // of the static residual, after the last step
constexpr int kRampSteps = 10;
constexpr int kMaxSteps = 300;
constexpr int kMaxNewton = 12;

class ColumnCreep {
 public:
  ColumnCreep(const ShellCarcass& shell, const ShellMesh& mesh, const std::function<void()>& each_step)
      : shell_(shell), mesh_(mesh), layout_(shell.layout()), each_step_(each_step) {
    q_ = undeformed(mesh);
    force_.assign(layout_.size(), 0.0);
    shell_.strains(q_, strains_);
    reference_ = pressure_norm();
  }

  /// @returns false when the tangent lost its definiteness or Newton's method did not converge; q is then
  /// unchanged
  bool step(double h) {
    before_ = q_;
    const double c = 1.0 + kCreepTime / h;
    Eigen::VectorXd r = residual(c);
    for (int n = 0; n < kMaxNewton; ++n) {
      if (each_step_) each_step_();
      const Eigen::LLT<Eigen::MatrixXd> factor(tangent(c));
      if (factor.info() != Eigen::Success) break;
      const Eigen::VectorXd change = -factor.solve(r);
      add(change);
      r = residual(c);
      if (!(r.norm() < 1e3 * reference_)) break;
      // At low pressure the rounding errors of c D̂ E alone are above the tolerance: more digits are not possible.
      if (r.norm() < kNewton * reference_ || change.lpNorm<Eigen::Infinity>() < kRounding) {
        shell_.strains(q_, strains_);
        return true;
      }
    }
    q_ = before_;
    return false;
  }

  void set_pressure(double pressure) { shell_.set_pressure(pressure); }
  double static_residual() { return residual(1.0).norm() / reference_; }
  const Field& q() const { return q_; }

 private:
  int unknowns() const { return 6 * (layout_.rows - 2); }

  Eigen::VectorXd column(const Field& f) const {
    Eigen::VectorXd v(unknowns());
    for (int k = 0; k < unknowns(); ++k) v[k] = f[layout_.offset(1 + k / 6, k % 6)];
    return v;
  }
  Eigen::VectorXd residual(double c) {
    shell_.forces(q_, q_, strains_, c, force_);
    return column(force_);
  }
  double pressure_norm() {
    Field with(layout_.size()), without(layout_.size());
    ShellCarcass bare = shell_;
    bare.set_pressure(0.0);
    shell_.forces(q_, q_, strains_, 0.0, with);
    bare.forces(q_, q_, strains_, 0.0, without);
    return (column(with) - column(without)).norm();
  }
  void add(const Eigen::VectorXd& change) {
    for (int j = 1; j + 1 < layout_.rows; ++j)
      for (const int s : {0, 3}) {
        const Vec3 v = layout_.get(q_, 0, j, s) + change.segment<3>(6 * (j - 1) + s);
        for (int i = 0; i < layout_.columns; ++i) layout_.set(q_, i, j, s, mesh_.turn(i) * v);
      }
    layout_.fill_padding(q_);
  }
  /// Element tangents with both columns tied to one: Tᵀ K T.
  Eigen::MatrixXd tangent(double c) {
    Eigen::MatrixXd k = Eigen::MatrixXd::Zero(6 * layout_.rows, 6 * layout_.rows);
    const auto element = std::make_unique<BatchTangent>();
    Eigen::Matrix<double, 24, 12> tie = Eigen::Matrix<double, 24, 12>::Zero();
    for (int n = 0; n < 4; ++n)
      for (const int s : {0, 3})
        tie.block<3, 3>(6 * n + s, (n < 2 ? 0 : 6) + s) = n == 1 || n == 2 ? mesh_.turn(1) : Mat3::Identity();
    for (int j = 0; j + 1 < layout_.rows; ++j) {
      Double4 stress[kStrains];
      BatchNodes before, nodes;
      before.read(layout_, before_.data(), 0, j);
      nodes.read(layout_, q_.data(), 0, j);
      shell_.batch_stress_between(before, nodes, c, j, stress);
      element->compute(shell_.stiffness(j), nodes, stress, c, 1.0, shell_.pressure());
      Eigen::Matrix<double, 24, 24> e;
      for (int a = 0; a < 24; ++a)
        for (int b = 0; b <= a; ++b) e(a, b) = e(b, a) = element->k[a][b][0];
      k.block<12, 12>(6 * j, 6 * j) += tie.transpose() * e * tie;
    }
    return k.block(6, 6, unknowns(), unknowns());
  }

  ShellCarcass shell_;
  const ShellMesh& mesh_;
  ShellLayout layout_;
  const std::function<void()>& each_step_;
  Field q_, before_, strains_, force_;
  double reference_ = 0.0;  // norm of the pressure forces on the undeformed column, N
};

}  // namespace

Field undeformed(const ShellMesh& mesh) {
  const ShellLayout layout{mesh.columns, mesh.rows};
  Field q(layout.size(), 0.0);
  for (int j = 0; j < mesh.rows; ++j)
    for (int i = 0; i < mesh.columns; ++i) {
      layout.set(q, i, j, 0, mesh.turn(i) * mesh.position[j]);
      layout.set(q, i, j, 3, mesh.turn(i) * mesh.director[j]);
    }
  layout.fill_padding(q);
  return q;
}

Field inflate(const ShellCarcass& shell, const ShellMesh& mesh, InflationReport& report,
              const std::function<void()>& each_step) {
  report = {};
  if (shell.pressure() == 0.0) return undeformed(mesh);
  ColumnCreep creep(shell, mesh, each_step);
  double h = kFirstStep;
  for (report.steps = 0; report.steps < kMaxSteps;) {
    creep.set_pressure(shell.pressure() * std::min(1.0, (report.steps + 1.0) / kRampSteps));
    if (!creep.step(h)) {
      h *= 0.5;
      if (h < 1e-7) break;
      continue;
    }
    ++report.steps;
    h = std::min(1.3 * h, kMaxStep);
    report.residual = creep.static_residual();
    if (report.steps >= kRampSteps && report.residual < kTolerance) break;
  }
  const std::string way_out = "try a lower pressure or stiffer layers";
  if (report.steps < kRampSteps)
    throw physics_error(fmt::format(
        "tire inflation to {:g} Pa did not converge: it reached {:.3g} Pa, residual {:.3g} of the pressure force after "
        "{} steps; {}",
        shell.pressure(), shell.pressure() * report.steps / kRampSteps, report.residual, report.steps, way_out));
  if (!(report.residual < kAccepted))
    throw physics_error(fmt::format(
        "tire inflation to {:g} Pa did not converge: the pressure was reached, but the tire does not come to "
        "rest under "
        "it; a residual of {:.3g} of the pressure force is left after {} steps, expected below {:g}; {}",
        shell.pressure(), report.residual, report.steps, kAccepted, way_out));
  return creep.q();
}

}  // namespace furrow::tire
