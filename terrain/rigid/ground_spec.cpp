#include "terrain/rigid/ground_spec.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/json_fields.hpp"
#include "terrain/rigid/rigid_ground.hpp"

namespace furrow::terrain {
namespace {

class GroundSpec final : public TerrainSpec {
 public:
  explicit GroundSpec(GroundOptions options) : options_(std::move(options)) {}

  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "rigid";
    d.name = options_.profile.empty() ? "rigid ground" : "rigid ground with a profile";
    d.gives_tangents = true;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext&) const override {
    TerrainEstimate e;
    e.text = options_.profile.empty()
                 ? "rigid plane z = 0"
                 : fmt::format("rigid profile of {} points", options_.profile.size());
    e.stable_reason = "no grains";
    return e;
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    GroundOptions options = options_;
    static_cast<TerrainContext&>(options) = context;
    return make_rigid_ground(options);
  }

 private:
  GroundOptions options_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_ground_spec(const nlohmann::json& section, const ReadContext& context) {
  GroundOptions options;
  options.scenario = context.file;
  read_fields(section, options);
  check_profile(options.profile, context.file, context.key("profile"));
  return make_ground_spec(options);
}

std::unique_ptr<TerrainSpec> make_ground_spec(const GroundOptions& options) {
  return std::make_unique<GroundSpec>(options);
}

}  // namespace furrow::terrain
