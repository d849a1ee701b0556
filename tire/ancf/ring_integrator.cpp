#include "tire/ancf/ring_integrator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "tire/ancf/shell_batch.hpp"

namespace furrow {
namespace {

constexpr double kGravity = 9.81;         // m/s²
constexpr double kDirectorLength = 0.01;  // m, makes director residuals (N m) comparable with forces
constexpr int kPairs = 12;
constexpr int kAged = 3;  // iterations

double dot(const Field& a, const Field& b, const RingLayout& layout) {
  const std::size_t first = layout.free_begin(), count = layout.free_size();
  return Eigen::Map<const Eigen::VectorXd>(a.data() + first, count)
      .dot(Eigen::Map<const Eigen::VectorXd>(b.data() + first, count));
}

/// Processor time of this thread: what the work costs, whoever else uses the machine.
class Stopwatch {
 public:
  explicit Stopwatch(double& total) : total_(total), start_(now()) {}
  ~Stopwatch() { total_ += now() - start_; }

 private:
  static double now() {
    timespec t;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
  }
  double& total_;
  double start_;
};

}  // namespace

RingIntegrator::RingIntegrator(const TireFile& file, const RingMesh& mesh, const RingIntegratorParams& params)
    : params_(params),
      mesh_(mesh),
      layout_{mesh.columns, mesh.rows},
      shell_(file, mesh),
      mass_(mesh, element_masses(file, mesh)),
      factor_(layout_, params.slots),
      slots_(params.slots) {
  for (Field* f : {&q_, &v_, &v_before_, &gravity_, &q_new_, &v_new_, &q_force_, &change_, &r_, &d_})
    f->assign(layout_.size(), 0.0);
  s_.assign(kPairs, r_);
  y_.assign(kPairs, r_);
  rho_.assign(kPairs, 0.0);
  Field down(layout_.size(), 0.0);
  for (int j = 0; j < layout_.rows; ++j)
    for (int i = 0; i < layout_.columns; ++i) layout_.set(down, i, j, 0, Vec3(0.0, 0.0, -kGravity));
  layout_.fill_padding(down);
  mass_.apply(down, 1.0, gravity_);
}

void RingIntegrator::start(const Field& q, const Field& v) {
  q_ = q;
  v_ = v;
  v_before_ = v;
  shell_.strains(q_, strains_);
  elastic_ = shell_.account(q_, strains_).elastic;
  dissipation_ = residual_ = 0.0;
  iterations_ = factorizations_ = 0;
  for (Slot& slot : slots_) slot.valid = false;
  shell_.forces(q_, q_, strains_, 0.0, r_);  // elastic − pressure
  ShellRing bare = shell_;
  bare.set_pressure(0.0);
  bare.forces(q_, q_, strains_, 0.0, d_);
  for (std::size_t k = 0; k < d_.size(); ++k) d_[k] -= r_[k];
  reference_ = std::max(free_norm(d_), 10.0 * free_norm(gravity_));
}

double RingIntegrator::free_norm(const Field& f) const {
  double total = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j) {
    const double* p = f.data() + layout_.offset(j, 0) - kLanes;
    const int half = 3 * layout_.stride();
    const Eigen::Map<const Eigen::VectorXd> force(p, half), moment(p + half, half);
    total += force.squaredNorm() + moment.squaredNorm() / (kDirectorLength * kDirectorLength);
  }
  return std::sqrt(total);
}

