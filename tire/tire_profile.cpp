#include "tire/tire_profile.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "tire/natural_spline.hpp"

namespace furrow::tire {

using nlohmann::json;

namespace {

constexpr std::size_t kMaxKnots = 2000;
constexpr std::size_t kPieces = 800;  // of the whole meridian, straight, in the search for crossings

struct Point {
  double t, x, y;
};

/// Twice the area of the triangle a, b, c; positive if they turn left.
double turn(const Point& a, const Point& b, const Point& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/// Whether the straight pieces (a, b) and (c, d) meet in one point within both.
bool cross(const Point& a, const Point& b, const Point& c, const Point& d) {
  if (std::max(a.y, b.y) < std::min(c.y, d.y) || std::max(c.y, d.y) < std::min(a.y, b.y)) return false;
  return turn(a, b, c) * turn(a, b, d) < 0.0 && turn(c, d, a) * turn(c, d, b) < 0.0;
}

/// The meridian as in the mesh, in straight pieces.
std::vector<Point> drawn(const std::vector<ProfileKnot>& profile) {
  std::vector<double> t, x, y;
  for (const ProfileKnot& knot : profile) t.push_back(knot.t), x.push_back(knot.x), y.push_back(knot.y);
  const NaturalSpline height(t, x), axial(t, y);
  const std::size_t between = std::max<std::size_t>(kPieces / (profile.size() - 1), 4);
  std::vector<Point> points;
  for (std::size_t k = 0; k + 1 < t.size(); ++k)
    for (std::size_t i = 0; i < between; ++i) {
      const double s = t[k] + (t[k + 1] - t[k]) * static_cast<double>(i) / static_cast<double>(between);
      points.push_back({s, height.value(s), axial.value(s)});
    }
  points.push_back({t.back(), x.back(), y.back()});
  return points;
}

/// Refuses a shell that passes through itself, which has no inside.
void check_crossings(const std::vector<ProfileKnot>& profile, const JsonReader& reader, const std::string& key) {
  const std::vector<Point> at = drawn(profile);
  for (std::size_t b = 2; b + 1 < at.size(); ++b)
    for (std::size_t a = 0; a + 1 < b; ++a)
      if (cross(at[a], at[a + 1], at[b], at[b + 1])) {
        const double before = turn(at[b], at[b + 1], at[a]), after = turn(at[b], at[b + 1], at[a + 1]);
        const double share = before / (before - after);
        const auto there = [&](double from, double to) {  // to a tenth of a millimetre
          return std::round(1e4 * (from + share * (to - from))) / 1e4 + 0.0;
        };
        reader.fail(key, fmt::format("crosses itself at x = {:g} m, y = {:g} m, between t = {:.2f} and t = {:.2f}, "
                                     "expected a meridian without a loop",
                                     there(at[a].x, at[a + 1].x), there(at[a].y, at[a + 1].y), at[a].t, at[b].t));
      }
}

}  // namespace

std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key) {
  std::vector<ProfileKnot> profile;
  for (const json& row : reader.array(key)) {
    const std::size_t k = profile.size();
    const bool three =
        row.is_array() && row.size() == 3 && row[0].is_number() && row[1].is_number() && row[2].is_number();
    if (!three) reader.fail(fmt::format("{}[{}]", key, k), "expected three numbers t, x, y");
    profile.push_back({row[0].get<double>(), row[1].get<double>(), row[2].get<double>()});
    if (profile[k].x < -1e-9)
      reader.fail(fmt::format("{}[{}]", key, k), "lies below the rim radius, expected x of zero or above");
    if (k > 0 && !(profile[k].t > profile[k - 1].t))
      reader.fail(fmt::format("{}[{}]", key, k), "expected t to increase");
  }
  if (profile.size() < 4 || profile.size() > kMaxKnots)
    reader.fail(key, fmt::format("has {} knots, expected 4 to {}", profile.size(), kMaxKnots));
  if (std::abs(profile.front().t) > 1e-9 || std::abs(profile.back().t - 1.0) > 1e-9)
    reader.fail(key, fmt::format("runs from t = {} to {}, expected 0 to 1", profile.front().t, profile.back().t));
  if (!(profile.back().y > profile.front().y))
    reader.fail(key, "expected y to run from the left (negative) to the right bead");
  check_crossings(profile, reader, key);
  return profile;
}

}  // namespace furrow::tire
