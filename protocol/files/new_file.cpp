#include "protocol/files/new_file.hpp"

#include <fcntl.h>
#include <sys/random.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow {
namespace {

constexpr std::string_view kEnding = ".part";
constexpr std::size_t kDigits = 16;

Error failed(const std::filesystem::path& file, const std::string& what) {
  return io_error(file.string(), what + ": " + std::strerror(errno));
}

std::filesystem::path unknown_name(const std::filesystem::path& file) {
  std::uint64_t number = 0;
  if (getrandom(&number, sizeof number, 0) != sizeof number) throw failed(file, "cannot be given a temporary name");
  return file.parent_path() / fmt::format(".{}.{:016x}{}", file.filename().string(), number, kEnding);
}

}  // namespace

NewFile::NewFile(const std::filesystem::path& file) : file_(file), part_(unknown_name(file)) {
  handle_ = open(part_.c_str(), O_RDWR | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0666);
  if (handle_ < 0) throw failed(file_, "cannot create");
}

NewFile::~NewFile() {
  if (handle_ < 0) return;  // published
  close(handle_);
  unlink(part_.c_str());
}

void NewFile::write(std::string_view bytes) {
  FURROW_ASSERT(handle_ >= 0, file_.string());
  while (!bytes.empty()) {
    const ssize_t count = ::write(handle_, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) throw failed(file_, "cannot write");
    bytes.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::filesystem::path NewFile::way() const {
  FURROW_ASSERT(handle_ >= 0, file_.string());
  return fmt::format("/proc/self/fd/{}", handle_);
}

void NewFile::publish() {
  FURROW_ASSERT(handle_ >= 0, file_.string());
  if (fsync(handle_) != 0) throw failed(file_, "cannot flush to the disk");
  if (std::rename(part_.c_str(), file_.c_str()) != 0) throw failed(file_, "cannot rename the finished file");
  close(handle_);
  handle_ = -1;
}

std::string name_in_the_making(std::string_view name) {
  if (name.size() <= kEnding.size() || !name.starts_with('.') || !name.ends_with(kEnding)) return {};
  name.remove_prefix(1);
  name.remove_suffix(kEnding.size());
  if (name.size() < kDigits + 2 || name[name.size() - kDigits - 1] != '.') return {};
  const std::string_view digits = name.substr(name.size() - kDigits);
  if (digits.find_first_not_of("0123456789abcdef") != std::string_view::npos) return {};
  return std::string(name.substr(0, name.size() - kDigits - 1));
}

}  // namespace furrow