void RingIntegrator::set_bead(const RimState& rim) {
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

/// Free nodes go on with their velocities and a share of the last change of these.
void RingIntegrator::predict(double h, double share) {
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (std::size_t k = first; k < last; ++k) q_new_[k] = q_[k] + h * (v_[k] + share * (v_[k] - v_before_[k]));
}

/// Residual of (2) at q_new_ into r_, at the beads the reactions Q.
void RingIntegrator::evaluate(double h, const Field& force) {
  const Stopwatch watch(times_.force);
  layout_.fill_padding(q_new_);
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (std::size_t k = first; k < last; ++k) v_new_[k] = (q_new_[k] - q_[k]) / h;
  for (std::size_t k = 0; k < q_.size(); ++k) {
    q_force_[k] = 0.5 * (q_[k] + q_new_[k]);
    change_[k] = v_new_[k] - v_[k];
  }
  shell_.forces(q_new_, q_force_, strains_, coefficient(h), r_);
  mass_.add(change_, 1.0 / h, r_);
  for (std::size_t k = 0; k < r_.size(); ++k) r_[k] -= force[k] + gravity_[k];
}

bool RingIntegrator::make_factor(Slot& slot, int index) {
  Field strains;
  shell_.strains(slot.q_old, strains);
  Field at(slot.q_old.size());
  for (std::size_t k = 0; k < at.size(); ++k) at[k] = 0.5 * (slot.q_old[k] + slot.q_new[k]);
  const double c = coefficient(slot.h), inertia = 1.0 / (slot.h * slot.h);
  auto tangent = std::make_unique<BatchTangent>();
  ++factorizations_;
  for (const double geometric : {0.5, 0.0}) {  // without its geometric part the tangent is positive definite
    {
      const Stopwatch watch(times_.jacobian);
      factor_.clear();
      for (int j = 0; j + 1 < layout_.rows; ++j)
        for (int b = 0; b < layout_.batches(); ++b) {
          Lanes stress[kStrains];
          shell_.batch_stress_at(slot.q_new, strains, c, j, b, stress);
          BatchNodes nodes;
          nodes.read(layout_, at.data(), b * kLanes, j);
          tangent->compute(shell_.stiffness(j), nodes, stress, c, geometric, shell_.pressure());
          factor_.add(*tangent, mass_.element(j), inertia, j, b);
        }
    }
    const Stopwatch watch(times_.factorize);
    if (factor_.factorize(index)) return slot.valid = true;
  }
  return slot.valid = false;
}

/// The factor whose rim stood, after turning by whole pitches, nearest to `orientation`; a new one when none
/// is near.
RingIntegrator::Placement RingIntegrator::place_factor(double h, const Mat3& orientation, bool renew) {
  const double pitch = mesh_.pitch();
  Placement best;
  double least = pitch;
  int unused = -1;
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const Slot& slot = slots_[k];
    if (!slot.valid || slot.h != h) {
      if (unused < 0) unused = static_cast<int>(k);
      continue;
    }
    const Mat3 since = slot.turn.transpose() * orientation;
    const double angle = std::atan2(since(0, 2) - since(2, 0), since(0, 0) + since(2, 2));
    const int shift = -static_cast<int>(std::lround(angle / pitch));
    const double off = std::abs(angle + shift * pitch);
    if (off < least) {
      least = off;
      best = {static_cast<int>(k), orientation * mesh_.turn(shift) * slot.turn.transpose(), shift};
    }
  }
  const bool near = least <= 0.5 * pitch / static_cast<double>(slots_.size());
  if (near || unused < 0) {
    if (least < pitch && !renew && !slots_[best.slot].stale) return best;
  } else {
    best.slot = unused;
  }
  Slot& slot = slots_[best.slot];
  slot = {false, false, orientation, h, -1, q_, q_new_};
  make_factor(slot, best.slot);
  return {best.slot, Mat3::Identity(), 0};
}

/// d_ = H r_ with the BFGS inverse that `pairs` steps have built on the factor.
void RingIntegrator::direction(const Placement& at, int pairs) {
  const Stopwatch watch(times_.solve);
  const std::size_t first = layout_.free_begin();
  const auto part = [&](Field& f) {
    return Eigen::Map<Eigen::VectorXd>(f.data() + first, layout_.free_size());
  };
  double weight[kPairs];
  part(change_) = part(r_);
  for (int k = pairs - 1; k >= 0; --k) {
    weight[k] = rho_[k] * dot(s_[k], change_, layout_);
    part(change_) -= weight[k] * part(y_[k]);
  }
  factor_.solve(at.slot, at.turn, at.shift, change_, d_);
  for (int k = 0; k < pairs; ++k) part(d_) += (weight[k] - rho_[k] * dot(y_[k], d_, layout_)) * part(s_[k]);
}

