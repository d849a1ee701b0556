// XDMF 3, https://www.xdmf.org/index.php/XDMF_Model_and_Format: a temporal collection of spatial collections, one grid
// per tire and one for the grains; every grid points into that frame's HDF5 file.
#include "nodes/output/xdmf.hpp"

#include <map>
#include <set>
#include <vector>

#include <fmt/format.h>

#include "nodes/output/frames.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::output {
namespace {

struct Frame {
  std::string file;  // relative to the run directory
  double time = 0.0;
  hsize_t points = 0, triangles = 0;
};

/// Of a table; 0 where there is none.
hsize_t rows(const Hdf5Reader& file, const std::string& name) {
  const std::vector<hsize_t> shape = file.shape(name);
  return shape.size() == 2 ? shape.front() : 0;
}

/// False for a file that cannot be read: it is left out.
bool read_frame(const std::filesystem::path& path, Frame& frame) {
  try {
    const Hdf5Reader file(path);
    frame.time = file.number("time_s");
    frame.points = rows(file, "position");
    if (file.has("triangle")) frame.triangles = rows(file, "triangle");
    frame.file = "frames/" + path.filename().string();
    return frame.points > 0;
  } catch (const Error&) {
    return false;
  }
}

std::string data_item(const Frame& f, const char* name, hsize_t count, int width, const char* type) {
  FURROW_ASSERT(width > 0, name, width);
  const std::string shape = width > 1 ? fmt::format("{} {}", count, width) : fmt::format("{}", count);
  return fmt::format(
      "<DataItem Dimensions=\"{}\" NumberType=\"{}\" Precision=\"4\" Format=\"HDF\">{}:/{}</DataItem>", shape,
      type, f.file, name);
}

std::string attribute(const Frame& f, const char* name, int width) {
  return fmt::format("<Attribute Name=\"{}\" AttributeType=\"{}\" Center=\"Node\">{}</Attribute>\n", name,
                     width > 1 ? "Vector" : "Scalar", data_item(f, name, f.points, width, "Float"));
}

std::string grid(const Frame& f, const std::string& name) {
  std::string text = fmt::format("<Grid Name=\"{}\" GridType=\"Uniform\">\n", name);
  if (f.triangles > 0)
    text += fmt::format("<Topology TopologyType=\"Triangle\" NumberOfElements=\"{}\">{}</Topology>\n",
                        f.triangles, data_item(f, "triangle", f.triangles, 3, "Int"));
  else
    text += fmt::format(
        "<Topology TopologyType=\"Polyvertex\" NumberOfElements=\"{}\" NodesPerElement=\"1\"/>\n", f.points);
  text += fmt::format("<Geometry GeometryType=\"XYZ\">{}</Geometry>\n",
                      data_item(f, "position", f.points, 3, "Float"));
  text += f.triangles > 0 ? attribute(f, "velocity", 3) + attribute(f, "force", 3)
                          : attribute(f, "speed", 1) + attribute(f, "radius", 1);
  return text + "</Grid>\n";
}

}  // namespace

void write_xdmf_index(const std::filesystem::path& run) {
  std::map<std::int64_t, std::map<std::string, Frame>> series;  // by index, then by kind
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(run / "frames", error)) {
    Frame frame;
    if (const auto name = frame_name(entry.path().filename().string());
        name && read_frame(entry.path(), frame))
      series[name->index][name->kind] = frame;
  }
  if (series.empty()) {
    std::filesystem::remove(run / "results.xdmf", error);  // of frames that are gone
    return;
  }
  std::set<std::string> kinds;
  for (const auto& [index, frames] : series)
    for (const auto& [kind, frame] : frames) kinds.insert(kind);
  std::string text =
      "<?xml version=\"1.0\"?>\n<Xdmf Version=\"3.0\"><Domain>\n"
      "<Grid Name=\"run\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
  for (const auto& [index, frames] : series) {
    if (frames.size() < kinds.size()) continue;
    text += fmt::format(
        "<Grid Name=\"{:06d}\" GridType=\"Collection\" CollectionType=\"Spatial\"><Time Value=\"{:.9g}\"/>\n",
        index, frames.begin()->second.time);
    for (const auto& [kind, frame] : frames) text += grid(frame, kind);
    text += "</Grid>\n";
  }
  write_whole_file(run / "results.xdmf", text + "</Grid></Domain></Xdmf>\n");
}

}  // namespace furrow::output
