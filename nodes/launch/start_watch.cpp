#include "nodes/launch/start_watch.hpp"

#include <cmath>
#include <cstdlib>

#include <fmt/format.h>

#include "protocol/core/error.hpp"

namespace furrow::launch {
namespace {

constexpr double kPatience = 120.0;  // s: large clusters take tens of seconds
constexpr const char* kVariable = "FURROW_START_TIMEOUT";

}  // namespace

bool StartWatch::too_late() {
  const bool reading = begun_.size() == ranks_ && read_.size() < ranks_;
  const bool expired = clock_.expired();
  if (!all_started() && !reading) return expired;
  clock_.heard();
  return false;
}

std::string StartWatch::standing() const {
  const auto of_all = [&](std::size_t count) {
    return count == ranks_ ? fmt::format("all {} ranks", ranks_)
                           : fmt::format("{} of {} ranks", count == 0 ? "none" : std::to_string(count), ranks_);
  };
  if (begun_.size() < ranks_) return of_all(begun_.size()) + " began";
  if (started_.size() == ranks_)
    return fmt::format("all {} ranks began and MPI connected them, but not all of it", ranks_);
  return fmt::format("all {} ranks began, but MPI connected {}", ranks_, of_all(started_.size()));
}

double start_patience() {
  const char* text = std::getenv(kVariable);
  if (!text || !*text) return kPatience;
  char* end = nullptr;
  const double seconds = std::strtod(text, &end);
  if (*end != '\0' || !(seconds > 0.0) || !std::isfinite(seconds))
    throw input_error("environment", kVariable, "is '{}', expected a number of seconds above 0", text);
  return seconds;
}

}  // namespace furrow::launch
