#include "protocol/doorbell.hpp"

#include <linux/futex.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <cerrno>
#include <climits>
#include <ctime>

#include "protocol/core/assert.hpp"

namespace furrow {
namespace {

constexpr double kUnrung = 200e-6;  // s, length of a sleep where the system has no such call
constexpr timespec kShort{0, 200000};

/// The word in memory that the kernel compares.
std::uint32_t* word_of(std::atomic<std::uint32_t>& value) { return reinterpret_cast<std::uint32_t*>(&value); }

}  // namespace

// Both sides write one word and then read the other's word, in one order for all. So either the sender sees that the
// owner sleeps, or the kernel sees that the count has changed and lets the owner continue.
void Doorbell::ring() noexcept {
  rings_.fetch_add(1);
  if (asleep_.load() != 0) syscall(SYS_futex, word_of(rings_), FUTEX_WAKE, INT_MAX, nullptr, nullptr, 0);
}

void Doorbell::sleep(std::uint32_t heard, double longest) noexcept {
  FURROW_ASSERT(longest >= 0.0, longest);
  const auto whole = static_cast<std::time_t>(longest);
  const timespec length{whole, static_cast<long>((longest - static_cast<double>(whole)) * 1e9)};
  asleep_.store(1);
  const long woken = syscall(SYS_futex, word_of(rings_), FUTEX_WAIT, heard, &length, nullptr, 0);
  const bool refused = woken != 0 && errno != EAGAIN && errno != ETIMEDOUT && errno != EINTR;
  asleep_.store(0);
  if (refused) nanosleep(longest < kUnrung ? &length : &kShort, nullptr);  // otherwise the owner would spin
}

}  // namespace furrow
