// The reference line of a road in the plane, and places by the way u along it and the distance v to its left.
//
// The line is straight between points P_0 … P_n that are `increment` apart. Segment k, from P_k to P_{k+1}, holds the
// places between the normals of the line at its ends: at a point within the line on P_{k+1} − P_{k−1}, at the ends of
// the line on its first or last segment, of a closed line in the middle between both. With m_k the unit vector along
// the former, t_k along the segment,
//   v = t_k × (p − P_k),   u = u_k + increment · a/(a + b),
//   a = (p − P_k)·m_k / (t_k·m_k),   b = (P_{k+1} − p)·m_{k+1} / (t_k·m_{k+1}).
// Before and behind the line u goes on straight. This is the evaluation of ASAM OpenCRG 1.2.0 (chapter 9, "Evaluation")
// but for the search: here the segment is that beside the nearest point of the whole line.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Core>

namespace furrow::terrain {

class RoadLine {
 public:
  using Vec2 = Eigen::Vector2d;

  struct Place {
    double u = 0.0, v = 0.0;                                        // m
    Vec2 along = Vec2::UnitX(), across = Vec2::UnitY();             // gradients of u and v over x and y
    std::size_t segment = std::numeric_limits<std::size_t>::max();  // none: not known
  };

  /// @param first u of the first point @param headings of the segments, rad @pre one segment at least, increment > 0
  RoadLine(Vec2 start, double first, double increment, const std::vector<double>& headings);

  /// @param near a segment to begin with, for places close to one whose segment is known; else the nearest point is
  /// looked for
  Place place(Vec2 at, std::size_t near = std::numeric_limits<std::size_t>::max()) const;
  /// Where the point k of the line lies moved by v to the left, on the normal of the line.
  Vec2 beside(std::size_t k, double v) const;
  std::size_t points() const { return point_.size(); }
  /// The largest v to the left (side 1) or right (side −1) of a segment at which its places do not overlap with those
  /// of the segments beside it, m; infinite where the line does not turn to that side.
  double room(std::size_t segment, double side) const;
  double most_curvature() const { return most_curvature_; }  // 1/m

 private:
  std::size_t nearest(const Vec2& at) const;

  std::vector<Vec2> point_, normal_to_;  // P_k, m_k
  double first_, increment_, most_curvature_ = 0.0;
  bool closed_ = false;  // the last point is the first
};

}  // namespace furrow::terrain
