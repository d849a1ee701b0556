#include "nodes/output/frames.hpp"

#include <algorithm>
#include <regex>
#include <span>

#include <fmt/format.h>

#include "nodes/launch/run_list.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/files/fault_point.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/new_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

std::filesystem::path new_frame(const std::filesystem::path& run, const FrameName& name) {
  const auto folder = run / "frames";
  std::error_code ignored;                             // if this fails, creating the file reports it
  std::filesystem::create_directory(folder, ignored);  // not the run's folder: it was moved or removed
  return folder / frame_file(name);
}

constexpr const char* kForms[] = {"tire%1d_%06d.h5", "terrain_%06d.h5"};  // names from frame_file

std::vector<float> flatten(const std::vector<Vec3>& vectors) {
  std::vector<float> flat;
  flat.reserve(3 * vectors.size());
  for (const Vec3& v : vectors)
    for (int i = 0; i < 3; ++i) flat.push_back(static_cast<float>(v[i]));
  return flat;
}

void put(Hdf5Writer& file, const std::string& name, std::span<const float> values, const std::vector<std::string>& axes,
         const std::string& units) {
  std::vector<hsize_t> shape{values.size()};
  if (axes.size() == 2) shape = {values.size() / 3, 3};
  file.put(name, values, shape);
  file.attribute_of(name, "units", units);
  file.lay_along(name, axes);
}

}  // namespace

std::string frame_file(const FrameName& name) {
  FURROW_ASSERT(name.index >= 0, name.kind, name.index);
  return fmt::format("{}_{:06d}.h5", name.kind, name.index);
}

std::vector<std::string> frame_forms() {
  std::vector<std::string> forms{"frames/"};
  for (const char* form : kForms) forms.push_back(std::string("frames/") + form);
  return forms;
}

void write_tire_frame(const std::filesystem::path& run, int tire, std::int64_t index, double time,
                      const SurfaceMesh& mesh, const SurfaceState& surface, const NodalForces& forces,
                      const std::vector<float>& strain) {
  FURROW_ASSERT(tire >= 0, tire);
  FURROW_ASSERT(surface.velocity.size() == surface.position.size(), surface.velocity.size(), surface.position.size());
  FURROW_ASSERT(forces.force.size() == forces.vertex.size(), forces.force.size(), forces.vertex.size());
  FURROW_ASSERT(std::all_of(forces.vertex.begin(), forces.vertex.end(),
                            [&](int v) { return in_range(v, surface.position.size()); }),
                surface.position.size());
  const std::size_t count = surface.position.size();
  std::vector<Vec3> dense(count, Vec3::Zero());
  for (std::size_t i = 0; i < forces.vertex.size(); ++i) dense[forces.vertex[i]] = forces.force[i];
  std::vector<std::int32_t> triangles;
  for (const auto& triangle : mesh.triangles) triangles.insert(triangles.end(), triangle.begin(), triangle.end());

  Hdf5Writer file(new_frame(run, {fmt::format("tire{}", tire), index}));
  file.attribute("time_s", time);
  file.put_axis("node", count);
  file.put_axis("face", mesh.triangles.size());
  file.put_axis("xyz", 3);
  file.put_axis("corner", 3);
  put(file, "position", flatten(surface.position), {"node", "xyz"}, "m");
  fault_point("frame");
  put(file, "velocity", flatten(surface.velocity), {"node", "xyz"}, "m/s");
  put(file, "force", flatten(dense), {"node", "xyz"}, "N");
  if (!strain.empty()) put(file, "strain", strain, {"node"}, "1");
  file.put("triangle", triangles, {mesh.triangles.size(), 3});
  file.lay_along("triangle", {"face", "corner"});
  file.finish();
}

void write_terrain_frame(const std::filesystem::path& run, std::int64_t index, double time,
                         const terrain::TerrainFrame& frame) {
  FURROW_ASSERT(frame.position.size() == 3 * frame.radius.size(), frame.position.size(), frame.radius.size());
  FURROW_ASSERT(frame.speed.size() == frame.radius.size(), frame.speed.size(), frame.radius.size());
  const std::size_t count = frame.radius.size();
  if (count == 0) return;
  Hdf5Writer file(new_frame(run, {"terrain", index}));
  file.attribute("time_s", time);
  file.put_axis("grain", count);
  file.put_axis("xyz", 3);
  put(file, "position", frame.position, {"grain", "xyz"}, "m");
  fault_point("frame");
  put(file, "speed", frame.speed, {"grain"}, "m/s");
  put(file, "radius", frame.radius, {"grain"}, "m");
  file.finish();
}

checkpoint::FrameClock continued_frames(const std::filesystem::path& run, const checkpoint::CheckpointManifest& from,
                                        std::int64_t every) {
  if (from.frames.every == every) return from.frames;
  std::error_code none;
  const bool written =
      std::filesystem::exists(run / "frames" / frame_file({"tire0", from.frames.index(from.step)}), none);
  return from.frames.continued(from.step, every, written);
}

void sync_frames(const std::filesystem::path& run) {
  std::error_code none;
  if (std::filesystem::is_directory(run / "frames", none)) sync_folder(run / "frames");
}

std::optional<FrameName> frame_name(const std::string& file) {
  static const std::regex pattern(R"((tire\d+|terrain)_(\d{6,18})\.h5)");
  std::smatch match;
  if (!std::regex_match(file, match, pattern)) return std::nullopt;
  return FrameName{match[1], std::stoll(match[2])};
}

void remove_frames_from(const std::filesystem::path& run, std::int64_t index) {
  FURROW_ASSERT(index >= 0, index);
  std::vector<std::filesystem::path> doomed;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / "frames", error)) {
    const std::string name = entry.path().filename().string();
    const auto frame = frame_name(name);
    if ((frame && frame->index >= index) || frame_name(name_in_the_making(name))) doomed.push_back(entry.path());
  }
  for (const auto& file : doomed) std::filesystem::remove(file, error);
}

}  // namespace furrow::output
