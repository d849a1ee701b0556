#include "tire/press/press_curve.hpp"

#include <cmath>
#include <filesystem>
#include <limits>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/cache_folder.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/program_id.hpp"
#include "protocol/files/text_file.hpp"
#include "tire/press/press.hpp"

namespace furrow::tire {
namespace {

constexpr int kFormat = 2;             // raise when the bits of a curve or its digest may change
constexpr double kFirstShare = 0.048;  // of the radius, the first deflection
constexpr double kMore = 1.6;          // times the deflection when the load was not reached
constexpr int kMostTrials = 4;
constexpr double kSteepest = 2.0;          // exponent with which a tire's force rises with its deflection, at most
constexpr double kMostPressure = 2e6;      // of any tire, Pa
constexpr int kPoints = 4;                 // of the curve
constexpr int kColumns = 48, kWidth = 12;  // elements of a coarse mesh

std::filesystem::path cache_file(const TireSpec& tire, double deflection) {
  const TireOptions& o = tire.options();
  const std::filesystem::path folder = cache_folder("press");
  if (folder.empty()) return {};
  Hash hash;
  const auto add = [&](const auto& value) { hash.add(&value, sizeof value); };
  hash.add(arithmetic_id());
  add(kFormat);
  add(kPoints);
  add(deflection);
  add(o.elements_circumference);
  add(o.elements_width);
  add(o.structural_damping);
  add(o.pressure.empty() ? -1.0 : o.pressure.at(0.0));
  // Checked where they were read: comments of a .tir may be in any encoding.
  hash.add(read_text_file(o.file, "a tire file in JSON", false));
  for (const std::filesystem::path& named : tire.files()) hash.add(read_text_file(named, "a tire's file", false));
  return folder / (hash.hex() + ".json");
}

/// Checksum of a curve's numbers.
std::string checksum(const PressCurve& curve) {
  Hash hash;
  hash.add(&curve.radius, sizeof curve.radius);
  for (const auto& [deflection, force] : curve.points)
    hash.add(&deflection, sizeof deflection), hash.add(&force, sizeof force);
  return hash.hex();
}

/// Reads a curve from the cache; none if it is missing or damaged.
std::optional<PressCurve> read_curve(const std::filesystem::path& file) {
  if (file.empty()) return std::nullopt;
  const nlohmann::ordered_json json = read_json_if_whole(file);
  const auto numbers = [&](const char* key) {
    std::vector<double> values;
    if (!json.is_object() || !json.contains(key) || !json[key].is_array()) return values;
    for (const auto& value : json[key])
      values.push_back(value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN());
    return values;
  };
  const std::vector<double> radius = numbers("radius_m"), deflection = numbers("deflection_m"),
                            force = numbers("force_N");
  if (radius.size() != 1 || deflection.size() != kPoints + 1 || force.size() != deflection.size()) return std::nullopt;
  PressCurve curve;
  curve.radius = radius.front();
  for (std::size_t k = 0; k < force.size(); ++k) {
    curve.points.emplace_back(deflection[k], force[k]);
    if (!std::isfinite(force[k]) || !std::isfinite(deflection[k])) return std::nullopt;
    if (k > 0 && !(force[k] > force[k - 1] && deflection[k] > deflection[k - 1])) return std::nullopt;
  }
  if (!json.contains("checksum") || json["checksum"] != checksum(curve)) return std::nullopt;
  return curve;
}

void write_curve(const std::filesystem::path& file, const PressCurve& curve) {
  if (file.empty()) return;
  nlohmann::ordered_json json;
  json["checksum"] = checksum(curve);
  json["radius_m"] = {curve.radius};
  for (const auto& [deflection, force] : curve.points) {
    json["deflection_m"].push_back(deflection);
    json["force_N"].push_back(force);
  }
  keep_json(file, json);
}

PressCurve press(const StaticTest& test, const TireSpec& tire, double deflection, const ProgressCall& progress) {
  const std::filesystem::path file = cache_file(tire, deflection);
  if (const std::optional<PressCurve> kept = read_curve(file)) return *kept;
  PressOptions options;
  options.deflection = deflection;
  options.points = kPoints;
  options.load = std::numeric_limits<double>::infinity();  // no footprint is wanted
  options.unload = false;
  const PressResults results = [&] {
    try {
      return test.press(options, progress);
    } catch (const Error& error) {
      throw Error(error.code(), tire.options().file.string() + ": " + error.what());
    }
  }();
  PressCurve curve;
  curve.radius = tire.describe().radius + results.inflation_growth.value_or(0.0);
  for (const PressPoint& point : results.loading) {
    const bool first = curve.points.empty();
    if (!first && !(point.force > curve.points.back().second))
      throw physics_error(fmt::format("{}: pressed by {:.4g} m this tire carries {:.4g} N, and {:.4g} N before",
                                      tire.options().file.string(), point.deflection, point.force,
                                      curve.points.back().second));
    curve.points.emplace_back(point.deflection, first ? 0.0 : point.force);
  }
  write_curve(file, curve);
  return curve;
}

}  // namespace

std::optional<PressCurve> press_curve(const TireSpec& tire, double load, const ProgressCall& progress) {
  FURROW_ASSERT(load > 0.0, load);
  const std::unique_ptr<StaticTest> test = tire.static_test();
  if (!test) return std::nullopt;
  double deflection = kFirstShare * tire.describe().radius;
  for (int trial = 0;; ++trial) {
    PressCurve curve = press(*test, tire, deflection, progress);
    if (curve.points.back().second >= load) return curve;
    // A load that the remaining trials cannot reach needs no pressing.
    const double reached = curve.points.back().second,
                 rise = std::pow(kMore, kSteepest * static_cast<double>(kMostTrials - trial));
    if (trial == kMostTrials || reached * rise < load)
      throw physics_error(fmt::format("{}: pressed by {:.4g} m this tire carries {:.4g} N, expected {:.4g} N",
                                      tire.options().file.string(), deflection, reached, load));
    deflection *= kMore;
  }
}

double hopeless_load(const TireDescription& tire) {
  return tire.deflects ? kMostPressure * 2.0 * tire.radius * tire.width : std::numeric_limits<double>::infinity();
}

TireOptions coarse_for_pressing(TireOptions options) {
  options.elements_circumference = kColumns;
  options.elements_width = kWidth;
  return options;
}

}  // namespace furrow::tire