/// @returns true when converged; false when slow, growing or not finite
bool RingIntegrator::iterate(double h, const Field& force, Placement& at, int& count, double& norm) {
  int pairs = 0;
  double best = norm;
  const std::size_t first = layout_.free_begin(), last = first + layout_.free_size();
  for (int n = 0; n < params_.max_iterations; ++n) {
    direction(at, pairs);
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
    evaluate(h, force);
    ++count;
    norm = free_norm(r_);
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

/// A factorization costs some fifteen iterations; it is not worth it where a new factor was no better.
void RingIntegrator::judge(Slot& slot, int count) {
  if (slot.first_iterations < 0) slot.first_iterations = count;
  slot.stale = count > std::max(params_.slow_iterations, slot.first_iterations + kAged);
}

TireStatus RingIntegrator::step(double h, const RimState& end, const Field& force, const Vec3& about,
                                Wrench& on_rim) {
  set_bead(end);
  layout_.fill_padding(v_new_);
  const Mat3 orientation = end.orientation.toRotationMatrix();
  double norm = 0.0;
  int count = 0;
  for (int attempt = 0; attempt < 3; ++attempt) {
    predict(h, attempt < 2 ? 1.0 : 0.0);
    evaluate(h, force);
    norm = free_norm(r_);
    bool converged = norm <= params_.tolerance * reference_;
    if (!converged) {
      Placement at = place_factor(h, orientation, attempt > 0);
      converged = slots_[at.slot].valid && iterate(h, force, at, count, norm);
      judge(slots_[at.slot], count);
    }
    if (converged) {
      iterations_ += count;
      residual_ = norm / reference_;
      finish(h, about, on_rim);
      return {};
    }
  }
  return {false, fmt::format("residual {:.3g} of the pressure force after {} iterations and a new "
                             "factorization, allowed {:.3g}; "
                             "try a smaller run.step or more tire.substeps",
                             norm / reference_, count, params_.tolerance)};
}

/// Spindle wrench from (2): −Σ Q − pressure resultant, moments at q_f, and the term Δx × ½ (p + p')/h. What
/// is left of the free residual is counted with the beads, so that momentum balances to round-off.
void RingIntegrator::finish(double h, const Vec3& about, Wrench& on_rim) {
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
        on_rim.moment -=
            (layout_.get(q_new_, i, j, s) - layout_.get(q_, i, j, s)).cross(layout_.get(d_, i, j, s));
  v_before_.swap(v_);
  v_.swap(v_new_);
  q_.swap(q_new_);
  const ShellRing::Energies energies = shell_.account(q_, strains_);
  elastic_ = energies.elastic;
  dissipation_ += params_.damping / h * energies.change;
}

void RingIntegrator::save(Archive& archive) const {
  archive.put("q", q_);
  archive.put("v", v_);
  archive.put("v_before", v_before_);
  archive.put("scalars", std::vector<double>{reference_, elastic_, dissipation_, residual_});
  archive.put("counts", std::vector<std::int64_t>{iterations_, factorizations_});
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const Archive::Scope scope(archive, fmt::format("factor{}/", k));
    const Slot& slot = slots_[k];
    archive.put("flags", std::vector<std::int64_t>{slot.valid, slot.stale, slot.first_iterations});
    archive.put("turn", std::vector<double>(slot.turn.data(), slot.turn.data() + 9));
    archive.put("h", slot.h);
    archive.put("q_old", slot.q_old);
    archive.put("q_new", slot.q_new);
  }
}

void RingIntegrator::restore(const Archive& archive) {
  q_ = archive.get<double>("q", layout_.size());
  v_ = archive.get<double>("v", layout_.size());
  v_before_ = archive.get<double>("v_before", layout_.size());
  shell_.strains(q_, strains_);
  const auto& scalars = archive.get<double>("scalars", 4);
  const auto& counts = archive.get<std::int64_t>("counts", 2);
  for (std::size_t k = 0; k < slots_.size(); ++k) {
    const Archive::Scope scope(archive, fmt::format("factor{}/", k));
    Slot& slot = slots_[k];
    const auto& flags = archive.get<std::int64_t>("flags", 3);
    slot.stale = flags[1] != 0;
    slot.first_iterations = static_cast<int>(flags[2]);
    std::copy_n(archive.get<double>("turn", 9).data(), 9, slot.turn.data());
    slot.h = archive.get_double("h");
    slot.q_old = archive.get<double>("q_old");
    slot.q_new = archive.get<double>("q_new");
    slot.valid = false;
    if (flags[0] != 0) make_factor(slot, static_cast<int>(k));
  }
  reference_ = scalars[0], elastic_ = scalars[1], dissipation_ = scalars[2], residual_ = scalars[3];
  iterations_ = counts[0], factorizations_ = counts[1];
}

}  // namespace furrow
