// Writes a file that appears whole or not at all. It is first written under a name that nobody can guess, in a newly
// created file that is never a link. It is then flushed to the disk and renamed.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace furrow {

class NewFile {
 public:
  /// Creates ".<name>.<16 hexadecimal digits>.part" next to `file`. @throws Error(io)
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();  // without publish(): removes the unfinished file
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// @throws Error(io)
  void write(std::string_view bytes);

  /// A path to this very file, even if its name has since been given to another: for libraries that open files by path.
  std::filesystem::path way() const;

  /// Flushes to the disk and gives the file its name. @throws Error(io)
  void publish();

 private:
  std::filesystem::path file_, part_;
  int handle_ = -1;
};

/// "a.h5" for ".a.h5.0123456789abcdef.part", the name of an unfinished file; empty for any other name.
std::string name_in_the_making(std::string_view name);

}  // namespace furrow
