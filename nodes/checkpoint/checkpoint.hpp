// Checkpoints on disk: <run>/checkpoints/<step>/ with one saved state per rank and a manifest that joins them.
//
//   manifest.json  format_version, scenario and its digest, step, checksum of every part, mark of each series,
//                  frames, segments, and a checksum of itself
//   rig.h5, tire<k>.h5, terrain.h5, terrain<k>.h5 of its further ranks   archive_file.hpp
//
// All is written into .<step>.part/ and flushed to the disk; then that folder is renamed. A checkpoint is thus complete
// or absent.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "nodes/checkpoint/frame_clock.hpp"
#include "nodes/checkpoint/segment.hpp"
#include "nodes/checkpoint/series_mark.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/messages.hpp"

namespace furrow::checkpoint {

struct CheckpointManifest {
  std::string version, build, cpu;  // of the program and the machine that wrote it
  std::string arithmetic;           // arithmetic_id() there
  std::string name;                 // of the scenario
  std::string scenario;             // completed, JSON
  std::string scenario_digest;
  std::vector<std::string> file_hashes;  // Scenario::file_hashes
  std::int64_t step = 0;
  double time = 0.0;                  // s
  std::vector<CheckpointPart> parts;  // rig, tires, terrain
  std::vector<SeriesMark> series;     // per table of results
  FrameClock frames;
  std::vector<Segment> segments;  // the last one ends here
  std::int64_t bytes = 0;         // of the parts on disk
  double write_s = 0.0;           // wall time that the run stopped for it, until this was written
};
/// All but scenario and segments, which have their own forms in the manifest.
void visit_fields(FieldsOf<CheckpointManifest> auto& s, auto&& visit) {
  visit(s.version, Field{"version", ""});
  visit(s.build, Field{"build", ""});
  visit(s.cpu, Field{"cpu", ""});
  visit(s.arithmetic, Field{"arithmetic", ""});
  visit(s.name, Field{"name", ""});
  visit(s.scenario_digest, Field{"scenario_digest", ""});
  visit(s.file_hashes, Field{"file_hashes", ""});
  visit(s.step, Field{"step"});
  visit(s.time, Field{"time_s", "s"});
  visit(s.bytes, Field{"bytes"});
  visit(s.write_s, Field{"write_s", "s"});
  visit(s.parts, Field{"parts", ""});
  visit(s.series, Field{"series", ""});
  visit(s.frames, Field{"frames", ""});
}

struct ResumePoint {
  std::filesystem::path folder;  // of the checkpoint
  CheckpointManifest manifest;
  std::string changed;     // JSON object: keys that change from here on
  std::string finer_than;  // Segment::finer_than
};

/// The segments before this one, and this one until `step`.
std::vector<Segment> segments_until(std::int64_t step, double wall_s, int threads, const ResumePoint* resume);

/// "rig.h5", "tire0.h5", "terrain.h5", for further ranks of a terrain "terrain1.h5" ….
std::string part_name(const Address& node);

/// Folders and files of checkpoints, for the run's list (launch/run_list.hpp).
std::vector<std::string> checkpoint_forms();

std::filesystem::path checkpoints_folder(const std::filesystem::path& run);
/// Folder for the parts of a checkpoint before it is complete.
std::filesystem::path unfinished_checkpoint(const std::filesystem::path& run, std::int64_t step);

/// Writes the manifest next to the parts, renames the folder and removes all but the newest `keep` checkpoints.
/// @throws Error(io)
void complete_checkpoint(const std::filesystem::path& run, const CheckpointManifest& manifest, int keep);

/// Removes the parts of a checkpoint that could not be completed. Errors are ignored.
void drop_unfinished_checkpoint(const std::filesystem::path& run, std::int64_t step);

/// @throws Error(io) if the checkpoint is damaged, incomplete or of another format; every part is read
CheckpointManifest read_checkpoint(const std::filesystem::path& folder);

/// Checksum of all bytes of a part, so that damage is found before the file is interpreted. @throws Error(io)
std::string part_checksum(const std::filesystem::path& file);

/// Folders of the complete checkpoints, newest first.
std::vector<std::filesystem::path> list_checkpoints(const std::filesystem::path& run);

/// Removes checkpoints beyond `step` and incomplete ones; no other file. Errors are ignored.
void remove_checkpoints_after(const std::filesystem::path& run, std::int64_t step) noexcept;

}  // namespace furrow::checkpoint
