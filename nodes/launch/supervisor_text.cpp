#include "nodes/launch/supervisor_text.hpp"

#include <algorithm>
#include <regex>

namespace furrow::launch {
namespace {

constexpr std::size_t kMaxLines = 40;
constexpr std::size_t kMaxWords = 600;  // characters
constexpr std::size_t kMaxLine = 2000;  // characters: a search in a longer one would take the stack

bool is_rule(std::string_view line) {
  return line.size() > 10 &&
         std::all_of(line.begin(), line.end(), [](char c) { return c == '-' || c == '='; });
}

std::string trimmed(std::string_view line) {
  const std::size_t from = line.find_first_not_of(" \t\r"), to = line.find_last_not_of(" \t\r");
  return from == std::string_view::npos ? std::string() : std::string(line.substr(from, to - from + 1));
}

}  // namespace

void LauncherText::add(std::string_view line) {
  // "mpirun noticed that process rank 2 with PID 0 on node host exited on signal 9 (Killed)."
  static const std::regex kDead("process rank ([0-9]+) with PID [0-9]+ on node .* exited on signal ([0-9]+)");
  line = line.substr(0, kMaxLine);
  std::match_results<std::string_view::const_iterator> found;
  if (std::regex_search(line.begin(), line.end(), found, kDead)) {
    if (!lost_) lost_ = LostRank{std::stoi(found[1].str()), std::stoi(found[2].str())};
    return;
  }
  const std::string text = trimmed(line);
  if (text.empty() || is_rule(text) || lines_.size() >= kMaxLines) return;
  lines_.push_back(text);
}

std::string LauncherText::words() const {
  std::string text;
  for (const std::string& line : lines_) text += (text.empty() ? "" : " ") + line;
  if (text.size() > kMaxWords) text = text.substr(0, kMaxWords) + " …";
  return text;
}

}  // namespace furrow::launch
