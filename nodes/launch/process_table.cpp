#include "nodes/launch/process_table.hpp"

#include <cstdlib>
#include <fstream>

namespace furrow::launch {

std::vector<pid_t> children_of(pid_t process) {
  const std::string name = std::to_string(process);
  std::ifstream file("/proc/" + name + "/task/" + name + "/children");
  std::vector<pid_t> children;
  for (pid_t child = 0; file >> child;) children.push_back(child);
  return children;
}

ProcessState state_of(pid_t process) {
  std::ifstream file("/proc/" + std::to_string(process) + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t begin = line.find('('), end = line.rfind(')');
  if (begin == std::string::npos || end == std::string::npos || end + 2 >= line.size()) return {};
  return {line.substr(begin + 1, end - begin - 1), line[end + 2],
          static_cast<pid_t>(std::atoi(line.c_str() + end + 3))};
}

}  // namespace furrow::launch
