// HDF5 identifiers that close themselves, and the types of numbers.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <utility>

namespace furrow {

class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Handle() { close(); }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }
  bool ok() const { return id_ >= 0; }
  /// @returns whether it could be closed; for a dataset, whether it was written
  bool close() { return id_ < 0 || close_(std::exchange(id_, -1)) >= 0; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

namespace hdf5 {
/// The HDF5 type of numbers in memory.
inline hid_t native(double) { return H5T_NATIVE_DOUBLE; }
inline hid_t native(float) { return H5T_NATIVE_FLOAT; }
inline hid_t native(std::int32_t) { return H5T_NATIVE_INT32; }
inline hid_t native(std::int64_t) { return H5T_NATIVE_INT64; }
inline hid_t native(std::uint64_t) { return H5T_NATIVE_UINT64; }
inline hid_t native(std::uint8_t) { return H5T_NATIVE_UINT8; }
}  // namespace hdf5

}  // namespace furrow
