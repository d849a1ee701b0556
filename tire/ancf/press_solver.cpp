#include "tire/ancf/press_solver.hpp"

#include <fmt/format.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Sparse>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/memory_limit.hpp"
#include "tire/ancf/inflation.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_tangent.hpp"
#include "tire/lone_thread.hpp"

namespace furrow::tire {
namespace {

constexpr double kTolerance = 1e-6;       // of the free residual, relative to the load
constexpr double kDirectorLength = 0.01;  // m, makes director residuals (N m) comparable with forces
constexpr double kMinLoad = 1.0;          // N, below which the residual is relative to the pressure forces
constexpr double kMinViscosity = 1e-3;    // σ = τ/h: first value if the tangent is not positive definite
constexpr double kMaxViscosity = 1e6;
constexpr double kRounding = 1e-13;  // of the potential, relative to its elastic part and p V
constexpr int kMaxSteps = 1500;
constexpr int kMaxCuts = 12;
constexpr double kShortStep = 0.2;                        // share of a step below which σ grows
constexpr int kAround = 6, kAcross = 4, kMaxAround = 64;  // contact points of an element
constexpr int kColumn[4] = {0, 1, 1, 0}, kRow[4] = {0, 0, 1, 1};

/// Number of points such that a bar's top, or its edge if that is longer, meets at least two.
int points_around(const ShellMesh& mesh, const PressObstacle& obstacle) {
  if (obstacle.height <= 0.0) return kAround;
  double longest = 0.0;
  for (const Vec3& x : mesh.position) longest = std::max(longest, (mesh.turn(1) * x - x).norm());
  const double points = std::ceil(2.0 * longest / std::max(obstacle.width, obstacle.edge));
  return static_cast<int>(std::clamp(points, double{kAround}, double{kMaxAround}));
}

}  // namespace

/// The tangent of the free coordinates, 6 (column × rows between the beads + row) + component, and its factor.
struct PressSolver::Linear {
  Eigen::SparseMatrix<double> matrix;  // lower triangle
  Eigen::CholmodSupernodalLLT<Eigen::SparseMatrix<double>, Eigen::Lower> llt;
  BatchTangent tangent;
  std::vector<std::array<int, 300>> slot;  // of each element: places of its matrix's lower triangle; −1: a bead's

  static int at(int r, int k) { return r >= k ? r * (r + 1) / 2 + k : k * (k + 1) / 2 + r; }

  explicit Linear(const ShellLayout& layout) {
    const int across = layout.rows - 2, n = 6 * across * layout.columns;
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<std::array<int, 24>> unknowns;
    for (int j = 0; j + 1 < layout.rows; ++j)
      for (int i = 0; i < layout.columns; ++i) {
        std::array<int, 24>& u = unknowns.emplace_back();
        for (int r = 0; r < 24; ++r) {
          const int row = j + kRow[r / 6] - 1, column = (i + kColumn[r / 6]) % layout.columns;
          u[r] = row < 0 || row >= across ? -1 : 6 * (column * across + row) + r % 6;
        }
        for (const int r : u)
          for (const int k : u)
            if (k >= 0 && r >= k) entries.emplace_back(r, k, 0.0);
      }
    matrix.resize(n, n);
    matrix.setFromTriplets(entries.begin(), entries.end());
    slot.resize(unknowns.size());
    for (std::size_t e = 0; e < slot.size(); ++e)
      for (int r = 0; r < 24; ++r)
        for (int k = 0; k <= r; ++k) {
          const int low = std::min(unknowns[e][r], unknowns[e][k]), high = std::max(unknowns[e][r], unknowns[e][k]);
          slot[e][at(r, k)] = low < 0 ? -1 : static_cast<int>(&matrix.coeffRef(high, low) - matrix.valuePtr());
        }
    require_blas_buffers();
    llt.cholmod().print = 0;
    llt.analyzePattern(matrix);
  }

