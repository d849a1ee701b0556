#include "protocol/mpi_yield.hpp"

#include <dlfcn.h>

#include <cstdlib>

namespace furrow {
namespace {

constexpr char kVariable[] = "OMPI_MCA_mpi_yield_when_idle";

}  // namespace

MpiYield::MpiYield() {
  if (std::getenv(kVariable)) return;
  switch_ = reinterpret_cast<Switch>(dlsym(RTLD_DEFAULT, "opal_progress_set_yield_when_idle"));
  setenv(kVariable, switch_ ? "1" : "0", 0);
}

void MpiYield::set(bool yields) noexcept {
  if (switch_) switch_(yields);
}

}  // namespace furrow
