#include "terrain/liggghts/engine_library.hpp"

#include <string>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "terrain/plugin_file.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr char kFile[] = "libfurrow_liggghts.so";

[[noreturn]] void refuse(const std::string& why) {
  throw input_error("scenario", "terrain.engine", "'liggghts' " + why);
}

/// The library, kept until the program ends, because LIGGGHTS' code must outlive its objects.
void* library() {
  static void* const handle = [] {
    require_engine_library();
    std::string why;
    void* const opened = open_plugin(find_engine_library(), why);
    if (!opened) refuse(fmt::format("cannot be loaded: {}; expected LIGGGHTS 3.8: install libliggghts3 (Debian)", why));
    return opened;
  }();
  return handle;
}

template <class Function>
Function symbol(const char* name) {
  void* const found = find_symbol(library(), name);
  if (!found) refuse(fmt::format("cannot be used: {} lacks {}; expected that of this program", kFile, name));
  return reinterpret_cast<Function>(found);
}

}  // namespace

std::filesystem::path find_engine_library() { return find_plugin(kFile); }

std::string engine_library_problem() {
  const std::filesystem::path file = find_engine_library();
  if (file.empty())
    return fmt::format(
        "'liggghts' is not part of this program: {} is not beside it; expected that file, which is made "
        "where "
        "LIGGGHTS 3.8 is installed (libliggghts-dev of Debian) when Furrow is built or installed",
        kFile);
  if (const std::string problem = plugin_problem(file); !problem.empty())
    return "'liggghts' cannot be used: " + problem;
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
