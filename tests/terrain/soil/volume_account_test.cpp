// Grains on a lattice that a strip pushes down or aside: each volume is known.
#include "terrain/soil/volume_account.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

namespace furrow::terrain::soil {
namespace {

constexpr double kRadius = 0.01, kPitch = 2.0 * kRadius;
constexpr int kLong = 24, kWide = 6, kHigh = 12;
constexpr double kLength = kLong * kPitch, kWidth = kWide * kPitch, kHeight = kHigh * kPitch;
constexpr double kSinkage = 2.0 * kPitch;
const Footprint kStrip{false, 0.5 * kLength, 0.0, 8 * kPitch};
constexpr double kArea = 8 * kPitch * kWidth;
const Region kAll{0.0, kLength, -0.5 * kWidth, 0.5 * kWidth, true, true};

std::vector<dem::Quad> lattice() {
  std::vector<dem::Quad> grains;
  for (int i = 0; i < kLong; ++i)
    for (int j = 0; j < kWide; ++j)
      for (int k = 0; k < kHigh; ++k)
        grains.push_back({(i + 0.5) * kPitch, (j + 0.5) * kPitch - 0.5 * kWidth, (k + 0.5) * kPitch, kRadius});
  return grains;
}

HeightField surface_of(const std::vector<dem::Quad>& grains) {
  HeightField field{0.5 * kPitch, 0.5 * kPitch - 0.5 * kWidth, kPitch, kLong, kWide, {}};
  field.height.assign(kLong * kWide, std::numeric_limits<double>::quiet_NaN());
  for (const dem::Quad& p : grains) {
    double& height =
        field.height[static_cast<int>(p.x / kPitch) * kWide + static_cast<int>((p.y + 0.5 * kWidth) / kPitch)];
    if (!(height >= p.z + p.w)) height = p.z + p.w;
  }
  return field;
}

VolumeAccount account_of(const std::vector<dem::Quad>& after) {
  const std::vector<dem::Quad> before = lattice();
  const HeightField was = surface_of(before), is = surface_of(after);
  return volume_account(kAll, kStrip, kArea, kSinkage, kHeight - kSinkage, {before, was}, {after, is}, kRadius);
}

TEST(VolumeAccount, grains_that_are_pressed_together_are_compacted) {
  std::vector<dem::Quad> after = lattice();
  for (dem::Quad& p : after)
    if (kStrip.covers(p.x, p.y)) p.z *= 1.0 - kSinkage / kHeight;
  const VolumeAccount a = account_of(after);
  EXPECT_NEAR(a.displaced, kArea * kSinkage, 1e-15);
  EXPECT_NEAR(a.heaved, 0.0, 1e-12);
  EXPECT_NEAR(a.compacted, a.displaced, 0.03 * a.displaced);
  EXPECT_NEAR(a.residual(), 0.0, 0.03 * a.displaced);
  // π/6 for a lattice of touching spheres, on points half a radius apart; overlaps count once.
  EXPECT_NEAR(a.solid_before, std::numbers::pi / 6.0, 0.03);
  EXPECT_GT(a.solid_after, a.solid_before + 0.02);
}

TEST(VolumeAccount, grains_that_are_pushed_aside_heave) {
  // The two layers under the strip, 8 columns wide, go onto the 16 beside it: one layer there.
  std::vector<dem::Quad> after = lattice();
  std::vector<dem::Quad> moved;
  std::erase_if(after, [&](const dem::Quad& p) {
    const bool taken = kStrip.covers(p.x, p.y) && p.z > kHeight - kSinkage;
    if (taken) moved.push_back(p);
    return taken;
  });
  for (dem::Quad& p : moved) {
    const bool upper = p.z > kHeight - 0.5 * kSinkage;
    p.x = upper ? p.x - 8 * kPitch : p.x + 8 * kPitch;
    p.z = kHeight + 0.5 * kPitch;
  }
  after.insert(after.end(), moved.begin(), moved.end());
  const VolumeAccount a = account_of(after);
  EXPECT_NEAR(a.heaved, a.displaced, 1e-9 * a.displaced);
  EXPECT_NEAR(a.compacted, 0.0, 0.03 * a.displaced);
  EXPECT_NEAR(a.solid_after, a.solid_before, 1e-9);
}

TEST(VolumeAccount, a_surface_that_does_not_belong_to_the_grains_leaves_a_residual) {
  const std::vector<dem::Quad> before = lattice();
  std::vector<dem::Quad> after = before;
  for (dem::Quad& p : after)
    if (kStrip.covers(p.x, p.y)) p.z *= 1.0 - kSinkage / kHeight;
  const HeightField was = surface_of(before);
  HeightField is = surface_of(after);
  for (double& height : is.height) height += 0.2 * kSinkage;
  const VolumeAccount a =
      volume_account(kAll, kStrip, kArea, kSinkage, kHeight - kSinkage, {before, was}, {after, is}, kRadius);
  EXPECT_NEAR(a.residual(), -0.2 * kSinkage * 16 * kPitch * kWidth, 0.03 * a.displaced);
}

}  // namespace
}  // namespace furrow::terrain::soil
