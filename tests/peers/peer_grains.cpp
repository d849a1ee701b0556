// One bulk test on the engine's side of a comparison: peer_grains JOB.json OUT
//
// `test` of the job:
//   fall   grains fall and come to rest for `steps`; positions every `every` steps
//   plate  `rest_steps`, then a mesh box (plate_side, plate_height, its lower face at plate_z, in the middle of the
//   bin)
//          goes down at `speed` for `steps`; means over each `every` steps
//   shear  grains between plates of grains: they fall for `settle_steps`; the lid, free to rise and sink, takes its
//   load
//          `pressure` × area over `load_steps`, keeps it for `hold_steps`, then moves along x in `stages`, each with a
//          `speed`, reached evenly over `ramp_steps`, for `steps` in all; means over each `every` steps.
//          Lid: M v̇ = F − P − c v with the mass of its grains and c = lid_damping, N s/m.
// OUT/positions.f64 (frames × grains × 3, start order) and OUT/series.csv.
#include <cstdio>
#include <fstream>
#include <iomanip>
#include <iostream>

#include "protocol/core/error.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/soil/tools.hpp"
#include "tests/peers/peer_bed.hpp"

namespace furrow::peers {
namespace {

class Output {
 public:
  Output(const std::filesystem::path& folder, const std::string& columns)
      : frames_(folder / "positions.f64", std::ios::binary), series_(folder / "series.csv") {
    series_ << std::setprecision(12) << columns << '\n';
  }
  void row(std::initializer_list<double> values) {
    const char* between = "";
    for (const double v : values) series_ << std::exchange(between, ",") << v;
    series_ << '\n';
  }
  void frame(const PeerBed& bed) {
    std::vector<double> x;
    bed.positions(x);
    frames_.write(reinterpret_cast<const char*>(x.data()), static_cast<std::streamsize>(8 * x.size()));
  }
  /// @throws Error(io)
  void close() {
    frames_.close(), series_.close();
    if (!frames_ || !series_) throw io_error("results", "could not be written");
  }

