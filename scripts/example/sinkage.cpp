// Lowers a flexible tire into a bed of grains at a constant speed, and prints the load on its rim against the sinkage.
//
// The coupling is that of furrow's ranks in one process: within each step the terrain meets the tire's surface where it
// is and moves it along; the tire then moves under the forces that the terrain returned.
#include <cstdio>
#include <exception>
#include <memory>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "terrain/terrains.hpp"
#include "tire/tires.hpp"

namespace {

constexpr double kStep = 1e-4;   // communication step, s
constexpr double kSpeed = 0.5;   // of the rim, downwards, m/s
constexpr double kDepth = 0.04;  // below the mean surface, at which the program ends, m

/// A coarse bed, 1.2 m long and 0.4 m wide, that settles within seconds. The keys are those of a scenario's section.
std::unique_ptr<furrow::terrain::Terrain> make_bed() {
  const nlohmann::json section = {{"engine", "dem"}, {"radius", 0.03}, {"cohesion", 80e3}, {"layers", 4},
                                  {"length", 1.2},   {"width", 0.4},   {"cache", false}};
  const furrow::ReadContext context{.file = "sinkage.cpp", .section = "terrain"};
  const auto spec = furrow::terrain::find_terrain("dem", context).read(section, context);
  furrow::terrain::TerrainContext run;
  run.step = kStep;
  return spec->make(run);
}

std::unique_ptr<furrow::tire::Tire> make_tire(const std::string& file) {
  furrow::tire::TireOptions options;
  options.file = file;
  options.elements_circumference = 36;
  options.elements_width = 6;
  return furrow::tire::read_tire(options)->make();
}

/// Fails as the program does: with a message, and with the exit code of failed physics.
void require(const furrow::Outcome& outcome, const std::string& who) {
  if (!outcome.ok) throw furrow::physics_error(outcome, who);
}

void press(furrow::tire::Tire& tire, furrow::terrain::Terrain& bed) {
  bed.prepare([](const std::string&, double) {});
  const double surface = bed.gather_mean_height(0.3, 0.9, -0.2, 0.2);
  const double top = bed.gather_top_height(0.1, 1.1, -0.2, 0.2);

  furrow::RimState rim;
  rim.position = {0.6, 0.0, top + tire.radius() + 0.01};
  rim.velocity = {0.0, 0.0, -kSpeed};
  tire.place(rim);
  furrow::tire::RimTrajectory motion(rim);
  std::vector<furrow::SurfaceState> skin(1);
  std::vector<furrow::NodalForces> forces(1);
  std::vector<furrow::ContactSums> contact(1);
  tire.surface(skin[0]);
  bed.attach(tire.mesh(), tire.material(), skin[0]);

  std::printf("grains: %lld\ndepth_m,load_N,contacts\n", static_cast<long long>(bed.size()));
  const auto depth = [&] { return surface - (rim.position.z() - tire.radius()); };
  for (int step = 1; depth() < kDepth; ++step) {
    tire.surface(skin[0]);
    require(bed.advance(skin, kStep, 1, forces, contact), "the terrain");
    motion.extend(rim, kStep);
    require(tire.advance(motion, forces[0], 1), "the tire");
    rim = motion.end();
    if (step % 100 == 0)
      std::printf("%.4f,%.1f,%lld\n", depth(), contact[0].force.z(), static_cast<long long>(contact[0].contacts));
  }
  std::printf("load at %.0f mm: %.0f N\n", 1e3 * kDepth, contact[0].force.z());
}

}  // namespace

int main(int count, char** arguments) {
  try {
    const std::string file = count > 1 ? arguments[1] : FURROW_DATA "/tire/data/hmmwv_lumped.json";
    press(*make_tire(file), *make_bed());
    return 0;
  } catch (const furrow::Error& error) {
    std::fprintf(stderr, "sinkage: error: %s\n", error.what());
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::fprintf(stderr, "sinkage: error: %s\n", error.what());
    return 1;
  }
}
