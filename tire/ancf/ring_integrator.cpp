#include "tire/ancf/ring_integrator.hpp"

#include <fmt/format.h>

#include <cmath>
#include <ctime>

#include "tire/ancf/shell_batch.hpp"

namespace furrow {
namespace {

constexpr double kGravity = 9.81;            // m/s²
constexpr int kAttempts = 10, kCareful = 2;  // per step; from which one on corrections are halved
constexpr double kLeastShare = 0.01;         // of a correction that is halved
constexpr double kDirectorLength = 0.01;     // m, makes director residuals (N m) comparable with forces
constexpr int kPairs = 12;
constexpr double kDirectorWeight = 0.5;  // the age of a director counts less: what it turns is softer
constexpr double kAlso = 0.4;  // of the age of renewal: sectors as old as this are renewed with others

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
      factor_(layout_),
      made_layout_{2 * kLanes * layout_.batches(), layout_.rows},
      made_old_(made_layout_.size()),
      made_new_(made_layout_.size()),
      geometric_(layout_.batches(), 1),
      made_pressure_(layout_.batches(), 0.0),
      age_(layout_.batches()),
      which_(layout_.batches()) {
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
  Field strains;
  shell_.strains(q_, strains);
  elastic_ = shell_.account(q_, strains).elastic;
  shell_.begin(q_, shell_step_);
  dissipation_ = residual_ = 0.0;
  iterations_ = factorizations_ = 0;
  factor_work_ = 0.0;
  factor_valid_ = false;
  shell_.forces(q_, q_, strains, 0.0, r_);  // elastic − pressure
  ShellRing bare = shell_;
  const double other = shell_.pressure() > 0.0 ? 0.0 : 1.0;  // Pa
  bare.set_pressure(other);
  bare.forces(q_, q_, strains, 0.0, d_);
  for (std::size_t k = 0; k < d_.size(); ++k) d_[k] -= r_[k];
  const double norm = free_norm(d_);
  unit_force_ = norm / std::abs(shell_.pressure() - other);
  set_reference(other > 0.0 ? 0.0 : norm);
}

void RingIntegrator::set_reference(double pressure_force) {
  reference_ = std::max(pressure_force, 10.0 * free_norm(gravity_));
}

void RingIntegrator::set_pressure(double pressure) {
  shell_.set_pressure(pressure);
  set_reference(unit_force_ * pressure);
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
  shell_.forces(q_new_, q_force_, shell_step_, coefficient(h), r_, params_.threads);
  mass_.add(change_, 1.0 / h, r_);
  for (std::size_t k = 0; k < r_.size(); ++k) r_[k] -= force[k] + gravity_[k];
  contact_.apply(layout_, q_force_, v_new_, r_);
}

/// Keeps the shape of a sector over the step, in rim axes.
void RingIntegrator::note_shape(int sector, const RimState& rim) {
  const Mat3 back = rim.orientation.toRotationMatrix().transpose();
  made_pressure_[sector] = shell_.pressure();
  for (int j = 0; j < layout_.rows; ++j)
    for (int k = 0; k <= kLanes; ++k) {
      const int i = sector * kLanes + k, to = 2 * sector * kLanes + k;
      made_layout_.set(made_old_, to, j, 0, back * (layout_.get(q_, i, j, 0) - rim.position));
      made_layout_.set(made_new_, to, j, 0, back * (layout_.get(q_new_, i, j, 0) - rim.position));
      made_layout_.set(made_old_, to, j, 3, back * layout_.get(q_, i, j, 3));
      made_layout_.set(made_new_, to, j, 3, back * layout_.get(q_new_, i, j, 3));
    }
  if (contact_made_.empty()) return;
  const int nodes = layout_.rows * std::min(kLanes, layout_.columns - sector * kLanes);
  const std::size_t first = static_cast<std::size_t>(sector) * kLanes * layout_.rows;
  std::copy_n(contact_now_.begin() + first, nodes, contact_made_.begin() + first);
}

/// What the nodes' contact tangents are in a step of size h, once there is or was one.
void RingIntegrator::note_contact(double h, const Mat3& turn) {
  if (contact_.empty() && contact_made_.empty()) return;
  contact_.stiffness(layout_, h, turn, contact_now_);
  if (contact_made_.empty()) contact_made_.assign(contact_now_.size(), Mat3::Zero());
}

void RingIntegrator::build(const std::vector<char>& which) {
  const Stopwatch watch(times_.jacobian);
  const int count = factor_.sectors();
  if (params_.threads > 1) {
#pragma omp parallel for schedule(dynamic) num_threads(params_.threads)
    for (int b = 0; b < count; ++b)
      if (which[b]) build_sector(b);
  } else {
    for (int b = 0; b < count; ++b)
      if (which[b]) build_sector(b);
  }
}

/// The tangent of a sector's elements in the shape that was kept.
void RingIntegrator::build_sector(int sector) {
  const double c = coefficient(factor_h_) + shell_.branch_gain(factor_h_),
               inertia = 1.0 / (factor_h_ * factor_h_);
  BatchTangent tangent;
  factor_.clear(sector);
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    BatchNodes before, now, middle;
    before.read(made_layout_, made_old_.data(), 2 * sector * kLanes, j);
    now.read(made_layout_, made_new_.data(), 2 * sector * kLanes, j);
    for (int n = 0; n < 4; ++n) {
      middle.r[n] = 0.5 * (before.r[n] + now.r[n]);
      middle.d[n] = 0.5 * (before.d[n] + now.d[n]);
    }
    Lanes stress[kStrains];
    shell_.batch_stress_between(before, now, c, j, stress);
    tangent.compute(shell_.stiffness(j), middle, stress, c, geometric_[sector] ? 0.5 : 0.0,
                    made_pressure_[sector]);
    factor_.add(tangent, mass_.element(j), inertia, j, sector);
  }
  if (contact_made_.empty()) return;
  for (int lane = 0; lane < kLanes && sector * kLanes + lane < layout_.columns; ++lane)
    for (int j = 1; j + 1 < layout_.rows; ++j)
      factor_.add_node(contact_made_[(sector * kLanes + lane) * layout_.rows + j], sector, lane, j);
}

/// Makes the factor anew in the sectors marked. Without its geometric part the tangent is positive definite.
bool RingIntegrator::renew(const std::vector<char>& which, const RimState& rim) {
  ++factorizations_;
  excess_ = 0;
  const auto rebuild = [&](const std::vector<char>& these, char geometric) {
    for (int b = 0; b < factor_.sectors(); ++b)
      if (these[b]) geometric_[b] = geometric;
    build(these);
    const Stopwatch watch(times_.factorize);
    factor_valid_ = factor_.factorize(params_.threads);
    factor_work_ += factor_.work();
    return factor_valid_;
  };
  for (int b = 0; b < factor_.sectors(); ++b)
    if (which[b]) note_shape(b, rim);
  return rebuild(which, 1) || rebuild(which, 0) || rebuild(std::vector<char>(which.size(), 1), 0);
}

/// Largest relative change of an edge or a director of a sector since the factor was made, in rim axes.
double RingIntegrator::age(int sector, const Mat3& turn) const {
  Lanes most = {};
  const auto compare = [&](const Lanes3& now, const Lanes3& made, double weight) {
    const Lanes3 change{turn(0, 0) * now.x + turn(1, 0) * now.y + turn(2, 0) * now.z - made.x,
                        turn(0, 1) * now.x + turn(1, 1) * now.y + turn(2, 1) * now.z - made.y,
                        turn(0, 2) * now.x + turn(1, 2) * now.y + turn(2, 2) * now.z - made.z};
    const Lanes relative = weight * weight * dot(change, change) / dot(made, made);
    most = relative > most ? relative : most;
  };
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    BatchNodes now, made;
    now.read(layout_, q_new_.data(), sector * kLanes, j);
    made.read(made_layout_, made_new_.data(), 2 * sector * kLanes, j);
    compare(now.r[1] - now.r[0], made.r[1] - made.r[0], 1.0);
    compare(now.r[3] - now.r[0], made.r[3] - made.r[0], 1.0);
    compare(now.d[0], made.d[0], kDirectorWeight);
  }
  return std::sqrt(std::max(std::max(most[0], most[1]), std::max(most[2], most[3])));
}

