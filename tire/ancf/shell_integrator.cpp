#include "tire/ancf/shell_integrator.hpp"

#include <fmt/format.h>

#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/mean_turn.hpp"
#include "tire/ancf/stopwatch.hpp"

namespace furrow::tire {
namespace {

constexpr int kAttempts = 10, kCareful = 2;  // per step; first attempt in which corrections are halved
constexpr double kMinShare = 0.01;           // of a correction that is halved
constexpr double kDirectorLength = 0.01;     // m, makes director residuals (N m) comparable with forces
constexpr int kPairs = 12;

double dot(const Field& a, const Field& b, const ShellLayout& layout) {
  const std::size_t first = layout.free_begin(), count = layout.free_size();
  return Eigen::Map<const Eigen::VectorXd>(a.data() + first, count)
      .dot(Eigen::Map<const Eigen::VectorXd>(b.data() + first, count));
}

}  // namespace

ShellIntegrator::ShellIntegrator(const TireFile& file, const ShellMesh& mesh, const ShellIntegratorParams& params)
    : params_(params),
      mesh_(mesh),
      layout_{mesh.columns, mesh.rows},
      shell_(file, mesh),
      mass_(mesh, element_masses(file, mesh)),
      factor_(layout_, shell_, mass_, params) {
  for (Field* f : {&q_, &v_, &v_before_, &p_, &q_new_, &v_new_, &p_new_, &moved_, &q_force_, &change_, &r_, &d_})
    f->assign(layout_.size(), 0.0);
  s_.assign(kPairs, r_);
  y_.assign(kPairs, r_);
  rho_.assign(kPairs, 0.0);
  mass_.weigh(params.gravity, gravity_);
}

void ShellIntegrator::start(const Field& q, const Field& v) {
  q_ = q;
  v_ = v;
  v_before_ = v;
  Field strains;
  shell_.strains(q_, strains);
  elastic_ = shell_.account(q_, strains).elastic;
  shell_.begin(q_, shell_step_);
  dissipation_ = numerical_loss_ = solver_loss_ = residual_ = 0.0;
  solver_impulse_.setZero();
  mass_.apply(v_, 1.0, p_);
  iterations_ = 0;
  factor_.start();
  shell_.forces(q_, q_, strains, 0.0, r_);  // elastic − pressure
  ShellCarcass bare = shell_;
  const double other = shell_.pressure() > 0.0 ? 0.0 : 1.0;  // Pa
  bare.set_pressure(other);
  bare.forces(q_, q_, strains, 0.0, d_);
  for (std::size_t k = 0; k < d_.size(); ++k) d_[k] -= r_[k];
  const double norm = free_norm(d_);
  unit_force_ = norm / std::abs(shell_.pressure() - other);
  set_reference(other > 0.0 ? 0.0 : norm);
}

void ShellIntegrator::set_reference(double pressure_force) {
  reference_ = std::max(pressure_force, 10.0 * free_norm(gravity_));
}

void ShellIntegrator::set_pressure(double pressure) {
  shell_.set_pressure(pressure);
  set_reference(unit_force_ * pressure);
}

double ShellIntegrator::free_norm(const Field& f) const {
  double total = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j) {
    const double* p = f.data() + layout_.offset(j, 0) - kDoubleLanes;
    const int half = 3 * layout_.stride();
    const Eigen::Map<const Eigen::VectorXd> force(p, half), moment(p + half, half);
    total += force.squaredNorm() + moment.squaredNorm() / (kDirectorLength * kDirectorLength);
  }
  return std::sqrt(total);
}

void ShellIntegrator::set_bead(const RimState& rim) {
  const Mat3 turn = rim.orientation.toRotationMatrix();
  for (const int j : {0, layout_.rows - 1})
    for (int i = 0; i < layout_.columns; ++i) {
      const Mat3 here = turn * mesh_.turn(i);
      const Vec3 arm = here * mesh_.position[j], director = here * mesh_.director[j];
      layout_.set(q_new_, i, j, 0, rim.position + arm);
      layout_.set(q_new_, i, j, 3, director);
      layout_.set(v_new_, i, j, 0, rim.velocity + rim.angular_velocity.cross(arm));
      layout_.set(v_new_, i, j, 3, rim.angular_velocity.cross(director));
    }
}

