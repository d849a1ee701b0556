// The part of HDF5 that Furrow uses: named datasets of numbers and attributes, in files that appear whole. The packaged
// library serves one thread at a time, so an open writer or reader holds a lock of the process.
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
  /// There is no file under this name until finish(). @throws Error(io)
  explicit Hdf5Writer(const std::filesystem::path& file);
  ~Hdf5Writer();  // without finish(): removes the temporary file
  Hdf5Writer(const Hdf5Writer&) = delete;
  Hdf5Writer& operator=(const Hdf5Writer&) = delete;

  /// Writes a dataset of the given shape, and creates the groups in its name ("a/b").
  /// @throws Error(io) when the shape does not fit the number of values, or the disk is full
  /// @param values numbers of a type that Hdf5Reader::get reads, one after another
  template <class Values>
  void put(const std::string& name, const Values& values, const std::vector<hsize_t>& shape) {
    write<typename Values::value_type>(name, values, shape);
  }

  void attribute(const std::string& name, double value);
  void attribute(const std::string& name, std::int64_t value);
  void attribute(const std::string& name, const std::string& text);

  /// Describes a dataset or a group to other programs, for example its `units`. @pre it, or a dataset in it, was put
  void attribute_of(const std::string& object, const std::string& name, const std::string& text);
  /// An axis without numbers of its own: a dimension of netCDF, along which other datasets may lie.
  void put_axis(const std::string& name, hsize_t length);
  /// Sets the axes of a dataset by the names of datasets of one dimension: HDF5 dimension scales, which netCDF (and so
  /// xarray) reads as coordinates. A dataset that lies along itself is a coordinate.
  /// @pre all of them were put; one axis per dimension of the dataset, of the same length
  void lay_along(const std::string& dataset, const std::vector<std::string>& axes);

  /// Closes the file, flushes it to the disk and renames it. @throws Error(io)
  void finish();

 private:
  template <class T>
  void write(const std::string& name, std::span<const T> values, const std::vector<hsize_t>& shape);
  void write_attribute(hid_t object, const std::string& name, hid_t type, const void* value);
  void write_text(hid_t object, const std::string& name, const std::string& text);
  void check(bool ok, const std::string& what) const;

  std::unique_lock<std::recursive_mutex> lock_;
  std::filesystem::path file_;
  NewFile part_;
  hid_t handle_ = -1;
};

enum class Hdf5Type { float64, float32, int64, int32, uint64, uint8, other };

/// Reads files of Furrow and of other programs. A dataset is read if it has plain numbers, and no more of them than the
/// file has bytes for (compressed: kMaxRatio times as many). So a damaged size cannot exhaust the memory.
class Hdf5Reader {
 public:
  static constexpr std::uintmax_t kMaxRatio = 64;  // positions of grains compress by less than 10

  /// Only files that Furrow wrote have the attribute format_version.
  /// @throws Error(io) when `file` cannot be opened, is cut short, or its format_version is newer than ours
  explicit Hdf5Reader(const std::filesystem::path& file);
  ~Hdf5Reader();
  Hdf5Reader(const Hdf5Reader&) = delete;
  Hdf5Reader& operator=(const Hdf5Reader&) = delete;

  /// Whether there is a dataset or group of that name; groups as in "a/b".
  bool has(const std::string& name) const;
  bool has_attribute(const std::string& name) const;

  /// Names of all datasets, those in groups as "a/b".
  std::vector<std::string> datasets() const;
  /// Lengths along its axes, at most 2³¹ numbers in all.
  std::vector<hsize_t> shape(const std::string& name) const;
  Hdf5Type type(const std::string& name) const;

  /// All values of a dataset, converted to T: double, float, int32, int64, uint64 or uint8. @throws Error(io)
  template <class T>
  std::vector<T> get(const std::string& name) const;

  double number(const std::string& attribute) const;
  std::int64_t integer(const std::string& attribute) const;
  std::string text(const std::string& attribute) const;

 private:
  class Set;
  void read_number(const std::string& attribute, hid_t type, void* value) const;
  void check(bool ok, const std::string& what) const;

  std::unique_lock<std::recursive_mutex> lock_;
  std::filesystem::path file_;
  std::uintmax_t size_ = 0;  // of the file, bytes
  hid_t handle_ = -1;
};

}  // namespace furrow
