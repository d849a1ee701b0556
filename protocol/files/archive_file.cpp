#include "protocol/files/archive_file.hpp"

#include <algorithm>

#include <fmt/format.h>

#include "protocol/core/archive_hash.hpp"
#include "protocol/files/hdf5_file.hpp"

namespace furrow {
namespace {

bool is_of(const Hdf5Reader& file, const ArchiveKind& kind) {
  return file.has_attribute("kind") && file.text("kind") == kind.name;
}

std::string swapped(std::string name, char from, char to) {
  std::replace(name.begin(), name.end(), from, to);
  return name;
}

std::string stored_name(const std::string& name, const ArchiveKind& kind) {
  return *kind.group ? std::string(kind.group) + "/" + swapped(name, '/', ':') : name;
}

/// The name of the array that a dataset stores; empty for any other dataset.
std::string array_name(const std::string& stored, const ArchiveKind& kind) {
  const std::string group = kind.group;
  if (group.empty()) return stored;
  return stored.starts_with(group + "/") ? swapped(stored.substr(group.size() + 1), ':', '/') : "";
}

Archive::Array read_array(const Hdf5Reader& file, const std::filesystem::path& path, const std::string& name) {
  switch (file.type(name)) {
    case Hdf5Type::float64:
      return file.get<double>(name);
    case Hdf5Type::int64:
      return file.get<std::int64_t>(name);
    case Hdf5Type::int32:
      return file.get<std::int32_t>(name);
    case Hdf5Type::uint64:
      return file.get<std::uint64_t>(name);
    case Hdf5Type::uint8:
      return file.get<std::uint8_t>(name);
    default:
      throw io_error(path.string(), "the dataset '" + name + "' is of a type that no array has: it is damaged");
  }
}

}  // namespace

void write_archive(const std::filesystem::path& path, const Archive& archive, const ArchiveKind& kind,
                   const std::function<void()>& each) {
  Hdf5Writer file(path);
  file.attribute("kind", std::string(kind.name));
  file.attribute("kind_version", kind.version);
  file.attribute("checksum", archive_hash(archive).hex());
  for (const auto& [name, array] : archive.arrays()) {
    if (each) each();
    const std::string stored = stored_name(name, kind);
    if (array_name(stored, kind) != name) throw io_error(path.string(), "an array may not be called '" + name + "'");
    std::visit([&](const auto& values) { file.put(stored, std::span(values), {values.size()}); }, array);
  }
  file.finish();
}

Archive read_archive(const std::filesystem::path& path, const ArchiveKind& kind, const std::function<void()>& each) {
  const Hdf5Reader file(path);
  if (!is_of(file, kind)) throw io_error(path.string(), std::string("is not ") + kind.words);
  if (const std::int64_t version = file.integer("kind_version"); version != kind.version)
    throw io_error(path.string(), fmt::format("is {} of version {}, but this program reads version {}: make it again",
                                              kind.words, version, kind.version));
  Archive archive;
  for (const std::string& stored : file.datasets()) {
    if (each) each();
    if (const std::string name = array_name(stored, kind); !name.empty())
      archive.put_array(name, read_array(file, path, stored));
  }
  if (archive_hash(archive).hex() != file.text("checksum"))
    throw io_error(path.string(), "the checksum does not fit the contents: the file is damaged");
  return archive;
}

bool may_be_archive(const std::filesystem::path& path, const ArchiveKind& kind) try {
  return is_of(Hdf5Reader(path), kind);
} catch (const Error&) {
  return true;
}

}  // namespace furrow
