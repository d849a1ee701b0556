#include "protocol/files/text_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

#include "protocol/core/error.hpp"

namespace furrow {
namespace {

Error failed(const std::filesystem::path& file, const std::string& what) {
  return io_error(file.string(), what + ": " + std::strerror(errno));
}

void flush_to_disk(const std::filesystem::path& path) {
  const int handle = open(path.c_str(), O_RDONLY);
  if (handle < 0) throw failed(path, "cannot open to flush");
  const int result = fsync(handle);
  close(handle);
  if (result != 0) throw failed(path, "cannot flush to the disk");
}

}  // namespace

std::filesystem::path temporary_name(const std::filesystem::path& file) {
  return file.parent_path() / ("." + file.filename().string() + ".part");
}

void publish_file(const std::filesystem::path& written, const std::filesystem::path& file) {
  flush_to_disk(written);
  if (rename(written.c_str(), file.c_str()) != 0) throw failed(file, "cannot rename the finished file");
}

void sync_folder(const std::filesystem::path& folder) { flush_to_disk(folder); }

void write_whole_file(const std::filesystem::path& file, const std::string& text) {
  const auto part = temporary_name(file);
  std::ofstream stream(part, std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) throw failed(file, "cannot write");
  publish_file(part, file);
}

}  // namespace furrow
