// Runs modules of scripts/python/furrow with Debian's own Python, whatever python is first on PATH. It is isolated (-I)
// from Python settings in the user's environment and folders.
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace furrow::commands {

struct PythonScript {
  std::string name;                            // of the module: "report"
  std::vector<std::string> arguments = {};     // options; the folders follow them
  std::vector<std::filesystem::path> folders;  // to read; messages name the first
  std::string what;                            // its product, for errors: "plots"
  /// Bytes that it needs: a plot takes 300 MB, and numpy's BLAS waits forever with less.
  double address_space = 512e6;
  bool quiet = false;                                                  // it prints nothing on standard error
  std::optional<std::chrono::steady_clock::time_point> deadline = {};  // when it is ended
  /// If both are given, the script reports its progress, and its standard error is passed on line by line.
  std::function<void(double share)> progress = {};
  std::function<void(const std::string& line)> message = {};
};

struct Finished {
  int status = 0;         // of waitpid
  std::string output;     // standard output, without the lines of progress
  bool too_late = false;  // it exceeded the deadline and was ended
};

/// Runs a script to its end; a stop signal or the deadline ends it.
/// @throws Error(io) without Python or script, Error(limit) with too little memory
Finished run_python(const PythonScript& script);

}  // namespace furrow::commands
