#include "nodes/checkpoint/checkpoint.hpp"

#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "nodes/checkpoint/segment.hpp"
#include "nodes/launch/run_list.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::checkpoint {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

constexpr int kFormatVersion = 3;
constexpr char kManifest[] = "manifest.json";
constexpr char kKind[] = "checkpoint";

std::string step_name(std::int64_t step) {
  FURROW_ASSERT(step >= 0, step);
  return fmt::format("{:012}", step);
}

template <class T>
inline constexpr bool kIsListOfStructs = false;
template <HasFields T>
inline constexpr bool kIsListOfStructs<std::vector<T>> = true;

/// Writes every field by its name, structs as objects.
template <class T>
Json as_json(const T& value) {
  Json json;
  if constexpr (HasFields<T>) {
    visit_fields(value, [&](const auto& one, const Field& field) { json[field.name] = as_json(one); });
  } else if constexpr (kIsListOfStructs<T>) {
    json = Json::array();
    for (const auto& one : value) json.push_back(as_json(one));
  } else {
    json = value;
  }
  return json;
}

/// @throws nlohmann::json::exception for a field that is missing or of another type
template <class T>
void take(const Json& json, T& value) {
  if constexpr (HasFields<T>) {
    visit_fields(value, [&](auto& one, const Field& field) { take(json.at(field.name), one); });
  } else if constexpr (kIsListOfStructs<T>) {
    for (const Json& one : json) take(one, value.emplace_back());
  } else {
    json.get_to(value);
  }
}

Json manifest_json(const CheckpointManifest& m) {
  Json json{{"format_version", kFormatVersion}, {"kind", kKind}};
  json.update(as_json(m));
  json["segments"] = segments_json(m.segments);
  json["scenario"] = Json::parse(m.scenario);
  return json;
}

CheckpointManifest manifest_in(const Json& json) {
  CheckpointManifest m;
  take(json, m);
  m.segments = segments_from_json(json.at("segments"));
  m.scenario = json.at("scenario").dump();
  return m;
}

/// @throws Error(io) for a file that exists but may not be read: it is neither missing nor damaged
void require_readable(const fs::path& path) {
  if (access(path.c_str(), R_OK) != 0 && errno != ENOENT && errno != ENOTDIR)
    throw io_error(path.string(), std::string("cannot be read: ") + std::strerror(errno));
}

CheckpointManifest read_manifest(const fs::path& file) {
  std::error_code error;
  require_readable(file);
  if (!fs::is_regular_file(file, error)) throw io_error(file.string(), "is missing: the checkpoint is not complete");
  Json json = read_json_if_whole(file);
  if (!json.is_object()) throw io_error(file.string(), "is not valid JSON: the checkpoint is damaged");
  try {
    if (json.value("kind", "") != kKind) throw io_error(file.string(), "is not a checkpoint of furrow");
    const Json& format = json.at("format_version");
    if (format != kFormatVersion)
      throw io_error(file.string(),
                     fmt::format("has format_version {}, but this program reads {}: continue the run with the version "
                                 "of furrow that wrote it, or start it again with furrow run",
                                 format.dump(), kFormatVersion));
    const std::string checksum = json.at("checksum");
    json.erase("checksum");
    if (text_hash(json.dump()) != checksum)
      throw io_error(file.string(), "the checksum does not fit the contents: the file is damaged");
    return manifest_in(json);
  } catch (const Json::exception& problem) {
    throw io_error(file.string(), std::string("is damaged: ") + problem.what());
  }
}

/// The step in the name of a complete checkpoint's folder; negative for any other folder.
std::int64_t step_of(const fs::path& folder) {
  std::int64_t step = -1;
  return launch::is_of_form(folder.filename().string(), "%012d", &step) ? step : -1;
}

constexpr const char* kFolderForms[] = {"%012d", ".%012d.part"};
constexpr const char* kFileForms[] = {kManifest, "rig.h5", "tire%1d.h5", "terrain.h5", "terrain%1d.h5"};

/// Removes the checkpoint's files in its folder, and the folder unless it contains other files.
void remove_checkpoint(const fs::path& run, const fs::path& folder) {
  launch::remove_listed(run, launch::RunList(checkpoint_forms()), "checkpoints/" + folder.filename().string() + "/");
  std::error_code error;
  fs::remove(folder, error);
}

bool is_whole(const fs::path& folder) {
  std::error_code error;
  return fs::exists(folder / kManifest, error);
}

}  // namespace

