#include "terrain/soil/direct_shear.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <utility>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "terrain/dem/beds/bed_statistics.hpp"
#include "terrain/dem/beds/loaded_lid.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kLift = 0.3;         // radii by which the lower plate lifts the grains off the floor
constexpr double kClear = 0.5;        // initial radii between grains and lid
constexpr double kGrowSpeed = 0.05;   // m/s, of the lower teeth
constexpr double kLoadTime = 15.0;    // s per m of grain radius, time in which the load grows
constexpr double kMaxHold = 60.0;     // s per m of grain radius, for consolidation
constexpr double kRestSpeed = 2e-3;   // m/s: a slower lid is at rest
constexpr double kStartShare = 0.01;  // of the travel, in which the speed grows
constexpr double kBulkShare = 0.5;    // solid fraction for the lid's mass
constexpr double kNearFace = 4.0;     // radii below the face in which the solid fraction is measured

/// Sums over the grains next to the upper plate.
struct FaceSums {
  double rolls = 0.0, passes = 0.0;  // ω r, speed of the plate against the centre, m/s
  double sliding = 0.0, contacts = 0.0;
  double solid = 0.0, space = 0.0;  // m³
};

/// The cell with its two plates; the lower one is first.
class ShearCell {
 public:
  ShearCell(const Specimen& specimen, const ShearTest& test, std::function<void()> each_step)
      : specimen_(specimen),
        r_(specimen.options().radius),
        area_(specimen.length() * specimen.width()),
        load_(test.normal_stress * area_),
        terrain_(specimen.terrain(std::move(each_step))),
        tools_{lower(specimen, test, r_), upper(specimen, test, r_)},
        lid_(area_, test.normal_stress, kBulkShare * specimen.options().density, specimen.height(),
             dem::grain_modulus(specimen.options())) {
    ContactMaterial material = rough_material(specimen.options());
    terrain_->attach(tools_[0].mesh(), material, tools_[0].state());
    material.pair_friction = test.friction;
    terrain_->attach(tools_[1].mesh(), material, tools_[1].state());
    targets_ = {tools_[0].state(), tools_[1].state()};
    frame_.motion = true;
  }

  /// Takes one step. The lid moves at `speed` along x and bears `share` of its load, or keeps its height if it is
  /// negative.
  void step(double speed, double share) {
    const double dt = specimen_.step();
    const double vertical = share < 0.0 ? 0.0 : lid_.step(sums_[1].force.z(), share * load_, dt);
    tools_[1].set_velocity(Vec3(speed, 0.0, vertical));
    for (int k = 0; k < 2; ++k) targets_[k] = tools_[k].state();
    const Outcome outcome = terrain_->advance(targets_, dt, 1, forces_, sums_);
    if (!outcome.ok) throw physics_error(outcome, "direct shear test: terrain");
    for (Tool& tool : tools_) tool.moved(dt);
    height_ += dt * vertical;
  }

  /// Makes the lower plate's teeth grow out of the floor.
  void grow(const ShearTest& test) {
    const double time = (kLift + test.tooth) * r_ / kGrowSpeed;
    const auto steps = static_cast<int>(std::ceil(time / specimen_.step()));
    const double duration = steps * specimen_.step();
    for (std::size_t a = 0; a < teeth_.size(); ++a)
      tools_[0].set_velocity(a, Vec3(0.0, 0.0, (kLift * r_ + teeth_[a]) / duration));
    for (int k = 0; k < steps; ++k) step(0.0, -1.0);
    tools_[0].set_velocity(Vec3::Zero());
  }

  /// Loads the lid and waits until it rests.
  void consolidate() {
    const double dt = specimen_.step();
    const auto loading = static_cast<int>(std::ceil(kLoadTime * r_ / dt));
    for (int k = 0; k < loading; ++k) step(0.0, (k + 1.0) / loading);
    const auto most = static_cast<int>(std::ceil(kMaxHold * r_ / dt));
    int resting = 0;
    for (int k = 0; k < most && resting < loading / 4; ++k) {
      step(0.0, 1.0);
      const bool bears = std::abs(sums_[1].force.z() - load_) < 0.02 * load_;
      resting = bears && std::abs(lid_.velocity()) < kRestSpeed ? resting + 1 : 0;
    }
  }

  /// Adds the grains next to the upper plate, which moves at `speed` along x. @param face of the plate
  void look_at_face(double speed, Face face, FaceSums& sums) {
    terrain_->gather_frame(frame_);
    const double lowest = height_ - (face == Face::glued ? r_ : 0.0);
    for (std::size_t g = 0; g < frame_.radius.size(); ++g) {
      const double r = frame_.radius[g], z = frame_.position[3 * g + 2];
      if (lowest - z < 1.5 * r) {
        sums.rolls += r * frame_.spin[3 * g + 1];
        sums.passes += speed - frame_.velocity[3 * g];
      }
      sums.solid += dem::volume_below(r, z, lowest) - dem::volume_below(r, z, lowest - kNearFace * r_);
    }
    sums.space += kNearFace * r_ * area_;
    sums.sliding += static_cast<double>(sums_[1].sliding);
    sums.contacts += static_cast<double>(sums_[1].contacts);
  }

