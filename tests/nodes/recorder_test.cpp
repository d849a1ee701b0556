// Frames and their index: files contain the given values.
#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "nodes/output/frames.hpp"
#include "nodes/output/xdmf.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

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

TEST(Frames, the_folder_of_a_run_that_was_moved_is_not_made_anew) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path run = folder.path() / "moved";
  const terrain::TerrainFrame grains{{0, 0, 0}, {0.5f}, {0.01f}};
  EXPECT_THROW(output::write_terrain_frame(run, 0, 0.0, grains), Error);
  EXPECT_FALSE(std::filesystem::exists(run));
}

TEST(Frames, going_on_removes_later_frames_and_no_file_of_the_users) {
  const testing::TemporaryFolder folder;
  const std::filesystem::path frames = folder.path() / "frames";
  std::filesystem::create_directory(frames);
  const auto names = [&] {
    std::set<std::string> found;
    for (const auto& entry : std::filesystem::directory_iterator(frames))
      found.insert(entry.path().filename().string());
    return found;
  };
  const std::set<std::string> stay{
      "terrain_000001.h5", "tire12_000001.h5", "view_000007.png", "tire_2026.h5", "tire0_99999999999999999999.h5",
      "mine.part"};
  for (const std::string& name : stay) std::ofstream(frames / name) << "x";
  for (const char* name : {"terrain_000002.h5", "tire12_1000000.h5", ".tire0_000001.h5.0123456789abcdef.part"})
    std::ofstream(frames / name) << "x";
  output::remove_frames_from(folder.path(), 2);
  EXPECT_EQ(names(), stay);
}

TEST(Xdmf, holds_complete_instants_only) {
  const testing::TemporaryFolder folder;
  const SurfaceMesh mesh{3, {{0, 1, 2}}};
  const SurfaceState surface{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, std::vector<Vec3>(3, Vec3::Zero())};
  const terrain::TerrainFrame grains{{0, 0, 0}, {0.5f}, {0.01f}};
  for (int i = 0; i < 3; ++i) output::write_tire_frame(folder.path(), 0, i, 0.1 * i, mesh, surface, {});
  for (int i = 0; i < 2; ++i) output::write_terrain_frame(folder.path(), i, 0.1 * i, grains);
  std::ofstream(folder.path() / "frames" / "terrain_000002.h5") << "cut short";
  EXPECT_EQ(output::write_xdmf_index(folder.path()),
            "frames/terrain_000002.h5 is missing or cannot be read: results.xdmf leaves out 1 instant");
  std::string text;
  for (const std::string& line : lines_of(folder.path() / "results.xdmf")) text += line + "\n";
  EXPECT_TRUE(holds(text, "tire0_000001.h5"));
  EXPECT_TRUE(holds(text, "terrain_000001.h5"));
  EXPECT_EQ(text.find("_000002.h5"), std::string::npos);
}

TEST(Xdmf, instants_that_are_lost_are_counted) {
  const testing::TemporaryFolder folder;
  const terrain::TerrainFrame grains{{0, 0, 0}, {0.5f}, {0.01f}};
  for (int i = 0; i < 9; ++i) output::write_terrain_frame(folder.path(), i, 0.1 * i, grains);
  EXPECT_EQ(output::write_xdmf_index(folder.path()), "");
  const auto frames = folder.path() / "frames";
  for (const int lost : {0, 3, 4}) std::filesystem::remove(frames / output::frame_file({"terrain", lost}));
  std::ofstream(frames / "terrain_000006.h5") << "cut short";
  EXPECT_EQ(output::write_xdmf_index(folder.path()),
            "frames/terrain_000000.h5 is missing or cannot be read: results.xdmf leaves out 4 instants");
}

TEST(Xdmf, is_not_written_without_frames) {
  const testing::TemporaryFolder folder;
  std::ofstream(folder.path() / "results.xdmf") << "of frames that are gone";
  output::write_xdmf_index(folder.path());
  EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

}  // namespace
}  // namespace furrow
