#include "terrain/liggghts/engine_library.hpp"

#include <dlfcn.h>
#include <elf.h>

#include <cstring>
#include <fstream>
#include <string>
#include <system_error>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::terrain::liggghts {
namespace {

namespace fs = std::filesystem;

constexpr char kFile[] = "libfurrow_liggghts.so";
constexpr int kFoldersUp = 3;  // from a test program to the build folder

[[noreturn]] void refuse(const std::string& why) {
  throw input_error("scenario", "terrain.engine", "'liggghts' " + why);
}

std::uintmax_t size_of(const fs::path& file) {
  std::error_code error;
  const std::uintmax_t size = fs::file_size(file, error);
  return error ? 0 : size;
}

/// End of the table of sections, which is the last part of an ELF file. Loading a shorter file would end the process.
std::uintmax_t least_size(const fs::path& file) {
  Elf64_Ehdr head{};
  std::ifstream in(file, std::ios::binary);
  if (!in.read(reinterpret_cast<char*>(&head), sizeof head) || std::memcmp(head.e_ident, ELFMAG, SELFMAG) != 0)
    return sizeof head;  // dlopen reports other mistakes
  return head.e_shoff + std::uintmax_t{head.e_shnum} * head.e_shentsize;
}

/// The library, kept until the program ends, because LIGGGHTS' code must outlive its objects.
void* library() {
  static void* const handle = [] {
    require_engine_library();
    const fs::path file = find_engine_library();
    void* const opened = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!opened) {
      const char* const why = dlerror();
      refuse(fmt::format("cannot be loaded: {}; expected LIGGGHTS 3.8: install libliggghts3 (Debian)",
                         why ? why : file.string()));
    }
    return opened;
  }();
  return handle;
}

template <class Function>
Function symbol(const char* name) {
  void* const found = dlsym(library(), name);
  if (!found) refuse(fmt::format("cannot be used: {} lacks {}; expected that of this program", kFile, name));
  return reinterpret_cast<Function>(found);
}

}  // namespace

fs::path find_engine_library() {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  fs::path folder = program.parent_path();
  for (int up = 0; up <= kFoldersUp; ++up, folder = folder.parent_path())
    if (fs::exists(folder / kFile, error)) return folder / kFile;
  return {};
}

std::string engine_library_problem() {
  const fs::path file = find_engine_library();
  if (file.empty())
    return fmt::format(
        "'liggghts' is not part of this program: {} is not beside it; expected that file, which is made "
        "where "
        "LIGGGHTS 3.8 is installed (libliggghts-dev of Debian) when Furrow is built or installed",
        kFile);
  if (const std::uintmax_t least = least_size(file), size = size_of(file); size < least)
    return fmt::format("'liggghts' cannot be used: {} has {} bytes, expected {} or more: it is cut short",
                       file.string(), size, least);
  return {};
}

void require_engine_library() {
  if (const std::string problem = engine_library_problem(); !problem.empty())
    throw input_error("scenario", "terrain.engine", problem);
}

std::unique_ptr<Engine> make_engine(const EngineSetup& setup) {
  const int version = symbol<int (*)()>(kEngineVersionOf)();
  if (version != kEngineVersion)
    refuse(fmt::format("cannot be used: {} is of version {}, expected {}", kFile, version, kEngineVersion));
  return std::unique_ptr<Engine>(symbol<MakeEngine>(kMakeEngine)(setup));
}

}  // namespace furrow::terrain::liggghts
