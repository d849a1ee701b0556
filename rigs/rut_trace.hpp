// The bottom of the ruts that wheels have rolled, from the lowest points of their tires: the soil that a following
// wheel finds already pressed. Elastic rebound and soil that falls back into a rut are ignored.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/vec.hpp"

namespace furrow::rigs {

class RutTrace {
 public:
  /// @param spacing of its points, m @param half_width of the rut, m
  RutTrace(double spacing, double half_width);

  /// Adds the tire's lowest point below the wheel's centre.
  void add(const Vec3& bottom);
  /// Returns z of the nearest point; none if all points are farther away than half the rut's width.
  std::optional<double> bottom(double x, double y) const;

  void save(Archive& archive, const std::string& name) const;
  void restore(const Archive& archive, const std::string& name);

 private:
  double spacing_, half_width_;
  std::vector<double> x_, y_, z_;
};

}  // namespace furrow::rigs
