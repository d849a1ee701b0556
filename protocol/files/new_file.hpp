// A file in the making. It is written under a name that nobody can guess, which is created again and never followed
// when it is a link, then flushed to the disk and renamed: it appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace furrow {

class NewFile {
 public:
  /// Creates ".<name>.<16 hexadecimal digits>.part" beside `file`. @throws Error(io)
  explicit NewFile(const std::filesystem::path& file);
  ~NewFile();  // without publish(): removes what was written
  NewFile(const NewFile&) = delete;
  NewFile& operator=(const NewFile&) = delete;

  /// @throws Error(io)
  void write(std::string_view bytes);

  /// Leads to this very file, whatever its name leads to by now: for libraries that open files by name.
  std::filesystem::path way() const;

  /// Flushes to the disk and gives the file its name. @throws Error(io)
  void publish();

 private:
  std::filesystem::path file_, part_;
  int handle_ = -1;
};

/// "a.h5" for ".a.h5.0123456789abcdef.part", the name of a file in the making; empty for any other name.
std::string name_in_the_making(std::string_view name);

}  // namespace furrow