/// Predicts free nodes from their velocities and a share of the last change of these.
void ShellIntegrator::predict(double h, double share) {
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (std::size_t k = first; k < last; ++k) q_new_[k] = q_[k] + h * (v_[k] + share * (v_[k] - v_before_[k]));
}

/// Computes the residual of (2) at q_new_ in r_; at the beads, the reactions Q.
void ShellIntegrator::evaluate(double h, const Field& force) {
  const Stopwatch watch(times_.force);
  layout_.fill_padding(q_new_);
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (std::size_t k = first; k < last; ++k) v_new_[k] = (q_new_[k] - q_[k]) / h;
  for (std::size_t k = 0; k < q_.size(); ++k) {
    q_force_[k] = 0.5 * (q_[k] + q_new_[k]);
    change_[k] = v_new_[k] - v_[k];
  }
  shell_.forces(q_new_, q_force_, shell_step_, params_.coefficient(h), r_, params_.threads);
  mass_.add(change_, 1.0 / h, r_);
  for (std::size_t k = 0; k < r_.size(); ++k) r_[k] -= force[k] + gravity_[k];
  contact_.apply(layout_, q_force_, v_new_, r_);
}

/// d_ = H r_ with the BFGS inverse that `pairs` steps have built on the factor.
void ShellIntegrator::direction(const Mat3& turn, int pairs) {
  const Stopwatch watch(times_.solve);
  const std::size_t first = layout_.free_begin();
  const auto part = [&](Field& f) { return Eigen::Map<Eigen::VectorXd>(f.data() + first, layout_.free_size()); };
  double weight[kPairs];
  part(change_) = part(r_);
  for (int k = pairs - 1; k >= 0; --k) {
    weight[k] = rho_[k] * dot(s_[k], change_, layout_);
    part(change_) -= weight[k] * part(y_[k]);
  }
  factor_.solve(turn, change_, d_);
  for (int k = 0; k < pairs; ++k) part(d_) += (weight[k] - rho_[k] * dot(y_[k], d_, layout_)) * part(s_[k]);
}

/// `careful`: a correction that makes the residual grow is halved.
/// @returns true when converged; false when slow, growing or not finite
bool ShellIntegrator::iterate(double h, const Field& force, const Mat3& turn, bool careful, int& count, double& norm) {
  int pairs = 0;
  double best = norm;
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (int n = 0; n < params_.max_iterations; ++n) {
    direction(turn, pairs);
    const int slot = std::min(pairs, kPairs - 1);
    if (pairs == kPairs) {  // forget the oldest
      std::rotate(s_.begin(), s_.begin() + 1, s_.end());
      std::rotate(y_.begin(), y_.begin() + 1, y_.end());
      std::rotate(rho_.begin(), rho_.begin() + 1, rho_.end());
    }
    for (std::size_t k = first; k < last; ++k) {
      s_[slot][k] = -d_[k];
      y_[slot][k] = -r_[k];
      q_new_[k] -= d_[k];
    }
    const double before = norm;
    evaluate(h, force);
    ++count;
    norm = free_norm(r_);
    for (double share = 0.5; careful && !(norm <= before) && share > kMinShare; share *= 0.5) {
      for (std::size_t k = first; k < last; ++k) {
        q_new_[k] += share * d_[k];
        s_[slot][k] = -share * d_[k];
      }
      evaluate(h, force);
      ++count;
      norm = free_norm(r_);
    }
    if (!std::isfinite(norm) || norm > 1e3 * best) return false;
    if (norm <= params_.tolerance * reference_) return true;
    best = std::min(best, norm);
    for (std::size_t k = first; k < last; ++k) y_[slot][k] += r_[k];
    const double curvature = dot(s_[slot], y_[slot], layout_);
    if (!(curvature > 0.0)) {
      pairs = std::min(pairs, kPairs - 1);
      continue;
    }
    rho_[slot] = 1.0 / curvature;
    pairs = slot + 1;
  }
  return false;
}

