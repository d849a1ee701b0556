// CHOLMOD opens a team of four OpenMP threads for the columns of a supernode, for any OMP_NUM_THREADS. A tire's factors
// are so small that waking the threads costs more than their work saves.
#pragma once

#include <omp.h>

namespace furrow::tire {

/// While it lives, parallel regions that this thread opens run on this thread only.
class LoneThread {
 public:
  LoneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~LoneThread() { omp_set_max_active_levels(levels_); }
  LoneThread(const LoneThread&) = delete;
  LoneThread& operator=(const LoneThread&) = delete;

 private:
  int levels_;
};

}  // namespace furrow::tire