/// Largest change of a contact tangent of a sector since the factor was made, relative to what the factor holds of the
/// node: that tangent and the node's inertia.
double RingIntegrator::contact_age(int sector, double h) const {
  if (contact_made_.empty()) return 0.0;
  double most = 0.0;
  for (int i = sector * kLanes; i < std::min((sector + 1) * kLanes, layout_.columns); ++i)
    for (int j = 1; j + 1 < layout_.rows; ++j) {
      const std::size_t node = static_cast<std::size_t>(i) * layout_.rows + j;
      const double change = (contact_now_[node] - contact_made_[node]).norm();
      if (change == 0.0) continue;
      const double inertia = -gravity_[layout_.offset(j, 2) + i] / (kGravity * h * h);
      most = std::max(most, change / (contact_made_[node].norm() + inertia));
    }
  return most;
}

/// A factor that is young enough everywhere; after a failed attempt one that is renewed wherever it has aged at all,
/// then one that is new.
bool RingIntegrator::prepare_factor(double h, const RimState& rim, int attempt) {
  const Mat3 turn = rim.orientation.toRotationMatrix();
  const bool all = !factor_valid_ || factor_h_ != h || attempt > 1;
  factor_h_ = h;
  double oldest = 0.0;
  note_contact(h, turn);
  for (int b = 0; b < factor_.sectors() && !all; ++b) {
    age_[b] = std::max(age(b, turn), params_.age / params_.contact_age * contact_age(b, h));
    oldest = std::max(oldest, age_[b]);
  }
  const bool slow = excess_ > params_.worth, due = oldest > params_.age || slow;
  if (!all && !due && attempt == 0) return true;
  const double limit = attempt > 0 ? 0.1 * params_.age : std::min(kAlso * params_.age, 0.5 * oldest);
  for (int b = 0; b < factor_.sectors(); ++b) which_[b] = all || age_[b] > limit;
  return renew(which_, rim);
}

