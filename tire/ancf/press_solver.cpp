#include "tire/ancf/press_solver.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <algorithm>
#include <cmath>
#include <memory>

#include "protocol/error.hpp"
#include "tire/ancf/inflation.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"

namespace furrow {
namespace {

constexpr double kCreepTime = 5e-3;   // τ, s
constexpr double kFirstStep = 2e-3;   // s
constexpr double kLargestStep = 1e6;  // s
constexpr double kStaticStep =
    0.5;  // s, a creep step this long shows the static tangent to be definite to τ/h = 1 %
constexpr double kTolerance = 1e-6;       // of the free static residual, relative to the load
constexpr double kNewton = 1e-8;          // of a creep step's residual, relative to the pressure forces
constexpr double kDirectorLength = 0.01;  // m, makes director residuals (N m) comparable with forces
constexpr double kLeastLoad = 1.0;        // N, below which the residual is relative to the pressure forces
constexpr int kMaxNewton = 15;
constexpr int kMaxSteps = 400;
constexpr int kAround = 6, kAcross = 4;  // contact points of an element
constexpr int kColumn[4] = {0, 1, 1, 0}, kRow[4] = {0, 0, 1, 1};

}  // namespace

PressObstacle::Profile PressObstacle::at(double x) const {
  if (height <= 0.0) return {};
  const double beyond = std::abs(x) - 0.5 * width;
  if (beyond <= 0.0) return {};
  if (beyond >= edge) return {-height, 0.0};
  const double s = beyond / edge;  // smooth step of second order
  const double fall = s * s * (3.0 - 2.0 * s), slope = 6.0 * s * (1.0 - s) / edge;
  return {-height * fall, -height * slope * (x < 0.0 ? -1.0 : 1.0)};
}

struct PressSolver::Linear {
  Eigen::SparseMatrix<double> matrix;
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> llt;
  std::vector<Eigen::Triplet<double>> entries;
  BatchTangent tangent;
  bool analyzed = false;
};

PressSolver::PressSolver(const TireFile& file, const RingMesh& mesh, const Field& inflated,
                         const PressObstacle& obstacle)
    : mesh_(mesh),
      shell_(file, mesh),
      layout_(shell_.layout()),
      obstacle_(obstacle),
      clearance_(file, mesh),
      q_(inflated),
      r_(layout_.size()),
      linear_(std::make_unique<Linear>()) {
  linear_->llt.cholmod().print = 0;
  shell_.strains(q_, strains_);
  for (int j = 0; j < layout_.rows; ++j)
    start_radius_ = std::max(start_radius_, layout_.get(q_, 0, j, 0).z());
  ShellRing bare = shell_;
  bare.set_pressure(0.0);
  Field without(layout_.size());
  shell_.forces(q_, q_, strains_, 0.0, r_);
  bare.forces(q_, q_, strains_, 0.0, without);
  double total = 0.0;
  for (std::size_t k = layout_.free_begin(); k < layout_.free_begin() + layout_.free_size(); ++k)
    total += (r_[k] - without[k]) * (r_[k] - without[k]);
  pressure_norm_ = std::max(std::sqrt(total), 1.0);
}

PressSolver::~PressSolver() = default;

/// visit(i, j, weights of the corners, position, share of the undeformed area)
template <class Visit>
void PressSolver::contact_points(Visit visit) const {
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    const Vec3 around = 0.5 * ((mesh_.turn(1) * mesh_.position[j] - mesh_.position[j]) +
                               (mesh_.turn(1) * mesh_.position[j + 1] - mesh_.position[j + 1]));
    const double area = around.cross(mesh_.position[j + 1] - mesh_.position[j]).norm() / (kAround * kAcross);
    for (int i = 0; i < layout_.columns; ++i) {
      Vec3 corner[4];
      double lowest = 1.0;
      for (int n = 0; n < 4; ++n) {
        corner[n] = layout_.get(q_, i + kColumn[n], j + kRow[n], 0);
        lowest = std::min(lowest, corner[n].z());
      }
      if (lowest > top_) continue;
      for (int a = 0; a < kAround; ++a)
        for (int b = 0; b < kAcross; ++b) {
          const double u = (a + 0.5) / kAround, v = (b + 0.5) / kAcross;
          const std::array<double, 4> w{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
          visit(i, j, w, w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] + w[3] * corner[3], area);
        }
    }
  }
}

