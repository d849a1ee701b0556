#include "nodes/launch/run_log.hpp"

#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>

#include <fmt/format.h>

#include "nodes/launch/progress.hpp"

namespace furrow::launch {
namespace {

constexpr std::streamoff kTail = 4096;  // bytes that hold a line of progress

}  // namespace

std::string last_error(const std::filesystem::path& log, int status) {
  if (WIFSIGNALED(status))
    return fmt::format("killed by signal {} ({})", WTERMSIG(status), strsignal(WTERMSIG(status)));
  std::ifstream in(log);
  std::string found;
  const std::string mark = "furrow: error: ";
  for (std::string line; std::getline(in, line);)
    if (line.starts_with(mark)) found = line.substr(mark.size());
  return found.empty() ? "it left no message in " + log.string() : found;
}

double share_in_log(const std::filesystem::path& log) {
  std::ifstream in(log, std::ios::binary | std::ios::ate);
  const std::streamoff size = in ? static_cast<std::streamoff>(in.tellg()) : 0;
  in.seekg(std::max(std::streamoff{0}, size - kTail));
  double share = 0.0;
  for (std::string line; std::getline(in, line);)
    if (const double told = share_in(line); std::isfinite(told)) share = told;
  return share;
}

}  // namespace furrow::launch
