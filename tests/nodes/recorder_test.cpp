// timeseries.csv, frames and their index: what is written is what was given.
#include <gtest/gtest.h>

#include <fstream>
#include <set>
#include <sstream>

#include "nodes/output/frames.hpp"
#include "nodes/output/series.hpp"
#include "nodes/output/xdmf.hpp"
#include "protocol/core/error.hpp"
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

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::stringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) cells.push_back(cell);
  return cells;
}

TEST(Series, columns_that_users_script_against_come_first) {
  const testing::TemporaryFolder folder;
  output::SeriesWriter writer(folder.path() / "timeseries.csv");
  writer.flush();
  EXPECT_EQ(
      lines_of(folder.path() / "timeseries.csv")
          .at(0)
          .substr(0, std::string("time_s,slip,drawbar_pull_N,sinkage_m,vertical_force_N,force_x_N,force_y_N,"
                                 "force_z_N,spindle_torque_Nm,impulse_sent_Ns,impulse_received_Ns,"
                                 "energy_error_J,")
                         .size()),
      "time_s,slip,drawbar_pull_N,sinkage_m,vertical_force_N,force_x_N,force_y_N,force_z_N,spindle_torque_Nm,"
      "impulse_sent_Ns,impulse_received_Ns,energy_error_J,");
  std::set<std::string> names;
  for (const output::SeriesColumn& column : output::series_columns())
    EXPECT_TRUE(names.insert(column.name).second) << column.name;
}

TEST(Series, numbers_come_back_bit_for_bit) {
  const testing::TemporaryFolder folder;
  output::SeriesRow row;
  row.time = 0.1 + 0.2;
  row.drawbar_pull = 1.0 / 3.0;
  row.impulse_sent = {1e-300, -0.0, 2.0 / 7.0};
  {
    output::SeriesWriter writer(folder.path() / "timeseries.csv");
    writer.add(row);
    writer.flush();
  }
  const auto lines = lines_of(folder.path() / "timeseries.csv");
  ASSERT_EQ(lines.size(), 2u);
  const auto cells = split(lines[1]);
  ASSERT_EQ(cells.size(), output::series_columns().size());
  for (std::size_t i = 0; i < cells.size(); ++i)
    EXPECT_EQ(std::stod(cells[i]), output::series_columns()[i].value(row))
        << output::series_columns()[i].name;
}

TEST(Series, a_full_disk_is_an_input_output_error_naming_the_file) {
  try {
    output::SeriesWriter writer("/dev/full");
    writer.add({});
    writer.flush();
    FAIL() << "nothing was noticed";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ExitCode::io);
    EXPECT_NE(std::string(error.what()).find("/dev/full"), std::string::npos);
  }
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
