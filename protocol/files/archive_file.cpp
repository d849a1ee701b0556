#include "protocol/files/archive_file.hpp"

#include <algorithm>

#include "protocol/core/hash.hpp"
#include "protocol/files/hdf5_file.hpp"

namespace furrow {
namespace {

constexpr char kKind[] = "state";
constexpr char kGroup[] = "state";

std::string swapped(std::string name, char from, char to) {
  std::replace(name.begin(), name.end(), from, to);
  return name;
}

std::string checksum(const Archive& archive) {
  Hash hash;
  for (const auto& [name, array] : archive.arrays()) {
    const std::size_t type = array.index();
    hash.add(name);
    hash.add(&type, sizeof type);
    std::visit(
        [&hash](const auto& values) {
          const std::size_t size = values.size();
          hash.add(&size, sizeof size);
          hash.add(std::span(values));
        },
        array);
  }
  return hash.hex();
}

Archive::Array read_array(const Hdf5Reader& file, const std::string& name) {
  switch (file.type(name)) {
    case Hdf5Type::float64:
      return file.get<double>(name);
    case Hdf5Type::int64:
      return file.get<std::int64_t>(name);
    case Hdf5Type::int32:
      return file.get<std::int32_t>(name);
    case Hdf5Type::uint64:
      return file.get<std::uint64_t>(name);
    default:
      return file.get<std::uint8_t>(name);
  }
}

}  // namespace

void write_archive(const std::filesystem::path& path, const Archive& archive) {
  Hdf5Writer file(path);
  file.attribute("kind", std::string(kKind));
  file.attribute("arrays", static_cast<std::int64_t>(archive.arrays().size()));
  file.attribute("checksum", checksum(archive));
  for (const auto& [name, array] : archive.arrays()) {
    if (name.find(':') != std::string::npos)
      throw io_error(path.string(), "array name '" + name + "' holds a ':'");
    const std::string stored = std::string(kGroup) + "/" + swapped(name, '/', ':');
    std::visit([&](const auto& values) { file.put(stored, std::span(values), {values.size()}); }, array);
  }
  file.finish();
}

Archive read_archive(const std::filesystem::path& path) {
  const Hdf5Reader file(path);
  if (!file.has_attribute("kind") || file.text("kind") != kKind)
    throw io_error(path.string(), "is not a saved state");
  Archive archive;
  if (file.integer("arrays") > 0)
    for (const std::string& stored : file.list(kGroup))
      archive.put_array(swapped(stored, ':', '/'), read_array(file, std::string(kGroup) + "/" + stored));
  if (checksum(archive) != file.text("checksum"))
    throw io_error(path.string(), "the checksum does not fit the contents: the file is damaged");
  return archive;
}

}  // namespace furrow
