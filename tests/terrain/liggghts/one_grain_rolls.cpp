// A grain rolls on the floor, across the borders between the ranks, under a plate that presses on it, resists its
// rolling and moves along x. Its motion and the forces on the plate must be those of one rank. In a second case the
// borders move beneath it. Each rank also computes the case of one rank. Runs under mpirun; prints differences and ends
// with 1.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <vector>

#include "protocol/core/error.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRadius = 0.01, kStep = 4e-5;  // m, s
constexpr double kSpeed = 2.0;                  // of the plate, m/s
constexpr double kOverlap = 2e-4;               // with floor and plate, m
constexpr int kSteps = 1876,
              kStart = 4;  // the grain goes 0.075 m; it starts 0.04 m before the middle of the bin

dem::DemOptions options() {
  dem::DemOptions o;
  o.radius = kRadius;
  o.length = 0.6;
  o.width = 0.2;
  o.step = kStep;
  o.friction = 0.5;
  o.rolling_friction = 0.02;
  o.precision = "double";
  o.activity = false;
  return o;
}

ContactMaterial plate_material() {
  ContactMaterial m;
  m.young_modulus = 2.49e7;
  m.poisson_ratio = 0.3;
  m.friction = 0.5;
  m.restitution = 0.2;
  m.rolling_friction = 0.05;
  return m;
}

/// The grain at one instant; the rank that owns it reports it.
struct Seen {
  std::array<double, 9> motion{};  // position, velocity, spin
  std::array<double, 3> push{};    // on the plate, N
  int owner = -1;
};

class Case {
 public:
  /// @param communicator none: on one rank
  explicit Case(std::optional<int> communicator, int rank) : contacts_(options()), rank_(rank) {
    EngineSetup s = contacts_.setup();
    s.communicator = communicator;
    s.top = 0.1;
    s.gravity = {};
    engine_ = make_engine(s);
    engine_->set_coefficients(contacts_.coefficients().pair);
    NewGrain grain;
    grain.radius = kRadius;
    grain.position = {0.5 * s.bin.length - 0.04, 0.01, kRadius - kOverlap};
    grain.list_position = grain.exchange_position = grain.position;
    engine_->place(std::vector<NewGrain>{grain}, false);
    engine_->begin(contacts_, false);
    const double top = 2.0 * kRadius - 2.0 * kOverlap;
    plate_ = testing::sheet(0.02, -0.08, 0.04, 8, 4, [&](double, double) { return top; });
    for (auto& t : plate_.mesh.triangles) std::swap(t[1], t[2]);  // its outside is below
    contacts_.attach(plate_.mesh, plate_material(), {plate_.vertex, {}});
  }

  void move_borders(std::span<const double> borders) { engine_->move_borders(borders); }

  Seen advance(int steps) {
    SurfaceState target{plate_.vertex, std::vector<Vec3>(plate_.vertex.size(), Vec3(kSpeed, 0, 0))};
    contacts_.begin_interval(std::span<const SurfaceState>(&target, 1), steps * kStep, steps);
    const StepTimes times{kStep, kStep, kStep};
    contacts_.set_times(times);
    engine_->run(steps, times);
    for (Vec3& x : plate_.vertex) x.x() += kSpeed * steps * kStep;
    NodalForces forces;
    ContactSums sums;
    contacts_.end_interval(steps * kStep, std::span<NodalForces>(&forces, 1), std::span<ContactSums>(&sums, 1));
    Seen seen;
    for (int k = 0; k < 3; ++k) seen.push[k] = sums.force[k];
    const OwnGrains own = engine_->own();
    if (own.count == 0) return seen;
    seen.owner = rank_;
    for (int k = 0; k < 3; ++k) {
      seen.motion[k] = own.position[0][k];
      seen.motion[3 + k] = own.velocity[0][k];
      seen.motion[6 + k] = own.spin[0][k];
    }
    return seen;
  }

 private:
  RankContacts contacts_;
  std::unique_ptr<Engine> engine_;
  testing::Surface plate_;
  int rank_;
};

/// Largest relative difference of motion and push between several ranks and one rank.
double difference(const Seen& mine, const Seen& alone) {
  Seen sum;
  MPI_Allreduce(mine.motion.data(), sum.motion.data(), 9, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  MPI_Allreduce(mine.push.data(), sum.push.data(), 3, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  double worst = 0.0;
  const auto compare = [&](const double* a, const double* b) {
    double apart = 0.0, size = 0.0;
    for (int k = 0; k < 3; ++k) apart = std::max(apart, std::abs(a[k] - b[k])), size = std::max(size, std::abs(b[k]));
    if (size > 0.0) worst = std::max(worst, apart / size);
  };
  for (int k = 0; k < 9; k += 3) compare(&sum.motion[k], &alone.motion[k]);
  compare(sum.push.data(), alone.push.data());
  return worst;
}

/// @param move whether the borders move half-way, so that the grain changes its rank at its place
int run(bool move) {
  int rank = 0, ranks = 1;
  MPI_Comm_rank(MPI_COMM_WORLD, &rank);
  MPI_Comm_size(MPI_COMM_WORLD, &ranks);
  Case shared(MPI_Comm_c2f(MPI_COMM_WORLD), rank), alone({}, rank);
  double worst = 0.0;
  int first = -1, last = -1, owners = 1;
  Seen one;
  for (int done = 0; done < kSteps; done += kStart) {
    if (move && done == 100) {
      std::vector<double> borders;
      for (int k = 1; k < ranks; ++k) borders.push_back(options().length * (0.2 + 0.2 * k / ranks));
      shared.move_borders(borders);
    }
    const Seen mine = shared.advance(kStart);
    one = alone.advance(kStart);
    worst = std::max(worst, difference(mine, one));
    int owner = -1;
    MPI_Allreduce(&mine.owner, &owner, 1, MPI_INT, MPI_MAX, MPI_COMM_WORLD);
    owners += last >= 0 && owner != last ? 1 : 0;
    if (first < 0) first = owner;
    last = owner;
  }
  const double way = one.motion[0] - (0.5 * options().length - 0.04), rolled = one.motion[7] * kRadius;
  const bool moved = std::abs(way / (0.5 * kSpeed * kSteps * kStep) - 1.0)<0.05, pressed = one.push[2]> 1.0;
  const bool crossed =
      (move && owners > 1) || ranks % 2 == 1 || (owners == 2 && first == ranks / 2 - 1 && last == ranks / 2);
  if (rank == 0)
    std::printf(
        "%d ranks%s: largest difference %.1e, way %.4f m, spin × radius %.4f m/s, push %.3f N, owners %d to "
        "%d\n",
        ranks, move ? ", moved borders" : "", worst, way, rolled, one.push[2], first, last);
  return worst < 1e-12 && moved && pressed && crossed ? 0 : 1;
}

}  // namespace
}  // namespace furrow::terrain::liggghts

int main(int argc, char** argv) {
  if (furrow::terrain::liggghts::find_engine_library().empty()) return 77;
  MPI_Init(&argc, &argv);
  int code = 1;
  try {
    code = furrow::terrain::liggghts::run(false) + furrow::terrain::liggghts::run(true);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, 1);
  }
  MPI_Finalize();
  return code;
}
