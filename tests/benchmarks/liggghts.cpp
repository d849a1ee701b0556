// Cost of a step of the engine liggghts, part by part, on the bed of a scenario: the pair style, motion and lists alone
// (one `run N`); with walls and accounts; and with one `run 1` and the terrain's sums for each step, as in a run of
// Furrow, but without tires and messages. Runs under mpirun for several ranks.
//
// The parts take turns, kBlock steps each. Prints wall time, and the largest processor time of a rank; both include
// waiting for other ranks.
//
// usage: bench_liggghts SCENARIO STEPS ROUNDS [KEY=VALUE …]     prints a line of CSV for each part and round
//        bench_liggghts RUN STEPS ROUNDS         the same from the last checkpoint of a run, without its tires, on as
//        many ranks
#include <mpi.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "nodes/checkpoint/checkpoint.hpp"
#include "nodes/checkpoint/resume.hpp"
#include "nodes/scenario/load_scenario.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/archive_file.hpp"
#include "terrain/dem/beds/bed_preparation.hpp"
#include "terrain/liggghts/borders.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "terrain/liggghts/saved_grains.hpp"
#include "terrain/liggghts/starting_bed.hpp"

namespace furrow::terrain::liggghts {
namespace {

class NoWork final : public StepWork {
 public:
  void lists_made(const OwnGrains&, std::span<const std::int32_t>) override {}
  void numbers_change(const OwnGrains&) override {}
  StepWish begin_step() override { return {}; }
  void add_forces(const OwnGrains&, int, int, bool) override {}
  void end_step(const PairSums& pairs, const MotionSums&, bool) override { contacts = pairs.contacts; }

  double contacts = 0.0;  // of the last step
};

/// The parts take turns with this number of steps each, so that other load on the machine affects all of them equally.
constexpr int kBlock = 25;

/// Processor time of this process, s.
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
  std::optional<std::vector<double>> borders;  // from a run: the bed is this rank's share
  std::int64_t grains = 0;                     // of all ranks
  int rank = 0, ranks = 1;

  /// Takes this rank's share of a run, without its tires.
  void take(const Archive& saved) {
    const Archive::Scope scope(saved, "terrain/");
    grains = saved.get_int("grains/all");
    borders = saved.get<double>("borders", static_cast<std::size_t>(ranks - 1));
    bed = read_grains(saved, grains);
    std::erase_if(bed.walls, [](const CarriedBy& one) { return one.contact.partner >= dem::kWalls; });
    bed.top = saved.get_double("top");
  }

  std::unique_ptr<Engine> engine(RankContacts& contacts, StepWork& work) const {
    EngineSetup s = contacts.setup();
    s.communicator = MPI_Comm_c2f(MPI_COMM_WORLD);
    s.top = bed.top;
    if (&work != &contacts) s.gravity = {};  // there is no floor
    Crowd crowd(options.length);
    for (const NewGrain& grain : bed.grains) crowd.add(grain.position[0]);
    if (borders)
      s.borders = *borders;
    else if (ranks > 1)
      s.borders = crowd.borders(ranks);
    std::unique_ptr<Engine> engine = make_engine(s);
    engine->set_coefficients(contacts.coefficients().pair);
    engine->place(bed.grains, borders.has_value());
    engine->remember(bed.pairs);
    engine->begin(work, false);
    if (&work == &contacts) hand_out(bed.walls, engine->own());
    return engine;
  }
};

/// One of the timed parts, with its own engine.
class Part {
 public:
  Part(const Bench& bench, const char* name, bool contacts_too, bool each_step)
      : bench_(bench),
        name_(name),
        contacts_too_(contacts_too),
        each_step_(each_step),
        contacts_(bench.options),
        engine_(bench.engine(contacts_, contacts_too ? static_cast<StepWork&>(contacts_) : nothing_)) {
    contacts_.set_times(times_);
    begin(kWarmUp);
    engine_->run(kWarmUp, times_);
    builds_ = engine_->list_builds();
  }

  void run(int steps) {
    MPI_Barrier(MPI_COMM_WORLD);
    const auto begin_wall = std::chrono::steady_clock::now();
    const double begin_busy = processor_time();
    for (int left = steps, now = each_step_ ? 1 : steps; left > 0; left -= now) {
      begin(now);
      engine_->run(now, times_);
    }
    busy_ += processor_time() - begin_busy;
    wall_ += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin_wall).count();
    steps_ += steps;
  }

