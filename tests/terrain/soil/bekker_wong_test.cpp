// The rigid wheel of soil theory against closed forms and limits.
#include <gtest/gtest.h>

#include <cmath>

#include "terrain/soil/bekker_wong.hpp"

namespace furrow::terrain::soil {
namespace {

const RigidWheel kBekkerWheel{0.4673, 0.254, 4609.0, 0.0, 0.0};  // θ_m = 0: pressure as under a plate
const SoilStrength kSmooth{0.0, 2e6, 1.0, 0.0, 0.0, 0.01};       // no shear strength

TEST(BekkerWong, pressure_alone_carries_the_load) {
  // Without shear and with n = 1: W = b k R² ∫ (cos θ − cos θ₁) cos θ dθ = b k R² (θ₁ − ½ sin 2θ₁)/2.
  const WheelEstimate e = rigid_wheel(kSmooth, kBekkerWheel, 0.3);
  ASSERT_TRUE(e.found);
  const double t = e.entry_angle, R = kBekkerWheel.radius, bk = kBekkerWheel.width * kSmooth.k_phi;
  EXPECT_NEAR(0.5 * bk * R * R * (t - 0.5 * std::sin(2.0 * t)), kBekkerWheel.load, 1e-3 * kBekkerWheel.load);
  EXPECT_EQ(e.thrust, 0.0);
  EXPECT_NEAR(e.pressure, kSmooth.k_phi * e.sinkage, 1e-3 * e.pressure);
}

TEST(BekkerWong, resistance_of_bekkers_pressure_is_the_compaction_work) {
  // R_c = b k z₀ⁿ⁺¹/(n + 1): the work of pressing a rut of that depth per length [Wong 2008].
  const double b = kBekkerWheel.width;
  for (const double n : {0.4, 1.0, 1.3}) {
    SoilStrength s = kSmooth;
    s.n = n;
    const WheelEstimate e = rigid_wheel(s, kBekkerWheel, 0.2);
    ASSERT_TRUE(e.found);
    EXPECT_NEAR(e.resistance, b * s.k_phi * std::pow(e.sinkage, n + 1.0) / (n + 1.0), 2e-3 * e.resistance) << n;
    EXPECT_NEAR(e.pull, -e.resistance, 1e-9);
  }
}

/// Sinkage of a towed rigid wheel, m: W = (k_c + b k_φ) √(2R z₀) z₀ⁿ (3 − n)/3 for small z₀ [Bekker 1956; Wong 2008].
double bekker_sinkage(const SoilStrength& s, const RigidWheel& w) {
  const double factor = (3.0 - s.n) * (s.k_c + w.width * s.k_phi) * std::sqrt(2.0 * w.radius);
  return std::pow(3.0 * w.load / factor, 2.0 / (2.0 * s.n + 1.0));
}

TEST(BekkerWong, sinkage_tends_to_bekkers_closed_form_on_firm_soil) {
  for (const double n : {0.5, 1.0}) {
    SoilStrength firm{5e3, 2e7, n, 0.0, 0.0, 0.01};
    const WheelEstimate e = rigid_wheel(firm, kBekkerWheel, 0.0);
    EXPECT_NEAR(e.sinkage, bekker_sinkage(firm, kBekkerWheel), 0.06 * e.sinkage) << n;
  }
}

TEST(BekkerWong, thrust_at_large_slip_is_coulombs_strength_of_the_patch) {
  // K → 0: τ = c + σ tan φ everywhere. On firm soil the patch is nearly level: thrust ≈ A c + W tan φ.
  const SoilStrength s{0.0, 5e9, 1.0, 2e4, 0.4, 1e-9};
  const WheelEstimate e = rigid_wheel(s, kBekkerWheel, 0.9);
  const double area = kBekkerWheel.width * kBekkerWheel.radius * e.entry_angle;
  EXPECT_NEAR(e.thrust, area * s.cohesion + kBekkerWheel.load * std::tan(s.phi), 0.01 * e.thrust);
  EXPECT_NEAR(e.torque, e.thrust * kBekkerWheel.radius, 0.01 * e.torque);
}

TEST(BekkerWong, pull_grows_with_slip_and_strength_and_falls_with_softness) {
  const SoilStrength s{15.6e3, 245e3, 0.395, 6.9e3, 0.467, 0.021};
  const RigidWheel wheel{0.4673, 0.254, 4609.0};
  double before = -1e9;
  for (const double slip : {0.0, 0.1, 0.3, 0.6}) {
    const WheelEstimate e = rigid_wheel(s, wheel, slip);
    ASSERT_TRUE(e.found);
    EXPECT_GT(e.pull, before);
    before = e.pull;
  }
  const double pull = rigid_wheel(s, wheel, 0.3).pull;
  SoilStrength other = s;
  other.cohesion *= 2.0;
  EXPECT_GT(rigid_wheel(other, wheel, 0.3).pull, pull);
  other = s, other.k_phi *= 0.7, other.k_c *= 0.7;
  EXPECT_LT(rigid_wheel(other, wheel, 0.3).pull, pull);
  EXPECT_LT(rigid_wheel(s, wheel, 0.0).pull, 0.0);
}

TEST(BekkerWong, soil_that_cannot_carry_is_told) {
  const SoilStrength mud{0.0, 1e3, 1.0, 0.0, 0.0, 0.01};
  EXPECT_FALSE(rigid_wheel(mud, kBekkerWheel, 0.3).found);
}

}  // namespace
}  // namespace furrow::terrain::soil
