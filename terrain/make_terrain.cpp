#include "protocol/core/error.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "terrain/terrain_options.hpp"

namespace furrow::terrain {
namespace {

Error unknown_engine(const std::string& name) {
  return input_error("scenario", "terrain.engine", "'" + name + "' is unknown, expected dem or rigid");
}

}  // namespace

std::unique_ptr<Terrain> make_terrain(const TerrainOptions& options) {
  if (options.engine == "dem") return make_dem_terrain(options);
  if (options.engine == "rigid") return make_rigid_ground(options);
  throw unknown_engine(options.engine);
}

TerrainEstimate estimate_terrain(const TerrainOptions& options) {
  if (options.engine == "dem") return estimate_dem_terrain(options);
  if (options.engine != "rigid") throw unknown_engine(options.engine);
  TerrainEstimate e;
  e.stable_step = 1.0;
  e.stable_reason = "no grains";
  return e;
}

}  // namespace furrow::terrain
