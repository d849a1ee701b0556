#include "nodes/launch/end_watch.hpp"

#include <fstream>
#include <limits>
#include <string>

#include "protocol/core/assert.hpp"

namespace furrow::launch {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

struct ProcessState {
  std::string name;
  char state = '?';  // Z: it has ended, and its parent has not taken notice
};

ProcessState state_of(const std::string& process) {
  std::ifstream file("/proc/" + process + "/stat");
  std::string line;
  std::getline(file, line);
  const std::size_t begin = line.find('('), end = line.rfind(')');
  if (begin == std::string::npos || end == std::string::npos || end + 2 >= line.size()) return {};
  return {line.substr(begin + 1, end - begin - 1), line[end + 2]};
}

/// Whether processes of this program are all that the launcher has, and all of them have ended. A launcher that works
/// takes notice within milliseconds.
bool leaves_ended_ranks(int launcher) {
  const std::string process = std::to_string(launcher), own = state_of("self").name;
  std::ifstream children("/proc/" + process + "/task/" + process + "/children");
  bool any = false;
  for (std::string child; children >> child; any = true) {
    const ProcessState state = state_of(child);
    if (state.state != 'Z' || state.name != own) return false;
  }
  return any;
}

}  // namespace

EndWatch::EndWatch(std::size_t ranks, double end_patience, double failure_patience)
    : ranks_(ranks),
      end_patience_(end_patience),
      failure_patience_(failure_patience),
      patience_(kForEver),
      clock_(kForEver) {
  FURROW_ASSERT(ranks > 0 && end_patience > 0.0, ranks, end_patience);
  FURROW_ASSERT(failure_patience > 0.0, failure_patience);
}

ExitCode EndWatch::code() const {
  for (const auto& [rank, code] : codes_)
    if (code != ExitCode::done) return code;
  return ExitCode::done;
}

bool EndWatch::too_late(int launcher) {
  double patience = failed_ ? failure_patience_ : kForEver;
  if (all_ended() || leaves_ended_ranks(launcher)) patience = end_patience_;
  clock_.expired();  // counts
  if (patience != patience_) {
    patience_ = patience;
    clock_.heard();
  }
  return clock_.silent() > patience_;
}

}  // namespace furrow::launch
