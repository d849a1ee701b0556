#include "protocol/mpi_yield.hpp"

#include <dlfcn.h>

#include <cstdlib>
#include <string_view>

namespace furrow {
namespace {

constexpr char kVariable[] = "OMPI_MCA_mpi_yield_when_idle";

}  // namespace

MpiYield::MpiYield() {
  const char* const chosen = std::getenv(kVariable);
  never_ = chosen && std::string_view(chosen) == "0";  // which Open MPI 5 passes over where ranks share cores
  if (chosen && !never_) return;
  switch_ = reinterpret_cast<Switch>(dlsym(RTLD_DEFAULT, "opal_progress_set_yield_when_idle"));
  setenv(kVariable, switch_ ? "1" : "0", 0);
}

void MpiYield::set(bool yields) noexcept {
  if (switch_) switch_(yields && !never_);
}

}  // namespace furrow