  /// @returns whether the matrix is positive definite
  bool factorize() {
    const LoneThread alone;
    llt.factorize(matrix);
    return llt.info() == Eigen::Success;
  }

  /// Index of unknown k in a field.
  static std::size_t place(const ShellLayout& layout, int k) {
    const int across = layout.rows - 2;
    return layout.offset(1 + k / 6 % across, k % 6) + k / 6 / across;
  }
  Eigen::VectorXd gather(const ShellLayout& layout, const Field& f) const {
    Eigen::VectorXd v(matrix.rows());
    for (int k = 0; k < v.size(); ++k) v[k] = f[place(layout, k)];
    return v;
  }
  void add(int element, int r, int k, double value) {
    if (const int to = slot[element][at(r, k)]; to >= 0) matrix.valuePtr()[to] += value;
  }
};

PressSolver::PressSolver(const TireFile& file, const ShellMesh& mesh, const Field& inflated,
                         const PressObstacle& obstacle)
    : mesh_(mesh),
      shell_(file, mesh),
      layout_(shell_.layout()),
      obstacle_(obstacle),
      left_(obstacle.left()),
      up_(obstacle.up()),
      clearance_(file, mesh),
      q_(inflated),
      r_(layout_.size()),
      around_(points_around(mesh, obstacle)),
      linear_(std::make_unique<Linear>(layout_)) {
  shell_.strains(q_, strains_);
  for (int j = 0; j < layout_.rows; ++j) {
    largest_radius_ = std::max(largest_radius_, layout_.get(q_, 0, j, 0).z());
    for (int i = 0; i < layout_.columns; ++i)
      start_height_ = std::max(start_height_, -up_.dot(layout_.get(q_, i, j, 0)));
  }
  top_ = -start_height_;
  ShellCarcass bare = shell_;
  bare.set_pressure(0.0);
  Field without(layout_.size());
  shell_.forces(q_, q_, strains_, 0.0, r_);
  bare.forces(q_, q_, strains_, 0.0, without);
  double total = 0.0;
  for (std::size_t k = layout_.free_begin(); k < layout_.free_begin() + layout_.free_size(); ++k)
    total += (r_[k] - without[k]) * (r_[k] - without[k]);
  pressure_norm_ = std::max(std::sqrt(total), 1.0);
  rounding_ = kRounding * (shell_.account(q_, strains_).elastic + shell_.pressure() * shell_.volume(q_, Vec3::Zero()));
}

PressSolver::~PressSolver() = default;

/// Calls visit(i, j, weights of the corners, position, share of the undeformed area), at least for points below the
/// obstacle's top.
template <class Visit>
void PressSolver::contact_points(Visit visit) const {
  for (int j = 0; j + 1 < layout_.rows; ++j) {
    const Vec3 around = 0.5 * ((mesh_.turn(1) * mesh_.position[j] - mesh_.position[j]) +
                               (mesh_.turn(1) * mesh_.position[j + 1] - mesh_.position[j + 1]));
    const double area = around.cross(mesh_.position[j + 1] - mesh_.position[j]).norm() / (around_ * kAcross);
    for (int i = 0; i < layout_.columns; ++i) {
      Vec3 corner[4];
      double lowest = std::numeric_limits<double>::max();
      for (int n = 0; n < 4; ++n) {
        corner[n] = layout_.get(q_, i + kColumn[n], j + kRow[n], 0);
        lowest = std::min(lowest, up_.dot(corner[n]));
      }
      if (lowest > top_) continue;
      for (int a = 0; a < around_; ++a)
        for (int b = 0; b < kAcross; ++b) {
          const double u = (a + 0.5) / around_, v = (b + 0.5) / kAcross;
          const std::array<double, 4> w{(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
          visit(i, j, w, w[0] * corner[0] + w[1] * corner[1] + w[2] * corner[2] + w[3] * corner[3], area);
        }
    }
  }
}

/// Depth of a point, m; its part of the contact's stiffness acts along −∂depth/∂x.
double PressSolver::depth(const Vec3& x, const PressObstacle::Profile& top) const {
  return top_ + top.height - up_.dot(x);
}

Vec3 PressSolver::normal(const PressObstacle::Profile& top) const { return up_ - top.slope * Vec3::UnitX(); }

/// Adds the contact to r_, rim_ and potential_, or to the tangent.
void PressSolver::contact(bool tangent) {
  contact_points([&](int i, int j, const std::array<double, 4>& w, const Vec3& x, double area) {
    const PressObstacle::Profile top = obstacle_.at(x.x());
    const double depth = this->depth(x, top);
    if (depth <= 0.0) return;
    const double stiffness = obstacle_.stiffness * area;
    const Vec3 normal = this->normal(top);
    if (tangent) {
      const double bend = depth * top.curvature;
      for (int n = 0; n < 4; ++n)
        for (int m = 0; m <= n; ++m)
          for (int a = 0; a < 3; ++a)
            for (int b = 0; b < 3; ++b)
              if (6 * n + a >= 6 * m + b)
                linear_->add(j * layout_.columns + i, 6 * n + a, 6 * m + b,
                             stiffness * w[n] * w[m] * (normal[a] * normal[b] + (a + b == 0 ? bend : 0.0)));
      return;
    }
    potential_ += 0.5 * stiffness * depth * depth;
    const Vec3 force = stiffness * depth * Vec3(-top.slope, 0.0, 1.0);  // in the ground's axes, like the position
    rim_.force += force, rim_.moment += Vec3(x.x(), left_.dot(x), up_.dot(x)).cross(force);
    for (int n = 0; n < 4; ++n) {
      const int row = j + kRow[n], column = (i + kColumn[n]) % layout_.columns;
      layout_.set(r_, column, row, 0, layout_.get(r_, column, row, 0) - w[n] * stiffness * depth * normal);
    }
  });
}

/// Computes ∂Π/∂q in r_, Π in potential_ and the rim's wrench in rim_. @returns the free residual's norm
double PressSolver::evaluate() {
  potential_ = shell_.account(q_, strains_).elastic - shell_.pressure() * shell_.volume(q_, Vec3::Zero());
  shell_.forces(q_, q_, strains_, 1.0, r_);
  rim_ = {};
  contact(false);
  double total = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j)
    for (int k = 0; k < 6; ++k) {
      const double* p = r_.data() + layout_.offset(j, k);
      const double scale = k < 3 ? 1.0 : 1.0 / (kDirectorLength * kDirectorLength);
      for (int i = 0; i < layout_.columns; ++i) total += scale * p[i] * p[i];
    }
  return std::sqrt(total);
}

/// Computes ∂²Π/∂q² + σ K_material at q_ without the contact's part.
void PressSolver::assemble() {
  linear_->matrix.coeffs().setZero();
  for (int j = 0; j + 1 < layout_.rows; ++j)
    for (int b = 0; b < layout_.batches(); ++b) {
      Double4 stress[kStrains];
      shell_.batch_stress_at(q_, strains_, 1.0, j, b, stress);
      BatchNodes nodes;
      nodes.read(layout_, q_.data(), b * kDoubleLanes, j);
      linear_->tangent.compute(shell_.stiffness(j), nodes, stress, 1.0 + viscosity_, 1.0, shell_.pressure());
      for (int lane = 0; lane < kDoubleLanes && b * kDoubleLanes + lane < layout_.columns; ++lane)
        for (int r = 0; r < 24; ++r)
          for (int k = 0; k <= r; ++k)
            linear_->add(j * layout_.columns + b * kDoubleLanes + lane, r, k, linear_->tangent.k[r][k][lane]);
    }
}

/// Factors ∂²Π/∂q² + σ K_material at q_. @returns false when it is not positive definite
bool PressSolver::factorize() {
  assemble();
  contact(true);
  return linear_->factorize();
}

/// One step of creep, with a factor in place; `norm` is the residual's norm before and after.
/// @returns the share of the step that was made; 0: the potential does not fall along it, q_ is unchanged
double PressSolver::creep(double& norm) {
  const Eigen::VectorXd gradient = linear_->gather(layout_, r_), change = -linear_->llt.solve(gradient);
  const double slope = gradient.dot(change), start = potential_, norm_before = norm;
  const Field from = q_;
  double step = 1.0;
  for (int cut = 0; cut <= kMaxCuts; ++cut, step *= 0.5) {
    move(from, change, step);
    norm = evaluate();
    // If the potential changes by less than its rounding errors, the residual decides.
    if (-slope < rounding_ ? norm < 2.0 * norm_before : potential_ < start + 1e-4 * step * slope) return step;
  }
  q_ = from;
  norm = evaluate();
  return 0.0;
}

void PressSolver::move(const Field& from, const Eigen::VectorXd& change, double share) {
  for (int k = 0; k < change.size(); ++k) {
    const std::size_t at = Linear::place(layout_, k);
    q_[at] = from[at] + share * change[k];
  }
  layout_.fill_padding(q_);
}

/// Moves the obstacle and, to first order with the factor of the last point, the touching points. So the step follows a
/// slow motion and not a sudden release.
void PressSolver::follow(double top) {
  const double rise = top - top_;
  if (!(force() > 0.0)) {
    top_ = top;
    return;
  }
  Field pull(layout_.size(), 0.0);
  contact_points([&](int i, int j, const std::array<double, 4>& w, const Vec3& x, double area) {
    const PressObstacle::Profile at = obstacle_.at(x.x());
    if (depth(x, at) <= 0.0) return;
    const Vec3 force = obstacle_.stiffness * area * rise * normal(at);
    for (int n = 0; n < 4; ++n) {
      const int row = j + kRow[n], column = (i + kColumn[n]) % layout_.columns;
      layout_.set(pull, column, row, 0, layout_.get(pull, column, row, 0) + w[n] * force);
    }
  });
  top_ = top;
  move(Field(q_), linear_->llt.solve(linear_->gather(layout_, pull)), 1.0);
}

PressPoint PressSolver::press(double deflection, const std::function<void()>& each_step) {
  FURROW_ASSERT(std::isfinite(deflection), deflection);
  PressPoint point;
  point.deflection = deflection;
  follow(deflection - start_height_);
  viscosity_ = 0.0;
  double norm = evaluate();
  for (; point.creep_steps < kMaxSteps && viscosity_ < kMaxViscosity; ++point.creep_steps) {
    if (each_step) each_step();
    const bool definite = factorize();
    if (!definite) ++point.failed_factorizations;
    point.force = force(), point.rim = rim_;
    point.residual = norm / (force() > kMinLoad ? force() : pressure_norm_);
    if (definite && viscosity_ == 0.0 && point.residual <= kTolerance) {
      const Outcome outcome = clearance_.outcome(clearance_.measure(layout_, q_, RimState{}));
      if (!outcome.ok) throw physics_error(outcome, "tire", fmt::format(" at a deflection of {:.4g} m", deflection));
      return point;
    }
    const double share = definite ? creep(norm) : 0.0;
    if (share < kShortStep)
      viscosity_ = std::max(4.0 * viscosity_, kMinViscosity);
    else if (share == 1.0)
      viscosity_ = viscosity_ > kMinViscosity ? 0.5 * viscosity_ : 0.0;
  }
  const std::string how = viscosity_ < kMaxViscosity
                              ? fmt::format("residual {:.2g} of the load, allowed {:.0e}", point.residual, kTolerance)
                              : std::string("its stiffness is not positive definite there, creep or not");
  throw physics_error(
      fmt::format("the tire found no static equilibrium at a deflection of {:.4g} m after {} creep steps: "
                  "{}; try smaller steps of "
                  "deflection, a finer mesh or more pressure",
                  deflection, point.creep_steps, how));
}

double PressSolver::runout() const {
  double most = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j) {
    double low = 1e300, high = 0.0;
    for (int i = 0; i < layout_.columns; ++i) {
      const Vec3 x = layout_.get(q_, i, j, 0);
      const double radius = std::hypot(x.x(), x.z());
      low = std::min(low, radius), high = std::max(high, radius);
    }
    most = std::max(most, high - low);
  }
  return most;
}

double PressSolver::director_runout() const {
  double most = 0.0;
  for (int j = 1; j + 1 < layout_.rows; ++j) {
    double low = 1e300, high = -1e300;
    for (int i = 0; i < layout_.columns; ++i) {
      const Vec3 director = layout_.get(q_, i, j, 3);
      const double angle = std::acos(std::clamp(director.y() / director.norm(), -1.0, 1.0));
      low = std::min(low, angle), high = std::max(high, angle);
    }
    most = std::max(most, high - low);
  }
  return most;
}

/// C of a point; zero if it does not touch.
Eigen::Matrix3d PressSolver::contact_matrix(const Vec3& x, double area, double tangential) const {
  const PressObstacle::Profile top = obstacle_.at(x.x());
  const double depth = this->depth(x, top);
  if (depth <= 0.0) return Eigen::Matrix3d::Zero();
  const Vec3 normal = this->normal(top), unit = normal.normalized();
  Eigen::Matrix3d c =
      normal * normal.transpose() + tangential * (Eigen::Matrix3d::Identity() - unit * unit.transpose());
  c(0, 0) += depth * top.curvature;
  return obstacle_.stiffness * area * c;
}

GroundStiffness PressSolver::ground_stiffness(double tangential) {
  FURROW_ASSERT(viscosity_ == 0.0 && tangential >= 0.0, viscosity_, tangential);
  using Motions = Eigen::Matrix<double, 3, 4>;
  GroundStiffness direct = GroundStiffness::Zero();
  std::array<Field, 4> pull;
  for (Field& f : pull) f.assign(layout_.size(), 0.0);
  assemble();
  contact_points([&](int i, int j, const std::array<double, 4>& w, const Vec3& x, double area) {
    const Eigen::Matrix3d c = contact_matrix(x, area, tangential);
    Motions d;
    d << Vec3::UnitX(), left_, up_, up_.cross(x);
    direct += d.transpose() * c * d;
    const Motions force = c * d;
    for (int n = 0; n < 4; ++n) {
      const int row = j + kRow[n], column = (i + kColumn[n]) % layout_.columns;
      for (int k = 0; k < 4; ++k)
        layout_.set(pull[k], column, row, 0, layout_.get(pull[k], column, row, 0) + w[n] * force.col(k));
      for (int m = 0; m <= n; ++m)
        for (int a = 0; a < 3; ++a)
          for (int b = 0; b < 3; ++b)
            if (6 * n + a >= 6 * m + b)
              linear_->add(j * layout_.columns + i, 6 * n + a, 6 * m + b, w[n] * w[m] * c(a, b));
    }
  });
  const bool definite = linear_->factorize();
  FURROW_ASSERT(definite, tangential);
  Eigen::MatrixXd right(linear_->matrix.rows(), 4);
  for (int k = 0; k < 4; ++k) right.col(k) = linear_->gather(layout_, pull[k]);
  const GroundStiffness stiffness = direct - right.transpose() * linear_->llt.solve(right);
  factorize();  // restores the factor of press(), with which the next point begins
  return 0.5 * (stiffness + stiffness.transpose());
}

std::vector<PressSample> PressSolver::footprint() const {
  std::vector<PressSample> samples;
  contact_points([&](int, int, const std::array<double, 4>&, const Vec3& x, double area) {
    const double depth = this->depth(x, obstacle_.at(x.x()));
    if (depth > 0.0) samples.push_back({x.x(), left_.dot(x), area, obstacle_.stiffness * depth});
  });
  return samples;
}

}  // namespace furrow::tire
