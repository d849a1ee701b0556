#include "terrain/scm/scm_spec.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "terrain/bulk_cohesion.hpp"
#include "terrain/scm/pressure_sinkage.hpp"
#include "terrain/scm/scm_ground.hpp"

namespace furrow::terrain::scm {
namespace {

constexpr double kFrameBytes = 20.0;  // of each node: position, speed, radius in single precision

constexpr double kMostSlope = 0.268;  // 15°
constexpr double kLeastShare =
    1e-4;                        // m, of k_c over k_φ; soils in the table of [Wong 2008] have 5e-4 to 0.2, one 1e-5
constexpr int kIterations = 30;  // of the sinkage below a wheel; each halves the error of its logarithm
constexpr double kMostSlopes = 1e6;  // places where the slope is measured

/// Over the distance of nodes, or where there are very many, of some of them.
double steepest_slope(const ScmOptions& o) {
  const GroundHeights heights = o.shape.heights();
  if (!heights) return 0.0;
  const double apart = std::max(o.grid_spacing, std::sqrt(o.length * o.width / kMostSlopes));
  double most = 0.0;
  for (double x = 0.0; x < o.length; x += apart)
    for (double y = -0.5 * o.width; y < 0.5 * o.width; y += apart) {
      const double z = heights(x, y);
      most = std::max(most, std::hypot(heights(x + apart, y) - z, heights(x, y + apart) - z) / apart);
    }
  return most;
}

std::vector<std::pair<std::string, std::string>> remarks_of(const ScmOptions& o) {
  auto remarks = o.shape.remarks();
  if (o.bekker_k_c != 0.0 && std::abs(o.bekker_k_c) < kLeastShare * o.bekker_k_phi)
    remarks.emplace_back("bekker_k_c",
                         fmt::format("is {:g} N/m^(n+1), less than {:g} m × bekker_k_phi: it changes nothing, or is it "
                                     "in kN?",
                                     o.bekker_k_c, kLeastShare));
  if (const double slope = steepest_slope(o); slope > kMostSlope)
    remarks.emplace_back("profile_file",
                         fmt::format("rises by {:.0f}° at its steepest, expected at most 15°: empirical soil sinks "
                                     "straight down and does not slide",
                                     std::atan(slope) * 180.0 / std::numbers::pi));
  return remarks;
}

class ScmSpec final : public TerrainSpec {
 public:
  explicit ScmSpec(ScmOptions options) : options_(std::move(options)), remarks_(remarks_of(options_)) {}

  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "scm";
    d.name = "empirical soil";
    d.bounds = {options_.length, options_.width};
    d.gives_tangents = d.answers_at_once = true;
    if (options_.shape.given()) {
      d.uneven_key = "profile_file";
      d.uneven = options_.shape.uneven();
    } else {
      d.undisturbed_height = 0.0;
    }
    d.remarks = remarks_;
    if (options_.cone_index > 0.0) d.cone_index = options_.cone_index;
    d.cohesive = options_.mohr_cohesion > kCohesionOfSand;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext&) const override {
    check_scm_options(options_);
    const auto nodes = static_cast<double>(scm_nodes(options_));
    TerrainEstimate e;
    e.text =
        fmt::format("grid of {:.0f} nodes, {:g} mm apart", nodes, 1e3 * options_.grid_spacing) + options_.shape.range();
    e.stable_reason = "no grains";
    e.memory_bytes = (kMemoryPerNode + (options_.shape.given() ? sizeof(double) : 0)) * nodes;
    e.frame_bytes = kFrameBytes * nodes;
    e.checkpoint_bytes = kSavedPerNode * nodes;
    return e;
  }
  /// That of unloading, over the contact from the lowest point forward.
  double stiffness_under(double radius, double width, double load) const override {
    const ScmOptions& o = options_;
    const double z = sinkage(radius, width, load), area = width * std::sqrt(2.0 * radius * z);
    return area * std::max(o.unloading_stiffness + o.unloading_stiffness_rate * z,
                           std::max(1.0, o.bekker_n) * load / (area * z));
  }
  double nodes_under(double radius, double width, double load) const override {
    return std::sqrt(2.0 * radius * sinkage(radius, width, load)) / options_.grid_spacing;
  }
  double modulus_under(double radius, double width, double load) const override {
    const double b = patch_width(radius, width, sinkage(radius, width, load));
    return 1.0 + options_.bekker_k_c / (b * options_.bekker_k_phi);
  }
  void check_tire_width(double width) const override { check_scm_width(options_, width); }
  void check_grousers(double thickness) const override {
    if (options_.grid_spacing > 0.5 * thickness)
      throw input_error(options_.scenario, "terrain.grid_spacing",
                        fmt::format("is {:g} m, expected at most {:g} m, half of tire.grouser_thickness: a node of the "
                                    "soil meets a thinner plate by chance",
                                    options_.grid_spacing, 0.5 * thickness));
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    ScmOptions options = options_;
    static_cast<TerrainContext&>(options) = context;
    return make_scm_ground(options);
  }
  std::vector<TerrainFile> files() const override {
    if (options_.profile_file.empty()) return {};
    return {{"profile_file", options_.profile_file}};
  }

 private:
  /// b of a contact of that width from the lowest point forward: 2 A/P, or the one of the scenario, m.
  double patch_width(double radius, double width, double sinkage) const {
    const double length = std::sqrt(2.0 * radius * sinkage);
    return options_.patch_width >= 0.0 ? options_.patch_width : width * length / (width + length);
  }
  /// Bekker's of a rigid wheel [Bekker 1969], W = ⅓ (3 − n) (k_c/b + k_φ) w √(2R) z^(n + ½), m.
  double sinkage(double radius, double width, double load) const {
    const ScmOptions& o = options_;
    const double rest = std::max(0.1, (3.0 - o.bekker_n) / 3.0) * width * std::sqrt(2.0 * radius);
    double z = 0.1 * radius;
    for (int k = 0; k < kIterations; ++k) {  // the modulus grows or falls with z, as b follows the contact
      const double modulus =
          PressureLaw{.k_c = o.bekker_k_c, .k_phi = o.bekker_k_phi}.modulus(patch_width(radius, width, z));
      z = std::sqrt(z * std::min(radius, std::pow(load / (rest * modulus), 1.0 / (o.bekker_n + 0.5))));
    }
    return z;
  }

  ScmOptions options_;
  std::vector<std::pair<std::string, std::string>> remarks_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_scm_spec(const nlohmann::json& section, const ReadContext& context) {
  ScmOptions options;
  options.scenario = context.file;
  read_fields(section, options);
  if (!options.profile_file.empty()) {
    options.profile_file = find_file(options.profile_file, context.key("profile_file"), context.file).string();
    options.shape =
        read_shape(options.profile_file, {options.profile_v, options.profile_from, options.profile_line == "curved"},
                   options.profile_across);
  }
  return make_scm_spec(options);
}

std::unique_ptr<TerrainSpec> make_scm_spec(const ScmOptions& options) { return std::make_unique<ScmSpec>(options); }

}  // namespace furrow::terrain::scm
