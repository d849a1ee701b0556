// Frames: what the tire and the terrain looked like at one instant, one HDF5 file each under <run>/frames/.
//   tire<k>_<index>.h5     /position (n, 3) m, /velocity (n, 3) m/s, /force (n, 3) N, /triangle (m, 3)
//   terrain_<index>.h5     /position (n, 3) m, /speed (n) m/s, /radius (n) m
// Attribute `time_s` on the file, `units` on the datasets; they lie along the axes node, face, grain, xyz and corner.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "protocol/core/surface.hpp"
#include "terrain/terrain.hpp"

namespace furrow::output {

/// Their folder and their names, for the run's list (launch/run_list.hpp).
std::vector<std::string> frame_forms();

/// @pre the run's folder exists, here and below @throws Error(io)
void write_tire_frame(const std::filesystem::path& run, int tire, std::int64_t index, double time,
                      const SurfaceMesh& mesh, const SurfaceState& surface, const NodalForces& forces);

/// Nothing is written for a terrain without grains. @throws Error(io)
void write_terrain_frame(const std::filesystem::path& run, std::int64_t index, double time,
                         const terrain::TerrainFrame& frame);

/// Frames of a run that continues with one every so many steps. @throws Error(io)
checkpoint::FrameClock continued_frames(const std::filesystem::path& run, const checkpoint::CheckpointManifest& from,
                                        std::int64_t every);

/// Flushes the names of all frames to the disk. @throws Error(io)
void sync_frames(const std::filesystem::path& run);

struct FrameName {
  std::string kind;  // "tire0", "terrain"
  std::int64_t index = 0;
};
/// Name of its file in <run>/frames.
std::string frame_file(const FrameName& name);
/// What the name of a file in <run>/frames says; none for a file that is no frame.
std::optional<FrameName> frame_name(const std::string& file);

/// Removes the frames whose number is `index` or more, and what was never finished; files of the user's stay.
/// Errors are ignored.
void remove_frames_from(const std::filesystem::path& run, std::int64_t index);

}  // namespace furrow::output
