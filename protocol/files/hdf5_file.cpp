#include "protocol/files/hdf5_file.hpp"

#include <hdf5_hl.h>

#include <functional>
#include <numeric>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "protocol/files/hdf5_library.hpp"

namespace furrow {

using hdf5::kFormatVersion;

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file) : lock_(hdf5::library()), file_(file), part_(file) {
  hdf5::prepare();
  // No buffer for small datasets: on a full disk they would be lost when they are closed, not when they are put.
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose);
  H5Pset_sieve_buf_size(access, 0);
  handle_ = H5Fcreate(part_.way().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access);
  check(handle_ >= 0, "cannot create");
  attribute("format_version", kFormatVersion);
}

Hdf5Writer::~Hdf5Writer() {
  if (handle_ >= 0) H5Fclose(handle_);
}

void Hdf5Writer::check(bool ok, const std::string& what) const {
  if (!ok) throw io_error(file_.string(), what + " (HDF5): is the folder writable and the disk not full?");
}

template <class T>
void Hdf5Writer::write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape) {
  const hid_t type = hdf5::native(T{});
  FURROW_ASSERT(!name.empty() && !shape.empty(), name, shape.size());
  const hsize_t count = std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
  if (count != values.size()) throw io_error(file_.string(), "dataset '" + name + "' does not fit its shape");
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(groups, 1);
  const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(timeless, false);  // equal contents make equal files
  Handle set(H5Dcreate2(handle_, name.c_str(), type, space, groups, timeless, H5P_DEFAULT), H5Dclose);
  check(set >= 0, "cannot create dataset '" + name + "'");
  const bool written = values.empty() || H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
  check(set.close() && written, "cannot write dataset '" + name + "'");
}

template void Hdf5Writer::write(const std::string&, std::span<const double>, const std::vector<hsize_t>&);
template void Hdf5Writer::write(const std::string&, std::span<const float>, const std::vector<hsize_t>&);
template void Hdf5Writer::write(const std::string&, std::span<const std::int32_t>, const std::vector<hsize_t>&);
template void Hdf5Writer::write(const std::string&, std::span<const std::int64_t>, const std::vector<hsize_t>&);
template void Hdf5Writer::write(const std::string&, std::span<const std::uint64_t>, const std::vector<hsize_t>&);
template void Hdf5Writer::write(const std::string&, std::span<const std::uint8_t>, const std::vector<hsize_t>&);

void Hdf5Writer::write_attribute(hid_t object, const std::string& name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(object, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute >= 0 && H5Awrite(attribute, type, value) >= 0, "cannot write attribute '" + name + "'");
}

void Hdf5Writer::attribute(const std::string& name, double value) {
  write_attribute(handle_, name, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5Writer::attribute(const std::string& name, std::int64_t value) {
  write_attribute(handle_, name, H5T_NATIVE_INT64, &value);
}
void Hdf5Writer::attribute(const std::string& name, const std::string& text) { write_text(handle_, name, text); }

void Hdf5Writer::write_text(hid_t object, const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);
  write_attribute(object, name, type, text.c_str());
}

void Hdf5Writer::attribute_of(const std::string& object, const std::string& name, const std::string& text) {
  const Handle found(H5Oopen(handle_, object.c_str(), H5P_DEFAULT), H5Oclose);
  check(found.ok(), "cannot find '" + object + "'");
  write_text(found, name, text);
}

// In netCDF-4 a dimension without a variable is recognized by the name of its scale, which begins with this text and
// ends with the length in ten places [NetCDF-4 File Format, "Dimensions", docs.unidata.ucar.edu/netcdf-c].
void Hdf5Writer::put_axis(const std::string& name, hsize_t length) {
  const Handle space(H5Screate_simple(1, &length, nullptr), H5Sclose);
  const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(timeless, false);
  const Handle set(H5Dcreate2(handle_, name.c_str(), H5T_IEEE_F32BE, space, H5P_DEFAULT, timeless, H5P_DEFAULT),
                   H5Dclose);
  check(set.ok(), "cannot create axis '" + name + "'");
  const std::string known_as = fmt::format("This is a netCDF dimension but not a netCDF variable.{:10}", length);
  check(H5DSset_scale(set, known_as.c_str()) >= 0, "cannot make an axis of '" + name + "'");
}

void Hdf5Writer::lay_along(const std::string& dataset, const std::vector<std::string>& axes) {
  const Handle set(H5Dopen2(handle_, dataset.c_str(), H5P_DEFAULT), H5Dclose);
  check(set.ok(), "cannot find dataset '" + dataset + "'");
  for (std::size_t k = 0; k < axes.size(); ++k) {
    const std::string& name = axes[k];
    const Handle axis(H5Dopen2(handle_, name.c_str(), H5P_DEFAULT), H5Dclose);
    check(axis.ok(), "cannot find axis '" + name + "'");
    if (H5DSis_scale(axis) == 0)
      check(H5DSset_scale(axis, name.substr(name.rfind('/') + 1).c_str()) >= 0,
            "cannot make an axis of '" + name + "'");
    if (name != dataset)
      check(H5DSattach_scale(set, axis, static_cast<unsigned>(k)) >= 0,
            "cannot lay '" + dataset + "' along '" + name + "'");
  }
}

void Hdf5Writer::finish() {
  FURROW_ASSERT(handle_ >= 0, file_.string());
  check(H5Fflush(handle_, H5F_SCOPE_LOCAL) >= 0, "cannot flush");
  const herr_t closed = H5Fclose(handle_);
  handle_ = -1;
  check(closed >= 0, "cannot close");
  part_.publish();
}

}  // namespace furrow
