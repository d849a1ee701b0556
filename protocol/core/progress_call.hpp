// How long work reports its progress and may be stopped.
#pragma once

#include <functional>
#include <string>

namespace furrow {

/// Called now and then during long work with (what, share done 0…1); may throw to stop it.
/// A `what` that begins with kWarning is no part of the work but a warning, which stays on the screen.
using ProgressCall = std::function<void(const std::string& what, double share)>;

inline constexpr char kWarning[] = "warning: ";

}  // namespace furrow
