#include "terrain/soil/plate_sinkage.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSides = 4.0;     // height of the plate's sides beyond the sinkage, radii
constexpr double kUnloaded = 0.1;  // share of the load that a lifted plate still bears; with less the hole collapses
constexpr double kRest = 0.5;      // of the time in which the plate sank, for the soil to come to rest
constexpr double kPressing = 0.6;  // share of the work if the plate is lifted afterwards
constexpr double kWindow = 6.0;    // disc diameters: side of the window about its middle for the volume account

/// The whole bed, or a window about a disc in a larger bed.
Region region_about(const Specimen& specimen, const Footprint& plate) {
  const dem::DemOptions& o = specimen.options();
  const double half = 0.5 * specimen.width();
  Region all{0.0, specimen.length(), -half, half, o.periodic_x, o.periodic_y()};
  if (!plate.disc) return all;
  const auto narrow = [&](double middle, double& from, double& to, bool& periodic) {
    if (to - from <= kWindow * plate.size) return;
    from = middle - 0.5 * kWindow * plate.size, to = middle + 0.5 * kWindow * plate.size;
    periodic = false;
  };
  narrow(plate.x, all.x_min, all.x_max, all.periodic_x);
  narrow(plate.y, all.y_min, all.y_max, all.periodic_y);
  return all;
}

std::vector<dem::Quad> grains_of(const Terrain& terrain) {
  TerrainFrame frame;
  terrain.gather_frame(frame);
  std::vector<dem::Quad> grains;
  grains.reserve(frame.radius.size());
  for (std::size_t g = 0; g < frame.radius.size(); ++g)
    grains.push_back({frame.position[3 * g], frame.position[3 * g + 1], frame.position[3 * g + 2], frame.radius[g]});
  return grains;
}

/// A plate above a bed, its motion and the forces on it.
class Press {
 public:
  Press(const Specimen& specimen, const PlateTest& test, const WorkCall& work)
      : specimen_(specimen), terrain_(specimen.terrain([this, &work] { work(share); })), plate_(over(test)) {
    terrain_->attach(plate_.mesh(), rough_material(specimen.options()), plate_.state());
    before_ = terrain_->gather_height_field();
    path_ = face_ - (surface_ - test.sinkage * r());
    interval_ = path_ / test.speed / test.samples;
    steps_ = std::max(1, static_cast<int>(std::ceil(interval_ / specimen.step())));
  }

  /// Takes one sample at this upward velocity. Returns the mean force on the plate, N.
  double move(double velocity) {
    plate_.set_velocity(Vec3(0.0, 0.0, velocity));
    const Outcome outcome = terrain_->advance({&plate_.state(), 1}, interval_, steps_, forces_, sums_);
    if (!outcome.ok) throw physics_error(outcome, "plate sinkage test: terrain");
    plate_.moved(interval_);
    face_ += velocity * interval_;
    return sums_[0].force.z();
  }

  double sinkage() const { return surface_ - face_; }  // m
  double interval() const { return interval_; }        // s
  double area() const { return area_; }                // m²
  double floor_force() const { return terrain_->gather_state().floor_force; }
  VolumeAccount account() const {
    const HeightField after = terrain_->gather_height_field();
    return volume_account(region_about(specimen_, print_), print_, area_, sinkage(), face_,
                          {specimen_.positions(), before_}, {grains_of(*terrain_), after}, r());
  }

  double share = 0.0;  // of the work

 private:
  double r() const { return specimen_.options().radius; }
  Tool over(const PlateTest& test) {
    const double half = 0.5 * specimen_.width(), width = test.width * r(), middle = 0.5 * specimen_.length();
    const double reach = test.disc ? 0.5 * width : half, sides = (test.sinkage + kSides) * r();
    print_ = {test.disc, middle, 0.0, width};
    area_ = test.disc ? std::numbers::pi * 0.25 * width * width : width * 2.0 * half;
    face_ = terrain_->gather_top_height(middle - 0.5 * width, middle + 0.5 * width, -reach, reach);
    surface_ =
        test.disc ? terrain_->gather_mean_height(middle - width, middle + width, -width, width) : specimen_.height();
    return test.disc ? disc_plate(middle, 0.0, width, face_, sides) : strip_plate(middle, width, half, face_, sides);
  }

  const Specimen& specimen_;
  Footprint print_;
  double area_ = 0.0, face_ = 0.0, surface_ = 0.0;  // m², heights of the plate's face and of the soil at first, m
  double path_ = 0.0, interval_ = 0.0;              // m, s
  int steps_ = 1;
  std::unique_ptr<Terrain> terrain_;
  Tool plate_;
  HeightField before_;
  std::vector<NodalForces> forces_{1};
  std::vector<ContactSums> sums_{1};
};

/// Lifts the plate until it bears almost nothing, and waits until the soil rests.
void unload(Press& press, const PlateTest& test, double load) {
  int lifting = 0;
  while (lifting++ < test.samples && press.move(test.speed) > kUnloaded * load) {
  }
  const int waiting = static_cast<int>(std::ceil(kRest * press.sinkage() / test.speed / press.interval()));
  for (int k = 0; k < waiting; ++k) press.move(0.0);
}

}  // namespace

PlateResult plate_sinkage(const Specimen& specimen, const PlateTest& test, const WorkCall& work) {
  FURROW_ASSERT(test.samples > 0 && test.speed > 0.0, test.samples, test.speed);
  const double width = test.width * specimen.options().radius;
  const double pressing = test.unload ? kPressing : 1.0;  // share of the work
  Press press(specimen, test, work);
  PlateResult result;
  result.disc = test.disc, result.size = width;
  result.curve.width = test.disc ? 0.5 * width : width;
  double off = 0.0, force = 0.0;
  for (int k = 0; k < test.samples; ++k) {
    const double begin = press.sinkage();
    force = press.move(-test.speed);
    press.share = pressing * (k + 1) / test.samples;
    // The force is the mean over the interval, so it belongs to the middle of the interval.
    result.curve.sinkage.push_back(0.5 * (begin + press.sinkage()));
    result.curve.pressure.push_back(force / press.area());
    if (2 * k >= test.samples) off += (press.floor_force() - specimen.weight() - force) / force;
  }
  const dem::DemOptions& o = specimen.options();
  const bool walls = !o.periodic_x || !o.periodic_y();  // walls, which bear a part of the load
  result.balance_error = walls ? std::numeric_limits<double>::quiet_NaN() : std::abs(off) / (0.5 * test.samples);
  result.volume = press.account();
  if (!test.unload) return result;
  const double deepest = press.sinkage();
  unload(press, test, force);
  result.unloaded = press.account();
  result.rebound = deepest - press.sinkage();
  return result;
}

}  // namespace furrow::terrain::soil
