#include "nodes/hdf5_file.hpp"

#include <numeric>

#include "nodes/text_file.hpp"
#include "protocol/error.hpp"

namespace furrow {
namespace {

constexpr std::int64_t kFormatVersion = 1;

/// Closes any kind of HDF5 handle at the end of a scope.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

}  // namespace

Hdf5Writer::Hdf5Writer(const std::filesystem::path& file) : file_(file), part_(temporary_name(file)) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors reach the user through exceptions alone
  handle_ = H5Fcreate(part_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  check(handle_ >= 0, "cannot create");
  attribute("format_version", kFormatVersion);
}

Hdf5Writer::~Hdf5Writer() {
  if (handle_ < 0) return;
  H5Fclose(handle_);
  std::error_code ignored;
  std::filesystem::remove(part_, ignored);
}

void Hdf5Writer::check(bool ok, const std::string& what) const {
  if (!ok) throw io_error(file_.string(), what + " (HDF5): is the folder writable and the disk not full?");
}

template <class T>
void Hdf5Writer::write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape,
                       hid_t type) {
  const hsize_t count = std::accumulate(shape.begin(), shape.end(), hsize_t{1}, std::multiplies<>());
  check(count == values.size(), "dataset '" + name + "' does not fit its shape");
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr), H5Sclose);
  const Handle groups(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
  H5Pset_create_intermediate_group(groups, 1);
  const Handle set(H5Dcreate2(handle_, name.c_str(), type, space, groups, H5P_DEFAULT, H5P_DEFAULT), H5Dclose);
  check(set >= 0, "cannot create dataset '" + name + "'");
  if (values.empty()) return;
  check(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0, "cannot write dataset '" + name + "'");
}

void Hdf5Writer::put(const std::string& name, std::span<const double> values, const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_DOUBLE);
}
void Hdf5Writer::put(const std::string& name, std::span<const float> values, const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_FLOAT);
}
void Hdf5Writer::put(const std::string& name, std::span<const std::int32_t> values,
                     const std::vector<hsize_t>& shape) {
  write(name, values, shape, H5T_NATIVE_INT32);
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
  check(H5Fflush(handle_, H5F_SCOPE_LOCAL) >= 0, "cannot flush");
  const herr_t closed = H5Fclose(handle_);
  handle_ = -1;
  check(closed >= 0, "cannot close");
  publish_file(part_, file_);
}

}  // namespace furrow
