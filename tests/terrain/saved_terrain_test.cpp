// Saved states of a terrain with a tire on it whose numbers cannot be: refused by name.
#include <gtest/gtest.h>

#include <limits>

#include "protocol/core/error.hpp"
#include "terrain/dem/dem_terrain.hpp"

namespace furrow::terrain {
namespace {

dem::DemOptions few_large_grains() {
  dem::DemOptions o;
  o.radius = 0.05, o.length = 0.6, o.width = 0.5, o.layers = 1;
  o.step = 1e-4;
  o.allow_unstable_step = true;
  o.threads = o.settle_threads = 1;
  o.cache = false;
  return o;
}

Archive saved() {
  const auto terrain = make_dem_terrain(few_large_grains());
  terrain->prepare({});
  SurfaceState square;
  for (const auto& [x, y] : {std::pair{0.1, -0.1}, {0.3, -0.1}, {0.3, 0.1}, {0.1, 0.1}})
    square.position.emplace_back(x, y, 0.2);
  square.velocity.assign(4, Vec3::Zero());
  ContactMaterial rubber;
  rubber.young_modulus = 1e7, rubber.poisson_ratio = 0.4, rubber.friction = 0.8, rubber.restitution = 0.2;
  terrain->attach({4, {{0, 1, 2}, {0, 2, 3}}}, rubber, square);
  Archive archive;
  terrain->save(archive);
  return archive;
}

template <class Value>
std::string complaint(Archive archive, const std::string& name, const Value& value) {
  if (!archive.has(name)) return "there is no " + name;
  archive.put(name, value);
  const auto terrain = make_dem_terrain(few_large_grains());
  try {
    terrain->prepare({});
    terrain->restore(archive);
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    return error.what();
  }
  return "";
}

TEST(SavedTerrain, a_step_that_is_none_is_refused) {
  const Archive good = saved();
  EXPECT_EQ(complaint(good, "terrain/step", 1e-4), "");
  for (const double step : {0.0, -1.0})
    EXPECT_NE(complaint(good, "terrain/step", step).find("saved state 'step' is"), std::string::npos) << step;
  EXPECT_NE(complaint(good, "terrain/step", std::numeric_limits<double>::quiet_NaN()).find("'step' is not finite"),
            std::string::npos);
}

TEST(SavedTerrain, a_grain_of_a_size_that_the_terrain_does_not_have_is_refused) {
  const Archive good = saved();
  const std::vector<double> positions = good.get<double>("terrain/position");
  EXPECT_EQ(complaint(good, "terrain/position", positions), "");
  for (const double share : {-1.0, 0.0, 0.5, 1.01}) {
    std::vector<double> changed = positions;
    changed[3] *= share;  // x, y, z, radius
    EXPECT_NE(complaint(good, "terrain/position", changed).find("'position' holds a grain of radius"),
              std::string::npos)
        << share;
  }
}

TEST(SavedTerrain, a_tire_of_a_material_that_cannot_be_is_refused) {
  const Archive good = saved();
  for (const auto& [field, value] : {std::pair{"young_modulus", 0.0},
                                     {"young_modulus", -1.0},
                                     {"poisson_ratio", -1.0},
                                     {"poisson_ratio", 0.6},
                                     {"friction", -1.0},
                                     {"restitution", 2.0},
                                     {"area_density", -1.0},
                                     {"cohesion", std::numeric_limits<double>::infinity()}}) {
    std::string name;
    for (const auto& [known, array] : good.arrays())
      if (known.ends_with(std::string("material/") + field)) name = known;
    EXPECT_NE(complaint(good, name, value).find("of surface 0 holds a material that cannot be"), std::string::npos)
        << field << ' ' << value;
  }
}

}  // namespace
}  // namespace furrow::terrain