Outcome ShellIntegrator::step(double h, const RimState& start, const RimState& end, const Field& force,
                              const Vec3& about, Wrench& on_rim) {
  FURROW_ASSERT(h > 0.0, h);
  FURROW_ASSERT(force.size() == layout_.size(), force.size(), layout_.size());
  FURROW_ASSERT(q_.size() == layout_.size() && v_.size() == layout_.size(), q_.size(), v_.size(), layout_.size());
  set_bead(end);
  shell_.prepare(shell_step_, h);
  layout_.fill_padding(v_new_);
  const Mat3 orientation = end.orientation.toRotationMatrix();
  const SectorFactor::Step now{h, end, q_, q_new_, contact_};
  double norm = 0.0;
  int count = 0;
  // First an old factor, then a younger one, then Newton's method with new ones while the residual is finite.
  for (int attempt = 0; attempt < kAttempts; ++attempt) {
    if (attempt <= kCareful) {
      predict(h, attempt < kCareful ? 1.0 : 0.0);
      evaluate(h, force);
      norm = free_norm(r_);
    } else if (!std::isfinite(norm)) {
      break;
    }
    bool converged = norm <= params_.tolerance * reference_;
    if (!converged) {
      converged = factor_.prepare(now, attempt) && iterate(h, force, orientation, attempt >= kCareful, count, norm);
      factor_.note_iterations(count);
    }
    if (converged) {
      iterations_ += count;
      residual_ = norm / reference_;
      finish(h, start, end, about, on_rim);
      return {};
    }
  }
  return Outcome::failure(
      "did not converge",
      fmt::format("residual {:.3g} of the pressure force, allowed {:.3g}, after {} iterations and a new "
                  "factorization with a step of {:.3g} s; try a smaller run.step or a larger "
                  "tire.structural_damping",
                  norm / reference_, params_.tolerance, count, h));
}

/// Spindle wrench from (2): −Σ Q − pressure resultant, moments at q_f, and the term Δx × ½ (p + p')/h. The free
/// residual is counted with the beads, so that momentum balances to round-off.
void ShellIntegrator::finish(double h, const RimState& start, const RimState& end, const Vec3& about, Wrench& on_rim) {
  const Stopwatch watch(times_.other);
  on_rim = {};
  for (int j = 0; j < layout_.rows; ++j)
    for (int i = 0; i < layout_.columns; ++i) {
      const Vec3 force = layout_.get(r_, i, j, 0);
      on_rim.force -= force;
      on_rim.moment -= (layout_.get(q_force_, i, j, 0) - about).cross(force) +
                       layout_.get(q_force_, i, j, 3).cross(layout_.get(r_, i, j, 3));
    }
  const Wrench air = shell_.pressure_resultant(q_force_, about);
  on_rim.force -= air.force;
  on_rim.moment -= air.moment;
  layout_.fill_padding(v_new_);
  for (std::size_t k = 0; k < v_.size(); ++k) change_[k] = 0.5 * (v_[k] + v_new_[k]);
  mass_.apply(change_, 1.0 / h, d_);
  for (int j = 0; j < layout_.rows; ++j)
    for (int i = 0; i < layout_.columns; ++i)
      for (const int s : {0, 3})
        on_rim.moment -= (layout_.get(q_new_, i, j, s) - layout_.get(q_, i, j, s)).cross(layout_.get(d_, i, j, s));
  book_losses(h, start, end);
  contact_.accept(layout_, q_force_, v_new_, h);
  p_.swap(p_new_);
  v_before_.swap(v_);
  v_.swap(v_new_);
  q_.swap(q_new_);
  const ShellCarcass::Energies energies = shell_.accept(shell_step_);
  elastic_ += energies.elastic + energies.stored;
  dissipation_ += params_.damping / h * energies.change + energies.relaxed;
  numerical_loss_ += 0.5 * energies.change;
}

