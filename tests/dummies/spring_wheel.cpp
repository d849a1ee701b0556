#include "tests/dummies/spring_wheel.hpp"

#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/constants.hpp"
#include "protocol/core/mean_turn.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/files/json_reader.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/tire_file_reader.hpp"

namespace furrow::tire {
namespace {

constexpr double kMostDeflection = 0.5;  // of the radius
const Vec3 kGravity(0.0, 0.0, -kStandardGravity);

/// Radial direction of spoke k in rim axes.
Vec3 direction(int k, int spokes) {
  const double angle = 2.0 * std::numbers::pi * k / spokes;
  return {std::sin(angle), 0.0, std::cos(angle)};
}

TireShape wheel_shape(const SpringWheelOptions& o) {
  TireShape shape;
  for (int k = 0; k < o.spokes; ++k)
    for (const double side : {0.5, -0.5})
      shape.vertex.push_back(o.radius * direction(k, o.spokes) + Vec3(0.0, side * o.width, 0.0));
  for (int k = 0; k < o.spokes; ++k) {
    const int left = 2 * k, right = left + 1, next_left = 2 * ((k + 1) % o.spokes), next_right = next_left + 1;
    shape.mesh.triangles.push_back({right, next_right, left});
    shape.mesh.triangles.push_back({next_right, next_left, left});
  }
  shape.mesh.vertex_count = 2 * o.spokes;
  const double spin = 0.5 * o.mass * o.radius * o.radius, other = 0.5 * spin + o.mass * o.width * o.width / 12.0;
  shape.mass = {o.mass, Vec3(other, spin, other).asDiagonal()};
  shape.radius = o.radius;
  shape.tread_width = o.width;
  return shape;
}

/// Contact properties of the tread, for every contact law.
ContactMaterial rubber() {
  ContactMaterial m;
  m.young_modulus = 1e7;
  m.poisson_ratio = 0.45;
  m.friction = 0.8;
  m.restitution = 0.2;
  m.normal_stiffness = 1e6;
  m.normal_damping = 30.0;
  return m;
}

class SpringWheel final : public Tire {
 public:
  SpringWheel(const SpringWheelOptions& options, TireShape shape)
      : Tire(kGravity, std::move(shape)),
        options_(options),
        deflection_(shape_.vertex.size()),
        rate_(shape_.vertex.size()) {}

  int coordinates() const override { return static_cast<int>(deflection_.size()); }

  void do_place(const RimState& rim) override {
    rim_ = rim;
    spindle_ = {};
    dissipation_ = numerical_loss_ = 0.0;
    deflection_.assign(shape_.vertex.size(), 0.0);
    rate_.assign(shape_.vertex.size(), 0.0);
  }

  void surface(SurfaceState& out) const override {
    const Mat3 turn = rim_.orientation.toRotationMatrix();
    out.position.resize(deflection_.size());
    out.velocity.resize(deflection_.size());
    for (std::size_t v = 0; v < deflection_.size(); ++v) {
      const Vec3 outwards = turn * direction_of(v), arm = turn * shape_.vertex[v] - deflection_[v] * outwards;
      out.position[v] = rim_.position + arm;
      out.velocity[v] = rim_.velocity + rim_.angular_velocity.cross(arm) - rate_[v] * outwards;
    }
  }

  Outcome do_advance(const RimTrajectory& rim, const NodalForces& forces, int substeps) override {
    const RimState &start = rim.start(), &end = rim.end();
    const Mat3 turn = rim.at(0.5).state.orientation.toRotationMatrix();
    spindle_.force = shape_.mass.mass * (kGravity - (end.velocity - start.velocity) / rim.duration());
    spindle_.moment = -(angular_momentum(end) - angular_momentum(start)) / rim.duration();
    std::vector<double> inwards(deflection_.size(), 0.0);  // force on each vertex, N
    for (std::size_t i = 0; i < forces.vertex.size(); ++i) {
      const std::size_t v = static_cast<std::size_t>(forces.vertex[i]);
      const Vec3 outwards = turn * direction_of(v);
      inwards[v] = -forces.force[i].dot(outwards);
      spindle_.force += forces.force[i];
      spindle_.moment += (turn * shape_.vertex[v] - deflection_[v] * outwards).cross(forces.force[i]);
    }
    book_rim_loss(start, end, rim.duration());
    const double step = rim.duration() / substeps;
    for (int s = 0; s < substeps; ++s)
      for (std::size_t v = 0; v < deflection_.size(); ++v) spring(v, inwards[v], step);
    rim_ = end;
    for (std::size_t v = 0; v < deflection_.size(); ++v)
      if (!(deflection_[v] < kMostDeflection * options_.radius))
        return Outcome::failure("reached its rim", fmt::format("vertex {} is {:g} m deep", v, deflection_[v]));
    return {};
  }

