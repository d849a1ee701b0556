#include "vehicle/driver/path_shapes.hpp"

#include <cmath>

#include <Eigen/Geometry>

#include "protocol/core/constants.hpp"
#include "vehicle/driver/lane_change.hpp"

namespace furrow::vehicle {
namespace {

constexpr double kArc = 0.05;   // angle of a circle's pieces at most, rad
constexpr int kGapPieces = 64;  // between two lanes

using Knots = std::vector<PathPoint>;

void add_straight(Knots& knots, double x, double y) { knots.push_back({Vec2(x, y), Vec2::UnitX()}); }

Knots knots_of(const StraightPath& shape, double) {
  Knots knots;
  add_straight(knots, 0.0, 0.0);
  add_straight(knots, shape.length, 0.0);
  return knots;
}

Knots knots_of(const CirclePath& shape, double) {
  Knots knots;
  if (shape.lead_in > 0.0) add_straight(knots, 0.0, 0.0);
  const double angle = shape.angle_deg * kDegree, side = shape.turn == "left" ? 1.0 : -1.0;
  const int pieces = static_cast<int>(std::ceil(angle / kArc));
  for (int i = 0; i <= pieces; ++i) {
    const double a = angle * i / pieces, sine = std::sin(a), cosine = std::cos(a);
    const Vec2 place(shape.lead_in + shape.radius * sine, side * shape.radius * (1.0 - cosine));
    knots.push_back({place, Vec2(cosine, side * sine)});
  }
  return knots;
}

// Between lanes with τ = x/length: y = y₀ + (y₁ − y₀)(10τ³ − 15τ⁴ + 6τ⁵)
void add_gap(Knots& knots, const Lane& from, const Lane& to, double shift) {
  const double length = to.start - from.end, height = to.centre - from.centre;
  for (int i = 1; i < kGapPieces; ++i) {
    const double t = static_cast<double>(i) / kGapPieces, u = 1.0 - t;
    const double y = from.centre + height * t * t * t * (10.0 - 15.0 * t + 6.0 * t * t);
    const double slope = height / length * 30.0 * t * t * u * u;
    knots.push_back({Vec2(shift + from.end + t * length, y), Vec2(1.0, slope).normalized()});
  }
}

Knots knots_of(const LaneChangePath& shape, double vehicle_width) {
  const std::array<Lane, 3> lanes = lanes_of(shape.track, vehicle_width);
  Knots knots;
  if (shape.lead_in > 0.0) add_straight(knots, 0.0, 0.0);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    if (i > 0) add_gap(knots, lanes[i - 1], lanes[i], shape.lead_in);
    add_straight(knots, shape.lead_in + lanes[i].start, lanes[i].centre);
    add_straight(knots, shape.lead_in + lanes[i].end, lanes[i].centre);
  }
  const Lane& last = lanes.back();
  if (shape.lead_out > 0.0) add_straight(knots, shape.lead_in + last.end + shape.lead_out, last.centre);
  return knots;
}

// Chords a and b before and after a point: direction ∝ |b|² a + |a|² b, over both lengths.
Knots knots_of(const WaypointPath& shape, double) {
  Knots knots;
  for (const auto& [x, y] : shape.points) add_straight(knots, x, y);
  const std::size_t n = knots.size();
  const auto chord = [&](std::size_t i) -> Vec2 { return knots[i + 1].position - knots[i].position; };
  for (std::size_t i = 1; i + 1 < n; ++i) {
    const Vec2 a = chord(i - 1), b = chord(i);
    knots[i].direction = (b.squaredNorm() * a + a.squaredNorm() * b).normalized();
  }
  const auto mirrored = [&](std::size_t piece, std::size_t neighbour) -> Vec2 {
    const Vec2 along = chord(piece).normalized();
    if (n == 2) return along;
    const Vec2& d = knots[neighbour].direction;
    return 2.0 * along.dot(d) * along - d;
  };
  knots.front().direction = mirrored(0, 1);
  knots.back().direction = mirrored(n - 2, n - 2);
  return knots;
}

}  // namespace

Path make_path(const PathSpec& spec, double vehicle_width) {
  Knots knots = std::visit([&](const auto& shape) { return knots_of(shape, vehicle_width); }, spec.shape);
  const Eigen::Rotation2Dd turn(spec.heading_deg * kDegree);
  for (PathPoint& knot : knots) {
    knot.position = Vec2(spec.x, spec.y) + turn * knot.position;
    knot.direction = turn * knot.direction;
  }
  return Path(knots);
}

}  // namespace furrow::vehicle
