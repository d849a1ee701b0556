// Wakes a process that waits for a message. A doorbell is a counter in memory that the processes of one machine share.
// Its owner sleeps on it (futex), and the others raise it after they have sent something.
//
//   const auto heard = bell.count();                 // first
//   if (nothing_arrived()) bell.sleep(heard, 0.05);  // a ring since then ends it at once
//
// A ring costs the sender one atomic addition, and a system call only while the owner sleeps.
#pragma once

#include <atomic>
#include <cstdint>

namespace furrow {

class alignas(64) Doorbell {
 public:
  std::uint32_t count() const noexcept { return rings_.load(); }
  void ring() noexcept;
  /// Sleeps until the count differs from `heard`, a signal comes, or `longest` s have passed. Only the owner may call
  /// it.
  /// @pre longest ≥ 0
  void sleep(std::uint32_t heard, double longest) noexcept;

 private:
  std::atomic<std::uint32_t> rings_{0}, asleep_{0};
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);  // otherwise it would not work between processes
static_assert(sizeof(Doorbell) == 64);                           // one cache line each

}  // namespace furrow
