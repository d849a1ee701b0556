// The library's only symbol: its table of functions. No exception leaves it.
#include <cstdio>
#include <exception>
#include <new>

#include "terrain/gpu/plugin/grain_engine.hpp"

namespace furrow::terrain::gpu {

struct Engine : GrainEngine {
  using GrainEngine::GrainEngine;
};

namespace {

Status say(Why* why, Status status, const char* text) {
  std::snprintf(why->text, sizeof why->text, "%s", text);
  return status;
}

template <class F>
Status guarded(Why* why, const F& f) noexcept {
  try {
    f();
    return Status::done;
  } catch (const DeviceError& error) {
    return say(why, error.status, error.text.c_str());
  } catch (const std::bad_alloc&) {
    return say(why, Status::memory, "memory of this machine");
  } catch (const std::exception& error) {
    return say(why, Status::fault, error.what());
  } catch (...) {
    return say(why, Status::fault, "an exception that nothing expects");
  }
}

constexpr Api kApi{
    .abi = kAbi,
    .device = [](DeviceInfo* info, Why* why) { return guarded(why, [&] { *info = device_info(); }); },
    .make = [](const Setup* setup, Engine** engine,
               Why* why) { return guarded(why, [&] { *engine = new Engine(*setup); }); },
    .destroy = [](Engine* engine) { delete engine; },
    .place = [](Engine* e, std::int32_t count, const double (*position)[3], const double (*velocity)[3],
                const double (*spin)[3],
                Why* why) { return guarded(why, [&] { e->place(count, position, velocity, spin); }); },
    .remember = [](Engine* e, std::int64_t pairs, const Pair* pair, std::int64_t walls, const WallTouch* wall,
                   std::int64_t facets, const FacetTouch* facet,
                   Why* why) { return guarded(why, [&] { e->remember(pairs, pair, walls, wall, facets, facet); }); },
    .coefficients = [](Engine* e, const dem::ContactCoefficients* pair, const dem::ContactCoefficients* floor,
                       const dem::ContactCoefficients* side,
                       Why* why) { return guarded(why, [&] { e->set_coefficients(*pair, *floor, *side); }); },
    .attach = [](Engine* e, const Surface* surface, Why* why) { return guarded(why, [&] { e->attach(*surface); }); },
    .surface_coefficients =
        [](Engine* e, std::int32_t surface, const dem::ContactCoefficients* c, std::int32_t rolls, Why* why) {
          return guarded(why, [&] { e->set_surface_coefficients(surface, *c, rolls != 0); });
        },
    .surface_motion =
        [](Engine* e, std::int32_t surface, const double (*end)[3], double duration, const FacetGrid* grid,
           std::int32_t same,
           Why* why) { return guarded(why, [&] { e->set_surface_motion(surface, end, duration, *grid, same != 0); }); },
    .move_surfaces = [](Engine* e, double share, Why* why) { return guarded(why, [&] { e->move_surfaces(share); }); },
    .surface_result = [](Engine* e, std::int32_t surface, double (*impulse)[3], SurfaceSums* sums,
                         Why* why) { return guarded(why, [&] { e->surface_result(surface, impulse, *sums); }); },
    .run = [](Engine* e, const Run* run, RunResult* result,
              Why* why) { return guarded(why, [&] { *result = e->run(*run); }); },
    .hardest = [](Engine* e, double above, double ahead, double deepest, Hardest* hardest,
                  Why* why) { return guarded(why, [&] { *hardest = e->hardest(above, ahead, deepest); }); },
    .sums = [](Engine* e, std::int32_t losses, double dt, Sums* sums,
               Why* why) { return guarded(why, [&] { *sums = e->sums(losses != 0, dt); }); },
    .wall_impulse =
        [](Engine* e, double impulse[3], Why* why) {
          return guarded(why, [&] {
            double taken[3];
            e->take_wall_impulse(taken);
            for (int k = 0; k < 3; ++k) impulse[k] = taken[k];
          });
        },
    .motion = [](Engine* e, double (*position)[3], double (*velocity)[3], double (*spin)[3],
                 Why* why) { return guarded(why, [&] { e->motion(position, velocity, spin); }); },
    .histories =
        [](Engine* e, std::int64_t* pairs, const Pair** pair, std::int64_t* walls, const WallTouch** wall,
           std::int64_t* facets, const FacetTouch** facet, Why* why) {
          return guarded(why, [&] {
            e->read_histories();
            *pairs = static_cast<std::int64_t>(e->pairs.size()), *pair = e->pairs.data();
            *walls = static_cast<std::int64_t>(e->walls.size()), *wall = e->walls.data();
            *facets = static_cast<std::int64_t>(e->facets.size()), *facet = e->facets.data();
          });
        },
};

}  // namespace
}  // namespace furrow::terrain::gpu

extern "C" const furrow::terrain::gpu::Api* furrow_gpu_api() { return &furrow::terrain::gpu::kApi; }
