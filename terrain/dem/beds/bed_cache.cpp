#include "terrain/dem/beds/bed_cache.hpp"

#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <span>
#include <variant>

#include "protocol/core/field_hash.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/hdf5_handle.hpp"
#include "terrain/dem/beds/bed_format_4.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/contact_mixing.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::dem {
namespace {

constexpr std::int64_t kBedFormat = 5;        // raise when the bits of a bed or its digest may change
constexpr std::int64_t kOldestBedFormat = 4;  // that can be read

template <class T>
hid_t native_type() {
  if constexpr (std::is_same_v<T, double>) return H5T_NATIVE_DOUBLE;
  if constexpr (std::is_same_v<T, std::int64_t>) return H5T_NATIVE_INT64;
  if constexpr (std::is_same_v<T, std::int32_t>) return H5T_NATIVE_INT32;
  if constexpr (std::is_same_v<T, std::uint64_t>) return H5T_NATIVE_UINT64;
  if constexpr (std::is_same_v<T, std::uint8_t>) return H5T_NATIVE_UINT8;
}

std::uint64_t checksum(const Archive& archive) {
  Hash hash;
  for (const auto& [name, array] : archive.arrays()) {
    hash.add(name);
    std::visit([&](const auto& values) { hash.add(std::span(values)); }, array);
  }
  return hash.value();
}

bool write_array(hid_t file, const std::string& name, const Archive::Array& array) {
  return std::visit(
      [&](const auto& values) {
        using T = typename std::decay_t<decltype(values)>::value_type;
        const hsize_t size = values.size();
        const Handle space(H5Screate_simple(1, &size, nullptr), H5Sclose);
        const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose);
        H5Pset_create_intermediate_group(links, 1);
        const Handle timeless(H5Pcreate(H5P_DATASET_CREATE), H5Pclose);  // the same bed, the same bytes
        H5Pset_obj_track_times(timeless, false);
        const Handle set(
            H5Dcreate2(file, name.c_str(), native_type<T>(), space, links, timeless, H5P_DEFAULT), H5Dclose);
        if (!set.ok()) return false;
        return size == 0 ||
               H5Dwrite(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) >= 0;
      },
      array);
}

template <class T>
bool read_as(hid_t set, hid_t type, hsize_t size, const std::string& name, Archive& archive) {
  if (H5Tequal(type, native_type<T>()) <= 0) return false;
  std::vector<T> values(size);
  if (size > 0 && H5Dread(set, native_type<T>(), H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()) < 0)
    return false;
  archive.put(name, values);
  return true;
}

herr_t read_object(hid_t file, const char* name, const H5O_info_t* info, void* target) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  const Handle set(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose);
  if (!set.ok()) return -1;
  const Handle space(H5Dget_space(set), H5Sclose), type(H5Dget_type(set), H5Tclose);
  const auto size = static_cast<hsize_t>(H5Sget_simple_extent_npoints(space));
  auto& archive = *static_cast<Archive*>(target);
  const bool good = read_as<double>(set, type, size, name, archive) ||
                    read_as<std::int64_t>(set, type, size, name, archive) ||
                    read_as<std::int32_t>(set, type, size, name, archive) ||
                    read_as<std::uint64_t>(set, type, size, name, archive) ||
                    read_as<std::uint8_t>(set, type, size, name, archive);
  return good ? 0 : -1;
}

std::string file_bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace

std::string bed_digest(const DemOptions& o) {
  Hash hash;
  const auto add = [&](const auto& value) { hash.add(&value, sizeof value); };
  add(kBedFormat);
  add(kSkinShare);
  DemOptions named = o;
  named.law = law_name(law_from(o.law));  // the law has a former name
  add_fields(hash, named, role::bed);
  add(o.periodic_x);
  add(o.seed);
  add(settle_step(o));
  if (!o.bed.empty()) hash.add(file_bytes(o.bed));
  return hash.hex();
}

std::filesystem::path bed_cache_file(const std::string& digest) {
  std::filesystem::path folder;
  if (const char* cache = std::getenv("XDG_CACHE_HOME"); cache && *cache) {
    folder = cache;
  } else if (const char* home = std::getenv("HOME"); home && *home) {
    folder = std::filesystem::path(home) / ".cache";
  } else {
    return {};
  }
  return folder / "furrow" / "beds" / (digest + ".h5");
}

void write_bed(const std::filesystem::path& file, const Archive& archive) {
  const Quiet quiet;
  std::error_code failed;
  std::filesystem::create_directories(file.parent_path(), failed);
  std::array<char, 64> host{};
  gethostname(host.data(), host.size() - 1);
  const std::filesystem::path temporary =
      file.string() + "." + host.data() + "." + std::to_string(getpid()) + ".partial";
  bool good = false;
  {
    Handle out(H5Fcreate(temporary.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose);
    if (out.ok()) {
      good = write_array(out, "format_version", std::vector<std::int64_t>{kBedFormat}) &&
             write_array(out, "checksum", std::vector<std::uint64_t>{checksum(archive)});
      for (const auto& [name, array] : archive.arrays()) good = good && write_array(out, name, array);
      good = good && H5Fflush(out, H5F_SCOPE_GLOBAL) >= 0;
      good = out.close() && good;
    }
  }
  if (good) std::filesystem::rename(temporary, file, failed);
  if (!good || failed) {
    std::error_code ignored;
    std::filesystem::remove(temporary, ignored);
    throw io_error(file.string(), "the bed could not be written");
  }
}

Archive read_bed(const std::filesystem::path& file) {
  const Quiet quiet;
  if (!std::filesystem::exists(file)) throw io_error(file.string(), "no such bed file");
  const Handle in(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!in.ok()) throw io_error(file.string(), "not an HDF5 file, or damaged");
  Archive all;
  if (H5Ovisit2(in, H5_INDEX_NAME, H5_ITER_NATIVE, read_object, &all, H5O_INFO_BASIC) < 0)
    throw io_error(file.string(), "damaged");
  if (!all.has("format_version") || !all.has("checksum"))
    throw io_error(file.string(), "not a bed of furrow");
  const std::int64_t format = all.get_int("format_version");
  if (format > kBedFormat)
    throw io_error(file.string(), "format_version " + std::to_string(format) +
                                      " is newer than this program's " + std::to_string(kBedFormat));
  if (format < kOldestBedFormat)
    throw io_error(file.string(), "format_version " + std::to_string(format) +
                                      " is older than this program reads, expected " +
                                      std::to_string(kOldestBedFormat) + " or later: make it anew");
  Archive archive;
  for (const auto& [name, array] : all.arrays())
    if (name != "format_version" && name != "checksum") archive.put_array(name, array);
  if (checksum(archive) != all.get<std::uint64_t>("checksum", 1).front())
    throw io_error(file.string(), "damaged: its checksum does not fit");
  return format == kBedFormat ? archive : from_format_4(archive);
}

}  // namespace furrow::terrain::dem
