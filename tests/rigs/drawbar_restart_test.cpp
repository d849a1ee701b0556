// A restored rig continues bit for bit.
#include <gtest/gtest.h>

#include <cstring>
#include <limits>

#include "protocol/core/error.hpp"
#include "tests/protocol/fields_of.hpp"
#include "tests/rigs/rig_fixture.hpp"

using namespace furrow;
using namespace furrow::testing;

namespace {

Wrench varying(int i) {
  return wrench(Vec3(300.0 + i, 40.0 - 0.3 * i, 4600.0 + 2.0 * i), Vec3(5.0, -100.0 - 0.5 * i, 0.1 * i));
}

void expect_equal(const rigs::Rig& a, const rigs::Rig& b) {
  const rigs::WheelReport x = a.report(0), y = b.report(0);
  EXPECT_EQ(std::memcmp(&x, &y, sizeof x), 0);
  const rigs::Subject wheel = a.subjects().front();
  for (const Column& column : wheel.columns)
    EXPECT_EQ(measured(a, column.name), measured(b, column.name)) << column.name;
  const RimState s = a.rim(0), t = b.rim(0);
  EXPECT_EQ(s.position, t.position);
  EXPECT_EQ(s.orientation.coeffs(), t.orientation.coeffs());
  EXPECT_EQ(s.velocity, t.velocity);
  EXPECT_EQ(s.angular_velocity, t.angular_velocity);
}

}  // namespace

TEST(Restart, continues_bit_for_bit_whether_placed_before_or_not) {
  for (const auto& [mode, move_from] :
       {std::pair{"fixed_angular_speed", 0.0}, {"fixed_speed", 0.0}, {"free_rolling", 0.0}, {"fixed_speed", 0.012}}) {
    rigs::DrawbarRigOptions options = reference_options();
    options.mode = mode;
    options.move_from = move_from;
    options.toe_angle = 0.05;
    options.toe_time = 0.004;
    options.camber_angle = -0.03;
    options.ramp = 0.01;
    options.touchdown_time = 0.012;
    const auto original = placed_rig(options);
    int i = 0;
    for (; i < 211; ++i) advance(*original, varying(i), 1, 4e-5, 2);
    Archive archive;
    original->save(archive);
    const auto placed = placed_rig(options);
    const auto fresh = rigs::make_drawbar_rig(options);
    fresh->add_tire_mass(0, tire_mass(), kRadius);
    placed->restore(archive);
    fresh->restore(archive);
    expect_equal(*original, *placed);
    expect_equal(*original, *fresh);
    for (; i < 500; ++i)
      for (rigs::Rig* rig : {original.get(), placed.get(), fresh.get()}) advance(*rig, varying(i), 1, 4e-5, 2);
    expect_equal(*original, *placed);
    expect_equal(*original, *fresh);
  }
}

TEST(Restart, a_saved_axle_without_a_height_is_refused) {
  const auto rig = placed_rig(reference_options());
  Archive archive;
  rig->save(archive);
  archive.put("rig/placed_height", std::numeric_limits<double>::quiet_NaN());
  EXPECT_THROW(rig->restore(archive), Error);
}

TEST(Restart, continues_bit_for_bit_from_before_and_after_the_axle_is_held) {
  rigs::DrawbarRigOptions options = reference_options();
  options.mode = "free_rolling";
  options.touchdown_time = 0.012;
  for (const int saved : {250, 313, 400}) {
    const auto original = rigs::make_held_drawbar_rig(options, 0.0125);
    original->add_tire_mass(0, tire_mass(), kRadius);
    original->place(std::array{0.5});
    int i = 0;
    for (; i < saved; ++i) advance(*original, varying(i), 1);
    Archive archive;
    original->save(archive);
    const auto fresh = rigs::make_held_drawbar_rig(options, 0.0125);
    fresh->add_tire_mass(0, tire_mass(), kRadius);
    fresh->restore(archive);
    expect_equal(*original, *fresh);
    for (; i < 600; ++i)
      for (rigs::Rig* rig : {original.get(), fresh.get()}) advance(*rig, varying(i), 1);
    expect_equal(*original, *fresh);
    EXPECT_NEAR(original->report(0).vertical_speed, 0.0, 1e-12);
  }
}

TEST(Restart, the_list_of_fields_of_a_report_forgets_no_member) {
  EXPECT_EQ(names_of<rigs::WheelReport>().size(), member_count<rigs::WheelReport>());
}

TEST(Restart, a_report_without_one_of_its_fields_is_refused_by_name) {
  const auto rig = placed_rig(reference_options());
  Archive saved, lacking;
  rig->save(saved);
  for (const auto& [name, values] : saved.arrays())
    if (name != "rig/report/drive_torque") lacking.put_array(name, values);
  try {
    rig->restore(lacking);
    FAIL() << "was restored";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    EXPECT_STREQ(error.what(), "saved state lacks 'rig/report/drive_torque'");
  }
}

TEST(Restart, refuses_the_state_of_another_tire) {
  const auto original = placed_rig(reference_options());
  Archive archive;
  original->save(archive);
  const auto other = placed_rig(reference_options(), tire_mass(2.0));
  EXPECT_THROW(other->restore(archive), Error);
}
