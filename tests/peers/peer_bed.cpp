#include "tests/peers/peer_bed.hpp"

#include <cmath>
#include <fstream>
#include <sstream>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "tests/peers/switched_law.hpp"
#undef MindlinLaw

namespace furrow::peers {
namespace {

using namespace terrain::dem;

terrain::dem::DemOptions options_of(const Job& job) {
  terrain::dem::DemOptions o;
  o.length = job.at("length");
  o.width = job.at("width");
  o.periodic_x = job.at("periodic_x");
  o.sides = job.at("periodic_y").get<bool>() ? "periodic" : "walls";
  o.radius = job.at("radius");
  o.density = job.at("density");
  o.young_modulus = job.at("young_modulus");
  o.poisson_ratio = job.at("poisson_ratio");
  o.restitution = job.at("restitution");
  o.friction = job.at("friction");
  o.cohesion = job.at("cohesion");
  o.precision = job.at("precision");
  o.step = job.at("step");
  o.activity = false;
  return o;
}

terrain::dem::SolverCoefficients coefficients_of(const Job& job, const terrain::dem::DemOptions& options) {
  const terrain::dem::SolverCoefficients all = terrain::dem::run_coefficients(options, options.step);
  const auto with_switches = [&](const terrain::dem::ContactCoefficients& mixed, bool wall) {
    terrain::dem::SwitchedLaw::Coefficients<double> c;
    static_cast<terrain::dem::OwnLaw::Coefficients<double>&>(c) = mixed.of<terrain::dem::OwnLaw>();
    if (wall) c.cohesion_force = 0.0, c.friction = job.at("wall_friction");
    c.switches = job.at("switches").get<int>();
    // m* instead of 2/7 m*.
    if (job.at("damper_mass") == "full") c.shear_damping *= std::sqrt(3.5);
    return terrain::dem::ContactCoefficients(c);
  };
  return {with_switches(all.pair, false), with_switches(all.floor, true), with_switches(all.side, true)};
}

}  // namespace

PeerBed::PeerBed(const Job& job)
    : options_(options_of(job)),
      step_(options_.step),
      params_(terrain::dem::solver_params(options_)),
      solver_(params_) {
  solver_.set_coefficients(coefficients_of(job, options_));
  const std::string file = job.at("start");
  std::ifstream in(file);
  std::vector<terrain::dem::Quad> at;
  for (std::string line; std::getline(in, line);) {
    if (line.find('x') != std::string::npos) continue;  // header
    std::istringstream fields(line);
    terrain::dem::Quad p;
    int kind = 0;
    char comma;
    if (!(fields >> kind >> comma >> p.x >> comma >> p.y >> comma >> p.z) || kind < kFree || kind > kLid)
      throw input_error(file, "", "'" + line + "' is not kind,x,y,z with a kind of 0, 1 or 2");
    at.push_back(p);
    kind_.push_back(kind);
    ++plates_[kind].grains;
  }
  if (at.empty()) throw io_error(file, "no grains could be read");
  solver_.place(at);
  // The peers' velocity Verlet has velocities at whole steps: the difference is half a step of free fall.
  if (job.at("half_step_start"))
    for (int g = 0; g < solver_.grains().count; ++g)
      if (kind_[solver_.grains().id[g]] == kFree) solver_.grains().velocity[g].z = 0.5 * step_ * kStandardGravity;
}

void PeerBed::step(const std::function<void()>& drive) {
  const int lost = solver_.step(step_);
  terrain::dem::Grains& grains = solver_.grains();
  if (lost >= 0) throw physics_error("grain " + std::to_string(grains.id[lost]) + " was lost");
  const double mass = params_.grain.mass;
  const auto each_driven = [&](const auto& f) {
    for (int g = 0; g < grains.count; ++g)
      if (const int kind = kind_[grains.id[g]]; kind != kFree) f(g, plates_[kind]);
  };
  for (Plate& plate : plates_) plate.force.setZero();
  each_driven([&](int g, Plate& plate) {
    const terrain::dem::Quad& v = grains.velocity[g];
    plate.force += mass / step_ * (Vec3(v.x, v.y, v.z) - plate.velocity) + Vec3(0.0, 0.0, mass * kStandardGravity);
  });
  if (drive) drive();
  each_driven([&](int g, const Plate& plate) {
    terrain::dem::Quad &v = grains.velocity[g], &x = grains.position[g];
    x.x += step_ * (plate.velocity.x() - v.x);
    x.y += step_ * (plate.velocity.y() - v.y);
    x.z += step_ * (plate.velocity.z() - v.z);
    v = {plate.velocity.x(), plate.velocity.y(), plate.velocity.z(), 0.0};
    grains.spin[g] = {};
  });
}

void PeerBed::positions(std::vector<double>& out) const {
  const terrain::dem::Grains& grains = solver_.grains();
  const std::size_t first = out.size();
  out.resize(first + 3 * grains.count);
  for (int g = 0; g < grains.count; ++g) {
    const terrain::dem::Quad& x = grains.position[g];
    double* const to = &out[first + 3 * grains.id[g]];
    to[0] = x.x, to[1] = x.y, to[2] = x.z;
  }
}

}  // namespace furrow::peers
