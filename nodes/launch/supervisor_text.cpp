#include "nodes/launch/supervisor_text.hpp"

#include <csignal>
#include <cstring>

#include <algorithm>
#include <regex>
#include <string_view>

#include "protocol/files/text_file.hpp"

namespace furrow::launch {
namespace {

constexpr std::size_t kMaxLines = 40;
constexpr std::size_t kMaxWords = 600;  // characters
// Begins Open MPI's paragraph of all possible reasons why ranks fail to start. Other paragraphs contain the cause.
constexpr std::string_view kUsual = "It looks like MPI_INIT failed for some reason";
constexpr std::string_view kNoticed = "noticed that process rank ";
constexpr std::size_t kLongestLine = 2000;  // characters: a search in a longer line would exhaust the stack

bool is_rule(std::string_view line) {
  return line.size() > 10 && std::all_of(line.begin(), line.end(), [](char c) { return c == '-' || c == '='; });
}

/// Checks for the launcher's own log and the ranks' text as they abort: it hides the cause, but is better than nothing.
bool is_internal(std::string_view line) {
  return line.find("ORTE_ERROR_LOG") != std::string_view::npos || line.find("/opal/mca/") != std::string_view::npos ||
         line.starts_with("*** ") || line.find("] Local abort before MPI_INIT") != std::string_view::npos ||
         (line.starts_with('[') && line.find("] *** ") != std::string_view::npos);
}

/// The signal with this name by strsignal; 0: none.
int signal_called(const std::string& name) {
  for (int signal = 1; signal < NSIG; ++signal)
    if (const char* known = strsignal(signal); known && name == known) return signal;
  return 0;
}

}  // namespace

void LauncherText::add(std::string_view line) {
  // "mpirun noticed that process rank 2 with PID 0 on node host exited on signal 9 (Killed)." Open MPI 5 breaks lines.
  static const std::regex kDead("process rank ([0-9]+) with PID [0-9]+ on node .* exited on signal ([0-9]+)");
  line = line.substr(0, kLongestLine);
  if (fault_.empty() && line.find(": precondition failed: ") != std::string_view::npos) fault_ = trimmed(line);
  const std::string sentence = begun_.empty() ? std::string(line) : begun_ + " " + std::string(trimmed(line));
  begun_.clear();
  if (std::smatch dead; std::regex_search(sentence, dead, kDead)) {
    if (!lost_) lost_ = LostRank{std::stoi(dead[1].str()), std::stoi(dead[2].str())};
    return;
  }
  if (sentence.find(kNoticed) != std::string::npos && sentence.size() < kLongestLine && !is_rule(trimmed(line))) {
    begun_ = sentence;
    return;
  }
  std::match_results<std::string_view::const_iterator> found;
  // "srun: error: node7: task 2: Killed"
  static const std::regex kDeadTask("srun: error: .*: task ([0-9]+): ([A-Za-z ]+)");
  if (std::regex_search(line.begin(), line.end(), found, kDeadTask)) {
    if (const int signal = signal_called(std::string(trimmed(found[2].str()))); signal > 0 && !lost_)
      lost_ = LostRank{std::stoi(found[1].str()), signal};
    return;
  }
  std::string plain(line);
  std::erase(plain, '\0');  // Open MPI 5 writes some
  const std::string text(trimmed(plain));
  if (is_rule(text)) is_usual_ = false;
  if (text.starts_with(kUsual)) is_usual_ = true;
  std::vector<std::string>& sort = is_usual_ ? usual_ : lines_;
  if (text.empty() || is_rule(text) || sort.size() >= kMaxLines) return;
  sort.push_back(text);
}

std::string LauncherText::words() const {
  std::string text, internal;
  const auto add_to = [](std::string& sort, const std::string& line) { sort += (sort.empty() ? "" : " ") + line; };
  for (const std::string& line : lines_) add_to(is_internal(line) ? internal : text, line);
  for (const std::string& line : usual_) add_to(text, line);
  if (text.empty()) text = internal;
  if (text.size() > kMaxWords) text = text.substr(0, kMaxWords) + " …";
  return text;
}

}  // namespace furrow::launch
