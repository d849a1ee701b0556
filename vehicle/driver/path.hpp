// A path in the horizontal plane: cubic curves from knot to knot with the knots' directions, so that the direction is
// continuous. With the chord d between two knots and the angle θ between their directions, the curve's tangents there
// are 2d/(1 + cos θ/2) long. For knots on a circle the curve then also meets the middle of the arc, and its distance
// from the circle is less than 1e-3 θ⁶ of the radius. After its last knot the path continues straight.
#pragma once

#include <vector>

#include <Eigen/Core>

#include "protocol/core/fields.hpp"

namespace furrow::vehicle {

using Vec2 = Eigen::Vector2d;  // W, horizontal

struct PathPoint {
  Vec2 position = Vec2::Zero();    // m
  Vec2 direction = Vec2::UnitX();  // of length 1
};

/// A place on a path. Places further on compare greater: by piece, then by fraction.
struct PathPlace {
  int piece = 0;          // counted from 0
  double fraction = 0.0;  // of the piece, 0 to 1
};
void visit_fields(FieldsOf<PathPlace> auto& s, auto&& visit) {
  visit(s.piece, Field{"piece"});
  visit(s.fraction, Field{"fraction"});
}

class Path {
 public:
  /// @pre at least two knots, neighbours at different places
  explicit Path(const std::vector<PathPoint>& knots);

  PathPoint at(const PathPlace& place) const;
  double distance(const PathPlace& place) const;  // from the first knot along the path, m
  PathPlace end() const { return {static_cast<int>(pieces_.size()) - 1, 1.0}; }
  bool is_end(const PathPlace& place) const { return place.piece == end().piece && place.fraction == 1.0; }

  /// The first place at or after `from` from which the path leads away from `point`. It never moves back, so paths may
  /// cross themselves.
  PathPlace follow(const PathPlace& from, const Vec2& point) const;
  /// The first position at or after `from` that is at least `distance` from `point`. @pre beyond the end of the path,
  /// the point is less than `distance` to the side of it
  Vec2 look_ahead(const PathPlace& from, const Vec2& point, double distance) const;
  /// Mean curvature of the path between two distances ahead of a place, 1/m, positive to the left; 0 after its end.
  /// @pre 0 ≤ near < far
  double curvature(const PathPlace& from, double near, double far) const;

 private:
  PathPlace ahead(const PathPlace& from, double distance) const;  // along the path
  struct Piece {
    Vec2 p0, p1;         // its ends, m
    Vec2 m0, m1;         // tangents there, by the fraction, m
    double start = 0.0;  // length of the path before it, m
    Vec2 position(double u) const;
    Vec2 tangent(double u) const;
    double length(double u) const;  // from its start, m
  };
  std::vector<Piece> pieces_;
};

}  // namespace furrow::vehicle
