#include "terrain/plugin_file.hpp"

#include <dlfcn.h>
#include <elf.h>

#include <cstring>
#include <fstream>
#include <system_error>

#include <fmt/format.h>

namespace furrow::terrain {
namespace {

namespace fs = std::filesystem;

constexpr int kFoldersUp = 3;  // from a test program to the build folder

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

}  // namespace

fs::path find_plugin(const std::string& name) {
  std::error_code error;
  const fs::path program = fs::read_symlink("/proc/self/exe", error);
  if (error) return {};
  fs::path folder = program.parent_path();
  for (int up = 0; up <= kFoldersUp; ++up, folder = folder.parent_path())
    if (fs::exists(folder / name, error)) return folder / name;
  return {};
}

std::string plugin_problem(const fs::path& file) {
  if (const std::uintmax_t least = least_size(file), size = size_of(file); size < least)
    return fmt::format("{} has {} bytes, expected {} or more: it is cut short", file.string(), size, least);
  return {};
}

void* open_plugin(const fs::path& file, std::string& why) {
  void* const opened = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (opened) return opened;
  const char* const text = dlerror();
  why = text ? text : file.string();
  return nullptr;
}

void* find_symbol(void* library, const char* name) { return dlsym(library, name); }

}  // namespace furrow::terrain
