// A library of the GPU that passes all calls on to another one, and fails when a test wants it to:
//   FURROW_GPU_LIBRARY=file            the other one
//   FURROW_GPU_FAULT=interval:status   the call that begins this interval of the tires returns this status;
//                                      interval 0: the call that asks for the device
#include <dlfcn.h>

#include <cstdio>
#include <cstdlib>

#include "terrain/gpu/gpu_interface.hpp"

namespace furrow::terrain::gpu {
namespace {

Api passed_on;  // of the other library
int fault_interval = -1, fault_status = 0, interval = 0;

Status fail(Why* why) {
  std::snprintf(why->text, sizeof why->text, "as a test wants it");
  return static_cast<Status>(fault_status);
}

Status device(DeviceInfo* info, Why* why) { return fault_interval == 0 ? fail(why) : passed_on.device(info, why); }

Status surface_motion(Engine* engine, std::int32_t surface, const double (*end)[3], double duration,
                      const FacetGrid* grid, std::int32_t same_grid, Why* why) {
  if (surface == 0 && ++interval == fault_interval) return fail(why);
  return passed_on.surface_motion(engine, surface, end, duration, grid, same_grid, why);
}

const Api* made() {
  const char *const file = std::getenv("FURROW_GPU_LIBRARY"), *const fault = std::getenv("FURROW_GPU_FAULT");
  if (!file || !fault || std::sscanf(fault, "%d:%d", &fault_interval, &fault_status) != 2) std::abort();
  void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
  if (!library) std::abort();
  static Api api = passed_on = *reinterpret_cast<GetApi>(dlsym(library, kApiSymbol))();
  api.device = device, api.surface_motion = surface_motion;
  return &api;
}

}  // namespace
}  // namespace furrow::terrain::gpu

extern "C" const furrow::terrain::gpu::Api* furrow_gpu_api() {
  static const furrow::terrain::gpu::Api* const api = furrow::terrain::gpu::made();
  return api;
}
