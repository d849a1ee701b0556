// Vectors in the plane of a wheel that is seen from the side.
#pragma once

#include <cstddef>
#include <vector>

namespace furrow::tire {

struct PlanarPoint {
  double x = 0.0, z = 0.0;  // forward, up: m, m/s or N
};

/// A vector of every node: positions (m), velocities (m/s) or forces (N).
struct PlanarField {
  std::vector<double> x, z;  // forward, up

  PlanarField() = default;
  explicit PlanarField(std::size_t nodes) : x(nodes, 0.0), z(nodes, 0.0) {}
  std::size_t size() const { return x.size(); }
};

}  // namespace furrow::tire