/// d_ = H r_ with the BFGS inverse that `pairs` steps have built on the factor.
void RingIntegrator::direction(const Mat3& turn, int pairs) {
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
  factor_.solve(turn, change_, d_, params_.threads);
  for (int k = 0; k < pairs; ++k) part(d_) += (weight[k] - rho_[k] * dot(y_[k], d_, layout_)) * part(s_[k]);
}

/// `careful`: a correction that makes the residual grow is halved.
/// @returns true when converged; false when slow, growing or not finite
bool RingIntegrator::iterate(double h, const Field& force, const Mat3& turn, bool careful, int& count,
                             double& norm) {
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
    for (double share = 0.5; careful && !(norm <= before) && share > kLeastShare; share *= 0.5) {
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

TireStatus RingIntegrator::step(double h, const RimState& end, const Field& force, const Vec3& about,
                                Wrench& on_rim) {
  set_bead(end);
  shell_.prepare(shell_step_, h);
  layout_.fill_padding(v_new_);
  const Mat3 orientation = end.orientation.toRotationMatrix();
  double norm = 0.0;
  int count = 0;
  // An old factor, a younger one, then Newton's method with new ones as long as the residual stays finite.
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
      converged =
          prepare_factor(h, end, attempt) && iterate(h, force, orientation, attempt >= kCareful, count, norm);
      excess_ += std::max(0, count - 1);
    }
    if (converged) {
      iterations_ += count;
      residual_ = norm / reference_;
      finish(h, about, on_rim);
      return {};
    }
  }
  return {false, "did not converge",
          fmt::format("residual {:.3g} of the pressure force, allowed {:.3g}, after {} iterations and a new "
                      "factorization with a step of {:.3g} s; try a smaller run.step or a larger "
                      "tire.structural_damping",
                      norm / reference_, params_.tolerance, count, h)};
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
  contact_.accept(layout_, q_force_, v_new_, h);
  v_before_.swap(v_);
  v_.swap(v_new_);
  q_.swap(q_new_);
  const ShellRing::Energies energies = shell_.accept(shell_step_);
  elastic_ += energies.elastic + energies.stored;
  dissipation_ += params_.damping / h * energies.change + energies.relaxed;
}

