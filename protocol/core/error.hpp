// Errors that reach the user, with the exit code of the program.
#pragma once

#include <stdexcept>
#include <string>
#include <utility>

#include <fmt/format.h>

namespace furrow {

/// Exit codes on which users' scripts rely.
enum class ExitCode : int {
  done = 0,
  bad_input = 2,  // scenario, tire file, command line
  physics = 3,    // no convergence, NaN, a grain lost
  rank_lost = 4,  // a rank died or stopped answering
  io = 5,         // a file could not be read or written
  limit = 6,      // memory or another limit of the system ran out
  fault = 70,     // in the program itself
  stopped = 75,   // stopped by a signal
};

/// May be thrown anywhere; caught only where a program or a rank begins.
class Error : public std::runtime_error {
 public:
  Error(ExitCode code, const std::string& text) : std::runtime_error(text), code_(code) {}
  ExitCode code() const { return code_; }

 private:
  ExitCode code_;
};

/// "FILE: key 'a.b': what is wrong, what is expected", exit code 2. Give an empty key for the file as a whole.
inline Error input_error(const std::string& file, const std::string& key, const std::string& what) {
  return Error(ExitCode::bad_input, key.empty() ? file + ": " + what : file + ": key '" + key + "': " + what);
}
/// In this function and those below, `what` may be a format of {fmt} with its arguments.
template <class First, class... More>
Error input_error(const std::string& file, const std::string& key, fmt::format_string<First, More...> what,
                  First&& first, More&&... more) {
  return input_error(file, key, fmt::format(what, std::forward<First>(first), std::forward<More>(more)...));
}

inline Error physics_error(const std::string& what) { return Error(ExitCode::physics, what); }
template <class First, class... More>
Error physics_error(fmt::format_string<First, More...> what, First&& first, More&&... more) {
  return physics_error(fmt::format(what, std::forward<First>(first), std::forward<More>(more)...));
}
inline Error limit_error(const std::string& what) { return Error(ExitCode::limit, what); }
/// For an exception that no code expects.
inline Error fault_error(const std::string& what) {
  return Error(ExitCode::fault, "fault of the program: " + what +
                                    "; please report it as an issue, with this message and run.log if there is one");
}
inline Error io_error(const std::string& file, const std::string& what) {
  return Error(ExitCode::io, file + ": " + what);
}

}  // namespace furrow
