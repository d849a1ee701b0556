#include "tire/planar/planar_static.hpp"

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "protocol/core/assert.hpp"
#include "protocol/files/memory_limit.hpp"
#include "tire/lone_thread.hpp"

namespace furrow::tire {
namespace {

constexpr double kTolerance = 1e-8;  // of the free forces, relative to the ground's
constexpr double kLeastForce = 1.0;  // N, below which they are relative to it
constexpr double kRounding = 1e-14;  // of the largest stiffness × size
constexpr double kLongest = 0.02;    // of the radius: a longer displacement is made in parts
constexpr int kMostHalvings = 8, kMostSteps = 200, kMostCuts = 25;
constexpr double kHold = 10.0;  // stiffness that holds the rim, in the disc's modulus × area
constexpr double kFirstShare = 1e-5, kLastShare = 1e3, kMoreShare = 4.0;

using Entries = std::vector<std::pair<int, double>>;  // of a vector: row, value

int unknown(int node) { return 2 * (node - 1); }
/// Number of rows of touch_stiffness() that belong to nodes.
int touch_size(const PlanarTouch& t) { return t.b < 0 ? 2 : 4; }
int touch_unknown(const PlanarTouch& t, int row) { return unknown(row < 2 ? t.a : t.b) + row % 2; }

}  // namespace

/// Unknowns: x, z of every node but the centre, which is the first.
struct PlanarStatic::Linear {
  std::vector<Eigen::Triplet<double>> entries;
  Eigen::SparseMatrix<double> matrix, shifted;  // lower triangles
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> llt;
  Eigen::VectorXd diagonal, right, way;
  bool analyzed = false;