void RingIntegrator::save(Archive& archive) const {
  archive.put("q", q_);
  archive.put("v", v_);
  archive.put("v_before", v_before_);
  archive.put("stress", shell_step_.stress);
  for (std::size_t i = 0; i < shell_step_.branch_strain.size(); ++i) {
    archive.put(fmt::format("branch/{}/strain", i), shell_step_.branch_strain[i]);
    archive.put(fmt::format("branch/{}/stress", i), shell_step_.branch_stress[i]);
  }
  archive.put("pressure", std::vector<double>{shell_.pressure(), unit_force_});
  archive.put("scalars", std::vector<double>{reference_, elastic_, dissipation_, residual_});
  archive.put("counts", std::vector<std::int64_t>{iterations_, factorizations_});
  archive.put("factor/flags", std::vector<std::int64_t>{factor_valid_, excess_});
  archive.put("factor/numbers", std::vector<double>{factor_h_, factor_work_});
  archive.put("factor/old", made_old_);
  archive.put("factor/new", made_new_);
  archive.put("factor/pressure", made_pressure_);
  if (!contact_made_.empty()) {
    std::vector<double> flat;
    for (const Mat3& m : contact_made_) flat.insert(flat.end(), m.data(), m.data() + 9);
    archive.put("factor/contact", flat);
  }
  archive.put("factor/geometric", std::vector<std::int32_t>(geometric_.begin(), geometric_.end()));
}

void RingIntegrator::restore(const Archive& archive) {
  q_ = archive.get<double>("q", layout_.size());
  v_ = archive.get<double>("v", layout_.size());
  v_before_ = archive.get<double>("v_before", layout_.size());
  shell_.begin(q_, shell_step_);
  shell_step_.stress = archive.get<double>("stress", shell_.strains_size());
  for (std::size_t i = 0; i < shell_step_.branch_strain.size(); ++i) {
    shell_step_.branch_strain[i] =
        archive.get<double>(fmt::format("branch/{}/strain", i), shell_.strains_size());
    shell_step_.branch_stress[i] =
        archive.get<double>(fmt::format("branch/{}/stress", i), shell_.strains_size());
  }
  const auto& pressure = archive.get<double>("pressure", 2);
  shell_.set_pressure(pressure[0]), unit_force_ = pressure[1];
  const auto& scalars = archive.get<double>("scalars", 4);
  const auto& counts = archive.get<std::int64_t>("counts", 2);
  const auto& flags = archive.get<std::int64_t>("factor/flags", 2);
  const auto& numbers = archive.get<double>("factor/numbers", 2);
  made_old_ = archive.get<double>("factor/old", made_layout_.size());
  made_new_ = archive.get<double>("factor/new", made_layout_.size());
  made_pressure_ = archive.get<double>("factor/pressure", made_pressure_.size());
  const auto& geometric = archive.get<std::int32_t>("factor/geometric", geometric_.size());
  geometric_.assign(geometric.begin(), geometric.end());
  contact_made_.clear();
  if (archive.has("factor/contact")) {
    contact_made_.resize(static_cast<std::size_t>(layout_.columns) * layout_.rows);
    const auto& flat = archive.get<double>("factor/contact", 9 * contact_made_.size());
    for (std::size_t k = 0; k < contact_made_.size(); ++k)
      contact_made_[k] = Eigen::Map<const Mat3>(&flat[9 * k]);
  }
  excess_ = static_cast<int>(flags[1]);
  factor_h_ = numbers[0], factor_work_ = numbers[1];
  factor_valid_ = false;
  if (flags[0] != 0) {
    build(std::vector<char>(factor_.sectors(), 1));
    factor_valid_ = factor_.factorize(params_.threads);
  }
  reference_ = scalars[0], elastic_ = scalars[1], dissipation_ = scalars[2], residual_ = scalars[3];
  iterations_ = counts[0], factorizations_ = counts[1];
}

}  // namespace furrow
