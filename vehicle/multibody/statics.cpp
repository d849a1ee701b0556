#include "vehicle/multibody/statics.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/core/paced_call.hpp"
#include "vehicle/multibody/rotation.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kClosed = 1e-13;      // m or rad, of a row
constexpr double kBalanced = 1e-12;    // of the weight
constexpr double kLongestStep = 0.03;  // of one iteration, m or rad
constexpr double kDifference = 1e-6;   // for stiffnesses, m or rad
constexpr double kRank = 1e-10;        // of a matrix
constexpr int kMaxStaticIterations = 200, kMaxHalvings = 30;

}  // namespace

double row_value(const System& system, const Row& row) {
  return row_value(row, system.pose(row.a), system.pose(row.b));
}

Row offset_row(const System& system, int a, int b, const Vec3& axis) {
  const Pose A = system.pose(a), B = system.pose(b);
  Row row;
  row.kind = RowKind::offset;
  row.a = a;
  row.b = b;
  row.point_a = A.R->transpose() * (*B.position - *A.position);
  row.axis_a = A.R->transpose() * axis.normalized();
  return row;
}

std::vector<HeldRow> held_body(const System& system, int body) {
  std::vector<HeldRow> rows;
  const std::string& name = system.body(body).name;
  for (int k = 0; k < 3; ++k) rows.push_back({name, offset_row(system, kGround, body, Vec3::Unit(k))});
  for (int k = 0; k < 3; ++k) {
    Row row;
    row.kind = RowKind::dot;
    row.b = body;
    row.axis_a = Vec3::Unit(k);
    row.axis_b = system.body(body).R.transpose() * Vec3::Unit((k + 1) % 3);
    rows.push_back({name, row});
  }
  return rows;
}

Eigen::MatrixXd Statics::jacobian() const {
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(row_count(), coordinate_count());
  const int own = system_.constraint_count();
  for (int i = 0; i < row_count(); ++i) {
    const Row& row = i < own ? system_.constraint_row(i) : held_[i - own].row;
    each_side(row, row_jacobian(row, system_.pose(row.a), system_.pose(row.b)),
              [&](int body, const Vec3& v, const Vec3& w) {
                G.block<1, 3>(i, 6 * body) += v.transpose();
                G.block<1, 3>(i, 6 * body + 3) += w.transpose();
              });
  }
  return G;
}

Eigen::VectorXd Statics::violations() const {
  Eigen::VectorXd wanted(row_count());
  const int own = system_.constraint_count();
  for (int i = 0; i < own; ++i) {
    const Row& row = system_.constraint_row(i);
    wanted[i] = -row_difference(row, row_value(system_, row), system_.target(i, system_.time()).value);
  }
  for (std::size_t k = 0; k < held_.size(); ++k)
    wanted[own + static_cast<int>(k)] =
        -row_difference(held_[k].row, row_value(system_, held_[k].row), held_[k].target);
  return wanted;
}

std::vector<BodyState> Statics::states() const {
  std::vector<BodyState> all;
  for (int i = 0; i < system_.body_count(); ++i) all.push_back(system_.body(i).state);
  return all;
}

void Statics::put(const std::vector<BodyState>& states) {
  for (int i = 0; i < system_.body_count(); ++i) system_.set_state(i, states[i]);
}

void Statics::displace(const Eigen::VectorXd& by) {
  for (int i = 0; i < system_.body_count(); ++i) {
    BodyState state;
    state.position = system_.body(i).state.position + by.segment<3>(6 * i);
    state.orientation = rotated(system_.body(i).state.orientation, by.segment<3>(6 * i + 3), 1.0);
    system_.set_state(i, state);
  }
}

Eigen::VectorXd shortest_solution(const Eigen::MatrixXd& matrix, const Eigen::VectorXd& right) {
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> solver;
  solver.setThreshold(kRank);
  return solver.compute(matrix).solve(right);
}