 private:
  std::ofstream frames_, series_;
};

void fall(PeerBed& bed, const Job& job, Output& out) {
  const int steps = job.at("steps"), every = job.at("every");
  out.frame(bed);
  for (int k = 1; k <= steps; ++k) {
    bed.step();
    if (k % every != 0) continue;
    const terrain::dem::Accounts& a = bed.solver().accounts();
    out.row({k * bed.dt(), a.kinetic, a.floor_force, static_cast<double>(a.contacts)});
    out.frame(bed);
  }
}

/// A closed box, outside outwards.
terrain::soil::Tool box(double middle, double side, double low, double height) {
  SurfaceMesh mesh;
  std::vector<Vec3> x;
  const double h = 0.5 * side;
  for (const double z : {low, low + height})
    for (const auto& [a, b] : {std::pair{-h, -h}, {h, -h}, {h, h}, {-h, h}}) x.emplace_back(middle + a, b, z);
  const auto quad = [&](int a, int b, int c, int d) {
    mesh.triangles.push_back({a, b, c});
    mesh.triangles.push_back({a, c, d});
  };
  quad(0, 3, 2, 1);
  quad(4, 5, 6, 7);
  for (int k = 0; k < 4; ++k) quad(k, (k + 1) % 4, 4 + (k + 1) % 4, 4 + k);
  return {std::move(mesh), std::move(x)};
}

void plate(PeerBed& bed, const Job& job, Output& out) {
  terrain::soil::Tool tool =
      box(0.5 * job.at("length").get<double>(), job.at("plate_side"), job.at("plate_z"), job.at("plate_height"));
  terrain::dem::SurfaceContacts& surfaces = bed.solver().surfaces();
  surfaces.attach(tool.mesh(), {}, bed.coefficients().side, tool.state());
  const double high = 1.0;  // m
  const int rest = job.at("rest_steps"), steps = job.at("steps"), every = job.at("every");
  std::vector<NodalForces> forces(1);
  std::vector<ContactSums> sums(1);
  Vec3 sum = Vec3::Zero();
  for (int k = 1; k <= rest + steps; ++k) {
    tool.set_velocity(Vec3(0.0, 0.0, k > rest ? -job.at("speed").get<double>() : 0.0));
    surfaces.set_targets({&tool.state(), 1}, bed.dt());
    surfaces.restrict_to({Vec3(-high, -high, -high), Vec3(high, high, high)});
    surfaces.move_to(0.0);
    bed.step();
    surfaces.move_to(1.0);
    surfaces.finish(bed.dt(), forces, sums);
    tool.moved(bed.dt());
    if (k <= rest) continue;
    sum += sums[0].force / every;
    if ((k - rest) % every != 0) continue;
    out.row({(k - rest) * bed.dt(), sum.x(), sum.y(), sum.z(), bed.solver().accounts().floor_force});
    sum.setZero();
  }
  out.frame(bed);
}

void shear(PeerBed& bed, const Job& job, Output& out) {
  const double load = job.at("pressure").get<double>() * bed.area(), damping = job.at("lid_damping");
  const double mass = bed.solver().params().grain.mass * bed.plate(kLid).grains, dt = bed.dt();
  const int settle = job.at("settle_steps"), loading = job.at("load_steps"), hold = job.at("hold_steps");
  const int every = job.at("every");
  Plate& lid = bed.plate(kLid);
  double height = 0.0, speed = 0.0;
  const auto drive = [&](double share, double push) {
    lid.velocity.z() += dt / mass * (lid.force.z() - share * load - damping * lid.velocity.z());
    lid.velocity.x() += dt * push;
    height += dt * lid.velocity.z();
  };
  for (int k = 0; k < settle; ++k) bed.step();
  for (int k = 0; k < loading; ++k) bed.step([&] { drive((k + 1.0) / loading, 0.0); });
  for (int k = 0; k < hold; ++k) bed.step([&] { drive(1.0, 0.0); });
  int done = 0;
  double along = 0.0, normal = 0.0, below = 0.0;
  for (const Job& stage : job.at("stages")) {
    const int ramp = stage.at("ramp_steps"), steps = stage.at("steps");
    const double push = (stage.at("speed").get<double>() - speed) / (ramp * dt);
    for (int k = 0; k < steps; ++k) {
      bed.step([&] { drive(1.0, k < ramp ? push : 0.0); });
      along -= lid.force.x() / every, normal += lid.force.z() / every;
      below += bed.plate(kBase).force.x() / every;
      if (++done % every != 0) continue;
      out.row({done * dt, along, normal, height, below});
      along = normal = below = 0.0;
    }
    speed = stage.at("speed");
  }
}

void run(const std::filesystem::path& file, const std::filesystem::path& folder) {
  std::ifstream in(file);
  if (!in) throw io_error(file.string(), "could not be read");
  const Job job = Job::parse(in);
  PeerBed bed(job);
  const std::string test = job.at("test");
  Output out(folder, test == "fall"    ? "time_s,kinetic_J,floor_N,contacts"
                     : test == "plate" ? "time_s,force_x_N,force_y_N,force_z_N,floor_N"
                                       : "time_s,shear_N,normal_N,lid_m,base_shear_N");
  test == "fall" ? fall(bed, job, out) : test == "plate" ? plate(bed, job, out) : shear(bed, job, out);
  out.close();
}

}  // namespace
}  // namespace furrow::peers

int main(int argc, char** argv) {
  try {
    if (argc != 3) throw furrow::input_error("command line", "", "expected peer_grains JOB.json OUT");
    furrow::peers::run(argv[1], argv[2]);
  } catch (const furrow::Error& error) {
    std::cerr << "peer_grains: error: " << error.what() << '\n';
    return static_cast<int>(error.code());
  } catch (const std::exception& error) {
    std::cerr << "peer_grains: error: " << error.what() << '\n';
    return static_cast<int>(furrow::ExitCode::bad_input);
  }
}
