// Clock, motions, saving, and refusal of bad states.
#include "vehicle/multibody/system.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "protocol/core/error.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/saved.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

struct Swing {
  vehicle::System system;
  int cart, bob;
  Swing() {
    vehicle::BodyState state;
    cart = system.add_body("cart", 5.0, Mat3::Identity(), state);
    state.position = Vec3(0.2, 0.1, -1.0);
    state.angular_velocity = Vec3(0.1, 0.2, 3.0);
    bob = system.add_body("bob", 2.0, Vec3(0.1, 0.2, 0.3).asDiagonal(), state);
    vehicle::JointPlace rail;
    rail.axis = Vec3::UnitX();
    const int joint = system.add_joint(vehicle::JointKind::prismatic, "rail", vehicle::kGround, cart, rail);
    system.add_joint(vehicle::JointKind::spherical, "ball", cart, bob, vehicle::JointPlace{});
    system.add_motor("drive", joint, [](double t) { return vehicle::ramped_motion(t, 1.5, 0.3); });
    system.add_line_element("strut", vehicle::kGround, bob, Vec3(0, 1, 0), Vec3(0.2, 0.1, -1.0),
                            vehicle::linear_spring_damper(300, 1.2, 20));
    system.assemble(0.0);
  }
};

}  // namespace

TEST(Motion, ramp_is_the_integral_of_its_speed_and_twice_continuous) {
  const double v = 3.0, T = 0.2, h = 1e-6;
  for (const double t : {0.02, 0.1, 0.19, 0.2, 0.5}) {
    const double slope =
        (vehicle::ramped_motion(t + h, v, T).value - vehicle::ramped_motion(t - h, v, T).value) / (2 * h);
    EXPECT_NEAR(slope, vehicle::ramped_motion(t, v, T).rate, 1e-8);
  }
  const auto acceleration = [&](double t) {
    return (vehicle::ramped_motion(t + h, v, T).rate - vehicle::ramped_motion(t - h, v, T).rate) / (2 * h);
  };
  EXPECT_NEAR(acceleration(1e-5), 0.0, 1e-2);
  EXPECT_NEAR(acceleration(T - 1e-5), 0.0, 1e-2);
  EXPECT_EQ(vehicle::ramped_motion(0.0, v, 0.0).rate, v);
  EXPECT_EQ(vehicle::ramped_motion(0.0, v, 0.0).value, 0.0);
}

TEST(System, imposed_motion_is_met_in_position_and_speed_at_every_step) {
  Swing swing;
  for (int i = 1; i <= 500; ++i) {
    EXPECT_TRUE(swing.system.step(1e-3).ok);
    EXPECT_EQ(swing.system.time(), i * 1e-3);
    const vehicle::Motion motion = vehicle::ramped_motion(i * 1e-3, 1.5, 0.3);
    ASSERT_NEAR(swing.system.body(swing.cart).state.position.x(), motion.value, 1e-12);
    ASSERT_NEAR(swing.system.body(swing.cart).state.velocity.x(), motion.rate, 1e-13);
  }
}

TEST(System, restored_system_continues_bit_for_bit) {
  Swing original, copy;
  for (int i = 0; i < 137; ++i) EXPECT_TRUE(original.system.step(1e-3).ok);
  copy.system.restore(saved(original.system));
  for (int i = 0; i < 100; ++i) {
    EXPECT_TRUE(original.system.step(1e-3).ok);
    EXPECT_TRUE(copy.system.step(1e-3).ok);
  }
  EXPECT_EQ(saved(copy.system).arrays(), saved(original.system).arrays());
}

TEST(System, a_saved_state_that_counts_no_steps_is_refused) {
  Swing swing;
  EXPECT_TRUE(swing.system.step(1e-3).ok);
  const Archive good = saved(swing.system);
  const auto restored = [&](const char* name, auto value) {
    Archive archive = good;
    archive.put(name, value);
    Swing other;
    other.system.restore(archive);
  };
  EXPECT_NO_THROW(restored("count", std::int64_t{5}));
  EXPECT_THROW(restored("count", std::numeric_limits<std::int64_t>::max()), Error);
  EXPECT_THROW(restored("count", std::int64_t{-1}), Error);
  EXPECT_THROW(restored("step", -1.0), Error);
  EXPECT_THROW(restored("start_time", std::numeric_limits<double>::quiet_NaN()), Error);
}

TEST(System, the_lists_of_what_is_saved_forget_no_member) {
  EXPECT_EQ(names_of<vehicle::BodyState>().size(), member_count<vehicle::BodyState>());
  EXPECT_EQ(names_of<vehicle::Reaction>().size(), member_count<vehicle::Reaction>());
}

TEST(System, a_step_into_not_a_number_fails_and_says_so) {
  Swing swing;
  swing.system.set_load(swing.bob, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0), Vec3::Zero());
  const Outcome outcome = swing.system.step(1e-3);
  EXPECT_FALSE(outcome.ok);
  EXPECT_FALSE(outcome.detail.empty()) << outcome.message("rig");
}

TEST(System, massless_bodies_are_refused) {
  vehicle::System system;
  EXPECT_THROW(system.add_body("ghost", 0.0, Mat3::Identity(), vehicle::BodyState{}), Error);
  EXPECT_THROW(system.add_body("needle", 1.0, Vec3(1, 1, 0).asDiagonal(), vehicle::BodyState{}), Error);
}