double PressSolver::contact(bool with_tangent) {
  double vertical = 0.0;
  const int across = layout_.rows - 2;
  contact_points([&](int i, int j, const std::array<double, 4>& w, const Vec3& x, double area) {
    const PressObstacle::Profile top = obstacle_.at(x.x());
    const double depth = top_ + top.height - x.z();
    if (depth <= 0.0) return;
    const double force = obstacle_.stiffness * area * depth;
    vertical += force;
    const Vec3 push(-top.slope * force, 0.0, force), normal(-top.slope, 0.0, 1.0);
    for (int n = 0; n < 4; ++n) {
      const int row = j + kRow[n], column = (i + kColumn[n]) % layout_.columns;
      layout_.set(r_, column, row, 0, layout_.get(r_, column, row, 0) - w[n] * push);
      if (!with_tangent || row < 1 || row > across) continue;
      for (int m = 0; m < 4; ++m) {
        const int other = j + kRow[m], other_column = (i + kColumn[m]) % layout_.columns;
        if (other < 1 || other > across) continue;
        for (const int a : {0, 2})
          for (const int b : {0, 2}) {
            const int r = 6 * (column * across + row - 1) + a,
                      c = 6 * (other_column * across + other - 1) + b;
            if (r >= c)
              linear_->entries.emplace_back(r, c,
                                            obstacle_.stiffness * area * w[n] * w[m] * normal[a] * normal[b]);
          }
      }
    }
  });
  return vertical;
}

/// Residual of a creep step (c = 1: of the static equations) and its norm; sets force_.
double PressSolver::evaluate(double c, const Field& e_old) {
  shell_.forces(q_, q_, e_old, c, r_);
  force_ = contact(false);
  double total = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j)
    for (int k = 0; k < 6; ++k) {
      const double* p = r_.data() + layout_.offset(j, k);
      const double scale = k < 3 ? 1.0 : 1.0 / (kDirectorLength * kDirectorLength);
      for (int i = 0; i < layout_.columns; ++i) total += scale * p[i] * p[i];
    }
  return std::sqrt(total);
}

void PressSolver::assemble(double c, const Field& e_old) {
  const int across = layout_.rows - 2, n = 6 * across * layout_.columns;
  auto& entries = linear_->entries;
  entries.clear();
  // The whole pattern, so that its analysis holds while contact comes and goes: contact couples nodes of one element.
  for (int j = 0; j + 1 < layout_.rows; ++j)
    for (int b = 0; b < layout_.batches(); ++b) {
      Lanes stress[kStrains];
      shell_.batch_stress_at(q_, e_old, c, j, b, stress);
      BatchNodes nodes;
      nodes.read(layout_, q_.data(), b * kLanes, j);
      linear_->tangent.compute(shell_.stiffness(j), nodes, stress, c, 1.0, shell_.pressure());
      for (int lane = 0; lane < kLanes && b * kLanes + lane < layout_.columns; ++lane) {
        int node[4];
        for (int m = 0; m < 4; ++m) {
          const int row = j + kRow[m] - 1;
          node[m] = row < 0 || row >= across
                        ? -1
                        : (b * kLanes + lane + kColumn[m]) % layout_.columns * across + row;
        }
        for (int r = 0; r < 24; ++r)
          for (int k = 0; k < 24; ++k) {
            if (node[r / 6] < 0 || node[k / 6] < 0) continue;
            const int row = 6 * node[r / 6] + r % 6, column = 6 * node[k / 6] + k % 6;
            if (row >= column)
              entries.emplace_back(row, column,
                                   r >= k ? linear_->tangent.k[r][k][lane] : linear_->tangent.k[k][r][lane]);
          }
      }
    }
  contact(true);
  linear_->matrix.resize(n, n);
  linear_->matrix.setFromTriplets(entries.begin(), entries.end());
}

