// What a step of the engine liggghts costs, part by part, on the bed of a scenario: the pair style, motion and lists alone
// (one `run N`); with walls and accounts; and with one `run 1` and the terrain's sums for each step, as a run of Furrow
// does it, but without tires and messages. Under mpirun for several ranks.
//
// Wall time, and the processor time of the rank that took most of it: waiting for other ranks is part of both.
//
// usage: bench_liggghts SCENARIO STEPS ROUNDS [KEY=VALUE …]     prints a line of CSV for each part and round
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "nodes/scenario/load_scenario.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/liggghts/borders.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain::liggghts {
namespace {

class NoWork final : public StepWork {
 public:
  void lists_made(const OwnGrains&) override {}
  StepWish begin_step() override { return {}; }
  void add_forces(const OwnGrains&, bool) override {}
  void end_step(const PairSums&, const MotionSums&, bool) override {}
};

/// Of this process, s.
double processor_time() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class T>
void broadcast(std::vector<T>& values) {
  std::uint64_t count = values.size();
  MPI_Bcast(&count, 1, MPI_UINT64_T, 0, MPI_COMM_WORLD);
  values.resize(count);
  MPI_Bcast(values.data(), static_cast<int>(count * sizeof(T)), MPI_BYTE, 0, MPI_COMM_WORLD);
}

struct Bench {
  dem::DemOptions options;
  StartingBed bed;
  int rank = 0, ranks = 1;

  std::unique_ptr<Engine> engine(RankContacts& contacts, StepWork& work) const {
    EngineSetup s = contacts.setup();
    s.communicator = MPI_Comm_c2f(MPI_COMM_WORLD);
    s.top = bed.top;
    if (&work != &contacts) s.gravity = {};  // there is no floor
    Crowd crowd(options.length);
    for (const NewGrain& grain : bed.grains) crowd.add(grain.position[0]);
    if (ranks > 1) s.borders = crowd.borders(ranks);
    std::unique_ptr<Engine> engine = make_engine(s);
    engine->set_coefficients(contacts.coefficients().pair);
    engine->place(bed.grains, false);
    engine->remember(bed.pairs);
    engine->begin(work, false);
    return engine;
  }

  void time(const char* part, int round, int steps, bool contacts_too, bool each_step) const {
    RankContacts contacts(options);
    NoWork nothing;
    StepWork& work = contacts_too ? static_cast<StepWork&>(contacts) : nothing;
    const std::unique_ptr<Engine> made = engine(contacts, work);
    const StepTimes times{options.step, options.step, options.step};
    contacts.set_times(times);
    contacts.begin_interval({}, (20 + steps) * options.step, 20 + steps);
    made->run(20, times);
    const auto builds = made->list_builds();
    MPI_Barrier(MPI_COMM_WORLD);
    const auto begin = std::chrono::steady_clock::now();
    const double busy_before = processor_time();
    if (each_step) {
      for (int s = 0; s < steps; ++s) {
        contacts.begin_interval({}, options.step, 1);
        made->run(1, times);
      }
    } else {
      made->run(steps, times);
    }
    double busy = processor_time() - busy_before;
    MPI_Allreduce(MPI_IN_PLACE, &busy, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
    int counts[2] = {made->own().count, made->own_ghosts()}, least = 0, most[2];
    MPI_Allreduce(&counts[0], &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    MPI_Allreduce(counts, most, 2, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (rank == 0)
      std::printf("%s,%d,%d,%zu,%d,%.2f,%.2f,%.2f,%d,%d,%d,%lld\n", part, ranks, round, bed.grains.size(),
                  steps, 1e6 * wall.count() / steps, 1e6 * busy / steps,
                  1e9 * wall.count() / steps / static_cast<double>(bed.grains.size()), least, most[0],
                  most[1], static_cast<long long>(made->list_builds() - builds));
    std::fflush(stdout);
  }
};

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: bench_liggghts SCENARIO STEPS ROUNDS [KEY=VALUE …]\n");
    return 2;
  }
  Bench bench;
  MPI_Comm_rank(MPI_COMM_WORLD, &bench.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &bench.ranks);
  std::vector<std::pair<std::string, std::string>> settings{{"terrain.engine", "liggghts"}};
  for (int k = 4; k < argc; ++k) {
    const std::string word = argv[k];
    settings.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
  }
  const scenario::Scenario s = scenario::load_scenario(argv[1], settings);
  bench.options = dem::with_context(*s.terrain->grains(), s.terrain_context());
  if (bench.rank == 0) {
    dem::GrainSolver solver(dem::solver_params(bench.options));
    dem::restore_bed(solver, dem::prepare_bed(bench.options, {}));
    bench.bed = starting_bed(solver);
    std::printf(
        "part,ranks,round,grains,steps,us_per_step,cpu_us_per_step,ns_per_grain_step,grains_least,grains_"
        "most,ghosts_most,"
        "list_builds\n");
  }
  broadcast(bench.bed.grains);
  broadcast(bench.bed.pairs);
  MPI_Bcast(&bench.bed.top, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  const int steps = std::atoi(argv[2]), rounds = std::atoi(argv[3]);
  for (int round = 0; round < rounds; ++round) {
    bench.time("pairs", round, steps, false, false);
    bench.time("walls_accounts", round, steps, true, false);
    bench.time("each_step", round, steps, true, true);
  }
  return 0;
}

}  // namespace
}  // namespace furrow::terrain::liggghts

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  int code = 1;
  try {
    code = furrow::terrain::liggghts::run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return code;
}
