#include "protocol/files/program_id.hpp"

#include <fstream>

#include "protocol/files/text_file.hpp"

namespace furrow {

std::string build_id() {
  static const std::string id = file_hash("/proc/self/exe");
  return id;
}

std::string arithmetic_id() { return FURROW_ARITHMETIC; }

std::string cpu_model() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  return "unknown";
}

}  // namespace furrow