std::vector<std::string> checkpoint_forms() {
  std::vector<std::string> forms{"checkpoints/"};
  for (const char* name : kFolderForms) {
    const std::string folder = forms.front() + name + "/";
    forms.push_back(folder);
    for (const char* file : kFileForms) forms.push_back(folder + file);
  }
  return forms;
}

std::string part_name(const Address& node) {
  const bool numbered = node.role == Role::tire || node.index > 0;
  return numbered ? fmt::format("{}{}.h5", to_string(node.role), node.index) : to_string(node.role) + ".h5";
}

fs::path checkpoints_folder(const fs::path& run) { return run / "checkpoints"; }

fs::path unfinished_checkpoint(const fs::path& run, std::int64_t step) {
  return checkpoints_folder(run) / ("." + step_name(step) + ".part");
}

void complete_checkpoint(const fs::path& run, const CheckpointManifest& manifest, int keep) {
  FURROW_ASSERT(keep > 0, keep);
  const fs::path part = unfinished_checkpoint(run, manifest.step);
  const fs::path folder = checkpoints_folder(run) / step_name(manifest.step);
  Json json = manifest_json(manifest);
  json["checksum"] = text_hash(json.dump());
  write_whole_file(part / kManifest, json.dump(1) + "\n");
  sync_folder(part);
  fault_point("checkpoint.rename");
  std::error_code error;
  remove_checkpoint(run, folder);
  fs::rename(part, folder, error);
  if (error) throw io_error(folder.string(), "cannot be given its name: " + error.message());
  sync_folder(checkpoints_folder(run));
  sync_folder(run);
  int kept = 0;
  for (const fs::path& each : list_checkpoints(run))
    if (is_whole(each) && ++kept > keep) remove_checkpoint(run, each);
}

void drop_unfinished_checkpoint(const fs::path& run, std::int64_t step) {
  remove_checkpoint(run, unfinished_checkpoint(run, step));
}

CheckpointManifest read_checkpoint(const fs::path& folder) {
  CheckpointManifest manifest = read_manifest(folder / kManifest);
  for (const CheckpointPart& part : manifest.parts) {
    const fs::path file = folder / fs::path(part.file).filename();
    if (part_checksum(file) != part.checksum)
      throw io_error(file.string(), "does not fit its checkpoint: it is damaged, or belongs to another");
  }
  return manifest;
}

std::string part_checksum(const fs::path& path) {
  std::error_code error;
  require_readable(path);
  if (!fs::is_regular_file(path, error))  // reading a pipe would block
    throw io_error(path.string(), "does not exist or is no file: the checkpoint is not complete");
  return file_hash(path);
}

std::vector<fs::path> list_checkpoints(const fs::path& run) {
  std::vector<fs::path> found;
  std::error_code error;
  require_readable(checkpoints_folder(run));
  for (const auto& entry : fs::directory_iterator(checkpoints_folder(run), error))
    if (step_of(entry.path()) >= 0) found.push_back(entry.path());
  std::sort(found.begin(), found.end(), [](const fs::path& a, const fs::path& b) { return step_of(a) > step_of(b); });
  return found;
}

void remove_checkpoints_after(const fs::path& run, std::int64_t step) noexcept {
  try {
    std::error_code error;
    std::vector<fs::path> doomed;
    for (const auto& entry : fs::directory_iterator(checkpoints_folder(run), error))
      if (step_of(entry.path()) > step || launch::is_of_form(entry.path().filename().string(), kFolderForms[1]))
        doomed.push_back(entry.path());
    for (const fs::path& folder : doomed) remove_checkpoint(run, folder);
  } catch (...) {
    // A remainder is harmless: it is replaced when its step comes again.
  }
}

std::vector<Segment> segments_until(std::int64_t step, double wall_s, int threads, const ResumePoint* resume) {
  FURROW_ASSERT(resume == nullptr || step >= resume->manifest.step, step);
  FURROW_ASSERT(threads > 0, threads);
  std::vector<Segment> segments;
  Segment now;
  if (resume) {
    segments = resume->manifest.segments;
    now.from_step = resume->manifest.step;
    now.changed = resume->changed;
    now.finer_than = resume->finer_than;
  }
  now.to_step = step;
  now.wall_s = wall_s;
  now.threads = threads;
  segments.push_back(now);
  return segments;
}

}  // namespace furrow::checkpoint
