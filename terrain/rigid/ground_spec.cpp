#include "terrain/rigid/ground_spec.hpp"

#include <cmath>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "terrain/rigid/ground_map.hpp"
#include "terrain/rigid/ground_shape.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "terrain/rigid/roads/iso_8608.hpp"

namespace furrow::terrain {
namespace {

class GroundSpec final : public TerrainSpec {
 public:
  explicit GroundSpec(GroundOptions options) : options_(std::move(options)) {}

  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "rigid";
    d.name = !options_.road_class.empty() ? "rigid road of class " + options_.road_class
             : options_.map               ? "rigid ground with a height map"
             : options_.profile.empty()   ? "rigid ground"
                                          : "rigid ground with a profile";
    d.gives_tangents = d.answers_at_once = true;
    d.yields = false;
    d.takes_stated_contacts = true;
    if (!options_.road_class.empty())
      d.uneven_key = "road_class";
    else if (!options_.profile_file.empty())
      d.uneven_key = "profile_file";
    else if (!options_.profile.empty())
      d.uneven_key = "profile";
    if (!options_.road_class.empty())
      d.uneven.from = options_.road_from, d.uneven.to = options_.road_from + options_.road_length;
    else
      d.uneven = GroundShape{options_.profile, options_.map}.uneven();
    d.remarks = options_.remarks;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext& context) const override {
    TerrainEstimate e;
    e.text = !options_.road_class.empty() ? fmt::format("rigid road of class {} (ISO 8608), {:g} m long",
                                                        options_.road_class, options_.road_length)
             : options_.map
                 ? fmt::format("rigid height map of {} by {} nodes", options_.map->x.size(), options_.map->y.size())
             : options_.profile.empty() ? "rigid plane z = 0"
                                        : fmt::format("rigid profile of {} points", options_.profile.size());
    e.text += GroundShape{profile(context), options_.map}.range();
    e.stable_reason = "no grains";
    return e;
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    GroundOptions options = options_;
    static_cast<TerrainContext&>(options) = context;
    options.profile = profile(context);
    return make_rigid_ground(options);
  }
  GroundHeights heights(const TerrainContext& context) const override {
    return GroundShape{profile(context), options_.map}.heights();
  }
  ProfilePoints profile(const TerrainContext& context) const override {
    if (options_.road_class.empty()) return options_.profile;
    return iso_8608_road(options_.road_class.front(), options_.road_from, options_.road_length, context.seed);
  }
  /// W = ∫ κ (δ − x²/2R) b dx over the contact of half length a = √(2 R δ) is ⅔ κ b a³/R; dW/dδ = 2 κ b a.
  double stiffness_under(double radius, double width, double load) const override {
    return 2.0 * options_.ground_stiffness * width *
           std::cbrt(1.5 * load * radius / (options_.ground_stiffness * width));
  }
  std::vector<TerrainFile> files() const override {
    if (options_.profile_file.empty()) return {};
    return {{"profile_file", options_.profile_file}};
  }

 private:
  GroundOptions options_;
};

/// One of the ways to say what the ground's heights are.
void check_heights(const GroundOptions& o, const ReadContext& context) {
  const auto alone = [&](bool given, const char* key, const char* other) {
    if (given)
      throw input_error(context.file, context.key(key),
                        std::string("is given beside ") + context.key(other) + ", expected one of them");
  };
  alone(!o.profile_file.empty() && !o.profile.empty(), "profile_file", "profile");
  alone(!o.road_class.empty() && !o.profile.empty(), "road_class", "profile");
  alone(!o.road_class.empty() && !o.profile_file.empty(), "road_class", "profile_file");
}

}  // namespace

std::unique_ptr<TerrainSpec> read_ground_spec(const nlohmann::json& section, const ReadContext& context) {
  GroundOptions options;
  options.scenario = context.file;
  read_fields(section, options);
  check_heights(options, context);
  check_profile(options.profile, context.file, context.key("profile"));
  if (!options.profile_file.empty()) {
    options.profile_file = find_file(options.profile_file, context.key("profile_file"), context.file).string();
    GroundShape shape =
        read_shape(options.profile_file, {options.profile_v, options.profile_from, options.profile_line == "curved"},
                   options.profile_across);
    options.remarks = shape.remarks();
    options.map = std::move(shape.map);
    options.profile = std::move(shape.profile);
  }
  return make_ground_spec(options);
}

std::unique_ptr<TerrainSpec> make_ground_spec(const GroundOptions& options) {
  return std::make_unique<GroundSpec>(options);
}

}  // namespace furrow::terrain
