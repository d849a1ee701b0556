#include "protocol/files/hdf5_file.hpp"

#include <algorithm>
#include <functional>
#include <numeric>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/hdf5_handle.hpp"

namespace furrow {
namespace {

constexpr std::int64_t kFormatVersion = 1;

std::recursive_mutex library;  // held by every open writer and reader

/// Errors reach the user through exceptions alone.
void silence() { H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr); }

hid_t native(double) { return H5T_NATIVE_DOUBLE; }
hid_t native(float) { return H5T_NATIVE_FLOAT; }
hid_t native(std::int32_t) { return H5T_NATIVE_INT32; }
hid_t native(std::int64_t) { return H5T_NATIVE_INT64; }
hid_t native(std::uint64_t) { return H5T_NATIVE_UINT64; }
hid_t native(std::uint8_t) { return H5T_NATIVE_UINT8; }

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file) : lock_(library), file_(file), part_(file) {
  silence();
  handle_ = H5Fcreate(part_.way().c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
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
void Hdf5Writer::write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape,
                       hid_t type) {
  FURROW_ASSERT(!name.empty() && !shape.empty(), name, shape.size());
  const hsize_t count = std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
  if (count != values.size()) throw io_error(file_.string(), "dataset '" + name + "' does not fit its shape");
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(groups, 1);
  const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);
  H5Pset_obj_track_times(timeless, false);  // equal contents make equal files
  const Handle set(H5Dcreate2(handle_, name.c_str(), type, space, groups, timeless, H5P_DEFAULT), H5Dclose);
  check(set >= 0, "cannot create dataset '" + name + "'");
  if (values.empty()) return;
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
        "cannot write dataset '" + name + "'");
}

void Hdf5Writer::put(const std::string& name, std::span<const double> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_DOUBLE);
}
void Hdf5Writer::put(const std::string& name, std::span<const float> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_FLOAT);
}
void Hdf5Writer::put(const std::string& name, std::span<const std::int32_t> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_INT32);
}
void Hdf5Writer::put(const std::string& name, std::span<const std::int64_t> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_INT64);
}
void Hdf5Writer::put(const std::string& name, std::span<const std::uint64_t> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_UINT64);
}
void Hdf5Writer::put(const std::string& name, std::span<const std::uint8_t> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_UINT8);
}

void Hdf5Writer::write_attribute(const std::string& name, hid_t type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose);
  const Handle attribute(H5Acreate2(handle_, name.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT), H5Aclose);
  check(attribute >= 0 && H5Awrite(attribute, type, value) >= 0, "cannot write attribute '" + name + "'");
}

void Hdf5Writer::attribute(const std::string& name, double value) {
  write_attribute(name, H5T_NATIVE_DOUBLE, &value);
}
void Hdf5Writer::attribute(const std::string& name, std::int64_t value) {
  write_attribute(name, H5T_NATIVE_INT64, &value);
}
void Hdf5Writer::attribute(const std::string& name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose);
  H5Tset_size(type, text.size() + 1);
  write_attribute(name, type, text.c_str());
}

void Hdf5Writer::finish() {
  FURROW_ASSERT(handle_ >= 0, file_.string());
  check(H5Fflush(handle_, H5F_SCOPE_LOCAL) >= 0, "cannot flush");
  const herr_t closed = H5Fclose(handle_);
  handle_ = -1;
  check(closed >= 0, "cannot close");
  part_.publish();
}

