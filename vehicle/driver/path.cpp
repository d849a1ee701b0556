#include "vehicle/driver/path.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::vehicle {
namespace {

constexpr int kHalvings = 60;  // of a fraction: to round-off

/// The fraction between two at which `changed` becomes true: the last one found at which it is false.
template <class Question>
double bisect(double low, double high, const Question& changed) {
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    (changed(middle) ? high : low) = middle;
  }
  return low;
}

}  // namespace

// Hermite's cubic: p = (1 + 2u)(1 − u)² p₀ + u(1 − u)² m₀ + u²(3 − 2u) p₁ + u²(u − 1) m₁
Vec2 Path::Piece::position(double u) const {
  const double v = 1.0 - u;
  return v * v * ((1.0 + 2.0 * u) * p0 + u * m0) + u * u * ((3.0 - 2.0 * u) * p1 - v * m1);
}

Vec2 Path::Piece::tangent(double u) const {
  const double v = 1.0 - u;
  return 6.0 * u * v * (p1 - p0) + v * (1.0 - 3.0 * u) * m0 + u * (3.0 * u - 2.0) * m1;
}

// ∫₀ᵘ |p′| by Gauss' rule with five points.
double Path::Piece::length(double u) const {
  constexpr std::array<double, 3> kPoint = {0.0, 0.5384693101056831, 0.9061798459386640};
  constexpr std::array<double, 3> kWeight = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
  double sum = kWeight[0] * tangent(0.5 * u).norm();
  for (std::size_t i = 1; i < kPoint.size(); ++i)
    sum += kWeight[i] * (tangent(0.5 * u * (1.0 - kPoint[i])).norm() + tangent(0.5 * u * (1.0 + kPoint[i])).norm());
  return 0.5 * u * sum;
}

Path::Path(const std::vector<PathPoint>& knots) {
  FURROW_ASSERT(knots.size() >= 2, knots.size());
  double start = 0.0;
  for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
    const PathPoint &a = knots[i], &b = knots[i + 1];
    const double chord = (b.position - a.position).norm();
    FURROW_ASSERT(chord > 0.0, i);
    const double cosine = std::sqrt(std::max(0.0, 0.5 * (1.0 + a.direction.dot(b.direction))));  // of θ/2
    const double size = 2.0 * chord / (1.0 + cosine);
    pieces_.push_back({a.position, b.position, size * a.direction, size * b.direction, start});
    start += pieces_.back().length(1.0);
  }
}

PathPoint Path::at(const PathPlace& place) const {
  FURROW_ASSERT(in_range(place.piece, pieces_.size()), place.piece, pieces_.size());
  const Piece& piece = pieces_[static_cast<std::size_t>(place.piece)];
  return {piece.position(place.fraction), piece.tangent(place.fraction).normalized()};
}

double Path::distance(const PathPlace& place) const {
  FURROW_ASSERT(in_range(place.piece, pieces_.size()), place.piece, pieces_.size());
  const Piece& piece = pieces_[static_cast<std::size_t>(place.piece)];
  return piece.start + piece.length(place.fraction);
}

// The distance to the point shrinks along the path while (point − p)·p′ > 0.
PathPlace Path::follow(const PathPlace& from, const Vec2& point) const {
  double u = from.fraction;
  for (std::size_t i = static_cast<std::size_t>(from.piece); i < pieces_.size(); ++i, u = 0.0) {
    const Piece& piece = pieces_[i];
    const auto passed = [&](double w) { return (point - piece.position(w)).dot(piece.tangent(w)) <= 0.0; };
    const int index = static_cast<int>(i);
    if (passed(u)) return {index, u};
    if (passed(1.0)) return {index, bisect(u, 1.0, passed)};
  }
  return end();
}

// After the end: |r + λ d| = distance, with r from the point to the end and the last direction d.
Vec2 Path::look_ahead(const PathPlace& from, const Vec2& point, double distance) const {
  if (!is_end(from)) {
    double u = from.fraction;
    for (std::size_t i = static_cast<std::size_t>(from.piece); i < pieces_.size(); ++i, u = 0.0) {
      const Piece& piece = pieces_[i];
      const auto far = [&](double w) { return (piece.position(w) - point).norm() >= distance; };
      if (far(u)) return piece.position(u);
      if (far(1.0)) return piece.position(bisect(u, 1.0, far));
    }
  }
  const PathPoint last = at(end());
  const Vec2 r = last.position - point;
  const double along = r.dot(last.direction);
  const double root = along * along - r.squaredNorm() + distance * distance;
  FURROW_ASSERT(root >= 0.0, root, distance);
  return last.position + (std::sqrt(std::max(root, 0.0)) - along) * last.direction;
}

PathPlace Path::ahead(const PathPlace& from, double along) const {
  const double wanted = distance(from) + along;
  for (std::size_t i = static_cast<std::size_t>(from.piece); i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const auto reached = [&](double u) { return piece.start + piece.length(u) >= wanted; };
    if (reached(1.0)) return {static_cast<int>(i), bisect(0.0, 1.0, reached)};
  }
  return end();
}

// The angle between the directions at both ends over the distance; a path turns by less than π between them.
double Path::curvature(const PathPlace& from, double near, double far) const {
  FURROW_ASSERT(near >= 0.0 && near < far, near, far);
  const Vec2 a = at(ahead(from, near)).direction, b = at(ahead(from, far)).direction;
  return std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b)) / (far - near);
}

}  // namespace furrow::vehicle
