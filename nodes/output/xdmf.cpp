// XDMF 3, https://www.xdmf.org/index.php/XDMF_Model_and_Format: a temporal collection of spatial collections, with one
// grid per tire and one for the grains. Every grid points into that frame's HDF5 file.
#include "nodes/output/xdmf.hpp"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "nodes/output/frames.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/new_file.hpp"

namespace furrow::output {
namespace {

struct Frame {
  std::string file;  // relative to the run directory
  double time = 0.0;
  hsize_t points = 0, triangles = 0;
  bool strain = false;
};

/// Number of rows of a dataset; 0 if there is none.
hsize_t rows(const Hdf5Reader& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape(name);
  return shape.size() == 2 ? shape.front() : 0;
}

/// None if the file cannot be read.
std::optional<Frame> read_frame(const std::filesystem::path& run, const FrameName& name) {
  try {
    Frame frame;
    frame.file = fmt::format("frames/{}", frame_file(name));
    const Hdf5Reader file(run / frame.file);
    frame.time = file.number("time_s");
    frame.points = rows(file, "position");
    if (file.has("triangle")) frame.triangles = rows(file, "triangle");
    frame.strain = file.has("strain");
    return frame.points > 0 ? std::optional(frame) : std::nullopt;
  } catch (const Error&) {
    return std::nullopt;
  }
}

/// {kind: numbers of its frames}, from the names of files.
using Kinds = std::map<std::string, std::set<std::int64_t>>;

Kinds kinds_in(const std::filesystem::path& run) {
  Kinds kinds;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / "frames", error))
    if (const auto name = frame_name(entry.path().filename().string())) kinds[name->kind].insert(name->index);
  return kinds;
}

/// Leaves out kinds of which no frame can be read.
Kinds readable(const std::filesystem::path& run, Kinds kinds) {
  std::erase_if(kinds, [&](const auto& kind) {
    return std::ranges::none_of(kind.second, [&](std::int64_t index) {
      return read_frame(run, {kind.first, index}).has_value();
    });
  });
  return kinds;
}

/// Instants with a missing or unreadable file.
struct LostInstants {
  std::int64_t count = 0;
  std::string first;  // the first such file

  void add(std::int64_t more, const FrameName& name) {
    if (count == 0) first = "frames/" + frame_file(name);
    count += more;
  }
  std::string text() const {
    if (count == 0) return {};
    return fmt::format("{} is missing or cannot be read: results.xdmf leaves out {} instant{}", first, count,
                       count == 1 ? "" : "s");
  }
};

std::string data_item(const Frame& f, const char* name, hsize_t count, int width, const char* type) {
  FURROW_ASSERT(width > 0, name, width);
  const std::string shape = width > 1 ? fmt::format("{} {}", count, width) : fmt::format("{}", count);
  return fmt::format("<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"4\" Format=\"HDF\">{}:/{}</DataItem>",
                     shape, type, f.file, name);
}

std::string attribute(const Frame& f, const char* name, int width) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                     width > 1 ? "Vector" : "Scalar", data_item(f, name, f.points, width, "Float"));
}

std::string grid(const Frame& f, const std::string& name) {
  std::string text = fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n", name);
  if (f.triangles > 0)
    text += fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>\n", f.triangles,
                        data_item(f, "triangle", f.triangles, 3, "Int"));
  else
    text += fmt::format("<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n",
                        f.points);
  text += fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n", data_item(f, "position", f.points, 3, "Float"));
  text += f.triangles > 0 ? attribute(f, "velocity", 3) + attribute(f, "force", 3)
                          : attribute(f, "speed", 1) + attribute(f, "radius", 1);
  if (f.strain) text += attribute(f, "strain", 1);
  return text + "</Grid>\n";
}

}  // namespace

std::string write_xdmf_index(const std::filesystem::path& run) {
  const Kinds all = kinds_in(run), kinds = readable(run, all);
  if (kinds.empty()) {
    std::error_code error;
    std::filesystem::remove(run / "results.xdmf", error);  // its frames are gone
    return {};
  }
  LostInstants lost;
  std::set<std::int64_t> instants;
  for (const auto& [kind, numbers] : all)
    if (kinds.contains(kind))
      instants.insert(numbers.begin(), numbers.end());
    else
      lost.add(static_cast<std::int64_t>(numbers.size()), {kind, *numbers.begin()});
  // Written piece by piece, because there may be a hundred thousand frames.
  NewFile file(run / "results.xdmf");
  file.write(
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
      "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n");
  std::int64_t next = 0;
  for (const std::int64_t index : instants) {
    if (index > next) lost.add(index - next, {kinds.begin()->first, next});
    next = index + 1;
    std::string grids;
    std::optional<Frame> frame;
    for (const auto& [kind, numbers] : kinds) {
      frame = read_frame(run, {kind, index});
      if (!frame) {
        lost.add(1, {kind, index});
        break;
      }
      grids += grid(*frame, kind);
    }
    if (!frame) continue;
    file.write(fmt::format(
        "<Grid Name=\"{:06d}\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"{:.9g}\"/>\n", index,
        frame->time));
    file.write(grids + "</Grid>\n");
  }
  file.write("</Grid></Domain></Xdmf>\n");
  file.publish();
  return lost.text();
}

}  // namespace furrow::output
