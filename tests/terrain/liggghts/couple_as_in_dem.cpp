// A grain is dragged through its centre along the facets of a tire that resists its rolling. In the engine liggghts it
// moves and loads the vertices as in the engine dem, and slides or rolls as in theory (rolling_couple_test.cpp). Runs
// on one rank; prints differences and ends with 1.
#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <vector>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/grain_solver.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/liggghts/engine_library.hpp"
#include "terrain/liggghts/rank_contacts.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain::liggghts {
namespace {

constexpr double kRadius = 0.01, kStep = 2e-6, kLevel = 0.2;  // m, s; of the facets, m
constexpr double kSlope = 0.45;                               // the drag over the weight on the facets
constexpr int kSteps = 5000, kInterval = 10;                  // of the run, of an interval

struct Friction {
  double sliding, rolling;
};

dem::DemOptions options(const Friction& friction) {
  dem::DemOptions o;
  o.radius = kRadius;
  o.length = o.width = 0.6;
  o.step = kStep;
  o.friction = friction.sliding;
  o.precision = "double";
  o.activity = false;
  return o;
}

Vec3 gravity() { return kStandardGravity / std::hypot(1.0, kSlope) * Vec3(kSlope, 0.0, -1.0); }

/// Facets that lie still. @param size of a facet, m
struct Facets {
  testing::Surface sheet;
  SurfaceState state;
  ContactMaterial material;

  Facets(const Friction& friction, double size) {
    const int along = static_cast<int>(std::lround(0.2 / size)), across = along / 2;
    sheet = testing::sheet(0.15, -0.05, size, along, across, [](double, double) { return kLevel; });
    state = {sheet.vertex, std::vector<Vec3>(sheet.vertex.size(), Vec3::Zero())};
    material = dem::grain_material(options(friction));
    material.cohesion = 0.0;
    material.rolling_friction = friction.rolling;
  }
};

/// The grain at the end of an interval, and the load on its facets in it.
struct Seen {
  std::array<Vec3, 3> motion;   // position, velocity, spin
  std::vector<Vec3> on_vertex;  // N

  void put(const NodalForces& forces, std::size_t vertices) {
    on_vertex.assign(vertices, Vec3::Zero());
    for (std::size_t k = 0; k < forces.vertex.size(); ++k) on_vertex[forces.vertex[k]] = forces.force[k];
  }
};

Vec3 place(const dem::DemOptions& o, const ContactMaterial& material) {
  const double load = dem::grain_properties(o.radius, o.density).mass * -gravity().z();
  const double stiffness = dem::surface_coefficients(o, material, kStep).of<dem::MindlinLaw>().stiffness;
  return {0.2, 0.01, kLevel + kRadius - std::pow(load / stiffness, 2.0 / 3.0)};
}

class InDem {
 public:
  InDem(const dem::DemOptions& o, const Facets& facets) : facets_(facets), solver_(params(o)) {
    solver_.set_coefficients(dem::run_coefficients(o, kStep));
    const Vec3 x = place(o, facets.material);
    solver_.place({{x.x(), x.y(), x.z(), 0.0}});
    solver_.surfaces().attach(facets.sheet.mesh, facets.material, dem::surface_coefficients(o, facets.material, kStep),
                              facets.state);
    solver_.surfaces().restrict_to({Vec3(-1, -1, 0), Vec3(2, 2, 1)});
  }

  Seen advance() {
    solver_.surfaces().set_targets({&facets_.state, 1}, kInterval * kStep);
    for (int s = 0; s < kInterval; ++s) {
      solver_.surfaces().move_to(static_cast<double>(s) / kInterval);
      solver_.step(kStep);
    }
    solver_.surfaces().move_to(1.0);
    NodalForces forces;
    ContactSums sums;
    solver_.surfaces().finish(kInterval * kStep, {&forces, 1}, {&sums, 1});
    const auto& grains = solver_.grains();
    const auto vec = [](const dem::Quad& q) { return Vec3(q.x, q.y, q.z); };
    Seen seen{{vec(grains.position[0]), vec(grains.velocity[0]), vec(grains.spin[0])}, {}};
    seen.put(forces, facets_.sheet.vertex.size());
    return seen;
  }

