// Hard ground with a profile: closed forms of depth and column, the plane's forces on level parts, and the energy of
// its contact.
#include "terrain/rigid/ground_profile.hpp"

#include <gtest/gtest.h>
#include <algorithm>

#include <cmath>

#include "protocol/core/error.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "tests/refusal.hpp"
#include "tests/saved.hpp"
#include "tests/terrain/ground_push.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

const ProfilePoints kCurb{{1.0, 0.0}, {1.0, 0.2}};

std::string complaint(const ProfilePoints& points) {
  return refusal(ExitCode::bad_input, [&] { check_profile(points, "s.json", "terrain.profile"); });
}

TEST(GroundProfile, heights_and_means_of_a_curb) {
  const GroundProfile curb(kCurb);
  EXPECT_EQ(curb.height(0.5), 0.0);
  EXPECT_EQ(curb.height(1.0), 0.2);
  EXPECT_EQ(curb.height(7.0), 0.2);
  EXPECT_EQ(curb.highest(0.0, 0.9), 0.0);
  EXPECT_EQ(curb.highest(0.0, 1.1), 0.2);
  EXPECT_NEAR(curb.mean(0.0, 4.0), 0.15, 1e-15);
  EXPECT_EQ(curb.mean(2.0, 2.0), 0.2);
  EXPECT_EQ(GroundProfile({}).height(3.0), 0.0);
  const GroundProfile ramp({{0.0, 0.0}, {2.0, 1.0}, {3.0, 1.0}});
  EXPECT_NEAR(ramp.height(0.5), 0.25, 1e-15);
  EXPECT_NEAR(ramp.mean(0.0, 3.0), 2.0 / 3.0, 1e-15);
}

TEST(GroundProfile, depth_is_the_distance_to_the_nearest_side) {
  const GroundProfile curb(kCurb);
  EXPECT_EQ(curb.depth(0.5, 0.1), 0.0);
  EXPECT_NEAR(curb.depth(0.5, -0.03), 0.03, 1e-15);
  EXPECT_NEAR(curb.depth(1.01, 0.1), 0.01, 1e-15);
  EXPECT_NEAR(curb.depth(1.05, 0.19), 0.01, 1e-15);
  EXPECT_NEAR(curb.depth(9.0, 0.15), 0.05, 1e-15);
  EXPECT_NEAR(curb.depth(1.03, -0.04), 0.05, 1e-15);  // to the foot of the face
  EXPECT_NEAR(GroundProfile({{0.0, 0.0}, {2.0, 1.0}}).depth(1.0, 0.4), 0.1 * 2.0 / std::sqrt(5.0), 1e-15);
}

TEST(GroundProfile, the_column_under_a_corner_is_its_integral_of_depth) {
  const GroundProfile curb(kCurb);
  EXPECT_NEAR(curb.column(0.2, -0.03), 0.5 * 9e-4, 1e-15);
  // Depth min(a, t) at a from the face, t below the top: t²/2 where t ≤ a, else a²/2 + a (t − a).
  EXPECT_NEAR(curb.column(1.05, 0.16), 0.5 * 16e-4, 1e-15);
  EXPECT_NEAR(curb.column(1.02, 0.15), 2e-4 + 0.02 * 0.03, 0.02 * 8e-4);
}

TEST(GroundProfile, level_stretches_are_known_with_what_is_near_them) {
  const GroundProfile curb(kCurb);
  EXPECT_TRUE(curb.level(0.0, 0.9, 0.05));
  EXPECT_FALSE(curb.level(0.0, 0.9, 0.15));
  EXPECT_TRUE(curb.level(1.2, 1.3, 0.1));
  EXPECT_FALSE(curb.level(1.2, 1.3, 0.25));
  EXPECT_TRUE(GroundProfile({}).level(-1.0, 1.0, 1.0));
  EXPECT_FALSE(GroundProfile({{0.0, 0.0}, {2.0, 1.0}}).level(0.9, 1.1, 0.0));
  EXPECT_TRUE(GroundProfile({{0.0, 0.5}, {2.0, 0.5}}).level(0.9, 3.0, 1.0));
}

TEST(GroundProfile, bad_points_are_refused_by_their_number) {
  EXPECT_EQ(complaint(kCurb), "");
  EXPECT_EQ(complaint({{0, 0}, {-1, 0}}),
            "s.json: key 'terrain.profile.1.0': is -1 m, expected 0 m, as in the entry before, or more");
  EXPECT_EQ(complaint({{0, 0}, {1, 2}, {1, 2}}),
            "s.json: key 'terrain.profile.2': is [1, 2] m as the entry before, expected another point");
  EXPECT_TRUE(holds(complaint({{0, 0}, {0, 1}, {0, 0.5}}), "a third time, expected two entries at most"));
}

TEST(GroundProfile, a_wheel_on_its_level_part_is_pressed_as_on_the_plane) {
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 3);
  GroundOptions plane, curb;
  curb.profile = {{2.0, 0.3}, {2.0, 0.5}};
  const Vec3 up(0.0, 0.0, 0.3);
  const Vec3 velocity(0.5, 0.1, -0.01);
  const SurfaceState low = placed(wheel, {0.3, 0.0, 0.398}, velocity),
                     high = placed(wheel, Vec3(0.3, 0.0, 0.398) + up, velocity);
  const auto a = ground_under(wheel, low, plane), b = ground_under(wheel, high, curb);
  const Push on_plane = push(*a, low, 1e-5), on_curb = push(*b, high, 1e-5);
  // Damping goes with the speed along facets that stand at up to 6°.
  EXPECT_NEAR(on_curb.sums.force.z() / on_plane.sums.force.z(), 1.0, 2e-3);
  EXPECT_NEAR((on_curb.sums.force.x() - on_plane.sums.force.x()) / on_plane.sums.force.z(), 0.0, 2e-3);
  EXPECT_NEAR(b->gather_state().elastic_energy / a->gather_state().elastic_energy, 1.0, 1e-9);
}

