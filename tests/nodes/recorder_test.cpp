// Frames and their index: what is written is what was given.
#include <gtest/gtest.h>

#include <fstream>

#include "nodes/output/frames.hpp"
#include "nodes/output/xdmf.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "temporary_folder.hpp"

namespace furrow {
namespace {

using testing::TemporaryFolder;

std::vector<std::string> lines_of(const std::filesystem::path& file) {
  std::ifstream stream(file);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

TEST(Frames, positions_and_forces_come_back_in_single_precision) {
  const testing::TemporaryFolder folder;
  const SurfaceMesh mesh{3, {{0, 1, 2}}};
  const SurfaceState surface{{{0, 0, 0.5}, {1, 0, 0}, {0, 1, 0}}, {{0, 0, 1}, {0, 0, 2}, {0, 0, 3}}};
  const NodalForces forces{{1}, {{1, 2, 3}}};
  output::write_tire_frame(folder.path(), 0, 12, 0.25, mesh, surface, forces);
  const Hdf5Reader file(folder.path() / "frames" / "tire0_000012.h5");
  EXPECT_EQ(file.number("time_s"), 0.25);
  EXPECT_EQ(file.shape("position"), (std::vector<hsize_t>{3, 3}));
  EXPECT_EQ(file.get<float>("position"), (std::vector<float>{0, 0, 0.5f, 1, 0, 0, 0, 1, 0}));
  EXPECT_EQ(file.get<float>("force"), (std::vector<float>{0, 0, 0, 1, 2, 3, 0, 0, 0}));
  EXPECT_EQ(file.get<std::int32_t>("triangle"), (std::vector<std::int32_t>{0, 1, 2}));
}

TEST(Frames, a_terrain_without_grains_leaves_no_file) {
  const testing::TemporaryFolder folder;
  output::write_terrain_frame(folder.path(), 0, 0.0, {});
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Xdmf, holds_complete_instants_only) {
  const testing::TemporaryFolder folder;
  const SurfaceMesh mesh{3, {{0, 1, 2}}};
  const SurfaceState surface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Vec3>(3, Vec3::Zero())};
  const terrain::TerrainFrame grains{{0, 0, 0}, {0.5f}, {0.01f}};
  for (int i = 0; i < 3; ++i) output::write_tire_frame(folder.path(), 0, i, 0.1 * i, mesh, surface, {});
  for (int i = 0; i < 2; ++i) output::write_terrain_frame(folder.path(), i, 0.1 * i, grains);
  std::ofstream(folder.path() / "frames" / "terrain_000002.h5") << "cut short";
  output::write_xdmf_index(folder.path());
  std::string text;
  for (const std::string& line : lines_of(folder.path() / "results.xdmf")) text += line + "\n";
  EXPECT_NE(text.find("tire0_000001.h5"), std::string::npos);
  EXPECT_NE(text.find("terrain_000001.h5"), std::string::npos);
  EXPECT_EQ(text.find("_000002.h5"), std::string::npos);
}

TEST(Xdmf, is_not_written_without_frames) {
  const testing::TemporaryFolder folder;
  output::write_xdmf_index(folder.path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace furrow
