// Reports of ranks to their supervisor: one line of JSON each on standard output, which mpirun passes on, after a mark
// that nothing else prints.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "nodes/launch/progress.hpp"
#include "protocol/core/error.hpp"

namespace furrow::launch {

struct RankLine {
  enum class Kind { started, progress, note, error, begun, read, ended };
  Kind kind = Kind::started;
  int rank = 0;
  std::string text;                // note, error
  ExitCode code = ExitCode::done;  // error, ended
  Progress progress;
};

/// With the line's end; at most 4 kB, which pipes take in one piece.
std::string encode(const RankLine& line);
/// None for a line of another kind.
std::optional<RankLine> decode(std::string_view line);

/// The environment variable that names a rank's supervisor; without it there is none.
inline constexpr const char* kSupervisedVariable = "FURROW_SUPERVISED";

/// The name of this process as supervisor: "host:4711".
std::string supervisor_name();
/// False if the variable names a process of this machine that is gone: it was killed before it could report.
bool supervisor_lives();

}  // namespace furrow::launch
