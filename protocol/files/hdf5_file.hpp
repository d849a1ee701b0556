// The little of HDF5 that Furrow uses: named datasets of numbers and attributes, in files that appear whole.
// The library as packaged serves one thread at a time: an open writer or reader holds a lock of the process.
#pragma once

#include <hdf5.h>

#include <cstdint>
#include <filesystem>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "protocol/files/new_file.hpp"

namespace furrow {

class Hdf5Writer {
 public:
  /// Nothing stands under `file` until finish(). @throws Error(io)
  explicit Hdf5Writer(const std::filesystem::path& file);
  ~Hdf5Writer();  // without finish(): removes the temporary file
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset of the given shape; groups in the name ("a/b") are made.
  /// @throws Error(io) when the shape does not fit the number of values, or the disk is full
  void put(const std::string& name, std::span<const double> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const float> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const std::int32_t> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const std::int64_t> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const std::uint64_t> values, const std::vector<hsize_t>& shape);
  void put(const std::string& name, std::span<const std::uint8_t> values, const std::vector<hsize_t>& shape);

  void attribute(const std::string& name, double value);
  void attribute(const std::string& name, std::int64_t value);
  void attribute(const std::string& name, const std::string& text);

  /// Closes, flushes to the disk, renames. @throws Error(io)
  void finish();

 private:
  template <class T>
  void write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape,
             hid_t type);
  void write_attribute(const std::string& name, hid_t type, const void* value);
  void check(bool ok, const std::string& what) const;

  std::unique_lock<std::recursive_mutex> lock_;
  std::filesystem::path file_;
  NewFile part_;
  hid_t handle_ = -1;
};

/// How the numbers of a dataset are stored.
enum class Hdf5Type { float64, float32, int64, int32, uint64, uint8, other };

class Hdf5Reader {
 public:
  /// Takes files of other programs as well: only those of ours have the attribute format_version.
  /// @throws Error(io) when `file` cannot be opened, is cut short, or its format_version is newer than ours
  explicit Hdf5Reader(const std::filesystem::path& file);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  bool has(const std::string& name) const;  // a dataset or group; groups on the way must exist
  bool has_attribute(const std::string& name) const;

  /// Names of all datasets, those in groups as "a/b".
  std::vector<std::string> datasets() const;
  std::vector<hsize_t> shape(const std::string& name) const;
  Hdf5Type type(const std::string& name) const;

  /// All values of a dataset, converted to T: double, float, int32, int64, uint64 or uint8. @throws Error(io)
  template <class T>
  std::vector<T> get(const std::string& name) const;

  double number(const std::string& attribute) const;
  std::int64_t integer(const std::string& attribute) const;
  std::string text(const std::string& attribute) const;

 private:
  void read_attribute(const std::string& name, hid_t type, void* value) const;
  void check(bool ok, const std::string& what) const;

  std::unique_lock<std::recursive_mutex> lock_;
  std::filesystem::path file_;
  hid_t handle_ = -1;
};

}  // namespace furrow
