#include "nodes/scenario/estimate.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <string>

#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/files/memory_limit.hpp"

namespace furrow::scenario {
namespace {

constexpr double kBytesPerRank = 40e6;  // program, MPI and libraries
constexpr double kBytesPerFrameVertex = 100.0;
// Bytes of a line of the series in CSV, in results.h5, and among the lines kept until the run ends.
constexpr double kBytesPerWheelLine = 2000.0, kBytesPerAccountsLine = 1100.0;

/// Number of outputs that are written once in every interval, at most once per step.
double times(const Scenario& s, double interval) {
  const std::int64_t every = s.run.steps_in(interval);
  return every > 0 ? static_cast<double>(s.run.steps() / every) : 0.0;
}

}  // namespace

Estimate estimate(const Scenario& s) {
  Estimate e;
  e.terrain = s.terrain->estimate(s.terrain_context());
  e.steps = s.run.steps();
  double vertices = 0.0, tires = 0.0, saved = 0.0;
  for (const tire::TireDescription& tire : describe_tires(s)) {
    e.coordinates += tire.coordinates;
    vertices += tire.vertices;
    tires += tire.memory;
    saved += tire.saved_bytes;
  }
  const auto ranks = static_cast<double>(1 + s.tires.size() + static_cast<std::size_t>(s.terrain_ranks));
  e.memory = e.terrain.memory_bytes + tires + kBytesPerRank * ranks;
  if (s.output.frame_interval > 0.0) e.frames = 1.0 + times(s, s.output.frame_interval);
  e.frame_bytes = e.terrain.frame_bytes + kBytesPerFrameVertex * vertices;
  e.checkpoints = times(s, s.checkpoint.interval) + (s.checkpoint.at_end ? 1.0 : 0.0);
  e.checkpoint_bytes = e.terrain.checkpoint_bytes + saved;
  const double line_bytes = kBytesPerWheelLine * static_cast<double>(s.tires.size()) + kBytesPerAccountsLine;
  e.disk = e.frames * e.frame_bytes + line_bytes * times(s, s.output.series_interval) +
           s.checkpoint.keep * e.checkpoint_bytes;
  return e;
}

MachineState machine_state() {
  MachineState state;
  std::ifstream info("/proc/meminfo");
  double kib = 0.0;
  for (std::string name, unit; info >> name >> kib; std::getline(info, unit))
    if (name == "MemAvailable:") state.memory_free = std::min(1024.0 * kib, memory_limit().bytes);
  std::error_code error;
  const auto space = std::filesystem::space(std::filesystem::current_path(error), error);
  if (!error) state.disk_free = static_cast<double>(space.available);
  return state;
}

}  // namespace furrow::scenario
