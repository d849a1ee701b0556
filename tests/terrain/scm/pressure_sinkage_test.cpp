// Pressure under a node of empirical soil against Bekker's and Wong's closed forms.
#include "terrain/scm/pressure_sinkage.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace furrow::terrain::scm {
namespace {

constexpr PressureLaw kLete{.k_c = 102e3, .k_phi = 5301e3, .n = 0.79, .unloading_rate = 5.03e8};

/// Loads a node in `steps` steps to the sinkage `to`; sums work and losses per area, J/m².
struct Way {
  double at = 0.0, pressure = 0.0, work = 0.0, lost = 0.0;

  void go(const PressureLaw& law, double modulus, SoilNode& node, double to, int steps = 400) {
    const double from = at;
    for (int k = 1; k <= steps; ++k) {
      const double next = from + (to - from) * k / steps;
      const PressureStep step = press(law, modulus, at, next, 0.0, node);
      work += 0.5 * (pressure + step.pressure) * (next - at);
      lost += step.compaction;
      at = next;
      pressure = step.pressure;
    }
  }
};

double stored(const SoilNode& node, double z) { return 0.5 * node.elastic(z) * std::max(z - node.plastic, 0.0); }

TEST(PressureSinkage, first_loading_is_bekkers_curve) {
  for (const double n : {0.3, 0.79, 1.0, 1.6}) {
    PressureLaw law = kLete;
    law.n = n;
    SoilNode node;
    const double k = law.modulus(0.1);
    EXPECT_DOUBLE_EQ(k, 102e3 / 0.1 + 5301e3);
    double z = 0.0;
    for (int i = 1; i <= 50; ++i) {
      const double next = 1e-3 * i;
      EXPECT_NEAR(press(law, k, z, next, 0.0, node).pressure / (k * std::pow(next, n)), 1.0, 1e-12) << n << ' ' << i;
      z = next;
    }
  }
}

TEST(PressureSinkage, unloading_and_reloading_are_wongs_line_and_the_curve_goes_on) {
  SoilNode node;
  Way way;
  PressureLaw law = kLete;
  law.k_phi = 505.8e3;  // softer than its own line from the beginning on
  law.n = 0.7;
  const double k = law.modulus(0.1), z_u = 0.02, p_u = k * std::pow(z_u, law.n), k_u = law.unloading_rate * z_u;
  way.go(law, k, node, z_u);
  for (const double z : {0.018, 0.0175, 0.019, z_u}) {
    way.go(law, k, node, z, 7);
    EXPECT_NEAR(way.pressure, std::max(p_u - k_u * (z_u - z), 0.0), 1e-9 * p_u) << z;
  }
  EXPECT_NEAR(node.plastic, z_u - p_u / k_u, 1e-15);  // the rut
  way.go(law, k, node, 0.0);
  EXPECT_EQ(way.pressure, 0.0);
  way.go(law, k, node, 0.5 * node.plastic);
  EXPECT_EQ(way.pressure, 0.0) << "above the rut nothing bears";
  way.go(law, k, node, 0.03);
  EXPECT_NEAR(way.pressure / (k * std::pow(0.03, law.n)), 1.0, 1e-12);
}

TEST(PressureSinkage, work_is_stored_or_lost_and_never_gained) {
  for (const double n : {0.3, 0.79, 1.0, 1.6})
    for (const double rate : {0.0, 5.03e8}) {
      PressureLaw law = kLete;
      law.n = n;
      law.unloading_rate = rate;
      law.unloading = 1e5;
      SoilNode node;
      Way way;
      double lost = 0.0, most = 0.0;  // J/m²
      for (const double z : {0.01, 0.004, 0.02, 0.0, 0.03, 0.029, 0.05}) {
        way.go(law, law.modulus(0.1), node, z);
        most = std::max(most, way.work);
        EXPECT_GE(way.lost, lost - 1e-9 * most) << n << ' ' << rate << ' ' << z;
        lost = way.lost;
        EXPECT_NEAR((way.lost + stored(node, z) - way.work) / most, 0.0, 2e-3) << n << ' ' << rate << ' ' << z;
        EXPECT_GE(node.plastic, 0.0);
      }
    }
}

TEST(PressureSinkage, a_change_of_width_neither_lifts_the_rut_nor_jumps_beyond_the_curves) {
  PressureLaw stiff = kLete;
  stiff.unloading = 1e8;
  SoilNode node;
  Way way;
  const double wide = stiff.modulus(0.2), narrow = stiff.modulus(0.02);
  way.go(stiff, narrow, node, 0.01);
  const double rut = node.plastic, yield = node.yield;
  way.go(stiff, wide, node, 0.0101, 1);
  EXPECT_GE(node.plastic, rut);
  EXPECT_DOUBLE_EQ(node.yield, yield);  // has borne more already
  way.go(stiff, wide, node, 0.03);
  EXPECT_NEAR(way.pressure / (wide * std::pow(0.03, stiff.n)), 1.0, 1e-12);
  const double before = node.plastic, pressure = way.pressure, lost = way.lost;
  way.go(stiff, narrow, node, 0.0301, 1);  // up the spring to the stiffer curve, without loss
  EXPECT_NEAR(way.pressure / (pressure + node.stiffness * 1e-4), 1.0, 1e-12);
  EXPECT_EQ(node.plastic, before);
  EXPECT_EQ(way.lost, lost);
  way.go(stiff, narrow, node, 0.05);
  EXPECT_NEAR(way.pressure / (narrow * std::pow(0.05, stiff.n)), 1.0, 1e-12);
}

TEST(PressureSinkage, the_damper_works_below_the_yield_pressure_only_and_never_pulls) {
  PressureLaw law = kLete;
  law.damping = 1e5;
  SoilNode node;
  const PressureStep first = press(law, law.modulus(0.1), 0.0, 0.02, 0.5, node);
  EXPECT_EQ(first.pressure, first.elastic);
  const double z = 0.02 - 0.25 * node.yield / node.stiffness;
  const PressureStep up = press(law, law.modulus(0.1), 0.02, z, -0.3, node);
  EXPECT_DOUBLE_EQ(up.pressure, up.elastic - 0.3e5);
  EXPECT_EQ(press(law, law.modulus(0.1), z, z, -1e3, node).pressure, 0.0);
  EXPECT_EQ(press(law, law.modulus(0.1), z, z, 1e3, node).pressure, node.yield);
}

TEST(PressureSinkage, a_negative_k_c_leaves_a_modulus_above_zero) {
  PressureLaw law = kLete;
  law.k_c = -6900.0;
  law.k_phi = 207e3;
  EXPECT_DOUBLE_EQ(law.modulus(0.1), 138e3);
  EXPECT_DOUBLE_EQ(law.modulus(0.01), 0.05 * 207e3);
}

}  // namespace
}  // namespace furrow::terrain::scm