Hdf5Reader::Hdf5Reader(const std::filesystem::path& file) : lock_(library), file_(file) {
  silence();
  std::error_code ignored;
  if (!std::filesystem::exists(file_, ignored)) throw io_error(file_.string(), "does not exist");
  handle_ = H5Fopen(file_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  check(handle_ >= 0, "not an HDF5 file, or damaged");
  try {
    if (!has_attribute("format_version")) return;
    const std::int64_t version = integer("format_version");
    check(version <= kFormatVersion, "format_version " + std::to_string(version) +
                                         " is newer than this program reads, which is " +
                                         std::to_string(kFormatVersion));
  } catch (...) {
    H5Fclose(handle_);
    throw;
  }
}

Hdf5Reader::~Hdf5Reader() { H5Fclose(handle_); }

void Hdf5Reader::check(bool ok, const std::string& what) const {
  if (!ok) throw io_error(file_.string(), what);
}

bool Hdf5Reader::has(const std::string& name) const {
  return H5Lexists(handle_, name.c_str(), H5P_DEFAULT) > 0;
}

bool Hdf5Reader::has_attribute(const std::string& name) const { return H5Aexists(handle_, name.c_str()) > 0; }

std::vector<std::string> Hdf5Reader::datasets() const {
  std::vector<std::string> names;
  const auto add = [](hid_t, const char* name, const H5O_info_t* info, void* target) -> herr_t {
    if (info->type == H5O_TYPE_DATASET) static_cast<std::vector<std::string>*>(target)->emplace_back(name);
    return 0;
  };
  check(H5Ovisit2(handle_, H5_INDEX_NAME, H5_ITER_INC, add, &names, H5O_INFO_BASIC) >= 0,
        "its contents cannot be listed: the file is damaged");
  return names;
}

std::vector<hsize_t> Hdf5Reader::shape(const std::string& name) const {
  const Handle set(H5Dopen2(handle_, name.c_str(), H5P_DEFAULT), H5Dclose);
  check(set >= 0, "lacks the dataset '" + name + "'");
  const Handle space(H5Dget_space(set), H5Sclose);
  std::vector<hsize_t> shape(static_cast<std::size_t>(std::max(H5Sget_simple_extent_ndims(space), 0)));
  H5Sget_simple_extent_dims(space, shape.data(), nullptr);
  return shape;
}

Hdf5Type Hdf5Reader::type(const std::string& name) const {
  const Handle set(H5Dopen2(handle_, name.c_str(), H5P_DEFAULT), H5Dclose);
  check(set >= 0, "lacks the dataset '" + name + "'");
  const Handle type(H5Dget_type(set), H5Tclose);
  const std::size_t size = H5Tget_size(type);
  if (H5Tget_class(type) == H5T_FLOAT) return size == 8 ? Hdf5Type::float64 : Hdf5Type::float32;
  if (H5Tget_class(type) != H5T_INTEGER) return Hdf5Type::other;
  const bool has_sign = H5Tget_sign(type) == H5T_SGN_2;
  if (size == 8) return has_sign ? Hdf5Type::int64 : Hdf5Type::uint64;
  if (size == 4 && has_sign) return Hdf5Type::int32;
  return size == 1 && !has_sign ? Hdf5Type::uint8 : Hdf5Type::other;
}

template <class T>
std::vector<T> Hdf5Reader::get(const std::string& name) const {
  const Handle set(H5Dopen2(handle_, name.c_str(), H5P_DEFAULT), H5Dclose);
  check(set >= 0, "lacks the dataset '" + name + "'");
  const Handle space(H5Dget_space(set), H5Sclose);
  std::vector<T> values(static_cast<std::size_t>(std::max<hssize_t>(H5Sget_simple_extent_npoints(space), 0)));
  if (values.empty()) return values;
  check(H5Dread(set, native(T{}), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0,
        "cannot read the dataset '" + name + "': is the file cut short?");
  return values;
}

template std::vector<double> Hdf5Reader::get(const std::string&) const;
template std::vector<float> Hdf5Reader::get(const std::string&) const;
template std::vector<std::int32_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::int64_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::uint64_t> Hdf5Reader::get(const std::string&) const;
template std::vector<std::uint8_t> Hdf5Reader::get(const std::string&) const;

void Hdf5Reader::read_attribute(const std::string& name, hid_t type, void* value) const {
  const Handle attribute(H5Aopen(handle_, name.c_str(), H5P_DEFAULT), H5Aclose);
  check(attribute >= 0 && H5Aread(attribute, type, value) >= 0, "lacks the attribute '" + name + "'");
}

double Hdf5Reader::number(const std::string& attribute) const {
  double value = 0.0;
  read_attribute(attribute, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::int64_t Hdf5Reader::integer(const std::string& attribute) const {
  std::int64_t value = 0;
  read_attribute(attribute, H5T_NATIVE_INT64, &value);
  return value;
}

std::string Hdf5Reader::text(const std::string& attribute) const {
  const Handle opened(H5Aopen(handle_, attribute.c_str(), H5P_DEFAULT), H5Aclose);
  check(opened >= 0, "lacks the attribute '" + attribute + "'");
  const Handle type(H5Aget_type(opened), H5Tclose);
  check(H5Tget_class(type) == H5T_STRING && H5Tis_variable_str(type) == 0,
        "holds the attribute '" + attribute + "' as something else than text");
  std::string text(H5Tget_size(type), '\0');
  read_attribute(attribute, type, text.data());
  text.resize(text.find_last_not_of('\0') + 1);
  return text;
}

}  // namespace furrow
