#include "tire/press/press_obstacle.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::tire {
namespace {

constexpr std::string_view kHeader = "x_m,z_m";
constexpr std::size_t kMostPoints = 100000;

/// Takes a number from the front of a line. @returns whether there was one, finite
bool take_number(std::string_view& line, double& value) {
  const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return false;
  line.remove_prefix(static_cast<std::size_t>(end - line.data()));
  return true;
}

}  // namespace

PressObstacle::Profile PressObstacle::at(double x) const {
  if (height <= 0.0) return {};
  const double beyond = std::abs(x - position) - 0.5 * width;
  if (beyond <= 0.0) return {};
  if (beyond >= edge) return {-height, 0.0};
  const double s = beyond / edge;  // smooth step, its slope and curvature continuous
  const double fall = s * s * s * (10.0 - s * (15.0 - 6.0 * s));
  const double slope = 30.0 * s * s * (1.0 - s) * (1.0 - s) / edge;
  const double curvature = 60.0 * s * (1.0 - s) * (1.0 - 2.0 * s) / (edge * edge);
  return {-height * fall, -height * slope * (x < position ? -1.0 : 1.0), -height * curvature};
}

std::vector<std::array<double, 2>> read_press_profile(const std::filesystem::path& file) {
  const std::string text = read_text_file(file, "a profile in CSV");
  std::vector<std::array<double, 2>> points;
  std::string_view rest = text;
  bool header = false;
  for (int number = 1; !rest.empty(); ++number) {
    std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(line.size() + 1, rest.size()));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.empty() || line.starts_with('#')) continue;
    const auto wrong = [&](const std::string& what) {
      return input_error(file.string(), "", fmt::format("line {}: {}", number, what));
    };
    if (!header) {
      if (line != kHeader) throw wrong(fmt::format("expected the header {}", kHeader));
      header = true;
      continue;
    }
    std::array<double, 2> point;
    bool two = take_number(line, point[0]) && line.starts_with(',');
    if (two) line.remove_prefix(1);
    two = two && take_number(line, point[1]) && line.empty();
    if (!two) throw wrong("expected two numbers, x and z in m, with a comma between them");
    if (!points.empty() && !(point[0] > points.back()[0]))
      throw wrong(
          fmt::format("x is {:g} m, expected more than that of the point before, {:g} m", point[0], points.back()[0]));
    if (points.size() == kMostPoints) throw wrong(fmt::format("expected at most {} points", kMostPoints));
    points.push_back(point);
  }
  if (points.size() < 2)
    throw input_error(file.string(), "", fmt::format("has {} points, expected two at least", points.size()));
  return points;
}

}  // namespace furrow::tire
