// How long work reports its progress and can be stopped.
#pragma once

#include <functional>
#include <string>

namespace furrow {

/// Called from time to time during long work with (what, share done 0…1); may throw to stop it. A `what` that begins
/// with kWarning is a warning, which stays on the screen.
using ProgressCall = std::function<void(const std::string& what, double share)>;

inline constexpr char kWarning[] = "warning: ";

}  // namespace furrow
