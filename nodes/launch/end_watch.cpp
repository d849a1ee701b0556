#include "nodes/launch/end_watch.hpp"

#include <unistd.h>

#include <algorithm>
#include <limits>
#include <string>

#include "nodes/launch/process_table.hpp"
#include "protocol/core/assert.hpp"

namespace furrow::launch {
namespace {

constexpr double kForEver = std::numeric_limits<double>::infinity();

/// Checks whether the launcher has only processes of this program, and all of them have ended. A working launcher
/// notices such an end within milliseconds.
bool leaves_ended_ranks(int launcher) {
  const std::vector<pid_t> children = children_of(launcher);
  const std::string own = state_of(getpid()).name;
  return !children.empty() && std::ranges::all_of(children, [&](pid_t child) {
    const ProcessState state = state_of(child);
    return state.state == 'Z' && state.name == own;
  });
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
  clock_.expired();  // measures the silence
  if (patience != patience_) {
    patience_ = patience;
    clock_.heard();
  }
  return clock_.silent() > patience_;
}

}  // namespace furrow::launch
