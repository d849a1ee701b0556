#include "rigs/rut_trace.hpp"

#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::rigs {

RutTrace::RutTrace(double spacing, double half_width) : spacing_(spacing), half_width_(half_width) {
  FURROW_ASSERT(spacing > 0.0 && half_width > 0.0, spacing, half_width);
}

void RutTrace::add(const Vec3& bottom) {
  if (!x_.empty() && std::hypot(bottom.x() - x_.back(), bottom.y() - y_.back()) < spacing_) return;
  x_.push_back(bottom.x());
  y_.push_back(bottom.y());
  z_.push_back(bottom.z());
}

std::optional<double> RutTrace::bottom(double x, double y) const {
  double nearest = half_width_ * half_width_;
  std::optional<double> z;
  for (std::size_t i = 0; i < x_.size(); ++i) {
    const double dx = x_[i] - x, dy = y_[i] - y, square = dx * dx + dy * dy;
    if (square > nearest) continue;
    nearest = square;
    z = z_[i];
  }
  return z;
}

void RutTrace::save(Archive& archive, const std::string& name) const {
  archive.put(name + "/x", x_);
  archive.put(name + "/y", y_);
  archive.put(name + "/z", z_);
}

void RutTrace::restore(const Archive& archive, const std::string& name) {
  x_ = archive.get<double>(name + "/x");
  y_ = archive.get<double>(name + "/y", x_.size());
  z_ = archive.get<double>(name + "/z", x_.size());
}

}  // namespace furrow::rigs