/// One creep step of size h. @returns false when the tangent is not positive definite or Newton's method fails; q_ is
/// then unchanged
bool PressSolver::creep(double h) {
  const Field before = q_, e_old = strains_;
  const double c = 1.0 + kCreepTime / h;
  const int across = layout_.rows - 2;
  double norm = evaluate(c, e_old), first = norm;
  for (int n = 0; n < kMaxNewton && norm > kNewton * pressure_norm_; ++n) {
    assemble(c, e_old);
    if (!linear_->analyzed) linear_->llt.analyzePattern(linear_->matrix), linear_->analyzed = true;
    linear_->llt.factorize(linear_->matrix);
    if (linear_->llt.info() != Eigen::Success) {
      ++failed_;
      q_ = before;
      return false;
    }
    evaluate(c, e_old);
    Eigen::VectorXd rhs(linear_->matrix.rows());
    for (int k = 0; k < rhs.size(); ++k)
      rhs[k] = -r_[layout_.offset(1 + k / 6 % across, k % 6) + k / 6 / across];
    const Eigen::VectorXd change = linear_->llt.solve(rhs);
    const Field from = q_;
    double step = 1.0, next = 0.0;
    for (int cut = 0;; ++cut) {  // halved while the residual grows much
      for (int k = 0; k < rhs.size(); ++k) {
        const std::size_t at = layout_.offset(1 + k / 6 % across, k % 6) + k / 6 / across;
        q_[at] = from[at] + step * change[k];
      }
      layout_.fill_padding(q_);
      next = evaluate(c, e_old);
      if (cut == 5 || (std::isfinite(next) && next < 3.0 * norm)) break;
      step *= 0.5;
    }
    norm = next;
    if (!(norm < 1e3 * std::max(first, 1e-3 * pressure_norm_))) break;
  }
  if (!(norm <= kNewton * pressure_norm_)) {
    q_ = before;
    return false;
  }
  shell_.strains(q_, strains_);
  return true;
}

PressPoint PressSolver::press(double deflection) {
  PressPoint point;
  point.deflection = deflection;
  top_ = deflection - start_radius_;
  failed_ = 0;
  double h = kFirstStep;
  for (point.creep_steps = 0; point.creep_steps < kMaxSteps;) {
    if (!creep(h)) {
      h *= 0.25;
      if (h < 1e-8) break;
      continue;
    }
    ++point.creep_steps;
    const double norm = evaluate(1.0, strains_);
    point.force = force_;
    point.residual = norm / (force_ > kLeastLoad ? force_ : pressure_norm_);
    if (point.residual <= kTolerance && h >= kStaticStep) {
      point.failed_factorizations = failed_;
      const TireStatus status = clearance_.status(clearance_.measure(layout_, q_, RimState{}));
      if (!status.converged)
        throw physics_error(status.message("", fmt::format(" at a deflection of {:.4g} m", deflection)));
      return point;
    }
    h = std::min((failed_ > 0 ? 1.5 : 3.0) * h, kLargestStep);
  }
  throw physics_error(fmt::format(
      "the tire found no static equilibrium at a deflection of {:.4g} m: residual {:.2g} of the load after "
      "{} creep steps, allowed {:.0e}; try smaller steps of deflection or a finer mesh",
      deflection, point.residual, point.creep_steps, kTolerance));
}

std::vector<PressSample> PressSolver::footprint() const {
  std::vector<PressSample> samples;
  contact_points([&](int, int, const std::array<double, 4>&, const Vec3& x, double area) {
    const double depth = top_ + obstacle_.at(x.x()).height - x.z();
    if (depth > 0.0) samples.push_back({x.x(), x.y(), area, obstacle_.stiffness * depth});
  });
  return samples;
}

}  // namespace furrow
