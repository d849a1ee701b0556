#include "tire/handling/sweep_table.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "protocol/files/printable.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::tire::handling {
namespace {

constexpr double kStraight = 1e-6;                        // rad
constexpr double kMostLoad = 1e9;                         // N
constexpr double kLeastRadius = 1e-3, kMostRadius = 1e3;  // m
constexpr auto kColumns =
    std::to_array<const char*>({"iso_w.force_N.0", "iso_w.force_N.1", "iso_w.force_N.2", "iso_w.moment_Nm.0",
                                "iso_w.moment_Nm.1", "iso_w.moment_Nm.2", "iso_w.slip_angle_rad",
                                "iso_w.camber_angle_rad", "iso_w.loaded_radius_m", "effective_rolling_radius_m"});

/// Of a line of CSV with quotes (RFC 4180).
std::vector<std::string> cells_of(const std::string& line) {
  std::vector<std::string> cells(1);
  bool quoted = false;
  for (std::size_t k = 0; k < line.size(); ++k) {
    const char c = line[k];
    if (c == '"' && quoted && k + 1 < line.size() && line[k + 1] == '"')
      cells.back() += line[++k];
    else if (c == '"')
      quoted = !quoted;
    else if (c == ',' && !quoted)
      cells.emplace_back();
    else if (c != '\r')
      cells.back() += c;
  }
  return cells;
}

/// Straight lines through (load, radius), and beyond the first and last.
double between(const std::vector<std::pair<double, double>>& points, double load) {
  if (points.size() == 1) return points.front().second;
  std::size_t k = 1;
  while (k + 1 < points.size() && points[k].first < load) ++k;
  const auto& [x0, y0] = points[k - 1];
  const auto& [x1, y1] = points[k];
  return y0 + (y1 - y0) * (load - x0) / (x1 - x0);
}

}  // namespace

std::vector<SweepPoint> read_sweep_table(const std::filesystem::path& file) {
  std::istringstream lines(read_text_file(file, "a table of furrow sweep in CSV"));
  std::vector<std::string> header;
  std::vector<SweepPoint> points;
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    if (trimmed(line).empty() || line.front() == '#') continue;
    const auto wrong = [&](const std::string& what) {
      return input_error(file.string(), fmt::format("line {}", number), what);
    };
    const std::vector<std::string> cells = cells_of(line);
    const auto at = [&](const std::string& name) {
      return static_cast<std::size_t>(std::find(header.begin(), header.end(), name) - header.begin());
    };
    if (header.empty()) {
      header = cells;
      for (const char* name : kColumns)
        if (at(name) == header.size())
          throw wrong(fmt::format("has no column '{}', expected it among the results of the study", name));
      if (at("rig.mode") == header.size())
        throw wrong("has no column 'rig.mode', expected a study whose runs say it: some roll freely");
      continue;
    }
    if (cells.size() != header.size())
      throw wrong(fmt::format("has {} values, expected {}", cells.size(), header.size()));
    if (const std::size_t state = at("state"); state < header.size() && cells[state] != "done") continue;
    std::array<double, kColumns.size()> v{};
    for (std::size_t k = 0; k < v.size(); ++k) {
      const std::string& cell = cells[at(kColumns[k])];
      const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), v[k]);
      if (error != std::errc() || end != cell.data() + cell.size() || !std::isfinite(v[k]))
        throw wrong(fmt::format("{} is '{}', expected a number", kColumns[k], excerpt(cell)));
    }
    SweepPoint p;
    p.forces = {.fx = v[0], .fy = v[1], .fz = v[2], .mx = v[3], .my = v[4], .mz = v[5]};
    p.state = {.load = v[2], .slip_angle = v[6], .camber = v[7]};
    p.loaded_radius = v[8];
    p.rolling_radius = v[9];
    if (!(p.state.load > 0.0 && p.state.load <= kMostLoad && p.rolling_radius >= kLeastRadius &&
          p.rolling_radius <= kMostRadius))
      throw wrong(
          fmt::format("has a load of {:g} N and a rolling radius of {:g} m, expected a wheel that rolls on the ground: "
                      "above 0 to {:g} N, {:g} to {:g} m",
                      p.state.load, p.rolling_radius, kMostLoad, kLeastRadius, kMostRadius));
    const bool free = cells[at("rig.mode")] == "free_rolling";
    p.rolls_freely = free && std::abs(p.state.slip_angle) < kStraight && std::abs(p.state.camber) < kStraight;
    p.state.slip = free ? 0.0 : std::numeric_limits<double>::quiet_NaN();
    points.push_back(p);
  }
  std::vector<std::pair<double, double>> free;
  for (const SweepPoint& p : points)
    if (p.rolls_freely) free.emplace_back(p.state.load, p.rolling_radius);
  std::sort(free.begin(), free.end());
  free.erase(std::unique(free.begin(), free.end(), [](const auto& a, const auto& b) { return a.first == b.first; }),
             free.end());
  if (free.empty())
    throw input_error(file.string(), "",
                      "has no row with rig.mode free_rolling, straight and upright, expected one at each load: slip "
                      "counts from free rolling");
  for (SweepPoint& p : points)
    if (std::isnan(p.state.slip)) p.state.slip = between(free, p.state.load) / p.rolling_radius - 1.0;
  return points;
}

}  // namespace furrow::tire::handling
