#include "nodes/launch/held_folder.hpp"

#include <sys/stat.h>

#include "protocol/core/error.hpp"

namespace furrow::launch {

HeldFolder::HeldFolder(const std::filesystem::path& folder)
    : folder_(folder),
      lock_(folder, "", FolderLock::Mode::together),
      parts_{{folder / "frames"}, {folder / "checkpoints"}} {
  check();
}

void HeldFolder::check() {
  if (!lock_.stands())
    throw io_error(
        folder_.string(),
        "was moved, removed or emptied while the run was under way; the run ends here and writes nothing elsewhere");
  for (Part& part : parts_) {
    struct stat now {};
    const bool there = stat(part.folder.c_str(), &now) == 0 && S_ISDIR(now.st_mode);
    if (part.number != 0 && (!there || now.st_dev != part.device || now.st_ino != part.number))
      throw io_error(part.folder.string(), "was moved or removed while the run was under way; the run ends here");
    if (there) part.device = now.st_dev, part.number = now.st_ino;
  }
}

}  // namespace furrow::launch
