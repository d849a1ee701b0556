#include "tire/ring/ring_solver.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "tire/ring/round_off_end.hpp"

namespace furrow::tire {
namespace {

constexpr double kForceTolerance = 1e-11;  // of the force that moves a segment by the radius
constexpr double kEnough = 4.0;            // round-offs of an entry of the gradient
constexpr double kGainsNothing = 32.0;     // round-offs of an entry, if a step gains nothing
constexpr double kGapTolerance = 1e-12;    // of the radius
constexpr double kLongestStep = 0.3;       // of the radius
constexpr int kFullSteps = 12;             // from then on steps are halved

}  // namespace

RingSolver::RingSolver(const RingParams& params, const RingGround& ground)
    : ring_(params), contact_(ring_, ground), step_(params.segments), n_(params.segments) {
  q_ = gradient_ = rest_ = ring_.zero();
  tangent_ = ring_.no_tangent();
  gaps_.resize(n_);
  set_.segment.resize(n_), set_.segment_force.resize(n_);
  for (auto* corners : {&corners_, &corners_before_}) corners->reserve(RingContact::kMostCornerGaps);
  for (ContactSet* set : {&set_, &set_before_})
    set->corner.reserve(RingContact::kMostCornerGaps), set->corner_force.reserve(RingContact::kMostCornerGaps);
}

void RingSolver::restart(const RingField& state, const std::vector<char>& closed_segments) {
  q_ = state;
  set_.segment = closed_segments;
  std::fill(set_.corner.begin(), set_.corner.end(), 0);
}

RingReport RingSolver::solve(const AxlePlace& axle) {
  contact_.place(axle);
  RingReport report;
  RoundOffEnd end;
  for (report.steps = 0;; ++report.steps) {
    report.crowded = !evaluate();
    if (report.crowded) break;
    const double smallest = kForceTolerance * ring_.radius() * std::abs(ring_.slope(0.0));
    const double enough = smallest + kEnough * ring_.rounding(q_);
    const double force_tolerance = smallest + kGainsNothing * ring_.rounding(q_);
    const double gap_tolerance = kGapTolerance * ring_.radius();
    report.residuals[report.steps] = report.residual = free_residual();
    judge(report);
    const bool near =
        report.residual <= force_tolerance && report.penetration <= gap_tolerance && report.pull <= force_tolerance;
    report.converged = end.reached(report.residual, enough, near);
    if (report.converged || report.steps == RingReport::kMostSteps) break;
    const int systems = step(force_tolerance, gap_tolerance);
    report.systems += systems;
    report.same_set[report.steps] = systems == 1;
    if (systems == 0) break;
    const RingField& change = step_.change();
    double largest = 0.0;
    for (int j = 0; j < n_; ++j) largest = std::max({largest, std::abs(change.u[j]), std::abs(change.v[j])});
    const double share =
        (report.steps < kFullSteps ? 1.0 : 0.5) * std::min(1.0, kLongestStep * ring_.radius() / largest);
    for (int j = 0; j < n_; ++j) q_.u[j] += share * change.u[j], q_.v[j] += share * change.v[j];
  }
  return report;
}

/// Computes Δ with the exact tangent. If there is no minimum, because the belt would slide over a corner, computes it
/// without the corners' curvature; this tangent always has a minimum. @returns linear systems solved; 0: failed
int RingSolver::step(double force_tolerance, double gap_tolerance) {
  set_before_ = set_;
  for (const bool exact : {true, false}) {
    ring_.tangent(q_, tangent_);
    if (exact) add_bends();
    set_ = set_before_;
    if (const int systems = step_.solve({tangent_, gradient_, gaps_, corners_, force_tolerance, gap_tolerance}, set_))
      return systems;
  }
  return 0;
}

/// @returns whether the corners near the belt are few enough
bool RingSolver::evaluate() {
  ring_.gradient(q_, gradient_);
  for (int j = 0; j < n_; ++j) {
    gaps_[j] = contact_.segment(q_, j);
    if (!std::isfinite(gaps_[j].gap)) set_.segment[j] = 0;
  }
  return carry_corners();
}

/// Keeps a corner's gap closed while the belt moves over it. Both lists have the corners in the same order.
bool RingSolver::carry_corners() {
  std::swap(corners_, corners_before_);
  std::swap(set_.corner, set_before_.corner), std::swap(set_.corner_force, set_before_.corner_force);
  corners_.clear();
  const bool all = contact_.corners(q_, corners_);
  set_.corner.assign(corners_.size(), 0), set_.corner_force.assign(corners_.size(), 0.0);
  std::size_t old = 0;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    while (old < corners_before_.size() && corners_before_[old].corner < corners_[k].corner) ++old;
    if (old == corners_before_.size()) break;
    if (corners_before_[old].corner != corners_[k].corner) continue;
    set_.corner[k] = set_before_.corner[old], set_.corner_force[k] = set_before_.corner_force[old];
  }
  return all;
}

/// Sets the segments' contact forces. @returns the largest force that contact does not balance
double RingSolver::free_residual() {
  rest_.u = gradient_.u, rest_.v = gradient_.v;
  for (std::size_t k = 0; k < corners_.size(); ++k) {
    if (!set_.corner[k]) continue;
    const double mu = set_.corner_force[k];
    for (int side = 0; side < 3; ++side) {
      const int j = (corners_[k].first + side) % n_;
      rest_.u[j] -= mu * corners_[k].slope[2 * side], rest_.v[j] -= mu * corners_[k].slope[2 * side + 1];
    }
  }
  double largest = 0.0;
  for (int j = 0; j < n_; ++j) {
    double u = rest_.u[j], v = rest_.v[j];
    if (set_.segment[j]) {
      const double du = gaps_[j].du, dv = gaps_[j].dv;
      const double force = set_.segment_force[j] = (u * du + v * dv) / (du * du + dv * dv);
      u -= force * du, v -= force * dv;
    }
    largest = std::max({largest, std::abs(u), std::abs(v)});
  }
  return largest;
}

/// Sets the report's largest penetration and pull.
void RingSolver::judge(RingReport& report) const {
  report.penetration = report.pull = 0.0;
  const auto look = [&](bool on, double gap, double force) {
    report.penetration = std::max(report.penetration, on ? std::abs(gap) : -gap);
    if (on) report.pull = std::max(report.pull, -force);
  };
  for (int j = 0; j < n_; ++j) look(set_.segment[j], gaps_[j].gap, set_.segment_force[j]);
  for (std::size_t k = 0; k < corners_.size(); ++k) look(set_.corner[k], corners_[k].gap, set_.corner_force[k]);
}

/// Adds the curvature of the closed corner gaps to the tangent.
void RingSolver::add_bends() {
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (set_.corner[k] && set_.corner_force[k] > 0.0)
      add_local(tangent_, corners_[k].first, corners_[k].bend, -set_.corner_force[k]);
}

RingForce RingSolver::ground_force() const {
  RingForce sum;
  for (int j = 0; j < n_; ++j)
    if (set_.segment[j])
      sum.x += set_.segment_force[j] * gaps_[j].push_x, sum.z += set_.segment_force[j] * gaps_[j].push_z;
  for (std::size_t k = 0; k < corners_.size(); ++k)
    if (set_.corner[k])
      sum.x += set_.corner_force[k] * corners_[k].push_x, sum.z += set_.corner_force[k] * corners_[k].push_z;
  return sum;
}

}  // namespace furrow::tire