Outcome Statics::close() {
  double worst = 0.0;
  int worst_row = 0;
  for (int iteration = 0; iteration < kMaxStaticIterations; ++iteration) {
    const Eigen::VectorXd wanted = violations();
    worst = row_count() > 0 ? wanted.cwiseAbs().maxCoeff(&worst_row) : 0.0;
    if (worst <= kClosed) break;
    if (!std::isfinite(worst)) break;
    Eigen::VectorXd step = shortest_solution(jacobian(), wanted);
    const double longest = step.cwiseAbs().maxCoeff();
    const bool settled = iteration > 5 && longest < 1e-14;  // round-off
    if (settled) break;
    if (longest > 0.3) step *= 0.3 / longest;
    displace(step);
  }
  if (worst <= 1e-10) {
    displace(Eigen::VectorXd::Zero(coordinate_count()));
    return {};
  }
  const int own = system_.constraint_count();
  return Outcome::failure(
      "cannot take this posture",
      "worst is '" + (worst_row < own ? system_.row_name(worst_row) : held_[worst_row - own].name) + "'");
}

Eigen::MatrixXd Statics::freedoms() const {
  const Eigen::MatrixXd G = jacobian();
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(G.cols(), G.rows());
  qr.setThreshold(kRank);
  qr.compute(G.transpose());
  const Eigen::MatrixXd Q = qr.householderQ();
  return Q.rightCols(G.cols() - qr.rank());
}

Eigen::VectorXd Statics::tangent(int held) const {
  Eigen::VectorXd rate = Eigen::VectorXd::Zero(row_count());
  rate[system_.constraint_count() + held] = 1.0;
  return shortest_solution(jacobian(), rate);
}

Eigen::VectorXd Statics::forces() const {
  Eigen::VectorXd Q = Eigen::VectorXd::Zero(coordinate_count());
  for (int i = 0; i < system_.body_count(); ++i) {
    const Body& body = system_.body(i);
    Q.segment<3>(6 * i) = body.mass * system_.gravity() + body.force;
    Q.segment<3>(6 * i + 3) = body.moment;
  }
  for (int e = 0; e < system_.element_count(); ++e) {
    const ForceElement& element = system_.element(e);
    const Row& row = element.row;
    const double force = element.law(row_value(system_, row), 0.0, system_.time()).force;
    each_side(row, row_jacobian(row, system_.pose(row.a), system_.pose(row.b)),
              [&](int body, const Vec3& v, const Vec3& w) {
                Q.segment<3>(6 * body) += force * v;
                Q.segment<3>(6 * body + 3) += force * w;
              });
  }
  if (forces_) forces_(system_, Q);
  return Q;
}

Eigen::VectorXd Statics::multipliers() const { return shortest_solution(jacobian().transpose(), -forces()); }

double Statics::unbalance() const { return (freedoms().transpose() * forces()).cwiseAbs().maxCoeff(); }

// The geometric part arises because the multipliers turn with the rows.
Eigen::MatrixXd Statics::stiffness(const Eigen::MatrixXd& N) const {
  const Eigen::VectorXd lambda = multipliers();
  Statics moved = *this;
  const std::vector<BodyState> here = states();
  Eigen::MatrixXd K(N.cols(), N.cols());
  for (int k = 0; k < N.cols(); ++k) {
    Eigen::VectorXd change = Eigen::VectorXd::Zero(coordinate_count());
    for (const double side : {1.0, -1.0}) {
      moved.put(here);
      moved.displace(side * kDifference * N.col(k));
      change -= side * (moved.forces() + moved.jacobian().transpose() * lambda);
    }
    K.col(k) = N.transpose() * change / (2.0 * kDifference);
  }
  moved.put(here);
  return 0.5 * (K + K.transpose());
}