/// Terms of the product of (2) with Δq = q' − q. For the beads, Δq is the rim's displacement X and turn θ
/// (mean_turn.hpp):
///   Δvᵀ M Δq/h = Δ(kinetic energy) + Δvᵀ M (Δq/h − v̄),  v̄ = ½ (v + v'),
/// ½ Δvᵀ M Δv on free nodes. The spindle's moment contains the beads' reactions, the term Σ Δq × M v̄/h, and the
/// residual r of the free nodes as if it acted on the rim. So the work of the rim, −F·X − M·θ, is less by
///   numerical: Δvᵀ M (Δq/h − v̄) + θ·Σ Δq × M v̄/h      (zero for a steady spin)
///   solver:    Σ r·X + θ·Σ (q_f − x) × r − r·Δq        over free nodes.
void ShellIntegrator::book_losses(double h, const RimState& start, const RimState& end) {
  using Map = Eigen::Map<const Eigen::VectorXd>;
  const auto all = [](const Field& f) { return Map(f.data(), static_cast<Eigen::Index>(f.size())); };
  const auto line = [&](const Field& f, int j, int c) { return Map(f.data() + layout_.offset(j, c), layout_.columns); };
  const auto cross = [&](const Field& a, const Field& b, int j, int s) {
    const Map x = line(a, j, s), y = line(a, j, s + 1), z = line(a, j, s + 2);
    const Map u = line(b, j, s), v = line(b, j, s + 1), w = line(b, j, s + 2);
    return Vec3(y.dot(w) - z.dot(v), z.dot(u) - x.dot(w), x.dot(v) - y.dot(u));
  };
  mass_.apply(v_new_, 1.0, p_new_);  // its padding and the padding of r_ are zero
  for (std::size_t k = 0; k < q_.size(); ++k) moved_[k] = q_new_[k] - q_[k];
  const auto one = Eigen::VectorXd::Ones(layout_.columns);
  Vec3 spin = Vec3::Zero(), force = Vec3::Zero(), moment = Vec3::Zero();
  for (int j = 0; j < layout_.rows; ++j)
    for (const int s : {0, 3}) {
      spin += cross(moved_, d_, j, s);
      if (j == 0 || j + 1 == layout_.rows) continue;
      moment += cross(q_force_, r_, j, s);
      if (s == 0) force += Vec3(line(r_, j, 0).dot(one), line(r_, j, 1).dot(one), line(r_, j, 2).dot(one));
    }
  const Vec3 way = end.position - start.position, centre = 0.5 * (start.position + end.position),
             turn = mean_turn(start.orientation, end.orientation);
  const auto pushed = all(p_new_) - all(p_);
  numerical_loss_ += pushed.dot(all(moved_)) / h - pushed.dot(all(change_)) + turn.dot(spin);
  solver_loss_ += force.dot(way) + (moment - centre.cross(force)).dot(turn) - dot(r_, moved_, layout_);
  solver_impulse_ += h * force;
}

double ShellIntegrator::potential_energy() const {
  using Map = Eigen::Map<const Eigen::VectorXd>;
  const auto size = static_cast<Eigen::Index>(q_.size());
  return -Map(gravity_.data(), size).dot(Map(q_.data(), size));
}

ShellIntegrator::Times ShellIntegrator::times() const {
  Times all = times_;
  all.jacobian = factor_.times().jacobian;
  all.factorize = factor_.times().factorize;
  return all;
}

void ShellIntegrator::save(Archive& archive) const {
  archive.put("q", q_);
  archive.put("v", v_);
  archive.put("v_before", v_before_);
  archive.put("stress", shell_step_.stress);
  for (std::size_t i = 0; i < shell_step_.branch_strain.size(); ++i) {
    archive.put(fmt::format("branch/{}/strain", i), shell_step_.branch_strain[i]);
    archive.put(fmt::format("branch/{}/stress", i), shell_step_.branch_stress[i]);
  }
  archive.put("pressure", shell_.pressure());
  save_fields(archive, "sums", *this);
  factor_.save(archive);
}

void ShellIntegrator::restore(const Archive& archive) {
  q_ = archive.get<double>("q", layout_.size());
  v_ = archive.get<double>("v", layout_.size());
  v_before_ = archive.get<double>("v_before", layout_.size());
  mass_.apply(v_, 1.0, p_);
  shell_.begin(q_, shell_step_);
  shell_step_.stress = archive.get<double>("stress", shell_.strains_size());
  for (std::size_t i = 0; i < shell_step_.branch_strain.size(); ++i) {
    shell_step_.branch_strain[i] = archive.get<double>(fmt::format("branch/{}/strain", i), shell_.strains_size());
    shell_step_.branch_stress[i] = archive.get<double>(fmt::format("branch/{}/stress", i), shell_.strains_size());
  }
  shell_.set_pressure(archive.get_double("pressure"));
  restore_fields(archive, "sums", *this);
  factor_.restore(archive);
}

}  // namespace furrow::tire
