// Fuzzes the readers of datasets, archives and positions with HDF5 files. Their datasets and attributes have any type
// and shape; some are cut short. Half of the files are frames of grains, like a user's bed, whose numbers, types and
// shapes differ a little from valid ones.
#include <algorithm>

#include <fuzzer/FuzzedDataProvider.h>

#include <hdf5.h>

#include "protocol/core/error.hpp"
#include "protocol/files/archive_file.hpp"
#include "protocol/files/hdf5_file.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "terrain/dem/beds/bed_positions_h5.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;

hid_t type_of(FuzzedDataProvider& in) {
  const hid_t types[] = {H5T_IEEE_F64LE,  H5T_IEEE_F32BE,     H5T_STD_I64LE, H5T_STD_I32LE,
                         H5T_STD_U64LE,   H5T_STD_U8LE,       H5T_STD_I16BE, H5T_C_S1,
                         H5T_STD_REF_OBJ, H5T_NATIVE_LDOUBLE, H5T_STD_B8LE};
  return types[in.ConsumeIntegralInRange<std::size_t>(0, std::size(types) - 1)];
}

std::string name_of(FuzzedDataProvider& in) {
  static const char* const names[] = {"x",        "position", "radius",    "triangle", "format_version",
                                      "checksum", "state",    "state/a:b", "group/x",  "group",
                                      "kind"};
  return names[in.ConsumeIntegralInRange<std::size_t>(0, std::size(names) - 1)];
}

