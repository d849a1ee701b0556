// The bottom of the ruts that wheels have rolled, as the lowest points of their tires: what a wheel that follows finds
// already pressed. Elastic rebound and what falls back into a rut are not seen.
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

  /// The tire's lowest point is at `bottom` where the wheel's centre is above.
  void add(const Vec3& bottom);
  /// z of the nearest point, none where the rut does not pass: where all points are farther away than half its width.
  std::optional<double> bottom(double x, double y) const;

  void save(Archive& archive, const std::string& name) const;
  void restore(const Archive& archive, const std::string& name);

 private:
  double spacing_, half_width_;
  std::vector<double> x_, y_, z_;
};

}  // namespace furrow::rigs
