// Flexible tires rolling on hard ground: impulses balance in every interval, ten revolutions gain no energy, mirrored
// angles give mirrored forces. FURROW_ROLLING_MESH=60x12 rolls the ten revolutions on this mesh instead of 30x6;
// FURROW_ROLLING_CSV names a file that receives their energies (tests/studies/revolutions.csv).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <vector>

#include "protocol/core/constants.hpp"
#include "tests/nodal_sums.hpp"
#include "tests/nodes/rolling_tire.hpp"
#include "tests/rigs/reference_options.hpp"
#include "tire/wheel_axes.hpp"

namespace furrow::test {
namespace {

constexpr double kStep = 1e-4;  // s

rigs::DrawbarRigOptions free_rolling(double speed) {
  rigs::DrawbarRigOptions options = testing::reference_options();
  options.mode = "free_rolling";
  options.speed = speed;
  options.ramp = 0.1;
  options.touchdown_time = 0.2;
  return options;
}

double load_of(RollingTire& rolling) { return rolling.rig->report(0).carried_mass * kStandardGravity; }

/// M (0, 0, −g), consistent.
tire::Field consistent_weight(const tire::AncfTire& tire) {
  const tire::ShellLayout& layout = tire.integrator().layout();
  tire::Field down(layout.size(), 0.0), weight(layout.size(), 0.0);
  for (int j = 0; j < layout.rows; ++j)
    for (int i = 0; i < layout.columns; ++i) layout.set(down, i, j, 0, Vec3(0, 0, -kStandardGravity));
  layout.fill_padding(down);
  tire.integrator().mass().apply(down, 1.0, weight);
  return weight;
}

/// Wrench of the ground on the tire over the last interval, about the world's origin.
Wrench acted(const RollingTire& rolling) {
  return {sum(rolling.on_tire), 0.5 * (moment_about(Vec3::Zero(), rolling.on_tire, rolling.before) +
                                       moment_about(Vec3::Zero(), rolling.on_tire, rolling.after))};
}

TEST(Rolling, spindle_impulse_is_that_of_ground_and_gravity_less_the_tires_momentum_to_1e10_of_the_load) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json"}) {
    rigs::DrawbarRigOptions options = free_rolling(4.0);
    options.toe_angle = 0.03;
    options.camber_angle = 0.03;
    RollingTire rolling(small_file(name, 30, 6), options, kStep);
    const tire::ShellLayout& layout = rolling.tire.integrator().layout();
    const tire::Field weight = consistent_weight(rolling.tire);
    const double load = load_of(rolling);
    double worst = 0.0, worst_moment = 0.0;
    auto [p, l] = momenta(rolling.tire);
    for (int n = 0; n < 5000; ++n) {
      const tire::Field from = rolling.tire.integrator().q();
      rolling.step();
      const tire::Field& to = rolling.tire.integrator().q();
      const Wrench on_rim = rolling.tire.spindle_wrench();
      const Vec3 centre = 0.5 * (rolling.trajectory.start().position + rolling.trajectory.end().position);
      Vec3 force = -on_rim.force, moment = -on_rim.moment - centre.cross(on_rim.force);
      for (int j = 0; j < layout.rows; ++j)
        for (int i = 0; i < layout.columns; ++i) {
          force += layout.get(weight, i, j, 0);
          for (const int s : {0, 3})
            moment += (0.5 * (layout.get(from, i, j, s) + layout.get(to, i, j, s))).cross(layout.get(weight, i, j, s));
        }
      const Wrench from_ground = acted(rolling);
      force += from_ground.force, moment += from_ground.moment;
      const auto [p1, l1] = momenta(rolling.tire);
      worst = std::max(worst, (p1 - p - kStep * force).norm() / (kStep * load));
      worst_moment = std::max(worst_moment, (l1 - l - kStep * moment).norm() / (kStep * load));  // arm of 1 m
      p = p1, l = l1;
    }
    EXPECT_GT(rolling.contact.force.z(), 0.5 * load);
    EXPECT_LT(worst, 1e-10) << name;
    EXPECT_LT(worst_moment, 1e-10) << name;
    std::printf("%s: impulse %.2g, angular impulse over 1 m %.2g of the load's\n", name, worst, worst_moment);
  }
}

std::pair<int, int> mesh() {
  std::pair<int, int> size{30, 6};
  if (const char* text = std::getenv("FURROW_ROLLING_MESH")) {
    EXPECT_EQ(std::sscanf(text, "%dx%d", &size.first, &size.second), 2) << text;
  }
  return size;
}

void write_energies(const char* name, int columns, int width, const std::vector<double>& mean,
                    const std::vector<double>& highest) {
  const char* path = std::getenv("FURROW_ROLLING_CSV");
  if (!path) return;
  std::FILE* file = std::fopen(path, "a");
  ASSERT_NE(file, nullptr) << path;
  std::fseek(file, 0, SEEK_END);
  if (std::ftell(file) == 0) std::fprintf(file, "tire,mesh,revolution,energy_mean_J,energy_highest_J\n");
  for (std::size_t k = 0; k < mean.size(); ++k)
    std::fprintf(file, "%s,%dx%d,%zu,%.6g,%.6g\n", name, columns, width, k, mean[k], highest[k]);
  std::fclose(file);
}

