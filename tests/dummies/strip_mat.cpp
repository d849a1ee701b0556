#include "tests/dummies/strip_mat.hpp"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"

namespace furrow::terrain {
namespace {

constexpr double kColumn = 0.02;       // w, m
constexpr double kYieldTime = 0.5;     // T, s
constexpr double kEvening = 1e-3;      // γ
constexpr float kFrameRadius = 0.01F;  // of the points that frames show, m

/// A tire on the mat.
struct Guest {
  std::vector<Vec3> position;  // now, m
  std::vector<double> area;    // of each vertex, m²
};

/// Push on a vertex in an interval.
struct Push {
  std::int32_t tire = 0, vertex = 0;
  double force = 0.0;  // mean, N
  double work = 0.0;   // on the tire, J
};

class StripMat final : public Terrain {
 public:
  StripMat(const StripMatOptions& options, std::shared_ptr<RankGroup> group)
      : options_(options), group_(std::move(group)) {
    const int columns = static_cast<int>(std::lround(std::ceil(options_.length / kColumn)));
    const int ranks = group_ ? group_->size() : 1, rank = group_ ? group_->rank() : 0;
    height_.assign(static_cast<std::size_t>(columns), 0.0);
    first_ = columns * rank / ranks;
    end_ = columns * (rank + 1) / ranks;
  }

  double do_prepare(const ProgressCall& progress) override {
    if (progress) progress("laying the mat", 0.5);
    exchange_heights();
    return 0.0;
  }
  double gather_top_height(double, double, double, double) const override {
    return *std::max_element(height_.begin(), height_.end());
  }
  double gather_mean_height(double, double, double, double) const override { return 0.0; }
  double floor_height() const override { return -1.0; }
  HeightField gather_height_field() const override {
    HeightField field;
    field.cell = kColumn;
    field.nx = static_cast<std::int32_t>(height_.size());
    field.ny = std::max(1, static_cast<int>(options_.width / kColumn));
    field.x0 = 0.5 * kColumn;
    field.y0 = -0.5 * kColumn * (field.ny - 1);
    for (const double h : height_) field.height.insert(field.height.end(), static_cast<std::size_t>(field.ny), h);
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
    std::vector<Push> own = own_vertices(targets, duration);
    for (int s = 0; s < substeps; ++s) {
      for (Push& push : own) press(push, targets, duration, s, substeps);
      exchange_heights();
      even_out();
    }
    std::erase_if(own, [](const Push& push) { return push.force == 0.0; });
    std::vector<Push> all = group_ ? gather_on_all<Push>(*group_, own) : own;
    std::sort(all.begin(), all.end(),
              [](const Push& a, const Push& b) { return std::pair(a.tire, a.vertex) < std::pair(b.tire, b.vertex); });
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      forces[k].clear();
      contact[k] = {};
    }
    for (const Push& push : all) add(push, duration, forces, contact);
    contacts_ = static_cast<std::int64_t>(all.size());
    for (std::size_t k = 0; k < guests_.size(); ++k)
      for (std::size_t v = 0; v < guests_[k].position.size(); ++v)
        guests_[k].position[v] = target(targets[k], v, duration);
    return {};
  }

  /// Its energy is the work done on it; the stored part is not known.
  TerrainState gather_state() const override {
    TerrainState state;
    state.energies.opening_loss = -work_;
    state.energies.surface_work = -work_;
    state.momenta = held_by_the_world(impulse_);
    state.contacts = contacts_;
    return state;
  }
  std::int64_t size() const override { return static_cast<std::int64_t>(height_.size()); }
  std::int64_t grains_here() const override { return end_ - first_; }
  void gather_frame(TerrainFrame& out) const override {
    out = {};
    for (int i = first_; i < end_; ++i) {
      for (const double x : {(i + 0.5) * kColumn, 0.0, height_[i]}) out.position.push_back(static_cast<float>(x));
      out.speed.push_back(0.0F);
      out.radius.push_back(kFrameRadius);
    }
  }

  void save(Archive& archive) const override {
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      save_value(archive, name(k) + "position", guests_[k].position);
      save_value(archive, name(k) + "area", guests_[k].area);
    }
    save_value(archive, "strip_mat/guests", static_cast<std::int64_t>(guests_.size()));
    save_value(archive, "strip_mat/height", std::vector<double>(height_.begin() + first_, height_.begin() + end_));
    save_value(archive, "strip_mat/contacts", contacts_);
    save_value(archive, "strip_mat/work", work_);
    save_value(archive, "strip_mat/impulse", impulse_);
  }
  void do_restore(const Archive& archive) override {
    std::int64_t count = 0;
    restore_value(archive, "strip_mat/guests", count);
    guests_.assign(static_cast<std::size_t>(count), {});
    for (std::size_t k = 0; k < guests_.size(); ++k) {
      restore_value(archive, name(k) + "position", guests_[k].position);
      restore_value(archive, name(k) + "area", guests_[k].area);
    }
    std::vector<double> own;
    restore_value(archive, "strip_mat/height", own);
    if (own.size() != static_cast<std::size_t>(end_ - first_))
      throw Error(ExitCode::io, "saved state 'strip_mat/height' is not this rank's");
    std::copy(own.begin(), own.end(), height_.begin() + first_);
    others_known_ = false;  // the others restore theirs now
    restore_value(archive, "strip_mat/contacts", contacts_);
    restore_value(archive, "strip_mat/work", work_);
    restore_value(archive, "strip_mat/impulse", impulse_);
  }

