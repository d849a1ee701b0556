// The stiffness of a slightly pressed tire against a ground to which it sticks, compared with the inflated tire's
// tangent. The tangent is inverted order by order (tire/ancf/shell_modes.hpp). Only the list of touching points comes
// from PressSolver, neither assembly nor solution.
#include <gtest/gtest.h>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/verification/record.hpp"
#include "tire/ancf/press_solver.hpp"

namespace furrow::test::sticking_ground_test {
namespace {

constexpr int kAround = 6, kAcross = 4;  // contact points of an element, as in PressSolver on a plate
constexpr int kAside = 3;                // columns on either side of the lowest node

/// Displacements of the nodes near the lowest one by forces on them, along x, y and z of the rim, m/N.
Eigen::MatrixXd compliance(const InflatedCarcass& ring) {
  const int rows = ring.mesh.rows - 2, size = 3 * rows, columns = 2 * kAside + 1, all = ring.mesh.columns;
  const auto place = [](int k) { return 6 * (k / 3) + k % 3; };
  const std::vector<Eigen::MatrixXd> between = compliance_by_distance(ring, columns, size, place);
  Eigen::MatrixXd whole(columns * size, columns * size);
  const int first = all / 2 - kAside;
  for (int i = 0; i < columns; ++i)
    for (int k = 0; k <= i; ++k)
      for (int a = 0; a < rows; ++a)
        for (int b = 0; b < rows; ++b) {
          const Mat3 c = ring.mesh.turn(first + i) * between[i - k].block<3, 3>(3 * a, 3 * b) *
                         ring.mesh.turn(first + k).transpose();
          whole.block<3, 3>(i * size + 3 * a, k * size + 3 * b) = c;
          whole.block<3, 3>(k * size + 3 * b, i * size + 3 * a) = c.transpose();
        }
  return whole;
}

/// Longitudinal, lateral, vertical, torsional stiffness, with the touching points at their places on the inflated tire.
Eigen::Vector4d linear_stiffness(const InflatedCarcass& ring, const std::vector<tire::PressSample>& touching) {
  const Eigen::MatrixXd flexible = compliance(ring);
  const int rows = ring.mesh.rows - 2, first = ring.mesh.columns / 2 - kAside;
  Eigen::MatrixXd springs = Eigen::MatrixXd::Zero(flexible.rows(), flexible.rows()),
                  pull = Eigen::MatrixXd::Zero(flexible.rows(), 4);
  Eigen::Matrix4d direct = Eigen::Matrix4d::Zero();
  std::size_t found = 0;
  for (int i = 0; i < 2 * kAside; ++i)
    for (int j = 0; j + 1 < rows; ++j)
      for (int p = 0; p < kAround * kAcross; ++p) {
        const double u = (p / kAcross + 0.5) / kAround, v = (p % kAcross + 0.5) / kAcross;
        const double w[4] = {(1 - u) * (1 - v), u * (1 - v), u * v, (1 - u) * v};
        Vec3 x = Vec3::Zero();
        int node[4];
        for (int n = 0; n < 4; ++n) {
          const int column = i + (n == 1 || n == 2), row = j + (n > 1);
          node[n] = 3 * (column * rows + row);
          x += w[n] * ring.shell.layout().get(ring.q, first + column, row + 1, 0);
        }
        const auto here = [&](const tire::PressSample& s) { return std::hypot(s.x - x.x(), s.y - x.y()) < 1e-3; };
        const auto sample = std::ranges::find_if(touching, here);
        if (sample == touching.end()) continue;
        ++found;
        const double k = tire::PressObstacle{}.stiffness * sample->area;
        Eigen::Matrix<double, 3, 4> d = Eigen::Matrix<double, 3, 4>::Zero();
        d.leftCols<3>().setIdentity();
        d.col(3) = Vec3(-x.y(), x.x(), 0.0);
        direct += k * d.transpose() * d;
        for (int n = 0; n < 4; ++n) {
          pull.block<3, 4>(node[n], 0) += k * w[n] * d;
          for (int m = 0; m < 4; ++m) springs.block<3, 3>(node[n], node[m]) += k * w[n] * w[m] * Mat3::Identity();
        }
      }
  EXPECT_EQ(found, touching.size());
  const Eigen::MatrixXd way = (Eigen::MatrixXd::Identity(flexible.rows(), flexible.rows()) + flexible * springs)
                                  .partialPivLu()
                                  .solve(flexible * pull);
  return (direct - pull.transpose() * way).diagonal();
}

TEST(StickingGround, a_hardly_pressed_tire_resists_as_its_tangent_says) {
  const InflatedCarcass ring(small_file("hmmwv_lumped.json", 90, 24));
  tire::PressSolver solver(ring.file, ring.mesh, ring.q, {});
  const char* names[4] = {"longitudinal, N/m", "lateral, N/m", "vertical, N/m", "torsional, N m/rad"};
  Eigen::Vector4d before = Eigen::Vector4d::Constant(1.0);
  for (const double deflection : {4e-4, 2e-4}) {
    solver.press(deflection);
    const Eigen::Vector4d pressed = solver.ground_stiffness().diagonal();
    const Eigen::Vector4d reference = linear_stiffness(ring, solver.footprint());
    for (int k = 0; k < 4; ++k) {
      const double off = std::abs(pressed[k] / reference[k] - 1.0);
      EXPECT_LT(off, before[k]) << names[k];  // it is the limit of small deflections
      before[k] = off;
      if (deflection < 3e-4)
        verification::verify("sticking ground beside the tangent as inflated",
                             fmt::format("stiffness at 0.2 mm, {}, lumped, 200 kPa, 90 x 24", names[k]), pressed[k],
                             reference[k], 5e-3, "linear: compliance of the inflated ring");
    }
  }
}

}  // namespace
}  // namespace furrow::test::sticking_ground_test
