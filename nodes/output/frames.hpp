// Frames: tire and terrain at one instant, one HDF5 file each under <run>/frames/.
//   tire<k>_<index>.h5     /position (n, 3) m, /velocity (n, 3) m/s, /force (n, 3) N, /triangle (m, 3); of a
//                          tire that has it also /strain (n), the largest principal strain of the surface
//   terrain_<index>.h5     /position (n, 3) m, /speed (n) m/s, /radius (n) m
// The file has the attribute `time_s`, the datasets `units`; their axes are node, face, grain, xyz and corner.
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

/// The frames' folder and the forms of their names, for the run's list (launch/run_list.hpp).
std::vector<std::string> frame_forms();

/// @pre the run's folder exists, here and below @throws Error(io)
void write_tire_frame(const std::filesystem::path& run, int tire, std::int64_t index, double time,
                      const SurfaceMesh& mesh, const SurfaceState& surface, const NodalForces& forces,
                      const std::vector<float>& strain = {});

/// Writes nothing for a terrain without grains. @throws Error(io)
void write_terrain_frame(const std::filesystem::path& run, std::int64_t index, double time,
                         const terrain::TerrainFrame& frame);

/// Returns the frame clock of a run that continues, with one frame every `every` steps. @throws Error(io)
checkpoint::FrameClock continued_frames(const std::filesystem::path& run, const checkpoint::CheckpointManifest& from,
                                        std::int64_t every);

/// Flushes the names of all frames to the disk. @throws Error(io)
void sync_frames(const std::filesystem::path& run);

struct FrameName {
  std::string kind;  // "tire0", "terrain"
  std::int64_t index = 0;
};
/// Returns the name of its file in <run>/frames.
std::string frame_file(const FrameName& name);
/// Reads the name of a file in <run>/frames; none for a file that is not a frame.
std::optional<FrameName> frame_name(const std::string& file);

/// Removes frames numbered `index` or higher and unfinished files; keeps the user's files. Errors are ignored.
void remove_frames_from(const std::filesystem::path& run, std::int64_t index);

}  // namespace furrow::output