  TireDiagnostics diagnostics() const override {
    TireDiagnostics d;
    d.momentum = shape_.mass.mass * rim_.velocity;
    d.kinetic_energy = 0.5 * (d.momentum.dot(rim_.velocity) + rim_.angular_velocity.dot(angular_momentum(rim_)));
    d.elastic_energy = d.pressure_energy = d.solver_loss = 0.0;
    for (const double u : deflection_) d.elastic_energy += 0.5 * options_.stiffness * u * u;
    d.potential_energy = -shape_.mass.mass * kGravity.dot(rim_.position);
    d.dissipation = dissipation_;
    d.numerical_loss = numerical_loss_;
    d.solver_impulse = Vec3::Zero();
    return d;
  }

  void add_state(Hash& hash) const override { hash.add(std::span<const double>(deflection_)); }

  void save(Archive& archive) const override {
    save_fields(archive, "spring_wheel/rim", rim_);
    save_fields(archive, "spring_wheel/spindle", spindle_);
    save_value(archive, "spring_wheel/deflection", deflection_);
    save_value(archive, "spring_wheel/rate", rate_);
    save_value(archive, "spring_wheel/dissipation", dissipation_);
    save_value(archive, "spring_wheel/numerical_loss", numerical_loss_);
  }
  void do_restore(const Archive& archive) override {
    restore_fields(archive, "spring_wheel/rim", rim_);
    restore_fields(archive, "spring_wheel/spindle", spindle_);
    restore_value(archive, "spring_wheel/deflection", deflection_, shape_.vertex.size());
    restore_value(archive, "spring_wheel/rate", rate_, shape_.vertex.size());
    restore_value(archive, "spring_wheel/dissipation", dissipation_);
    restore_value(archive, "spring_wheel/numerical_loss", numerical_loss_);
  }

 private:
  Vec3 direction_of(std::size_t vertex) const { return direction(static_cast<int>(vertex) / 2, options_.spokes); }

  Vec3 angular_momentum(const RimState& rim) const {
    const Mat3 turn = rim.orientation.toRotationMatrix();
    return turn * (shape_.mass.inertia * (turn.transpose() * rim.angular_velocity));
  }

  /// Solves (1) over one step.
  void spring(std::size_t v, double inwards, double step) {
    const double c = options_.damping, before = deflection_[v];
    deflection_[v] = (c * before + step * inwards) / (c + step * options_.stiffness);
    rate_[v] = (deflection_[v] - before) / step;
    const double change = deflection_[v] - before;
    dissipation_ += c * rate_[v] * change;
    numerical_loss_ += 0.5 * options_.stiffness * change * change;
  }

  /// Records the loss of the backward differences of the rim's motion.
  void book_rim_loss(const RimState& from, const RimState& to, double duration) {
    const Vec3 before = angular_momentum(from), after = angular_momentum(to);
    const Vec3 way = (to.position - from.position) / duration - 0.5 * (from.velocity + to.velocity),
               turn = mean_turn(from.orientation, to.orientation) / duration -
                      0.5 * (from.angular_velocity + to.angular_velocity);
    numerical_loss_ += shape_.mass.mass * (to.velocity - from.velocity).dot(way) + (after - before).dot(turn) +
                       0.5 * (from.angular_velocity.dot(after) - to.angular_velocity.dot(before));
  }

  SpringWheelOptions options_;
  std::vector<double> deflection_, rate_;            // u, m; u̇, m/s
  double dissipation_ = 0.0, numerical_loss_ = 0.0;  // J
};

class SpringWheelSpec final : public TireSpec {
 public:
  SpringWheelSpec(const SpringWheelOptions& wheel, const TireOptions& options)
      : TireSpec(options), wheel_(wheel), shape_(wheel_shape(wheel)) {
    shape_.material = rubber();
    if (options.friction >= 0.0) shape_.material.friction = options.friction;
  }
  TireDescription describe() const override {
    TireDescription d;
    d.kind = "spring_wheel";
    d.name = "spring wheel";
    d.details = fmt::format("{} radial springs", shape_.vertex.size());
    d.radius = wheel_.radius;
    d.width = d.tread_width = wheel_.width;
    d.coordinates = d.vertices = static_cast<int>(shape_.vertex.size());
    d.facets = wheel_.spokes;
    d.mass = shape_.mass;
    d.takes = {"friction"};
    d.damping_time = wheel_.damping / wheel_.stiffness;
    d.step_share = 0.1;
    return d;
  }
  std::unique_ptr<Tire> make(const TireContext&) const override {
    return std::make_unique<SpringWheel>(wheel_, shape_);
  }
  TireShape shape() const override { return shape_; }

 private:
  SpringWheelOptions wheel_;
  TireShape shape_;
};

}  // namespace

std::unique_ptr<TireSpec> read_spring_wheel(const nlohmann::json& file, const TireOptions& options) {
  SpringWheelOptions wheel;
  JsonReader reader(file, options.file.string());
  take_common_keys(reader);
  read_keys(reader, wheel);
  reader.finish();
  return std::make_unique<SpringWheelSpec>(wheel, options);
}

}  // namespace furrow::tire