  void print(int round) const {
    double busy = busy_, touching = contacts_too_ ? contacts_.sums().contacts : nothing_.contacts;
    MPI_Allreduce(MPI_IN_PLACE, &busy, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, &touching, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    int counts[2] = {engine_->own().count, engine_->own_ghosts()}, least = 0, most[2];
    MPI_Allreduce(&counts[0], &least, 1, MPI_INT, MPI_MIN, MPI_COMM_WORLD);
    MPI_Allreduce(counts, most, 2, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    if (bench_.rank == 0)
      std::printf("%s,%d,%d,%lld,%d,%.2f,%.2f,%.2f,%d,%d,%d,%lld,%.0f\n", name_, bench_.ranks, round,
                  static_cast<long long>(bench_.grains), steps_, 1e6 * wall_ / steps_, 1e6 * busy / steps_,
                  1e9 * wall_ / steps_ / static_cast<double>(bench_.grains), least, most[0], most[1],
                  static_cast<long long>(engine_->list_builds() - builds_), touching);
    std::fflush(stdout);
  }

 private:
  static constexpr int kWarmUp = 20;  // steps

  void begin(int steps) { contacts_.begin_interval({}, steps * times_.dt, steps); }

  const Bench& bench_;
  const char* name_;
  bool contacts_too_, each_step_;
  RankContacts contacts_;
  NoWork nothing_;
  std::unique_ptr<Engine> engine_;  // uses contacts_ or nothing_
  StepTimes times_{bench_.options.step, bench_.options.step, bench_.options.step};
  int steps_ = 0;
  double wall_ = 0.0, busy_ = 0.0;  // s
  std::int64_t builds_ = 0;
};

int run(int argc, char** argv) {
  if (argc < 4) {
    std::fprintf(stderr, "usage: bench_liggghts SCENARIO STEPS ROUNDS [KEY=VALUE …]\n");
    return 2;
  }
  Bench bench;
  MPI_Comm_rank(MPI_COMM_WORLD, &bench.rank);
  MPI_Comm_size(MPI_COMM_WORLD, &bench.ranks);
  const std::filesystem::path from = argv[1];
  const bool of_a_run = is_directory(from);
  std::vector<std::pair<std::string, std::string>> settings{{"terrain.engine", "liggghts"}};
  for (int k = 4; k < argc; ++k) {
    const std::string word = argv[k];
    settings.emplace_back(word.substr(0, word.find('=')), word.substr(word.find('=') + 1));
  }
  const scenario::Scenario s = scenario::load_scenario(of_a_run ? from / "scenario.json" : from, settings);
  bench.options = dem::with_context(*s.terrain->grains(), s.terrain_context());
  if (of_a_run) {
    if (s.terrain_ranks != bench.ranks)
      throw Error(ExitCode::bad_input, "start as many ranks as the run's terrain has");
    const auto file = checkpoint::last_checkpoint(from).folder / checkpoint::part_name({Role::terrain, bench.rank});
    bench.take(read_archive(file));
  } else {
    if (bench.rank == 0) {
      dem::GrainSolver solver(dem::solver_params(bench.options));
      dem::load_bed(solver, bench.options, {});
      bench.bed = starting_bed(solver);
    }
    broadcast(bench.bed.grains);
    broadcast(bench.bed.pairs);
    broadcast(bench.bed.walls);
    MPI_Bcast(&bench.bed.top, 1, MPI_DOUBLE, 0, MPI_COMM_WORLD);
    bench.grains = bench.bed.size();
  }
  if (bench.rank == 0)
    std::printf(
        "part,ranks,round,grains,steps,us_per_step,cpu_us_per_step,ns_per_grain_step,grains_least,grains_"
        "most,ghosts_most,"
        "list_builds,contacts\n");
  const int steps = std::atoi(argv[2]), rounds = std::atoi(argv[3]);
  for (int round = 0; round < rounds; ++round) {
    Part parts[] = {
        {bench, "pairs", false, false}, {bench, "walls_accounts", true, false}, {bench, "each_step", true, true}};
    for (int done = 0; done < steps; done += kBlock)
      for (Part& part : parts) part.run(std::min(kBlock, steps - done));
    for (const Part& part : parts) part.print(round);
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
