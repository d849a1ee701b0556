// Wakes a process that has nothing to do until a message comes: a counter in memory that the processes of one machine
// share, on which the owner sleeps (futex) and which others raise after they have sent something.
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
  /// Sleeps until the count is another than `heard`, a signal comes, or `longest` s have passed. Only the owner does.
  /// @pre longest ≥ 0
  void sleep(std::uint32_t heard, double longest) noexcept;

 private:
  std::atomic<std::uint32_t> rings_{0}, asleep_{0};
};
static_assert(std::atomic<std::uint32_t>::is_always_lock_free);  // or it would not work between processes
static_assert(sizeof(Doorbell) == 64);                           // a cache line each

}  // namespace furrow
