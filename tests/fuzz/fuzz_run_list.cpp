// A folder's list of what furrow wrote there, which says what --overwrite may remove: whatever it holds, nothing
// outside the folder is found by it, and nothing behind a link.
#include "nodes/launch/run_list.hpp"
#include "protocol/core/error.hpp"
#include "tests/fuzz/input_file.hpp"

namespace {

using namespace furrow;
namespace fs = std::filesystem;

/// A few files, two folders, and a link to a folder outside.
const fs::path& run() {
  static const fs::path made = [] {
    const fs::path run = fuzz::folder() / "run";
    fs::create_directories(run / "frames");
    fs::create_directories(run / "checkpoints/000000000010");
    fs::create_directories(fuzz::folder() / "outside");
    for (const char* name : {"run/summary.json", "run/frames/tire0_000001.h5", "run/a b", "outside/frames.h5",
                             "run/checkpoints/000000000010/rig.h5", "run/.summary.json.part"})
      fuzz::input_file(name, nullptr, 0);
    std::error_code ignored;
    fs::create_directory_symlink(fuzz::folder() / "outside", run / "link", ignored);
    return run;
  }();
  return made;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  run();
  fuzz::input_file("run/.furrow-run", data, size);
  try {
    const launch::RunList list = launch::RunList::read(run());
    for (const char* inside : {"", "checkpoints/", "link/"}) {
      const launch::RunList::Found found = list.find(run(), inside);
      for (const auto& names : {found.files, found.folders})
        for (const std::string& name : names)
          if (name.starts_with("link/") || fs::path(name).is_absolute() || name.find("..") != std::string::npos)
            __builtin_trap();
    }
    for (const std::string& form : list.forms()) {
      std::int64_t number = 0;
      if (launch::is_of_form("frames/tire0_000001.h5", form, &number) && number < 0) __builtin_trap();
      list.holds(form);
    }
  } catch (const Error& error) {
    if (std::string(error.what()).empty()) __builtin_trap();
  }
  return 0;
}
