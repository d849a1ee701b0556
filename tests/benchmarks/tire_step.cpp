// Milliseconds per step of the layered tire, and its load–deflection secant.
//
// The tire carries a ballast on a flat ground, rolling at constant angular speed (or standing, at speed 0).
// Ground: a penalty of 3e5 N/m per vertex with a tangential spring of 2e5 N/m limited by Coulomb friction,
// both explicit.
//   tire_step FILE [COLUMNS WIDTH SPEED STEP END BALLAST FRICTION]
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>

#include "protocol/error.hpp"
#include "tire/ancf/ancf_tire.hpp"
#include "tire/tire_file.hpp"

namespace {

using namespace furrow;

double processor_time() {
  timespec t;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// Flat ground at z = 0.
class Ground {
 public:
  Ground(std::size_t vertices, double friction) : slip_(vertices, Vec3::Zero()), friction_(friction) {}

  Vec3 push(const SurfaceState& s, double h, NodalForces& out) {
    out.clear();
    Vec3 total = Vec3::Zero();
    for (std::size_t k = 0; k < s.position.size(); ++k) {
      const double depth = -s.position[k].z();
      const double normal = std::max(0.0, kNormal * depth - kDamping * s.velocity[k].z());
      if (depth <= 0.0 || normal == 0.0) {
        slip_[k].setZero();
        continue;
      }
      const Vec3 rate(s.velocity[k].x(), s.velocity[k].y(), 0.0);
      slip_[k] += h * rate;
      Vec3 tangential = -kTangential * slip_[k] - kDamping * rate;
      if (const double limit = friction_ * normal; tangential.norm() > limit) {
        tangential *= limit / tangential.norm();
        slip_[k] = -(tangential + kDamping * rate) / kTangential;
      }
      out.vertex.push_back(static_cast<int>(k));
      out.force.push_back(tangential + Vec3(0.0, 0.0, normal));
      total += out.force.back();
    }
    return total;
  }

 private:
  static constexpr double kNormal = 3e5, kTangential = 2e5;  // N/m
  static constexpr double kDamping = 10.0;                   // N s/m
  std::vector<Vec3> slip_;                                   // of the tangential spring, m
  double friction_;
};

struct Run {
  double speed = 4.28;   // rad/s
  double step = 6e-5;    // s
  double end = 0.5;      // s
  double ballast = 465;  // kg
  double friction = 0.9;
};

void roll(AncfTire& tire, const Run& run) {
  RimState rim;
  rim.position = Vec3(0, 0, tire.radius() + 1e-3);
  rim.velocity = Vec3(0.975 * run.speed * tire.radius(), 0, 0);
  rim.angular_velocity = Vec3(0, run.speed, 0);
  double start = processor_time();
  tire.place(rim);
  fmt::print("placed in {:.2f} s, {} creep steps, {} repeated, static residual {:.1e}\n",
             processor_time() - start, tire.inflation().steps, tire.inflation().shrunk,
             tire.inflation().residual);
  RimTrajectory trajectory(rim);
  Ground ground(tire.mesh().vertex_count, run.friction);
  NodalForces forces;
  SurfaceState surface;
  const auto steps = static_cast<long>(run.end / run.step), block = std::max(1L, steps / 12);
  RingIntegrator::Times before = tire.integrator().times();
  TireDiagnostics last = tire.diagnostics();
  double load = 0.0, deflection = 0.0, spent = 0.0, worst = 0.0;
  for (long n = 1; n <= steps; ++n) {
    tire.surface(surface);
    ground.push(surface, run.step, forces);
    trajectory.extend(rim, run.step);
    start = processor_time();
    const TireStatus status = tire.advance(trajectory, forces, 1);
    spent += processor_time() - start;
    if (!status.converged) throw physics_error(status.message);
    const Wrench wrench = tire.spindle_wrench();
    const double damper = n * run.step < 0.6 * run.end ? 12e3 : 0.0;
    rim.velocity.z() += run.step * ((wrench.force.z() - damper * rim.velocity.z()) / run.ballast - 9.81);
    rim.position += run.step * rim.velocity;
    rim.orientation =
        (Quat(Eigen::AngleAxisd(run.step * run.speed, Vec3::UnitY())) * rim.orientation).normalized();
    load += wrench.force.z() / block;
    deflection += (tire.radius() - rim.position.z()) / block;
    worst = std::max(worst, tire.integrator().residual());
    if (n % block != 0) continue;
    const TireDiagnostics d = tire.diagnostics();
    const RingIntegrator::Times t = tire.integrator().times();
    const double k = 1e3 / block;
    fmt::print(
        "t {:.3f} s  load {:.0f} N  deflection {:.2f} mm  secant {:.0f} kN/m  Fx {:.0f} N  vertices {}  "
        "iterations {:.2f}  "
        "factorizations {}  ms/step {:.2f} = force {:.2f} jacobian {:.2f} factorize {:.2f} solve {:.2f} "
        "other {:.2f}  "
        "residual {:.1e}\n",
        n * run.step, load, deflection * 1e3, load / deflection * 1e-3, wrench.force.x(),
        forces.vertex.size(), static_cast<double>(d.newton_iterations - last.newton_iterations) / block,
        d.factorizations - last.factorizations, spent * k, (t.force - before.force) * k,
        (t.jacobian - before.jacobian) * k, (t.factorize - before.factorize) * k,
        (t.solve - before.solve) * k, (t.other - before.other) * k, worst);
    std::fflush(stdout);
    before = t, last = d;
    load = deflection = spent = worst = 0.0;
  }
}

}  // namespace

int main(int argc, char** argv) {
  try {
    if (argc < 2) throw input_error("tire_step", "", "expected a tire file");
    const auto number = [&](int k, double otherwise) { return argc > k ? std::atof(argv[k]) : otherwise; };
    TireFile file = read_tire_file(argv[1]);
    file.elements_circumference = static_cast<int>(number(2, 60));
    set_elements_width(file, static_cast<int>(number(3, 12)));
    RingIntegratorParams params;
    if (const char* slots = std::getenv("TIRE_SLOTS")) params.slots = std::atoi(slots);
    if (const char* slow = std::getenv("TIRE_SLOW")) params.slow_iterations = std::atoi(slow);
    AncfTire tire(file, params);
    const Run defaults;
    roll(tire, {number(4, defaults.speed), number(5, defaults.step), number(6, defaults.end),
                number(7, defaults.ballast), number(8, defaults.friction)});
  } catch (const Error& e) {
    fmt::print(stderr, "furrow: error: {}\n", e.what());
    return static_cast<int>(e.code());
  }
  return 0;
}
