// Hard ground with a height map: closed forms of its contact with a box, its energy, and its files.
#include "terrain/rigid/ground_map.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <utility>

#include "protocol/core/error.hpp"
#include "terrain/rigid/rigid_ground.hpp"
#include "terrain/rigid/roads/read_map.hpp"
#include "terrain/rigid/roads/read_road.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"
#include "tests/terrain/ground_push.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain {
namespace {

/// A map of 4 m by 2 m about the origin with nodes `apart` from each other.
template <class Height>
HeightMap map_of(double apart, const Height& height) {
  HeightMap map;
  for (double x = -2.0; x <= 2.0 + 1e-9; x += apart) map.x.push_back(x);
  for (double y = -1.0; y <= 1.0 + 1e-9; y += apart) map.y.push_back(y);
  for (const double x : map.x)
    for (const double y : map.y) map.z.push_back(height(x, y));
  return map;
}

GroundOptions options_of(const HeightMap& map) {
  GroundOptions options;
  options.map = std::make_shared<const HeightMap>(map);
  options.ground_stiffness = 1e7;
  options.ground_damping = 0.0;
  return options;
}

TEST(GroundMap, heights_are_straight_between_nodes_and_those_of_the_border_beyond_it) {
  const GroundMap map({{0.0, 1.0, 3.0}, {0.0, 2.0}, {0.0, 1.0, 2.0, 3.0, 4.0, 5.0}});
  EXPECT_DOUBLE_EQ(map.height(0.5, 1.0), 1.5);
  EXPECT_DOUBLE_EQ(map.height(2.0, 0.5), 3.25);
  EXPECT_DOUBLE_EQ(map.height(-7.0, 9.0), 1.0);
  EXPECT_DOUBLE_EQ(map.height(8.0, -1.0), 4.0);
  EXPECT_NEAR(map.cosine(0.5, 1.0), 1.0 / std::sqrt(1.0 + 4.0 + 0.25), 1e-15);
  EXPECT_DOUBLE_EQ(map.cosine(-1.0, 5.0), 1.0);
  EXPECT_DOUBLE_EQ(map.highest(0.2, 0.4, 0.0, 1.0), 1.3);
  EXPECT_DOUBLE_EQ(map.highest(-5.0, 9.0, -5.0, 5.0), 5.0);
  EXPECT_NEAR(map.mean(0.0, 1.0, 0.0, 2.0), 1.5, 1e-12);
  EXPECT_NEAR(map.depth({0.5, 1.0, 1.0}), 0.5 * map.cosine(0.5, 1.0), 1e-15);
  EXPECT_EQ(map.depth({0.5, 1.0, 2.0}), 0.0);
}

/// ∮ −p n dA = κ V n and E = κ ∫ ½ c (h − z)² dA of the part of a box under a plane.
TEST(GroundMap, a_box_in_a_tilted_plane_is_pushed_along_its_normal_by_stiffness_times_volume) {
  const double sx = 0.3, sy = -0.2, c = 1.0 / std::sqrt(1.0 + sx * sx + sy * sy), length = 0.2, width = 0.1;
  for (const double apart : {1.0, 0.05, 0.01}) {
    const GroundOptions options = options_of(map_of(apart, [&](double x, double y) { return sx * x + sy * y; }));
    const testing::Surface box = testing::box({-0.5 * length, -0.5 * width, 0.0}, {0.5 * length, 0.5 * width, 0.3});
    const Vec3 place(0.31, 0.17, 0.0), deep(0.31, 0.17, sx * 0.31 + sy * 0.17 - 0.06);
    const SurfaceState above = placed(box, place + Vec3(0.0, 0.0, 0.2), Vec3::Zero());
    const auto ground = ground_under(box, above, options, 0.0);
    const SurfaceState in = placed(box, deep, Vec3::Zero());
    push(*ground, in, 1e-3);
    const Push one = push(*ground, in, 1e-3);
    const double force = options.ground_stiffness * 0.06 * length * width;
    const Vec3 normal = c * Vec3(-sx, -sy, 1.0);
    EXPECT_LT((one.sums.force - force * normal).norm(), 1e-6 * force) << "nodes " << apart << " m apart";
    const double square = 0.06 * 0.06 + (sx * sx * length * length + sy * sy * width * width) / 12.0;
    EXPECT_NEAR(ground->gather_state().elastic_energy, 0.5 * options.ground_stiffness * c * square * length * width,
                1e-6 * force * 0.06);
  }
}

TEST(GroundMap, contact_without_friction_and_damping_gives_back_what_it_took) {
  const GroundOptions options =
      options_of(map_of(0.05, [](double x, double y) { return 0.01 * std::sin(9.0 * x) * std::cos(7.0 * y); }));
  const testing::Surface wheel = testing::wheel(0.4, 0.2, 60, 3);
  const auto at = [](double phase) {
    const double angle = 2.0 * M_PI * phase;
    return Vec3(0.2 + 0.05 * (1.0 - std::cos(angle)), 0.04 * std::sin(angle), 0.412 - 0.01 * (1.0 - std::cos(angle)));
  };
  const int steps = 1000;
  const auto ground = ground_under(wheel, placed(wheel, at(0.0), Vec3::Zero()), options, 0.0);
  const double duration = 1e-3;
  double work = 0.0, taken = 0.0, most = 0.0, worst = 0.0;
  const double first = ground->gather_state().elastic_energy;
  for (int k = 0; k < steps; ++k) {
    const Vec3 velocity = (at((k + 1.0) / steps) - at(double(k) / steps)) / duration;
    const Push one = push(*ground, placed(wheel, at(double(k) / steps), velocity), duration);
    const double step = -one.sums.force.dot(velocity) * duration;
    work += step, taken += std::abs(step);
    const double stored = ground->gather_state().elastic_energy - first;
    most = std::max(most, stored), worst = std::max(worst, std::abs(work - stored));
  }
  EXPECT_GT(most, 1.0);
  EXPECT_LT(std::abs(work), 0.005 * taken);
  EXPECT_LT(worst, 0.02 * most);
}

TEST(GroundMap, friction_lies_in_the_plane_of_the_ground) {
  const double sy = 0.2, c = 1.0 / std::sqrt(1.0 + sy * sy);
  const GroundOptions options = options_of(map_of(0.5, [&](double, double y) { return sy * y; }));
  testing::Surface box = testing::box({-0.05, -0.05, 0.0}, {0.05, 0.05, 0.1});
  for (Vec3& x : box.vertex) x = Eigen::AngleAxisd(std::atan(sy), Vec3::UnitX()) * x;
  const Vec3 normal(0.0, -sy * c, c), along(0.0, c, sy * c);
  SurfaceState now = placed(box, -1e-3 * normal, 2.0 * along);
  const auto ground = ground_under(box, now, options, 0.5);
  Push one;
  for (int k = 0; k < 200; ++k) {
    one = push(*ground, now, 1e-4);
    for (Vec3& x : now.position) x += 1e-4 * now.velocity[0];
  }
  EXPECT_NEAR(one.sums.force.dot(along) / one.sums.force.dot(normal), -0.5, 5e-3);  // μ tanh(c v)
  // The box's sides also push its edges, with different shares on both sides of the diagonals of its faces.
  EXPECT_NEAR(one.sums.force.x() / one.sums.force.norm(), 0.0, 1e-4);
}

TEST(GroundMap, each_wheel_stands_on_its_own_height) {
  const auto ground = make_rigid_ground(options_of(map_of(0.1, [](double, double y) { return y > 0.05 ? 0.3 : 0.1; })));
  EXPECT_NEAR(ground->gather_top_height(-0.2, 0.2, 0.7, 0.9), 0.3, 1e-12);
  EXPECT_NEAR(ground->gather_top_height(-0.2, 0.2, -0.9, -0.7), 0.1, 1e-12);
  EXPECT_NEAR(ground->gather_mean_height(-0.2, 0.2, -0.9, -0.7), 0.1, 1e-12);
  EXPECT_EQ(ground->gather_height_field().ny, 100);
}

class MapFile : public ::testing::Test {
 protected:
  std::filesystem::path put(const std::string& name, const std::string& bytes) {
    std::ofstream(folder_.path() / name, std::ios::binary) << bytes;
    return folder_.path() / name;
  }
  testing::TemporaryFolder folder_;
};

TEST_F(MapFile, three_kinds_hold_the_same_map) {
  const std::filesystem::path files[] = {
      put("grid.ASC",
          "ncols 3\nnrows 2\nxllcorner 9.5\nyllcenter 100\ncellsize 1\nNODATA_value -9999\n3 4.5 5\n0 1 2\n"),
      put("marked.asc",
          "\xEF\xBB\xBFncols 3\r\nnrows 2\r\nxllcenter 10\r\nyllcenter 100\r\ncellsize 1\r\n3 4.5 5\r\n0 1 2\r\n"),
      put("grid.csv", "x_m,y_m,z_m\n10,101,3\n11,101,4.5\n12,101,5\n10,100,0\n11,100,1\n12,100,2\n"),
      put("grid.crg",
          "$ROAD_CRG\nREFERENCE_LINE_START_U = 10\nREFERENCE_LINE_END_U = 12\nREFERENCE_LINE_INCREMENT = 1\n$\n"
          "$KD_DEFINITION\n#:LRFI\nD:long section at v = 101,m\nD:long section at v = 100,m\n$\n$$\n"
          " 3.0000000 0.0000000\n 4.5000000 1.0000000\n 5.0000000 2.0000000\n")};
  for (const std::filesystem::path& file : files) {
    const auto map = read_map(file, {});
    ASSERT_TRUE(map) << file;
    EXPECT_EQ(map->x, (std::vector<double>{10.0, 11.0, 12.0}));
    EXPECT_EQ(map->y, (std::vector<double>{100.0, 101.0}));
    EXPECT_EQ(map->z, (std::vector<double>{0.0, 3.0, 1.0, 4.5, 2.0, 5.0}));
    const auto placed = read_map(file, {.v = 100.5, .from = 2.0});
    EXPECT_EQ(placed->x, (std::vector<double>{2.0, 3.0, 4.0}));
    EXPECT_EQ(placed->y, (std::vector<double>{-0.5, 0.5}));
    const ProfilePoints cut = read_road(file, {.v = 100.5, .from = 2.0});
    EXPECT_EQ(cut, (ProfilePoints{{2.0, 1.5}, {3.0, 2.75}, {4.0, 3.5}}));
  }
  EXPECT_FALSE(read_map(put("profile.csv", "x_m,z_m\n0,0\n1,1\n"), {}));
  EXPECT_EQ(read_road(folder_.path() / "profile.csv", {.from = 5.0})[1][0], 6.0);
}

TEST_F(MapFile, open_crg_goes_on_beside_its_cross_sections) {
  const auto map = read_map(put("road.crg",
                                "$ROAD_CRG\nREFERENCE_LINE_INCREMENT = 1\n$\n$KD_DEFINITION\n#:LRFI\nD:long section at "
                                "v = 0,m\nD:long section at v = 1,m\nD:long section at v = 2,m\n$\n$$\n"
                                " *missing* 1.0000000 *missing*\n 4.0000000 5.0000000 *missing*\n"),
                            {});
  EXPECT_EQ(map->z, (std::vector<double>{1.0, 1.0, 1.0, 4.0, 5.0, 5.0}));
}

TEST_F(MapFile, mistakes_are_refused_by_their_place) {
  const std::string head = "ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n";
  const std::pair<std::string, std::string> grids[] = {
      {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\n1 2 3 4\n", "CELLSIZE': is missing"},
      {"ncols 2.5\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 1\n1 2 3 4\n",
       "NCOLS': is 2.5, expected a whole number"},
      {"ncols 2\nrows 2\n", "ROWS': is unknown, expected ncols"},
      {"ncols 2\nncols 2\n", "NCOLS': is given twice"},
      {"ncols two\n", "NCOLS': is 'two', expected a number"},
      {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 0\ncellsize 0\n1 2 3 4\n", "cellsize': is 0, expected more than 0 m"},
      {head + "1 2 3\n", "row 2, column 2': is missing"},
      {head + "1 2 3 4 5\n", "has more than 4 heights"},
      {head + "1 2 x 4\n", "row 2, column 1': is 'x', expected a number"},
      {head + "1 -9999 3 4\n",
       "row 1, column 2': has no height (NODATA_value -9999), expected a grid that was cropped"},
      {head + "1 2e6 3 4\n", "has the height 2e+06 m at x = 1.5 m, y = 1.5 m"},
      {"ncols 2\nnrows 2\nxllcorner 0\nyllcorner 5.4e6\ncellsize 1\n1 2 3 4\n",
       "lies from y = 5.4e+06 to 5.4e+06 m, expected -1e+06 to 1e+06 m: terrain.profile_from and terrain.profile_v"}};
  for (const auto& [text, words] : grids) {
    const std::filesystem::path file = put("wrong.asc", text);
    expect_refused(ExitCode::bad_input, {words}, [&] { read_map(file, {}); });
  }
  const std::pair<const char*, const char*> tables[] = {
      {"x_m,y_m,z_m\n0,0,1\n1,0,1\n0,1,1\n", "has 3 rows for 2 x and 2 y, expected 4"},
      {"x_m,y_m,z_m\n0,0,1\n1,0,1\n0,1,1\n0,1,2\n", "line 5': is a node of the grid once more"},
      {"x_m,y_m,z_m\n0,0,1\n1,0,1\n", "has one y alone"}};
  for (const auto& [text, words] : tables) {
    const std::filesystem::path file = put("wrong.csv", text);
    expect_refused(ExitCode::bad_input, {words}, [&] { read_map(file, {}); });
  }
  for (const auto& [name, words] : {std::pair{"bump.obj", "is a mesh, expected heights"}, {"a.BMP", "is a picture"}}) {
    const std::filesystem::path file = put(name, "o bump\n");
    expect_refused(ExitCode::bad_input, {words}, [&] { read_road(file, {}); });
  }
  const std::filesystem::path grid = put("grid.asc", head + "1 2 3 4\n");
  expect_refused(ExitCode::bad_input, {"has no height at y = 3 m, expected terrain.profile_v from 0.5 to 1.5 m"},
                 [&] { read_road(grid, {.v = 3.0}); });
}

}  // namespace
}  // namespace furrow::terrain
