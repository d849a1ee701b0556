// A fuzzer's input as a file in memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <string>

#include <unistd.h>

namespace furrow::fuzz {

inline std::filesystem::path folder() {
  static const std::filesystem::path made = [] {
    const std::filesystem::path f = "/dev/shm/furrow_fuzz_" + std::to_string(getpid());
    std::filesystem::create_directories(f);
    return f;
  }();
  return made;
}

inline std::filesystem::path input_file(const std::string& name, const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = folder() / name;
  std::filesystem::create_directories(file.parent_path());
  std::ofstream(file, std::ios::binary).write(reinterpret_cast<const char*>(data), static_cast<std::streamsize>(size));
  return file;
}

}  // namespace furrow::fuzz