TEST(GroundProfile, level_everywhere_is_the_plane) {
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 3);
  const Vec3 velocity(0.5, 0.1, -0.01), axle(0.3, 0.0, 0.398);
  const auto pushed = [&](const ProfilePoints& profile, double height) {
    GroundOptions options;
    options.profile = profile;
    const SurfaceState start = placed(wheel, axle + height * Vec3::UnitZ(), velocity);
    const auto ground = ground_under(wheel, start, options);
    const Push result = push(*ground, start, 1e-3, 4);
    EXPECT_EQ(ground->gather_mean_height(-1.0, 1.0, 0.0, 0.0), height);
    return std::pair(result.sums, ground->gather_state().elastic_energy);
  };
  const auto plane = pushed({}, 0.0);
  for (const double height : {0.0, 0.3}) {
    const auto level = pushed({{-1.0, height}, {0.3, height}, {2.0, height}}, height);
    const double most = 1e-9 * plane.first.force.norm();
    EXPECT_LT((level.first.force - plane.first.force).norm(), most);
    EXPECT_LT((level.first.tangential - plane.first.tangential).norm(), most);
    EXPECT_NEAR(level.second / plane.second, 1.0, 1e-9);
  }
}

/// A block whose lower right edge moves around the curb's edge and back.
TEST(GroundProfile, contact_without_friction_and_damping_gives_back_what_it_took) {
  GroundOptions options;
  options.profile = kCurb;
  options.ground_damping = 0.0;
  options.ground_stiffness = 1e7;
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 1);
  const auto at = [](double phase) {  // the wheel's centre: in contact with face, edge and top in turn
    const double angle = 2.0 * M_PI * phase;
    return Vec3(0.75 + 0.03 * (1.0 - std::cos(angle)), 0.0, 0.52 - 0.03 * std::sin(angle));
  };
  const int steps = 4000;
  const auto ground = ground_under(wheel, placed(wheel, at(0.0), Vec3::Zero()), options, 0.0);
  const double duration = 1e-3;
  double work = 0.0, taken = 0.0, most = 0.0, worst = 0.0;
  const double first = ground->gather_state().elastic_energy;
  for (int k = 0; k < steps; ++k) {
    const Vec3 velocity = (at((k + 1.0) / steps) - at(double(k) / steps)) / duration;
    const Push one = push(*ground, placed(wheel, at(double(k) / steps), velocity), duration);
    const double step = -one.sums.force.dot(velocity) * duration;
    work += step, taken += std::abs(step);
    const double stored = ground->gather_state().elastic_energy - first;
    most = std::max(most, stored), worst = std::max(worst, std::abs(work - stored));
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(std::abs(work), 0.005 * taken);
  EXPECT_LT(worst, 0.02 * most);
  EXPECT_NEAR(ground->gather_state().energies.losses(), 0.0, 1e-9);
}

TEST(GroundProfile, friction_lies_along_the_face_that_is_touched) {
  GroundOptions options;
  options.profile = kCurb;
  const testing::Surface block = testing::box({-0.1, -0.05, 0.0}, {0.0, 0.05, 0.1});
  const SurfaceState start = placed(block, {1.0004, 0.0, 0.05}, Vec3(0.0, 0.0, 3.0));
  const auto ground = ground_under(block, start, options, 0.5);
  Push one;
  SurfaceState now = start;
  for (int k = 0; k < 100; ++k) {
    one = push(*ground, now, 1e-4);
    for (Vec3& x : now.position) x += 1e-4 * now.velocity[0];
  }
  EXPECT_LT(one.sums.force.x(), 0.0);
  EXPECT_NEAR(one.sums.force.z() / one.sums.force.x(), 0.5, 1e-3);  // μ tanh(c v) of the normal force, downwards
}

TEST(GroundProfile, a_restored_ground_continues_bit_for_bit) {
  GroundOptions options;
  options.profile = kCurb;
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 1);
  SurfaceState state = placed(wheel, {0.62, 0.0, 0.3995}, Vec3(0.4, 0.1, 0.02));
  const auto one = ground_under(wheel, state, options, 0.5);
  const auto go = [&](Terrain& ground, int count) {
    Push last;
    for (int k = 0; k < count; ++k) {
      last = push(ground, state, 1e-4);
      for (Vec3& x : state.position) x += 1e-4 * state.velocity[0];
    }
    return last;
  };
  go(*one, 100);
  const auto other = make_rigid_ground(options);
  other->restore(testing::saved(*one));
  const SurfaceState kept = state;
  const Push a = go(*one, 100);
  state = kept;
  const Push b = go(*other, 100);
  EXPECT_EQ(a.sums.force, b.sums.force);
  EXPECT_EQ(one->gather_state().energies.losses(), other->gather_state().energies.losses());
  EXPECT_EQ(one->gather_state().elastic_energy, other->gather_state().elastic_energy);
}

}  // namespace
}  // namespace furrow::terrain
