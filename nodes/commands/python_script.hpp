// Scripts of scripts/, run by Debian's own Python, whatever python stands first on PATH, and isolated (-I) from what
// the user's environment and folders have for Python.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace furrow::commands {

struct PythonScript {
  std::string name;                            // in scripts/
  std::vector<std::string> arguments = {};     // options; the folders follow them
  std::vector<std::filesystem::path> folders;  // that it reads; messages name the first
  std::string what;                            // it makes, for errors: "plots"
  /// Bytes that it must have: a plot takes 300 MB, and numpy's BLAS waits for ever for less.
  double address_space = 512e6;
  bool quiet = false;                                                  // nothing on standard error
  std::optional<std::chrono::steady_clock::time_point> deadline = {};  // when it is ended
  /// Given both, the script is asked to say how far it is, and its standard error comes line by line.
  std::function<void(double share)> progress = {};
  std::function<void(const std::string& line)> message = {};
};

struct Finished {
  int status = 0;         // of waitpid
  std::string output;     // standard output, without the lines of progress
  bool too_late = false;  // it was ended at the deadline
};

/// Runs a script to its end; a stop signal or the deadline ends it.
/// @throws Error(io) without Python or script, Error(limit) with too little memory
Finished run_python(const PythonScript& script);

}  // namespace furrow::commands
