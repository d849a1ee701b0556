// The ring's linear solver, and gaps to the ground with their derivatives.
#include "tire/ring/ring_contact.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "tests/tire/ring/ring_examples.hpp"
#include "tire/ring/folded_band.hpp"

namespace furrow::tire {
namespace {

TEST(FoldedBand, solves_what_a_dense_matrix_solves) {
  for (const int n : {16, 17, 40}) {
    RingMechanics ring(truck_ring(n));
    RingTangent k = ring.no_tangent();
    ring.tangent(random_field(ring, 0.01, 7), k);
    Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    for (int d = 0; d < 3; ++d)
      for (int j = 0; j < n; ++j) {
        const int at = 2 * j, with = 2 * ((j + d) % n);
        Eigen::Matrix2d block;
        block << k.uu[d][j], k.uv[d][j], k.vu[d][j], k.vv[d][j];
        dense.block<2, 2>(at, with) += block;
        if (d > 0) dense.block<2, 2>(with, at) += block.transpose();
      }
    FoldedBand band(n);
    ASSERT_TRUE(band.factorize(k));
    std::vector<double> x(band.entries());
    Eigen::MatrixXd right = Eigen::MatrixXd::Random(2 * n, FoldedBand::kLanes);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < 2; ++i)
        for (int lane = 0; lane < FoldedBand::kLanes; ++lane)
          x[FoldedBand::kLanes * (band.place(j) + i) + lane] = right(2 * j + i, lane);
    band.solve(x.data());
    const Eigen::MatrixXd expected = dense.ldlt().solve(right);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < 2; ++i)
        for (int lane = 0; lane < FoldedBand::kLanes; ++lane)
          EXPECT_NEAR(x[FoldedBand::kLanes * (band.place(j) + i) + lane], expected(2 * j + i, lane),
                      1e-9 * expected.col(lane).cwiseAbs().maxCoeff());
  }
}

TEST(RingGround, faces_corners_and_rays) {
  const RingGround step({{-1.0, 0.0}, {0.0, 0.0}, {0.1, 0.05}, {1.0, 0.05}});
  EXPECT_EQ(step.face(-1.1), -1);
  EXPECT_EQ(step.face(-0.5), 0);
  EXPECT_EQ(step.face(0.05), 1);
  EXPECT_EQ(step.face(1.0), 2);
  EXPECT_EQ(step.top(), 0.05);
  ASSERT_EQ(step.corners().size(), 3U);  // the ends and the convex one
  EXPECT_EQ(step.corners()[1].x, 0.1);
  EXPECT_NEAR(step.distance(0.0, 0.4, 0.0), 0.4, 1e-15);
  EXPECT_NEAR(step.distance(0.5, 0.45, std::atan(0.25)), 0.4 / std::cos(std::atan(0.25)), 1e-15);
  EXPECT_TRUE(std::isinf(RingGround::bar(0.05, 0.0).distance(0.0, 0.4, 0.2)));
}

TEST(RingContact, translation_moves_every_point_of_the_belt_alike) {
  RingMechanics ring(truck_ring(120));
  for (const double across : {-0.013, 0.0, 0.0071}) {
    RingContact contact(ring, RingGround::bar(0.05, across));
    contact.place({0.0, ring.radius()});
    std::vector<CornerGap> before, after;
    contact.corners(ring.zero(), before);
    contact.corners(wave(ring, 1, 1e-3, -1e-3), after);  // down by 1 mm
    ASSERT_EQ(before.size(), 2U);
    ASSERT_EQ(after.size(), 2U);
    for (int k = 0; k < 2; ++k) {
      EXPECT_NEAR(after[k].gap, before[k].gap - 1e-3, 1e-15);
      double resultant = 0.0;  // work of a unit force under this motion
      for (int i = 0; i < 3; ++i) {
        const int j = (after[k].first + i) % 120;
        resultant += -after[k].slope[2 * i] * std::cos(j * ring.angle()) +
                     after[k].slope[2 * i + 1] * std::sin(j * ring.angle());
      }
      EXPECT_NEAR(resultant, after[k].push_z, 1e-13);
    }
  }
}

/// A corner's gap changed in one coordinate.
CornerGap moved(const RingContact& contact, RingField q, int j, bool radial, double by) {
  (radial ? q.u[j] : q.v[j]) += by;
  std::vector<CornerGap> gaps;
  contact.corners(q, gaps);
  return gaps.at(0);
}

TEST(RingContact, corner_gaps_have_their_derivatives) {
  for (const RingKinematics kinematics : {RingKinematics::exact, RingKinematics::radial}) {
    RingParams p = truck_ring(120);
    p.kinematics = kinematics;
    RingMechanics ring(p);
    RingField q = wave(ring, 3, -4e-3, 2e-3);
    for (int j = 0; j < 120; ++j) q.u[j] += 1e-3 * std::sin(17.0 * j), q.v[j] += 2e-3 * std::cos(5.0 * j);
    RingContact contact(ring, RingGround::bar(0.05, 0.0));
    for (const double x : {-0.06, -0.031, 0.012, 0.09}) {
      contact.place({x, 0.372});
      std::vector<CornerGap> gaps;
      contact.corners(q, gaps);
      ASSERT_EQ(gaps.size(), 2U);
      const double h = 1e-6;
      for (int i = 0; i < 6; ++i) {
        const int j = (gaps[0].first + i / 2) % 120;
        const CornerGap up = moved(contact, q, j, i % 2 == 0, h), down = moved(contact, q, j, i % 2 == 0, -h);
        EXPECT_NEAR((up.gap - down.gap) / (2 * h), gaps[0].slope[i], 1e-8);
        for (int o = 0; o < 6; ++o) EXPECT_NEAR((up.slope[o] - down.slope[o]) / (2 * h), gaps[0].bend[6 * i + o], 1e-5);
      }
    }
  }
}

TEST(RingContact, a_corners_gap_is_smooth_where_the_belt_passes_from_one_segment_to_the_next) {
  RingMechanics ring(truck_ring(120));
  const RingField q = wave(ring, 4, -5e-3, 2e-3);
  RingContact contact(ring, RingGround::bar(0.05, 0.0));
  double at = 0.02;  // of the axle: where the first of three segments changes
  const auto gap_at = [&](double x) {
    contact.place({x, 0.38});
    std::vector<CornerGap> gaps;
    contact.corners(q, gaps);
    return gaps.at(0);
  };
  double low = at, high = at + ring.radius() * ring.angle();
  ASSERT_NE(gap_at(low).first, gap_at(high).first);
  for (int i = 0; i < 60; ++i) (gap_at(0.5 * (low + high)).first == gap_at(at).first ? low : high) = 0.5 * (low + high);
  const CornerGap before = gap_at(low), after = gap_at(high);
  EXPECT_NE(before.first, after.first);
  EXPECT_NEAR(before.gap, after.gap, 1e-14);
  EXPECT_NEAR(before.push_x, after.push_x, 1e-12);
}

}  // namespace
}  // namespace furrow::tire