  double lid_height() const { return height_; }
  double area() const { return area_; }
  const ContactSums& lower_sums() const { return sums_[0]; }
  const ContactSums& upper_sums() const { return sums_[1]; }
  double floor_force() const { return terrain_->gather_state().floor_force; }
  /// Distance between the flats of the two plates, m.
  double gap() const { return height_ - kLift * r_; }

 private:
  Tool lower(const Specimen& s, const ShearTest& test, double r) {
    const double room = 3.0 * r;
    Tool sheet =
        toothed_sheet(-room, s.length() + room, 0.5 * s.width() + room, 0.0, test.pitch * r, test.tooth * r, 1);
    std::vector<Vec3> flat = sheet.state().position;
    for (Vec3& x : flat) teeth_.push_back(x.z()), x.z() = 0.0;
    return {sheet.mesh(), std::move(flat)};
  }
  /// A plate long enough to cover the cell at the end of its travel.
  Tool upper(const Specimen& s, const ShearTest& test, double r) {
    const double room = 3.0 * r;
    height_ = s.top() + (kLift + kClear + 2.0 * test.tooth) * r;
    const double from = -room - (test.travel + test.pitch) * r, to = s.length() + room, half = 0.5 * s.width() + room;
    if (test.face == Face::flat) return flat_sheet(from, to, half, height_);
    if (test.face == Face::glued) return studded_sheet(from, to, half, height_, r);
    return toothed_sheet(from, to, half, height_, test.pitch * r, test.tooth * r, -1);
  }

  const Specimen& specimen_;
  double r_, area_, load_;     // m, m², N
  double height_ = 0.0;        // of the lid's flats, m
  std::vector<double> teeth_;  // height to which each vertex of the lower plate grows, m
  std::unique_ptr<Terrain> terrain_;
  std::array<Tool, 2> tools_;
  dem::LoadedLid lid_;
  std::vector<SurfaceState> targets_;
  std::vector<NodalForces> forces_{2};
  std::vector<ContactSums> sums_{2};
  TerrainFrame frame_;
};

struct Sample {
  double shear = 0.0, normal = 0.0, below = 0.0, across = 0.0;
};

}  // namespace

const char* face_name(Face face) { return face == Face::teeth ? "teeth" : face == Face::flat ? "flat" : "glued"; }

ShearResult direct_shear(const Specimen& specimen, const ShearTest& test, const WorkCall& work) {
  FURROW_ASSERT(test.samples > 0 && test.speed > 0.0 && test.travel > 0.0, test.samples, test.speed, test.travel);
  constexpr double kPreparation = 0.35;  // of the work
  const double r = specimen.options().radius, dt = specimen.step(), travel = test.travel * r;
  double share = 0.0;
  ShearCell cell(specimen, test, [&] { work(share); });
  cell.grow(test);
  share = 0.1;
  cell.consolidate();
  share = kPreparation;

  ShearResult result;
  result.face = test.face;
  result.normal_nominal = test.normal_stress;
  result.height = cell.gap();
  const double start = cell.lid_height(), each = travel / test.samples;
  double j = 0.0, begun = 0.0, floor_off = 0.0, shear_off = 0.0, late_shear = 0.0;
  FaceSums face;
  const int half = test.samples - (test.samples + 1) / 2;         // samples from the half on
  const int quarter = test.samples - (3 * test.samples + 3) / 4;  // of the last quarter
  for (int k = 0; k < test.samples; ++k) {
    Sample sum;
    int steps = 0;
    double speed = 0.0;
    for (; steps == 0 || j < (k + 1) * each; ++steps) {
      speed = test.speed * std::clamp(j / (kStartShare * travel), 0.05, 1.0);
      cell.step(speed, 1.0);
      j += dt * speed;
      sum.shear -= cell.upper_sums().force.x();
      sum.normal += cell.upper_sums().force.z();
      sum.across += cell.lower_sums().force.x();
      sum.below += cell.floor_force() - cell.lower_sums().force.z();
    }
    share = kPreparation + (1.0 - kPreparation) * (k + 1) / test.samples;
    result.travel.push_back(0.5 * (begun + j));
    begun = j;
    result.shear.push_back(sum.shear / steps / cell.area());
    result.normal.push_back(sum.normal / steps / cell.area());
    result.rise.push_back(cell.lid_height() - start);
    if (2 * k >= test.samples) {
      result.normal_mean += result.normal.back() / half;
      floor_off += (sum.below - sum.normal) / steps - specimen.weight();
      shear_off += (sum.across - sum.shear) / steps;
      late_shear += sum.shear / steps;
      if (test.face != Face::teeth) cell.look_at_face(speed, test.face, face);
    }
    if (4 * k >= 3 * test.samples) result.final_shear += result.shear.back() / quarter;
  }
  result.floor_error = std::abs(floor_off / half) / (specimen.weight() + result.normal_mean * cell.area());
  result.shear_error = std::abs(shear_off) / std::max(std::abs(late_shear), 1e-300);
  result.janosi = fit_janosi(result.travel, result.shear);
  if (test.face == Face::teeth) return result;
  result.roll = face.rolls / face.passes;
  result.sliding = face.sliding / std::max(face.contacts, 1.0);
  result.solid = face.solid / face.space;
  return result;
}

}  // namespace furrow::terrain::soil
