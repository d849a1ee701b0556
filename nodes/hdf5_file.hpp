// The little of HDF5 that Furrow writes: named datasets of numbers and attributes, in files that appear whole.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace furrow {

class Hdf5Writer {
 public:
  /// Creates a temporary file; nothing stands under `file` until finish(). @throws Error(io)
  explicit Hdf5Writer(const std::filesystem::path& file);
  ~Hdf5Writer();  // without finish(): removes the temporary file
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset of the given shape; groups in the name ("a/b") are made.
  /// @throws Error(io) when the shape does not fit the number of values, or the disk is full
  void put(const std::string& name, std::span<const double> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const float> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const std::int32_t> values, const std::vector<hsize_t>& shape);

  void attribute(const std::string& name, double value);
  void attribute(const std::string& name, std::int64_t value);
  void attribute(const std::string& name, const std::string& text);

  /// Closes, flushes to the disk, renames. @throws Error(io)
  void finish();

 private:
  template <class T>
  void write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape, hid_t type);
  void write_attribute(const std::string& name, hid_t type, const void* value);
  void check(bool ok, const std::string& what) const;

  std::filesystem::path file_, part_;
  hid_t handle_ = -1;
};

}  // namespace furrow
