// The obstacle that a tire is pressed on, and the results of pressing, for the static tests of all models.
#pragma once

#include <array>
#include <cmath>
#include <filesystem>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "protocol/core/surface.hpp"

namespace furrow::tire {

/// A flat plate, a flat-topped bar across the direction of travel with rounded edges, or a profile.
///
/// The ground's axes are x forward, y left, z up from the ground; the rim's centre is over their origin. Camber turns
/// the wheel about x. In the wheel's axes, which have the same x, the ground is tilted.
struct PressObstacle {
  double height = 0.0;                         // of the bar's top above the base, m; 0: a plate
  double width = 0.0;                          // of the top along x, m
  double position = 0.0;                       // of the bar's middle, forward of the axle, m
  double camber = 0.0;                         // of the wheel; a positive one leans its top to the right of travel, rad
  double edge = 5e-3;                          // along x, over which the bar's sides rise, m
  double stiffness = 4e9;                      // κ, N/m³: 0.06 mm under 240 kPa
  std::vector<std::array<double, 2>> profile;  // x from the axle, z, m; empty: plate or bar

  struct Profile {
    double height = 0.0, slope = 0.0, curvature = 0.0;  // m, -, 1/m
  };
  /// Profile of plate and bar. The top is at 0; the base of a bar is never touched.
  Profile at(double x) const;
  /// The ground's y and z in the wheel's axes.
  Vec3 left() const { return {0.0, std::cos(camber), -std::sin(camber)}; }
  Vec3 up() const { return {0.0, std::sin(camber), std::cos(camber)}; }
};

/// The obstacle for a model in the plane.
template <class Ground>
Ground plane_ground(const PressObstacle& obstacle, double radius) {
  if (obstacle.profile.empty())
    return obstacle.height > 0.0 ? Ground::bar(obstacle.width, obstacle.position) : Ground::plate(radius);
  std::vector<typename Ground::Point> points;
  for (const auto& [x, z] : obstacle.profile) points.push_back({x, z});
  return Ground(std::move(points));
}

/// Reads rows x_m,z_m of a CSV file, x increasing. @throws Error(bad_input) naming file and line
std::vector<std::array<double, 2>> read_press_profile(const std::filesystem::path& file);

struct PressPoint {
  double deflection = 0.0;  // m
  double force = 0.0;       // on the tire, upwards, N
  double residual = 0.0;    // of the free forces, relative to the load
  int creep_steps = 0;
  int failed_factorizations = 0;
  Wrench rim;  // of the tire on the rim, about its centre, in the ground's axes
};

/// Pressure at a point of the contact surface.
struct PressSample {
  double x = 0.0, y = 0.0;  // in the ground's axes, m
  double area = 0.0;        // m²
  double pressure = 0.0;    // Pa
};

/// Stiffness of a pressed tire against small motions of a ground to which it sticks wherever it touches. Rows are the
/// force and moment that move the ground. Columns are its displacements along x, y and z (m) and its turn about z
/// through the rim's centre (rad). N/m, N, N m/rad. NaN: the model has none.
using GroundStiffness = Eigen::Matrix4d;

}  // namespace furrow::tire