 private:
  static dem::SolverParams params(const dem::DemOptions& o) {
    dem::SolverParams p = dem::solver_params(o);
    p.gravity = gravity();
    return p;
  }
  const Facets& facets_;
  dem::GrainSolver solver_;
};

class InLiggghts {
 public:
  InLiggghts(const dem::DemOptions& o, const Facets& facets) : facets_(facets), contacts_(o) {
    EngineSetup s = contacts_.setup();
    s.top = 0.3;
    for (int k = 0; k < 3; ++k) s.gravity[k] = gravity()[k];
    engine_ = make_engine(s);
    engine_->set_coefficients(contacts_.coefficients().pair);
    const Vec3 x = place(o, facets.material);
    NewGrain grain;
    grain.radius = kRadius;
    grain.position = {x.x(), x.y(), x.z()};
    grain.list_position = grain.exchange_position = grain.position;
    engine_->place(std::vector<NewGrain>{grain}, false);
    engine_->begin(contacts_, false);
    contacts_.attach(facets.sheet.mesh, facets.material, facets.state);
  }

  Seen advance() {
    contacts_.begin_interval({&facets_.state, 1}, kInterval * kStep, kInterval);
    const StepTimes times{kStep, kStep, kStep};
    contacts_.set_times(times);
    engine_->run(kInterval, times);
    NodalForces forces;
    ContactSums sums;
    contacts_.end_interval(kInterval * kStep, {&forces, 1}, {&sums, 1});
    const OwnGrains own = engine_->own();
    const auto vec = [](const double* v) { return Vec3(v[0], v[1], v[2]); };
    Seen seen{{vec(own.position[0]), vec(own.velocity[0]), vec(own.spin[0])}, {}};
    seen.put(forces, facets_.sheet.vertex.size());
    return seen;
  }

 private:
  const Facets& facets_;
  RankContacts contacts_;
  std::unique_ptr<Engine> engine_;
};

/// Relative difference of motion and loads.
double difference(const Seen& one, const Seen& other) {
  double worst = 0.0, apart = 0.0, load = 0.0;
  for (int k = 0; k < 3; ++k) {
    const double size = other.motion[k].norm();
    if (size > 0.0) worst = std::max(worst, (one.motion[k] - other.motion[k]).norm() / size);
  }
  for (std::size_t v = 0; v < one.on_vertex.size(); ++v) {
    apart = std::max(apart, (one.on_vertex[v] - other.on_vertex[v]).norm());
    load = std::max(load, other.on_vertex[v].norm());
  }
  return std::max(worst, load > 0.0 ? apart / load : 1.0);
}

int run(const Friction& friction, double facet) {
  const dem::DemOptions o = options(friction);
  const Facets facets(friction, facet);
  InDem dem(o, facets);
  InLiggghts liggghts(o, facets);
  double worst = 0.0, half_way = 0.0;
  Seen seen;
  for (int done = 0; done < kSteps; done += kInterval) {
    const Seen expected = dem.advance();
    seen = liggghts.advance();
    worst = std::max(worst, difference(seen, expected));
    if (done + kInterval == kSteps / 2) half_way = seen.motion[1].x();
  }
  const double press = -gravity().z(), drag = gravity().x(), speed = seen.motion[1].x();
  const double acceleration = (speed - half_way) / (0.5 * kSteps * kStep), turns = seen.motion[2].y() * kRadius / speed;
  const bool slides = friction.rolling > friction.sliding;
  const double expected = slides ? drag - friction.sliding * press : (drag - friction.rolling * press) / 1.4;
  std::printf(
      "friction %g, rolling %g, facets of %g mm: largest difference %.1e, acceleration %.4f, expected %.4f m/s², "
      "spin × radius/speed %.4f\n",
      friction.sliding, friction.rolling, 1e3 * facet, worst, acceleration, expected, turns);
  const bool as_theory =
      std::abs(acceleration - expected) < 5e-3 * kStandardGravity && std::abs(turns - (slides ? 0.0 : 1.0)) < 0.02;
  return worst < 1e-9 && as_theory ? 0 : 1;
}

}  // namespace
}  // namespace furrow::terrain::liggghts

int main(int argc, char** argv) {
  using namespace furrow::terrain::liggghts;
  if (find_engine_library().empty()) return 77;
  MPI_Init(&argc, &argv);
  int code = 0;
  try {
    for (const double facet : {0.05, 0.004})  // larger and smaller than the grain
      for (const Friction& friction : {Friction{0.5, 0.0}, {0.5, 0.1}, {0.5, 0.3}, {0.2, 0.4}})
        code |= run(friction, facet);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    code = 1;
  }
  MPI_Finalize();
  return code;
}
