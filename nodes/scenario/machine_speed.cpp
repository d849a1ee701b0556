#include "nodes/scenario/machine_speed.hpp"

#include <nlohmann/json.hpp>

#include "protocol/core/clock.hpp"
#include "protocol/core/hash.hpp"
#include "protocol/files/cache_folder.hpp"
#include "protocol/files/data_files.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/program_id.hpp"
#include "protocol/host.hpp"
#include "rigs/rolling_tire.hpp"
#include "terrain/dem/beds/bed_generators.hpp"
#include "terrain/dem/beds/bed_settling.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tire/tires.hpp"

namespace furrow::scenario {
namespace {

constexpr double kSettle = 0.12;            // of the small bed, s: long enough for its contacts to form
constexpr double kGrainTime = 0.3;          // processor time for the timed steps, s
constexpr double kTireTime = 0.8;           // s
constexpr double kTireWarm = 0.8;           // processor time before the timed steps, s
constexpr int kColumns = 60, kAcross = 12;  // mesh of the reference tire

double own_time() { return processor_time(CLOCK_THREAD_CPUTIME_ID); }

/// Runs `step` for this processor time and returns the time of one step.
template <class Step>
double time_of(double seconds, const Step& step) {
  const double begin = own_time();
  int count = 0;
  do {
    step();
    ++count;
  } while (own_time() - begin < seconds);
  return (own_time() - begin) / count;
}

double measured_grain_step() {
  terrain::dem::DemOptions o;
  o.cohesion = 80e3;
  o.length = o.width = 0.24;
  o.periodic_x = true;
  o.sides = "periodic";
  terrain::dem::GrainSolver solver(terrain::dem::settling_params(o));
  solver.place(terrain::dem::starting_positions(o, {}));
  terrain::dem::settle(solver, o, {}, kSettle);
  const double dt = terrain::dem::settle_step(o);
  return time_of(kGrainTime, [&] { solver.step(dt); }) / solver.grains().count;
}

void measure_tire(MachineSpeed& found) {
  tire::TireOptions options;
  options.file = data_folder() / "tire" / "data" / "hmmwv_layered.json";
  options.elements_circumference = kColumns;
  options.elements_width = kAcross;
  const auto tire = tire::read_tire(options)->make({});
  rigs::RollingTire rolling(*tire, {.step = 6e-5});
  const auto step = [&] {
    rolling.push();
    rolling.roll();
    rolling.follow(0.0);
  };
  time_of(kTireWarm, step);
  found.tire_step = time_of(kTireTime, step);
  found.tire_coordinates = static_cast<int>(tire->coordinates());
}

std::string digest() {
  Hash hash;
  hash.add(build_id());
  hash.add(cpu_model());
  return hash.hex();
}

bool kept(const std::filesystem::path& file, MachineSpeed& found) {
  const nlohmann::ordered_json json = read_json_if_whole(file);
  if (!json.is_object()) return false;
  const auto positive = [&](const char* key) {
    const auto at = json.find(key);
    return at != json.end() && at->is_number() && at->get<double>() > 0.0 ? at->get<double>() : 0.0;
  };
  found.grain_step = positive("grain_step_s");
  found.tire_step = positive("tire_step_s");
  found.tire_coordinates = static_cast<int>(positive("tire_coordinates"));
  return found.grain_step > 0.0 && found.tire_step > 0.0 && found.tire_coordinates > 0;
}

}  // namespace

MachineSpeed machine_speed() {
  MachineSpeed found;
  found.cores = static_cast<int>(allowed_cores().size());
  std::filesystem::path file = cache_folder("speed");
  if (!file.empty()) file /= digest() + ".json";
  if (!file.empty() && kept(file, found)) return found;
  found.grain_step = measured_grain_step();
  measure_tire(found);
  if (!file.empty())
    keep_json(file, {{"grain_step_s", found.grain_step},
                     {"tire_step_s", found.tire_step},
                     {"tire_coordinates", found.tire_coordinates}});
  return found;
}

}  // namespace furrow::scenario