Outcome Statics::settle(double weight, const ProgressCall& progress) {
  PacedCall tell(progress);
  if (Outcome closed = close(); !closed.ok) return closed;
  double now = unbalance();
  const double first = now, last = kBalanced * weight;
  double lowest = now;
  for (int iteration = 0; iteration < kMaxStaticIterations && now > kBalanced * weight; ++iteration) {
    // Newton's steps shorten the distance by decades.
    lowest = std::min(lowest, now);
    tell("finding how it stands", std::clamp(std::log(first / lowest) / std::log(first / last), 0.0, 1.0));
    const Eigen::MatrixXd N = freedoms();
    Eigen::MatrixXd K = stiffness(N);
    // If it is not stable (a wheel in the air), stiffness is added so that it comes down.
    const double least = Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(K, Eigen::EigenvaluesOnly).eigenvalues()[0];
    const double floor = 1e-4 * weight;
    if (least < floor) K.diagonal().array() += 0.5 * weight / kLongestStep * 0.02 + floor - least;
    Eigen::VectorXd step = N * K.ldlt().solve(N.transpose() * forces());
    const double longest = step.cwiseAbs().maxCoeff();
    if (longest > kLongestStep) step *= kLongestStep / longest;
    const std::vector<BodyState> here = states();
    double next = now;
    for (int halving = 0; halving < kMaxHalvings; ++halving, step *= 0.5) {
      put(here);
      displace(step);
      const bool whole = close().ok;
      next = whole ? unbalance() : std::numeric_limits<double>::infinity();
      if (next < now || (least < floor && whole)) break;
    }
    if (!(next < now) && now <= 1e-8 * weight) {  // round-off
      put(here);
      return {};
    }
    now = next;
  }
  if (now <= 1e-8 * weight) return {};
  return Outcome::failure("does not come to rest", "there is no equilibrium near the drawn posture");
}

Eigen::MatrixXd Statics::mass() const {
  Eigen::MatrixXd M = Eigen::MatrixXd::Zero(coordinate_count(), coordinate_count());
  for (int i = 0; i < system_.body_count(); ++i) {
    const Body& body = system_.body(i);
    M.block<3, 3>(6 * i, 6 * i) = body.mass * Mat3::Identity();
    M.block<3, 3>(6 * i + 3, 6 * i + 3) = body.R * body.inertia * body.R.transpose();
  }
  return M;
}

// The mean of the coefficients for small speeds of either sign.
Eigen::MatrixXd Statics::damping() const {
  constexpr double kSpeed = 1e-3;  // m/s
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(coordinate_count(), coordinate_count());
  for (int e = 0; e < system_.element_count(); ++e) {
    const ForceElement& element = system_.element(e);
    const Row& row = element.row;
    const double x = row_value(system_, row), t = system_.time();
    const double c = (element.law(x, -kSpeed, t).force - element.law(x, kSpeed, t).force) / (2.0 * kSpeed);
    Eigen::VectorXd g = Eigen::VectorXd::Zero(coordinate_count());
    each_side(row, row_jacobian(row, system_.pose(row.a), system_.pose(row.b)),
              [&](int body, const Vec3& v, const Vec3& w) {
                g.segment<3>(6 * body) += v;
                g.segment<3>(6 * body + 3) += w;
              });
    if (c != 0.0) C += c * g * g.transpose();
  }
  return C;
}

std::vector<Mode> Statics::modes() const {
  const Eigen::MatrixXd N = freedoms(), K = stiffness(N);
  const Eigen::MatrixXd M = N.transpose() * mass() * N, C = N.transpose() * damping() * N;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> solver(K, M);
  std::vector<Mode> modes;
  for (int k = 0; k < N.cols(); ++k) {
    const double omega = std::sqrt(std::max(0.0, solver.eigenvalues()[k]));
    const Eigen::VectorXd v = solver.eigenvectors().col(k);  // vᵀ M v = 1
    Mode mode;
    mode.frequency = omega / (2.0 * std::numbers::pi);
    mode.damping = omega > 0.0 ? v.dot(C * v) / (2.0 * omega) : 0.0;
    mode.shape = N * v;
    modes.push_back(std::move(mode));
  }
  return modes;
}

}  // namespace furrow::vehicle