  void add(int row, int column, double value) {
    if (row >= column && column >= 0) entries.emplace_back(row, column, value);
  }
  /// Adds the matrix of rank one factor × g gᵀ. Entries of the same row add up.
  void add_outer(Entries& g, double factor) {
    std::sort(g.begin(), g.end());
    std::size_t kept = 0;
    for (std::size_t k = 1; k < g.size(); ++k) {
      if (g[k].first == g[kept].first)
        g[kept].second += g[k].second;
      else
        g[++kept] = g[k];
    }
    g.resize(g.empty() ? 0 : kept + 1);
    for (const auto& [row, a] : g)
      for (const auto& [column, b] : g) add(row, column, factor * a * b);
  }
};

PlanarStatic::PlanarStatic(const PlanarParams& params, PlanarGround ground)
    : mesh_(planar_wheel(params.size)),
      elements_(planar_elements(mesh_, params)),
      contact_(mesh_, std::move(ground), {params.contact_stiffness * params.options.width, 0.0}),
      x_(mesh_.position),
      still_(mesh_.position.size()),
      force_(mesh_.position.size()),
      linear_(std::make_unique<Linear>()) {
  FURROW_ASSERT(mesh_.centre == 0, mesh_.centre);
  centre_ = {0.0, contact_.ground().top() + params.size.radius};
  for (double& z : x_.z) z += centre_.z;
  for (const int n : mesh_.rim)
    inertia_ += mesh_.position.x[n] * mesh_.position.x[n] + mesh_.position.z[n] * mesh_.position.z[n];
  spring_ = kHold * params.disc.young_modulus * params.size.rim_radius * params.size.rim_radius * params.options.width;
  require_blas_buffers();
  linear_->llt.cholmod().print = 0;  // tangents that are not positive definite are handled
  linear_->right.resize(2 * (mesh_.nodes() - 1));
  assemble();
  linear_->diagonal = linear_->matrix.diagonal();
}

PlanarStatic::~PlanarStatic() = default;

/// Mean turn about +y of the rim about the centre.
double PlanarStatic::turn(const PlanarField& x) const {
  double sum = 0.0;
  for (const int n : mesh_.rim)
    sum += mesh_.position.z[n] * (x.x[n] - centre_.x) - mesh_.position.x[n] * (x.z[n] - centre_.z);
  return sum / inertia_;
}

double PlanarStatic::couple() const { return -spring_ * turn(x_); }

double PlanarStatic::potential(const PlanarField& x) {
  contact_.find(x);
  const double theta = turn(x);
  return elements_.energy(x) + contact_.energy() + 0.5 * spring_ * theta * theta;
}

double PlanarStatic::gradient(const PlanarField& x) {
  if (!elements_.force(x, still_, force_)) return std::nan("");
  contact_.find(x);
  for (const PlanarTouch& t : contact_.touches()) {
    const int b = t.b < 0 ? t.a : t.b;
    force_.x[t.a] += (1.0 - t.share) * t.force * t.push_x, force_.z[t.a] += (1.0 - t.share) * t.force * t.push_z;
    force_.x[b] += t.share * t.force * t.push_x, force_.z[b] += t.share * t.force * t.push_z;
  }
  const double moment = spring_ * turn(x) / inertia_;
  for (const int n : mesh_.rim)
    force_.x[n] -= moment * mesh_.position.z[n], force_.z[n] += moment * mesh_.position.x[n];
  double most = 0.0;
  for (int n = 1; n < mesh_.nodes(); ++n) {
    linear_->right[unknown(n)] = force_.x[n], linear_->right[unknown(n) + 1] = force_.z[n];
    most = std::max({most, std::abs(force_.x[n]), std::abs(force_.z[n])});
  }
  return most;
}

/// Stiffness of a touch in x, z of its nodes a and b and of the ground. Of ½ c h²: c ∇h ∇hᵀ, and on a side of the
/// length L, with its direction t, its normal m inwards and u the motion against the ground where it touches,
/// c h d²h = c h [(2/L) m·(u_b − u_a) t·u − h/L² (m·(u_b − u_a))²]. A ground that sticks adds s c (t·u)².
PlanarMatrix PlanarStatic::touch_stiffness(const PlanarTouch& t, double tangential) const {
  using Motion = Eigen::Matrix<double, 6, 1>;
  const double c = contact_.law().stiffness, of_a = 1.0 - t.share, of_b = t.share;
  const auto against_ground = [&](double x, double z) {
    return Motion{of_a * x, of_a * z, of_b * x, of_b * z, -x, -z};
  };
  const Motion closes = against_ground(t.push_x, t.push_z), slides = against_ground(t.push_z, -t.push_x);
  PlanarMatrix k = c * (closes * closes.transpose() + tangential * slides * slides.transpose());
  if (t.b < 0 || t.share <= 0.0 || t.share >= 1.0) return k;
  const double length = std::hypot(x_.x[t.b] - x_.x[t.a], x_.z[t.b] - x_.z[t.a]), slope = t.depth / length;
  const Motion turns{-t.push_x, -t.push_z, t.push_x, t.push_z, 0.0, 0.0};
  k += c * slope * (turns * slides.transpose() + slides * turns.transpose() - slope * turns * turns.transpose());
  return k;
}

/// The sparsity pattern is always the same: touches add to entries that the elements fill.
/// @param tangential s of touch_stiffness()
void PlanarStatic::assemble(double tangential) {
  Linear& l = *linear_;
  l.entries.clear();
  const std::vector<double> pressure = elements_.volumetric(x_);
  for (int e = 0; e < elements_.size(); ++e) {
    const auto node = elements_.element(e).node;
    const PlanarMatrix k = element_tangent(elements_, x_, e, pressure[e]);
    for (int r = 0; r < 6; ++r)
      for (int c = 0; c < 6; ++c) l.add(unknown(node[r / 2]) + r % 2, unknown(node[c / 2]) + c % 2, k(r, c));
  }
  Entries g;
  for (const PlanarElements::Patch& patch : elements_.patches()) {
    g.clear();
    double volume = 0.0;
    for (const int e : patch.elements) {
      const auto part = volume_gradient(elements_, x_, e);
      const auto f = elements_.gradient(x_, e);
      volume += elements_.element(e).area * (f[0] * f[3] - f[1] * f[2]);
      for (int r = 0; r < 6; ++r)
        g.emplace_back(unknown(elements_.element(e).node[r / 2]) + r % 2, part[r] / (3.0 * patch.area));
    }
    const double j = volume / (3.0 * patch.area);
    l.add_outer(g, elements_.options().width * patch.area * patch.kappa * (1.0 + 1.0 / (j * j)));
  }
  g.clear();
  for (const int n : mesh_.rim) {
    g.emplace_back(unknown(n), mesh_.position.z[n] / inertia_);
    g.emplace_back(unknown(n) + 1, -mesh_.position.x[n] / inertia_);
  }
  l.add_outer(g, spring_);
  for (const PlanarTouch& t : contact_.touches()) {
    const PlanarMatrix k = touch_stiffness(t, tangential);
    for (int r = 0; r < touch_size(t); ++r)
      for (int c = 0; c < touch_size(t); ++c) l.add(touch_unknown(t, r), touch_unknown(t, c), k(r, c));
  }
  const int n = 2 * (mesh_.nodes() - 1);
  l.matrix.resize(n, n);
  l.matrix.setFromTriplets(l.entries.begin(), l.entries.end());
}

bool PlanarStatic::factorize(double share) {
  Linear& l = *linear_;
  l.shifted = l.matrix;
  if (share > 0.0) l.shifted.diagonal() += share * l.diagonal;
  if (!l.analyzed) l.llt.analyzePattern(l.shifted);
  l.analyzed = true;
  const LoneThread alone;
  l.llt.factorize(l.shifted);
  return l.llt.info() == Eigen::Success;
}

/// Follows the step as far as the potential falls, or the residual if round-off hides the potential.
bool PlanarStatic::descend(double& energy, double& residual) {
  double share = 1.0;
  for (int cut = 0; cut < kMostCuts; ++cut, share *= 0.5) {
    trial_ = x_;
    for (int n = 1; n < mesh_.nodes(); ++n)
      trial_.x[n] += share * linear_->way[unknown(n)], trial_.z[n] += share * linear_->way[unknown(n) + 1];
    const double left = gradient(trial_);
    if (!std::isfinite(left)) continue;
    const double now = potential(trial_);
    if (!(now < energy) && !(left < residual)) continue;
    std::swap(x_, trial_);
    energy = now, residual = left;
    return true;
  }
  return false;
}

PlanarReport PlanarStatic::solve() {
  PlanarReport report;
  report.residual = gradient(x_);
  const double size = std::abs(centre_.x) + std::abs(centre_.z) + std::abs(mesh_.position.z[mesh_.outer[0]]);
  const double rounding = kRounding * linear_->diagonal.maxCoeff() * size;
  double energy = potential(x_);
  for (report.steps = 0; report.steps < kMostSteps && std::isfinite(report.residual); ++report.steps) {
    report.converged = report.residual <= std::max(rounding, kTolerance * std::max(kLeastForce, std::abs(force())));
    if (report.converged) break;
    assemble();
    double share = 0.0;
    while (!factorize(share)) {
      ++report.indefinite;
      share = share == 0.0 ? kFirstShare : kMoreShare * share;
      if (share > kLastShare) return report;
    }
    linear_->way = linear_->llt.solve(linear_->right);
    if (!descend(energy, report.residual)) break;
  }
  return report;
}

Wrench PlanarStatic::rim() const {
  Wrench sum;
  for (const PlanarTouch& t : contact_.touches()) {
    const int b = t.b < 0 ? t.a : t.b;
    const Vec3 at((1.0 - t.share) * x_.x[t.a] + t.share * x_.x[b] - centre_.x, 0.0,
                  (1.0 - t.share) * x_.z[t.a] + t.share * x_.z[b] - centre_.z);
    const Vec3 force = t.force * Vec3(t.push_x, 0.0, t.push_z);
    sum.force += force, sum.moment += at.cross(force);
  }
  return sum;
}

GroundStiffness PlanarStatic::ground_stiffness(double tangential) {
  GroundStiffness out = GroundStiffness::Constant(std::nan(""));
  assemble(tangential);
  if (!factorize(0.0)) return out;
  Eigen::Matrix2d direct = Eigen::Matrix2d::Zero();
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(linear_->matrix.rows(), 2);
  for (const PlanarTouch& t : contact_.touches()) {
    const PlanarMatrix k = touch_stiffness(t, tangential);
    direct += k.bottomRightCorner<2, 2>();
    for (int r = 0; r < touch_size(t); ++r) pull.row(touch_unknown(t, r)) += k.block<1, 2>(r, 4);
  }
  const Eigen::MatrixXd way = linear_->llt.solve(pull);
  const Eigen::Matrix2d s = direct - pull.transpose() * way;
  const std::array<int, 2> place{0, 2};
  for (int r = 0; r < 2; ++r)
    for (int c = 0; c < 2; ++c) out(place[r], place[c]) = 0.5 * (s(r, c) + s(c, r));
  return out;
}

PlanarReport PlanarStatic::move_to(PlanarPoint centre) {
  PlanarReport total;
  double step = kLongest * std::abs(mesh_.position.z[mesh_.outer[0]]);
  int halvings = 0;
  for (;;) {
    const double dx = centre.x - centre_.x, dz = centre.z - centre_.z, left = std::hypot(dx, dz);
    const double part = left <= step ? 1.0 : step / left;
    const PlanarField found = x_;
    const PlanarPoint from = centre_;
    for (double& x : x_.x) x += part * dx;
    for (double& z : x_.z) z += part * dz;
    centre_ = part == 1.0 ? centre : PlanarPoint{from.x + part * dx, from.z + part * dz};
    x_.x[0] = centre_.x, x_.z[0] = centre_.z;
    const PlanarReport report = solve();
    total.steps += report.steps, total.indefinite += report.indefinite;
    total.residual = report.residual, total.converged = report.converged;
    if (report.converged) {
      if (part == 1.0) return total;
    } else {
      if (++halvings > kMostHalvings) return total;
      step *= 0.5, x_ = found, centre_ = from;
    }
  }
}

}  // namespace furrow::tire
