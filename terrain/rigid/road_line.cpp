#include "terrain/rigid/road_line.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr double kSamePoint = 0.1;    // of the increment: the ends of a closed line
constexpr double kLeastShare = 1e-3;  // of the increment, a + b where segments overlap

double cross(const RoadLine::Vec2& a, const RoadLine::Vec2& b) { return a.x() * b.y() - a.y() * b.x(); }

}  // namespace

RoadLine::RoadLine(Vec2 start, double first, double increment, const std::vector<double>& headings)
    : first_(first), increment_(increment) {
  FURROW_ASSERT(!headings.empty() && increment > 0.0, headings.size(), increment);
  const std::size_t segments = headings.size();
  std::vector<Vec2> along;
  point_.push_back(std::move(start));
  for (const double heading : headings) {
    along.emplace_back(std::cos(heading), std::sin(heading));
    point_.push_back(point_.back() + increment * along.back());
  }
  for (std::size_t k = 0; k <= segments; ++k)
    normal_to_.push_back((along[k == 0 ? 0 : k - 1] + along[std::min(k, segments - 1)]).normalized());
  for (std::size_t k = 1; k < segments; ++k)
    most_curvature_ = std::max(most_curvature_, std::abs(cross(along[k - 1], along[k])) / increment);
  closed_ = segments > 2 && (point_.back() - point_.front()).norm() < kSamePoint * increment;
  if (closed_) normal_to_.front() = normal_to_.back() = (along.front() + along.back()).normalized();
}

RoadLine::Vec2 RoadLine::beside(std::size_t k, double v) const {
  const Vec2& m = normal_to_[k];
  const Vec2 along = (point_[std::min(k + 1, points() - 1)] - point_[std::min(k, points() - 2)]).normalized();
  return point_[k] + v / along.dot(m) * Vec2(-m.y(), m.x());
}

double RoadLine::room(std::size_t segment, double side) const {
  // At v a segment is shorter by v (tan α_k + tan α_{k+1}), α of t_k from m_k and of m_{k+1} from t_k.
  const Vec2 along = (point_[segment + 1] - point_[segment]) / increment_;
  const Vec2 &m = normal_to_[segment], &next = normal_to_[segment + 1];
  const double shorter = side * (cross(m, along) / m.dot(along) + cross(along, next) / next.dot(along));
  return shorter > 0.0 ? increment_ / shorter : std::numeric_limits<double>::infinity();
}

/// No point of a stretch of the line is farther from its middle point than half its length.
std::size_t RoadLine::nearest(const Vec2& at) const {
  std::size_t best = 0;
  double least = (at - point_.front()).norm();
  const auto look = [&](auto&& self, std::size_t from, std::size_t to) -> void {  // [from, to)
    if (from >= to) return;
    const std::size_t middle = from + (to - from) / 2;
    const double distance = (at - point_[middle]).norm();
    if (distance < least || (distance == least && middle < best)) least = distance, best = middle;
    if (distance - increment_ * static_cast<double>(std::max(middle - from, to - 1 - middle)) > least) return;
    const bool ahead = middle + 1 < to && (at - point_[middle + 1]).norm() < distance;
    if (ahead) self(self, middle + 1, to);
    self(self, from, middle);
    if (!ahead) self(self, middle + 1, to);
  };
  look(look, 0, points());
  return best;
}

RoadLine::Place RoadLine::place(Vec2 at, std::size_t near) const {
  const std::size_t last = points() - 2;
  std::size_t k = near;
  if (near > last) {
    k = nearest(at);
    if (closed_ && (k == 0 || k > last)) k = (at - point_.front()).dot(normal_to_.front()) < 0.0 ? last : 0;
  }
  k = std::min(k, last);
  while (k < last && (at - point_[k + 1]).dot(normal_to_[k + 1]) > 0.0) ++k;
  while (k > 0 && (at - point_[k]).dot(normal_to_[k]) < 0.0) --k;
  Place place;
  place.segment = k;
  const Vec2 to = at - point_[k], along = (point_[k + 1] - point_[k]) / increment_;
  place.across = Vec2(-along.y(), along.x());
  place.v = place.across.dot(to);
  const Vec2 from_first = normal_to_[k] / along.dot(normal_to_[k]),
             from_last = normal_to_[k + 1] / along.dot(normal_to_[k + 1]);
  const double a = from_first.dot(to), b = from_last.dot(point_[k + 1] - at), both = a + b;
  const double before = first_ + static_cast<double>(k) * increment_;
  if (a < 0.0 || b < 0.0 || both < kLeastShare * increment_) {  // beyond an end, or where segments overlap
    const double way = along.dot(to);
    place.u = before + (a < 0.0 || b < 0.0 ? way : std::clamp(way, 0.0, increment_));
    place.along = along;
    return place;
  }
  place.u = before + increment_ * a / both;
  place.along = increment_ / (both * both) * (b * from_first + a * from_last);
  return place;
}

}  // namespace furrow::terrain