TEST(Rolling, ten_revolutions_gain_no_energy) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json"}) {
    const auto [columns, width] = mesh();
    RollingTire rolling(small_file(name, columns, width), free_rolling(8.0), kStep);
    std::vector<double> mean, highest;
    double angle = 0.0, sum = 0.0, most = -1e300;
    int count = 0;
    while (mean.size() < 11) {
      rolling.step();
      angle += kStep * rolling.rig->report(0).spin;
      const tire::TireDiagnostics d = rolling.tire.diagnostics();
      const double energy = d.kinetic_energy + d.strain_energy();
      sum += energy, most = std::max(most, energy), ++count;
      if (angle < 2.0 * std::numbers::pi) continue;
      mean.push_back(sum / count), highest.push_back(most);
      angle -= 2.0 * std::numbers::pi, sum = 0.0, most = -1e300, count = 0;
    }
    write_energies(name, columns, width, mean, highest);
    // The first revolution contains touch-down and start; their bounce dies out.
    const double kinetic = 0.5 * rolling.tire.mass_properties().mass * 64.0;
    double first = 0.0, second = 0.0;
    for (std::size_t k = 1; k <= 5; ++k) first += mean[k] / 5, second += mean[k + 5] / 5;
    EXPECT_NEAR(second, first, 5e-3 * kinetic) << name;
    EXPECT_LE(*std::max_element(highest.begin() + 6, highest.end()),
              *std::max_element(highest.begin() + 1, highest.begin() + 6) + 1e-3 * kinetic)
        << name;
  }
}

/// Mean force and moment in the tire's axes on the ground over the last part of a roll.
Wrench mean_wrench(double toe, double camber, double& slip_angle) {
  rigs::DrawbarRigOptions options = free_rolling(4.0);
  options.toe_angle = toe;
  options.camber_angle = camber;
  RollingTire rolling(small_file("hmmwv_lumped.json", 30, 6), options, kStep);
  Wrench sum;
  int count = 0;
  for (int n = 0; n < 4500; ++n) {
    const Vec3 from = rolling.rig->rim(0).position;
    rolling.step();
    if (n < 3000) continue;
    RimState rim = rolling.rig->rim(0);
    rim.position = 0.5 * (from + rim.position);
    const tire::WheelAxes axes = tire::wheel_axes(rim, Vec3::UnitX(), 0.0);
    const Wrench from_ground = acted(rolling);
    const Wrench now = axes.wrench(from_ground.force, from_ground.moment, Vec3::Zero());
    sum.force += now.force, sum.moment += now.moment, ++count;
    slip_angle = axes.slip_angle;
    EXPECT_NEAR(axes.camber_angle, camber, 1e-9);
  }
  sum.force /= count, sum.moment /= count;
  return sum;
}

TEST(Rolling, mirrored_toe_and_camber_mirror_forces_and_moments_and_oppose_the_slip) {
  for (const auto& [toe, camber] : {std::pair{0.02, 0.0}, std::pair{0.0, 0.05}}) {
    double slip_angle = 0.0, mirrored_slip_angle = 0.0;
    const Wrench a = mean_wrench(toe, camber, slip_angle), b = mean_wrench(-toe, -camber, mirrored_slip_angle);
    EXPECT_NEAR(slip_angle, -toe, 1e-9);
    EXPECT_NEAR(mirrored_slip_angle, toe, 1e-9);
    const double load = a.force.z();
    EXPECT_NEAR(a.force.x(), b.force.x(), 1e-3 * load);
    EXPECT_NEAR(a.force.y(), -b.force.y(), 1e-3 * load);
    EXPECT_NEAR(a.force.z(), b.force.z(), 1e-3 * load);
    EXPECT_NEAR(a.moment.x(), -b.moment.x(), 1e-3 * load * 0.5);
    EXPECT_NEAR(a.moment.y(), b.moment.y(), 1e-3 * load * 0.5);
    EXPECT_NEAR(a.moment.z(), -b.moment.z(), 1e-3 * load * 0.5);
    std::printf("toe %g, camber %g: Fy %.4g and %.4g N, Mz %.4g and %.4g N m\n", toe, camber, a.force.y(), b.force.y(),
                a.moment.z(), b.moment.z());
    if (toe > 0.0) {  // wheel to the left: slips to its right, is pushed to the left, and turned back
      EXPECT_GT(a.force.y(), 0.05 * load);
      EXPECT_LT(a.moment.z(), 0.0);
    } else {  // top to the right: camber thrust to the right
      EXPECT_LT(a.force.y(), -0.005 * load);
    }
  }
}

}  // namespace
}  // namespace furrow::test
