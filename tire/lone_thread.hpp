// CHOLMOD opens a team of four OpenMP threads for the columns of a supernode, whatever OMP_NUM_THREADS says. In factors
// of the size of a tire's there is less work in each than it costs to wake them.
#pragma once

#include <omp.h>

namespace furrow::tire {

/// While it lives, parallel regions that this thread opens are its own alone.
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
