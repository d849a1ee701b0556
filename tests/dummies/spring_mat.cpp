#include "tests/dummies/spring_mat.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/outcome.hpp"
#include "protocol/files/json_fields.hpp"

namespace furrow::terrain {
namespace {

/// A tire on the mat.
struct Guest {
  std::vector<Vec3> position;  // now, m
  std::vector<double> area;    // of each vertex, m²
};

class SpringMat final : public Terrain {
 public:
  explicit SpringMat(const SpringMatOptions& options) : Terrain(true), options_(options) {}

  double do_prepare(const ProgressCall&) override { return 0.0; }
  double gather_top_height(double, double, double, double) const override { return 0.0; }
  double gather_mean_height(double, double, double, double) const override { return 0.0; }
  double floor_height() const override { return -1.0; }
  HeightField gather_height_field() const override {
    HeightField field;
    field.cell = 1.0;
    field.nx = field.ny = 1;
    field.height = {0.0};
    return field;
  }

  void do_attach(const SurfaceMesh& mesh, const ContactMaterial&, const SurfaceState& start) override {
    Guest guest{start.position, std::vector<double>(start.position.size(), 0.0)};
    for (const auto& [a, b, c] : mesh.triangles) {
      const Vec3 ab = start.position[b] - start.position[a], ac = start.position[c] - start.position[a];
      for (const int vertex : {a, b, c}) guest.area[vertex] += ab.cross(ac).norm() / 6.0;
    }
    guests_.push_back(std::move(guest));
  }

  Outcome do_advance(std::span<const SurfaceState> targets, double duration, int substeps,
                     std::span<NodalForces> forces, std::span<ContactSums> contact) override {
    contacts_ = 0;
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      forces[k].clear();
      contact[k] = {};
      for (std::size_t v = 0; v < guests_[k].position.size(); ++v)
        press(guests_[k], v, targets[k], duration, substeps, forces[k], contact[k]);
      work_ += contact[k].work;
      impulse_ -= duration * contact[k].force;
      contacts_ += contact[k].contacts;
    }
    return {};
  }

  TerrainState gather_state() const override {
    TerrainState state;
    for (const Guest& guest : guests_)
      for (std::size_t v = 0; v < guest.area.size(); ++v)
        state.elastic_energy +=
            0.5 * options_.mat_stiffness * guest.area[v] * std::pow(std::min(guest.position[v].z(), 0.0), 2);
    state.energies.elastic_normal = state.elastic_energy;
    state.energies.normal_damping_loss = damped_;
    state.energies.surface_work = -work_;
    state.momenta = held_by_the_world(impulse_);
    state.contacts = contacts_;
    return state;
  }
  std::int64_t size() const override { return 0; }
  void gather_frame(TerrainFrame& out) const override { out = {}; }

  void save(Archive& archive) const override {
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      save_value(archive, name(k) + "position", guests_[k].position);
      save_value(archive, name(k) + "area", guests_[k].area);
    }
    save_value(archive, "spring_mat/guests", static_cast<std::int64_t>(guests_.size()));
    save_value(archive, "spring_mat/work", work_);
    save_value(archive, "spring_mat/damped", damped_);
    save_value(archive, "spring_mat/impulse", impulse_);
  }
  void do_restore(const Archive& archive) override {
    std::int64_t count = 0;
    restore_value(archive, "spring_mat/guests", count);
    guests_.assign(count, {});
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      restore_value(archive, name(k) + "position", guests_[k].position);
      restore_value(archive, name(k) + "area", guests_[k].area);
    }
    restore_value(archive, "spring_mat/work", work_);
    restore_value(archive, "spring_mat/damped", damped_);
    restore_value(archive, "spring_mat/impulse", impulse_);
  }

 private:
  std::size_t attached() const override { return guests_.size(); }
  std::size_t vertices(std::size_t k) const override { return guests_[k].position.size(); }

  static std::string name(std::size_t k) { return "spring_mat/guest" + std::to_string(k) + "/"; }

  /// Moves vertex v to its target, with the force (1) on the way.
  void press(Guest& guest, std::size_t v, const SurfaceState& target, double duration, int substeps,
             NodalForces& forces, ContactSums& contact) {
    const Vec3 start = guest.position[v], end = target.position[v] + duration * target.velocity[v];
    const Vec3 velocity = (end - start) / duration;
    double mean = 0.0;  // N
    for (int s = 0; s < substeps; ++s) {
      const double z = start.z() + (end.z() - start.z()) * (s + 0.5) / substeps;
      if (!(z < 0.0)) continue;
      const double spring = -options_.mat_stiffness * z;
      const double pressure = std::max(spring - options_.mat_damping * velocity.z(), 0.0);
      damped_ -= guest.area[v] * (pressure - spring) * velocity.z() * duration / substeps;
      if (pressure > 0.0) mean += guest.area[v] * pressure / substeps;
    }
    guest.position[v] = end;
    if (mean == 0.0) return;
    const Vec3 force(0.0, 0.0, mean);
    forces.vertex.push_back(static_cast<int>(v));
    forces.force.push_back(force);
    contact.force += force;
    contact.normal += force;
    contact.work += force.dot(end - start);
    contact.contacts += 1;
  }

  SpringMatOptions options_;
  std::vector<Guest> guests_;
  Vec3 impulse_ = Vec3::Zero();  // by tires on the mat, N s
  double work_ = 0.0;            // of the mat on tires, J
  double damped_ = 0.0;          // J
  std::int64_t contacts_ = 0;
};

class SpringMatSpec final : public TerrainSpec {
 public:
  explicit SpringMatSpec(const SpringMatOptions& options) : options_(options) {}
  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "spring_mat";
    d.name = "spring mat";
    return d;
  }
  TerrainEstimate estimate(const TerrainContext&) const override {
    TerrainEstimate e;
    e.text = "springs under the plane z = 0";
    e.stable_reason = "no grains";
    return e;
  }
  std::unique_ptr<Terrain> make(const TerrainContext&) const override { return std::make_unique<SpringMat>(options_); }

 private:
  SpringMatOptions options_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_spring_mat(const nlohmann::json& section, const ReadContext& context) {
  SpringMatOptions options;
  read_fields(section, options);
  if (!(options.mat_stiffness > 0.0))
    throw input_error(context.file, context.key("mat_stiffness"), "is not above 0, expected N/m³");
  return std::make_unique<SpringMatSpec>(options);
}

}  // namespace furrow::terrain