 private:
  std::size_t attached() const override { return guests_.size(); }
  std::size_t vertices(std::size_t k) const override { return guests_[k].position.size(); }

  static std::string name(std::size_t k) { return "strip_mat/guest" + std::to_string(k) + "/"; }

  static Vec3 target(const SurfaceState& surface, std::size_t v, double duration) {
    return surface.position[v] + duration * surface.velocity[v];
  }
  int column(double x) const {
    return std::clamp(static_cast<int>(std::floor(x / kColumn)), 0, static_cast<int>(height_.size()) - 1);
  }

  /// Vertices that end above a column of this rank; they press this column during the whole interval.
  std::vector<Push> own_vertices(std::span<const SurfaceState> targets, double duration) {
    if (!others_known_) exchange_heights();
    std::vector<Push> own;
    for (std::size_t k = 0; k < guests_.size(); ++k)
      for (std::size_t v = 0; v < guests_[k].position.size(); ++v) {
        const int i = column(target(targets[k], v, duration).x());
        if (i >= first_ && i < end_) own.push_back({static_cast<std::int32_t>(k), static_cast<std::int32_t>(v)});
      }
    return own;
  }

  /// Computes (1) in the middle of substep s, and the yielding of (2).
  void press(Push& push, std::span<const SurfaceState> targets, double duration, int s, int substeps) {
    const Guest& guest = guests_[push.tire];
    const Vec3 start = guest.position[push.vertex], end = target(targets[push.tire], push.vertex, duration);
    const double rate = (end.z() - start.z()) / duration, z = start.z() + (end.z() - start.z()) * (s + 0.5) / substeps;
    double& height = height_[column(end.x())];
    if (!(z < height)) return;
    const double area = guest.area[push.vertex];
    const double force = std::max(area * (options_.stiffness * (height - z) - options_.damping * rate), 0.0);
    push.force += force / substeps;
    push.work += force * (end.z() - start.z()) / substeps;
    height -= duration / substeps / kYieldTime * force / (options_.stiffness * kColumn * options_.width);
  }

  void exchange_heights() {
    others_known_ = true;
    if (!group_) return;
    const std::span<const double> own(height_.data() + first_, static_cast<std::size_t>(end_ - first_));
    height_ = gather_on_all<double>(*group_, own);
  }
  void even_out() {
    const std::vector<double> before = height_;
    for (std::size_t i = 1; i + 1 < before.size(); ++i)
      height_[i] += kEvening * (before[i - 1] - 2.0 * before[i] + before[i + 1]);
  }

  void add(const Push& push, double duration, std::span<NodalForces> forces, std::span<ContactSums> contact) {
    const Vec3 force(0.0, 0.0, push.force);
    forces[push.tire].vertex.push_back(push.vertex);
    forces[push.tire].force.push_back(force);
    ContactSums& sums = contact[push.tire];
    sums.force += force;
    sums.normal += force;
    sums.work += push.work;
    sums.contacts += 1;
    work_ += push.work;
    impulse_ -= duration * force;
  }

  StripMatOptions options_;
  std::shared_ptr<RankGroup> group_;
  std::vector<double> height_;  // of all columns, m
  int first_ = 0, end_ = 0;     // this rank's
  bool others_known_ = false;
  std::vector<Guest> guests_;
  Vec3 impulse_ = Vec3::Zero();  // by tires on the mat, N s
  double work_ = 0.0;            // of the mat on tires, J
  std::int64_t contacts_ = 0;
};

class StripMatSpec final : public TerrainSpec {
 public:
  explicit StripMatSpec(const StripMatOptions& options) : options_(options) {}
  TerrainDescription describe() const override {
    TerrainDescription d;
    d.engine = "strip_mat";
    d.name = "strip mat";
    d.most_ranks = 8;
    d.bounds = {options_.length, options_.width};
    d.undisturbed_height = 0.0;
    return d;
  }
  TerrainEstimate estimate(const TerrainContext&) const override {
    TerrainEstimate e;
    e.text = "columns that yield";
    e.stable_reason = "no grains";
    return e;
  }
  std::unique_ptr<Terrain> make(const TerrainContext& context) const override {
    return std::make_unique<StripMat>(options_, context.group);
  }

 private:
  StripMatOptions options_;
};

}  // namespace

std::unique_ptr<TerrainSpec> read_strip_mat(const nlohmann::json& section, const ReadContext&) {
  StripMatOptions options;
  read_fields(section, options);
  return std::make_unique<StripMatSpec>(options);
}

}  // namespace furrow::terrain
