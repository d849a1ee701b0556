#include "tire/planar/tread_contact.hpp"

#include <algorithm>
#include <utility>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr double kEnd = 1e6;  // m from the middle of the world, where no run gets

class TreadContact final : public PlaneContact {
 public:
  TreadContact(const PlanarMesh& mesh, std::vector<int> tread, std::vector<double> mass, const PlanarContactLaw& law,
               PlanarGround ground)
      : tread_(std::move(tread)),
        mass_(std::move(mass)),
        contact_(mesh, std::move(ground), law),
        world_{PlanarField(mass_.size()), PlanarField(mass_.size())},
        across_(mass_.size(), 0.0),
        pressed_(mass_.size(), Vec3::Zero()),
        rubbed_(mass_.size(), Vec3::Zero()) {}

  void begin() override {
    std::ranges::fill(pressed_, Vec3::Zero());
    std::ranges::fill(rubbed_, Vec3::Zero());
  }
  void place(const PlaneFrame& frame) override { frame_ = frame; }
  void add(const PlanarField& x, const PlanarField& v, double step, double time, PlanarField& force) override;
  void state(const PlanarField& x, double duration, StatedContact& out) override;

 private:
  void move(const PlanarField& x);

  std::vector<int> tread_;
  std::vector<double> mass_;
  RubbingContact contact_;
  PlaneFrame frame_;
  PlanarState world_;                   // of the tread, in x and z
  std::vector<double> across_;          // velocities along y, m/s
  std::vector<Vec3> pressed_, rubbed_;  // impulses on nodes in the interval: of the law's F and of its friction, N s
};

void TreadContact::move(const PlanarField& x) {
  for (const int n : tread_) {
    const Vec3 at = frame_.centre + frame_.plane.out({x.x[n], x.z[n]});
    world_.x.x[n] = at.x(), world_.x.z[n] = at.z();
  }
}

void TreadContact::add(const PlanarField& x, const PlanarField& v, double step, double time, PlanarField& force) {
  move(x);
  for (const int n : tread_) {
    const Vec3 u =
        frame_.plane.out({v.x[n], v.z[n]}) + frame_.lateral + frame_.tilt.cross(frame_.plane.out({x.x[n], x.z[n]}));
    world_.v.x[n] = u.x(), world_.v.z[n] = u.z(), across_[n] = u.y();
  }
  contact_.rub(world_, mass_, step, across_);
  for (const PlanarTouch& t : contact_.touches()) {
    const Vec3 press = t.force * Vec3(t.push_x, 0.0, t.push_z),
               rub = t.friction * Vec3(t.push_z, 0.0, -t.push_x) + t.across * Vec3::UnitY();
    const PlanarPoint in = frame_.plane.in(press + rub);
    for (const auto& [n, share] : {std::pair{t.a, 1.0 - t.share}, std::pair{t.other(), t.share}}) {
      pressed_[n] += time * share * press, rubbed_[n] += time * share * rub;
      force.x[n] += share * in.x, force.z[n] += share * in.z;
    }
  }
}

void TreadContact::state(const PlanarField& x, double duration, StatedContact& out) {
  FURROW_ASSERT(duration > 0.0, duration);
  out.given = true;
  out.forces.clear();
  out.friction.clear();
  for (std::size_t k = 0; k < tread_.size(); ++k) {
    const Vec3 friction = 0.5 / duration * rubbed_[tread_[k]], force = 0.5 / duration * pressed_[tread_[k]] + friction;
    if (force.isZero(0.0)) continue;
    for (const std::size_t vertex : {2 * k, 2 * k + 1}) {
      out.forces.vertex.push_back(static_cast<int>(vertex));
      out.forces.force.push_back(force);
      out.friction.push_back(friction);
    }
  }
  move(x);
  contact_.find(world_.x);
  out.energy = contact_.energy();
}

}  // namespace

PlanarGround endless_ground(const GroundProfilePoints& points) {
  const double before = points.empty() ? 0.0 : points.front()[1], after = points.empty() ? 0.0 : points.back()[1];
  std::vector<PlanarPoint> all{{-kEnd, before}};
  for (const auto& [x, z] : points) all.push_back({x, z});
  all.push_back({kEnd, after});
  return PlanarGround(std::move(all));
}

std::unique_ptr<PlaneContact> make_tread_contact(const PlanarMesh& mesh, const std::vector<int>& tread,
                                                 const std::vector<double>& mass, const PlanarContactLaw& law,
                                                 const GroundProfilePoints& ground) {
  return std::make_unique<TreadContact>(mesh, tread, mass, law, endless_ground(ground));
}

}  // namespace furrow::tire
