#include "tests/tire/verification/linear_plate.hpp"

#include <algorithm>
#include <cmath>

#include "tire/ancf/press_solver.hpp"

namespace furrow::test {
namespace {

constexpr int kAround = 6, kAcross = 4;  // contact points of an element, as in PressSolver on a plate
constexpr int kMaxChanges = 200, kMaxLoadSteps = 60;

double start_radius(const InflatedCarcass& ring) {
  double radius = 0.0;
  for (int j = 0; j < ring.mesh.rows; ++j) radius = std::max(radius, ring.shell.layout().get(ring.q, 0, j, 0).z());
  return radius;
}

}  // namespace

LinearPlate::LinearPlate(const InflatedCarcass& ring, double reach) {
  const double bottom = -start_radius(ring);
  const tire::ShellMesh& mesh = ring.mesh;
  const auto near = [&](int i, int j) { return ring.shell.layout().get(ring.q, i, j, 0).z() - bottom < reach; };
  const int lowest = mesh.columns / 2;
  int aside = 0;
  while (near(lowest + aside + 1, mesh.rows / 2)) ++aside;
  first_column_ = lowest - aside, columns_ = 2 * aside + 1;
  while (!near(lowest, first_row_)) ++first_row_;
  while (first_row_ + rows_ < mesh.rows && near(lowest, first_row_ + rows_)) ++rows_;
  make_compliance(ring);
  make_points(ring);
}

void LinearPlate::make_compliance(const InflatedCarcass& ring) {
  const int size = 2 * rows_;
  // Coordinate 2 b + s of a column: x (s = 0) or z (s = 1) of row b within reach, in the column's axes.
  const auto place = [&](int k) { return 6 * (first_row_ + k / 2 - 1) + (k % 2 == 0 ? 0 : 2); };
  const std::vector<Eigen::MatrixXd> between = compliance_by_distance(ring, columns_, size, place);
  compliance_.resize(columns_ * rows_, columns_ * rows_);
  for (int i = 0; i < columns_; ++i)
    for (int k = 0; k <= i; ++k) {
      const Vec3 up_i = ring.mesh.turn(first_column_ + i).transpose() * Vec3::UnitZ(),
                 up_k = ring.mesh.turn(first_column_ + k).transpose() * Vec3::UnitZ();
      const Eigen::Vector2d to(up_i.x(), up_i.z()), from(up_k.x(), up_k.z());
      for (int a = 0; a < rows_; ++a)
        for (int b = 0; b < rows_; ++b)
          compliance_(node(i, a), node(k, b)) = compliance_(node(k, b), node(i, a)) =
              to.dot(between[i - k].block<2, 2>(2 * a, 2 * b) * from);
    }
}

void LinearPlate::make_points(const InflatedCarcass& ring) {
  const tire::ShellMesh& mesh = ring.mesh;
  const double radius = start_radius(ring), stiffness = tire::PressObstacle().stiffness;
  for (int j = 0; j + 1 < rows_; ++j) {
    const Vec3 &a = mesh.position[first_row_ + j], &b = mesh.position[first_row_ + j + 1];
    const Vec3 around = 0.5 * ((mesh.turn(1) * a - a) + (mesh.turn(1) * b - b));
    const double area = around.cross(b - a).norm() / (kAround * kAcross);
    for (int i = 0; i + 1 < columns_; ++i)
      for (int p = 0; p < kAround; ++p)
        for (int q = 0; q < kAcross; ++q) {
          const double u = (p + 0.5) / kAround, v = (q + 0.5) / kAcross;
          Point point{{node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1)},
                      {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v},
                      radius,
                      stiffness * area};
          for (int n = 0; n < 4; ++n)
            point.gap +=
                point.weight[n] * ring.shell.layout()
                                      .get(ring.q, first_column_ + i + (n == 1 || n == 2), first_row_ + j + (n > 1), 0)
                                      .z();
          points_.push_back(point);
        }
  }
}

LinearPlate::Answer LinearPlate::at_deflection(double deflection) const {
  Answer answer;
  answer.deflection = deflection;
  const auto nodes = compliance_.rows();
  std::vector<bool> active(points_.size());
  for (std::size_t s = 0; s < points_.size(); ++s) active[s] = points_[s].gap < deflection;
  for (int change = 0; change < kMaxChanges && !answer.found; ++change) {
    // f = a − S u of the active points, and how it grows with δ; then (1 + C S) u = C a.
    Eigen::MatrixXd s_matrix = Eigen::MatrixXd::Zero(nodes, nodes), right = Eigen::MatrixXd::Zero(nodes, 2);
    for (std::size_t s = 0; s < points_.size(); ++s) {
      if (!active[s]) continue;
      const Point& p = points_[s];
      for (int n = 0; n < 4; ++n) {
        right(p.node[n], 0) += p.weight[n] * p.stiffness * (deflection - p.gap);
        right(p.node[n], 1) += p.weight[n] * p.stiffness;
        for (int m = 0; m < 4; ++m) s_matrix(p.node[n], p.node[m]) += p.stiffness * p.weight[n] * p.weight[m];
      }
    }
    const Eigen::MatrixXd u =
        (Eigen::MatrixXd::Identity(nodes, nodes) + compliance_ * s_matrix).partialPivLu().solve(compliance_ * right);
    answer.force = answer.tangent = 0.0;
    answer.found = true;
    for (std::size_t s = 0; s < points_.size(); ++s) {
      const Point& p = points_[s];
      double depth = deflection - p.gap, growth = 1.0;
      for (int n = 0; n < 4; ++n) depth -= p.weight[n] * u(p.node[n], 0), growth -= p.weight[n] * u(p.node[n], 1);
      if (active[s]) answer.force += p.stiffness * depth, answer.tangent += p.stiffness * growth;
      if (active[s] == (depth > 0.0)) continue;
      active[s] = depth > 0.0;
      answer.found = false;
    }
  }
  return answer;
}

LinearPlate::Answer LinearPlate::at_load(double load) const {
  Answer answer = at_deflection(1e-3);
  for (int step = 0; step < kMaxLoadSteps && answer.found && std::abs(answer.force - load) > 1e-6 * load; ++step)
    answer = at_deflection(answer.deflection + (load - answer.force) / answer.tangent);
  answer.found = answer.found && std::abs(answer.force - load) <= 1e-6 * load;
  return answer;
}

}  // namespace furrow::test