void add_dataset(FuzzedDataProvider& in, hid_t file) {
  std::vector<hsize_t> shape, chunk;
  for (int axes = in.ConsumeIntegralInRange(0, 3); axes > 0; --axes) {
    shape.push_back(in.ConsumeBool() ? in.ConsumeIntegralInRange<hsize_t>(0, 20)
                                     : in.ConsumeIntegral<std::uint64_t>() >> 2);
    chunk.push_back(in.ConsumeIntegralInRange<hsize_t>(1, in.ConsumeBool() ? 20 : 1u << 30));
  }
  const Handle space(in.ConsumeIntegralInRange(0, 20) == 0 ? H5Screate(H5S_NULL)
                     : shape.empty()                       ? H5Screate(H5S_SCALAR)
                                     : H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                     H5Sclose);
  const Handle made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose), link(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(link, 1);
  const hssize_t count = space.ok() ? H5Sget_simple_extent_npoints(space) : 0;
  switch (in.ConsumeIntegralInRange(0, 7)) {
    case 1:  // the library fails on large compact datasets
      if (count >= 0 && count < 1000) H5Pset_layout(made, H5D_COMPACT);
      break;
    case 2:
    case 3:
    case 4:
      if (chunk.empty()) break;
      H5Pset_chunk(made, static_cast<int>(chunk.size()), chunk.data());
      if (in.ConsumeBool()) H5Pset_deflate(made, 6);
      if (in.ConsumeBool()) H5Pset_shuffle(made);
  }
  const hid_t type = type_of(in);
  const Handle set(H5Dcreate2(file, name_of(in).c_str(), type, space, link, made, H5P_DEFAULT), H5Dclose);
  if (!set.ok() || count <= 0 || count > 8000 || H5Tget_class(type) == H5T_REFERENCE) return;
  if (!chunk.empty() && H5Pget_layout(made) == H5D_CHUNKED) {
    hsize_t bytes = 16;
    for (const hsize_t length : chunk)
      if ((bytes *= length) > (1U << 22)) return;
  }
  std::vector<char> values(static_cast<std::size_t>(count) * 16, in.ConsumeIntegral<char>());
  if (in.ConsumeBool()) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void add_attribute(FuzzedDataProvider& in, hid_t file) {
  const char* const names[] = {"format_version", "kind", "kind_version", "checksum", "time_s"};
  const char* const name = names[in.ConsumeIntegralInRange<std::size_t>(0, std::size(names) - 1)];
  const hsize_t count = in.ConsumeIntegralInRange<hsize_t>(0, in.ConsumeBool() ? 1 : 1000);
  const Handle space(count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &count, nullptr), H5Sclose);
  const Handle text(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(text, in.ConsumeBool() ? in.ConsumeIntegralInRange<std::size_t>(1, 40) : H5T_VARIABLE);
  const bool words = in.ConsumeBool();
  const hid_t type = words ? static_cast<hid_t>(text) : type_of(in);
  const Handle made(H5Acreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  if (!made.ok() || (words && H5Tis_variable_str(text) > 0) || H5Tget_class(type) == H5T_REFERENCE) return;
  std::vector<char> values(std::max<std::size_t>(count * H5Tget_size(type), 1), '\0');
  const char* const kinds[] = {"state", "bed"};
  if (words)
    std::strncpy(values.data(), kinds[in.ConsumeBool()], values.size() - 1);
  else if (!values.empty())
    values[0] = in.ConsumeIntegralInRange<char>(0, 5);
  H5Awrite(made, type, values.data());
}

void fill(FuzzedDataProvider& in, hid_t file) {
  for (int k = 0; k < 10 && in.remaining_bytes() > 8; ++k) switch (in.ConsumeIntegralInRange(0, 9)) {
      case 3: {
        const Handle group(H5Gcreate2(file, name_of(in).c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose);
        break;
      }
      case 4:
      case 5:
        add_attribute(in, file);
        break;
      default:
        add_dataset(in, file);
    }
}

/// A dataset with columns, of floating-point numbers.
void add_table(FuzzedDataProvider& in, hid_t file, const char* name, hsize_t rows, hsize_t columns) {
  const hsize_t shape[] = {rows, columns};
  const int axes = columns == 1 && in.ConsumeIntegralInRange(0, 9) > 0 ? 1 : 2;
  const Handle space(H5Screate_simple(axes, shape, nullptr), H5Sclose);
  const Handle made(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  if (rows > 0 && in.ConsumeBool()) {
    const hsize_t chunk[] = {in.ConsumeIntegralInRange<hsize_t>(1, rows), columns};
    H5Pset_chunk(made, axes, chunk);
    if (in.ConsumeBool()) H5Pset_deflate(made, 1);
  }
  const hid_t type = in.ConsumeIntegralInRange(0, 9) == 0 ? type_of(in)
                     : in.ConsumeBool()                   ? H5T_IEEE_F64LE
                                                          : H5T_IEEE_F32LE;
  const Handle set(H5Dcreate2(file, name, type, space, H5P_DEFAULT, made, H5P_DEFAULT), H5Dclose);
  if (!set.ok() || (H5Tget_class(type) != H5T_FLOAT && H5Tget_class(type) != H5T_INTEGER)) return;
  std::vector<double> values(rows * columns);
  for (double& value : values) value = in.ConsumeFloatingPointInRange(-1.0, 1.0);
  if (!values.empty() && in.ConsumeIntegralInRange(0, 4) == 0)
    values[in.ConsumeIntegralInRange<std::size_t>(0, values.size() - 1)] = in.ConsumeFloatingPoint<double>();
  H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
}

void fill_frame(FuzzedDataProvider& in, hid_t file) {
  const auto grains = in.ConsumeIntegralInRange<hsize_t>(0, 12);
  add_table(in, file, "position", grains, in.ConsumeIntegralInRange(0, 9) == 0 ? 4 : 3);
  if (in.ConsumeBool()) add_table(in, file, "radius", in.ConsumeIntegralInRange(0, 4) == 0 ? grains + 1 : grains, 1);
  if (in.ConsumeIntegralInRange(0, 4) == 0) add_table(in, file, "triangle", 1, 3);
  if (in.ConsumeBool()) add_attribute(in, file);
}

template <class F>
void attempt(F&& read) {
  try {
    read();
  } catch (const Error&) {
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  FuzzedDataProvider in(data, size);
  const std::filesystem::path file = fuzz::folder() / "foreign.h5";
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  {
    const Handle out(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (in.ConsumeBool())
      fill_frame(in, out);
    else
      fill(in, out);
  }
  if (in.ConsumeIntegralInRange(0, 9) == 0)
    std::filesystem::resize_file(file, in.ConsumeIntegralInRange<std::uintmax_t>(0, std::filesystem::file_size(file)));
  attempt([&] {
    const Hdf5Reader reader(file);
    for (const char* name : {"x", "position", "radius", "group/x"}) {
      attempt([&] { reader.has(name); });
      attempt([&] { reader.shape(name); });
      attempt([&] { reader.type(name); });
      attempt([&] { reader.get<double>(name); });
      attempt([&] { reader.get<std::uint8_t>(name); });
    }
    for (const char* name : {"format_version", "kind", "time_s"}) {
      attempt([&] { reader.number(name); });
      attempt([&] { reader.text(name); });
    }
  });
  constexpr ArchiveKind kBed{"bed", "a bed of furrow", 5, ""};
  attempt([&] { terrain::dem::read_positions_h5(file); });
  attempt([&] { read_archive(file); });
  attempt([&] { read_archive(file, kBed); });
  may_be_archive(file, kBed);
  return 0;
}
