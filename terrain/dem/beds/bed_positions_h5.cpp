#include "terrain/dem/beds/bed_positions_h5.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_file.hpp"

namespace furrow::terrain::dem {
namespace {

/// All numbers of a dataset with this many columns; a vector has one column.
std::vector<double> numbers(const Hdf5Reader& file, const std::string& name, hsize_t columns,
                            const std::filesystem::path& path) {
  const auto wrong = [&](const std::string& what) {
    return input_error(path.string(), "dataset '" + name + "'", what);
  };
  const auto is_table = [&] {
    const std::vector<hsize_t> shape = file.shape(name);
    const Hdf5Type type = file.type(name);
    return (type == Hdf5Type::float64 || type == Hdf5Type::float32) && !shape.empty() && shape.size() <= 2 &&
           (shape.size() == 2 ? shape[1] : 1) == columns;
  };
  if (!file.has(name) || !is_table())
    throw wrong(columns == 1 ? "expected N numbers, m"
                             : "expected N × 3 numbers, m, as frames/terrain_*.h5 of a run has them");
  const auto values = file.get<double>(name);
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k])) throw wrong("grain " + std::to_string(k / columns) + " is not a finite number");
  return values;
}

}  // namespace

bool is_hdf5(const std::filesystem::path& file) {
  constexpr std::array<char, 8> kHdf5{'\x89', 'H', 'D', 'F', '\r', '\n', '\x1a', '\n'};
  std::array<char, 8> start{};
  std::ifstream in(file, std::ios::binary);
  in.read(start.data(), start.size());
  return start == kHdf5;
}

std::vector<Quad> read_positions_h5(const std::filesystem::path& file) {
  const Hdf5Reader in(file);
  if (in.has("triangle"))
    throw input_error(file.string(), "dataset 'triangle'", "is of a surface, expected positions of grains");
  const std::vector<double> x = numbers(in, "position", 3, file);
  std::vector<Quad> grains(x.size() / 3);
  for (std::size_t k = 0; k < grains.size(); ++k) grains[k] = {x[3 * k], x[3 * k + 1], x[3 * k + 2], 0.0};
  if (grains.empty()) throw input_error(file.string(), "dataset 'position'", "holds no grain");
  if (!in.has("radius")) return grains;
  const std::vector<double> radius = numbers(in, "radius", 1, file);
  if (radius.size() != grains.size())
    throw input_error(
        file.string(), "dataset 'radius'",
        "has " + std::to_string(radius.size()) + " numbers, expected one per grain, " + std::to_string(grains.size()));
  for (std::size_t k = 0; k < grains.size(); ++k) grains[k].w = radius[k];
  return grains;
}

}  // namespace furrow::terrain::dem
