#include "terrain/dem/beds/bed_positions_h5.hpp"

#include <array>
#include <cmath>
#include <fstream>
#include <string>

#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_handle.hpp"

namespace furrow::terrain::dem {
namespace {

Handle opened(const std::filesystem::path& file) {
  return Handle(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
}

/// All numbers of a dataset with this many columns; a vector has one.
std::vector<double> numbers(hid_t file, const std::string& name, hsize_t columns,
                            const std::filesystem::path& path) {
  const auto wrong = [&] {
    return input_error(path.string(), "dataset '" + name + "'",
                       columns == 1 ? "expected N numbers, m" : "expected N × 3 numbers, m");
  };
  const Handle set(H5Dopen2(file, name.c_str(), H5P_DEFAULT), H5Dclose);
  if (!set.ok()) throw wrong();
  const Handle space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
  const int rank = H5Sget_simple_extent_ndims(space);
  std::array<hsize_t, 2> size{0, 1};
  if (rank < 1 || rank > 2 || H5Sget_simple_extent_dims(space, size.data(), nullptr) < 0 ||
      size[1] != columns || H5Tget_class(type) != H5T_FLOAT)
    throw wrong();
  std::vector<double> values(size[0] * size[1]);
  if (!values.empty() && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    throw io_error(path.string(), "the dataset '" + name + "' cannot be read");
  for (std::size_t k = 0; k < values.size(); ++k)
    if (!std::isfinite(values[k]))
      throw input_error(path.string(), "dataset '" + name + "'",
                        "grain " + std::to_string(k / columns) + " is not a finite number");
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

bool is_settled_bed(const std::filesystem::path& file) {
  const Quiet quiet;
  const Handle in = opened(file);
  return !in.ok() || H5Lexists(in, "checksum", H5P_DEFAULT) > 0;
}

std::vector<Quad> read_positions_h5(const std::filesystem::path& file) {
  const Quiet quiet;
  const Handle in = opened(file);
  if (!in.ok()) throw io_error(file.string(), "not an HDF5 file, or damaged");
  if (H5Lexists(in, "triangle", H5P_DEFAULT) > 0)
    throw input_error(file.string(), "dataset 'triangle'", "is of a surface, expected positions of grains");
  const std::vector<double> x = numbers(in, "position", 3, file);
  std::vector<Quad> grains(x.size() / 3);
  for (std::size_t k = 0; k < grains.size(); ++k) grains[k] = {x[3 * k], x[3 * k + 1], x[3 * k + 2], 0.0};
  if (grains.empty()) throw input_error(file.string(), "dataset 'position'", "holds no grain");
  if (H5Lexists(in, "radius", H5P_DEFAULT) <= 0) return grains;
  const std::vector<double> radius = numbers(in, "radius", 1, file);
  if (radius.size() != grains.size())
    throw input_error(file.string(), "dataset 'radius'",
                      "has " + std::to_string(radius.size()) + " numbers, expected one per grain, " +
                          std::to_string(grains.size()));
  for (std::size_t k = 0; k < grains.size(); ++k) grains[k].w = radius[k];
  return grains;
}

}  // namespace furrow::terrain::dem
