#include "terrain/liggghts/engine_library.hpp"

#include <dlfcn.h>

#include <string>
#include <system_error>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::terrain::liggghts {
namespace {

namespace fs = std::filesystem;

constexpr char kFile[] = "libfurrow_liggghts.so";
constexpr int kFoldersUp = 3;  // from a program of the tests to the build folder

[[noreturn]] void refuse(const std::string& why) {
  throw input_error("scenario", "terrain.engine", "'liggghts' " + why);
}

/// The library, kept until the program ends: LIGGGHTS' code must outlive its objects.
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

void require_engine_library() {
  if (find_engine_library().empty())
    refuse(fmt::format(
        "is not part of this program ({} is missing); expected LIGGGHTS 3.8 while Furrow is built: "
        "install libliggghts-dev (Debian), then configure and build again",
        kFile));
}

std::unique_ptr<Engine> make_engine(const EngineSetup& setup) {
  const int version = symbol<int (*)()>(kEngineVersionOf)();
  if (version != kEngineVersion)
    refuse(fmt::format("cannot be used: {} is of version {}, expected {}", kFile, version, kEngineVersion));
  return std::unique_ptr<Engine>(symbol<MakeEngine>(kMakeEngine)(setup));
}

}  // namespace furrow::terrain::liggghts
