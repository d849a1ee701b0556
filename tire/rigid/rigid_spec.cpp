#include "tire/rigid/rigid_spec.hpp"

#include <algorithm>
#include <numeric>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/files/nearest_words.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/cylinder.hpp"
#include "tire/rigid/grousers.hpp"
#include "tire/rigid/rigid_tire.hpp"
#include "tire/tire_file_chrono.hpp"

namespace furrow::tire {
namespace {

constexpr int kFacets = 96, kRows = 7;  // of a cylinder

constexpr const char* kRigid = "rigid";

/// What the options change of a rigid tire: its grousers.
void take_grousers(const TireOptions& options, TireDescription& d) {
  d.vertices += options.grousers * kGrouserVertices;
  if (options.grousers > 0) {
    d.grouser_height = options.grouser_height;
    d.grouser_thickness = options.grouser_thickness;
    d.facets = std::gcd(d.facets, options.grousers);
  }
  d.takes.insert(d.takes.end(), {"grousers", "grouser_height", "grouser_thickness"});
}
TireShape with_grousers(TireShape shape, const TireOptions& options) {
  if (options.grousers > 0) add_grousers(shape, options.grousers, options.grouser_height, options.grouser_thickness);
  return shape;
}

class RigidSpec final : public TireSpec {
 public:
  explicit RigidSpec(std::unique_ptr<TireSpec> flexible)
      : TireSpec(flexible->options()), flexible_(std::move(flexible)) {}

  TireDescription describe() const override {
    TireDescription d = flexible_->describe();
    d.kind = d.name = d.details = kRigid;
    d.coordinates = 0;
    d.memory = d.saved_bytes = 0.0;
    d.takes_tangents = d.deflects = false;
    d.follows_rim = true;
    d.own_contact.clear();
    d.vertical_stiffness = d.grip_stiffness = d.grip_damping = 0.0;
    d.static_only.clear();
    d.damping_time = d.step_share = 0.0;
    take_grousers(options(), d);
    return d;
  }
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    return std::make_unique<RigidTire>(shape(), context.gravity);
  }
  TireShape shape() const override { return with_grousers(flexible_->shape(), options()); }
  std::vector<std::filesystem::path> files() const override { return flexible_->files(); }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    return flexible_->unlikely_values();
  }

 private:
  std::unique_ptr<TireSpec> flexible_;
};

/// Keys of RigidTire.
struct RigidWheelFile {
  double radius = 0.0, width = 0.0;  // m
  double mass = 0.0;                 // kg
  std::array<double, 3> inertia{};   // about x, the axle, z, kg m²
  ContactBlock contact;
  std::vector<std::pair<std::string, std::string>> remarks;
};
void visit_fields(FieldsOf<RigidWheelFile> auto& s, auto&& visit) {
  visit(s.radius, needed("Radius", "m", keys::kSize, ""));
  visit(s.width, needed("Width", "m", keys::kSize.usual(0.02, 1.5), ""));
  visit(s.mass, needed("Mass", "kg", allowed::above(0).usual(0.05, 3000), ""));
}

class RigidWheelSpec final : public TireSpec {
 public:
  RigidWheelSpec(RigidWheelFile file, const TireOptions& options) : TireSpec(options), file_(std::move(file)) {}

  TireDescription describe() const override {
    TireDescription d;
    d.kind = d.name = d.details = kRigid;
    d.radius = file_.radius;
    d.width = d.tread_width = file_.width;
    d.vertices = kFacets * kRows + 2;
    d.facets = kFacets;
    d.mass = mass();
    d.deflects = false;
    d.follows_rim = true;
    d.takes = {"friction"};
    take_grousers(options(), d);
    return d;
  }
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    return std::make_unique<RigidTire>(shape(), context.gravity);
  }
  TireShape shape() const override {
    TireShape shape = cylinder(kFacets, file_.radius, file_.width, kRows);
    shape.material = file_.contact;
    options().apply_to(shape.material);
    shape.mass = mass();
    return with_grousers(std::move(shape), options());
  }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    auto odd = unusual_values(file_);
    const double most = file_.mass * file_.radius * file_.radius, spin = file_.inertia[1];
    if (spin > most)
      odd.emplace_back("Inertia", fmt::format("is {:g} kg m² about the axle, and the whole mass at the radius has {:g}",
                                              spin, most));
    else if (spin > file_.inertia[0] + file_.inertia[2])
      odd.emplace_back("Inertia", fmt::format("is {:g} kg m² about the axle, more than the sum of the others: no body "
                                              "has that",
                                              spin));
    odd.insert(odd.end(), file_.remarks.begin(), file_.remarks.end());
    return odd;
  }

 private:
  MassProperties mass() const {
    return {file_.mass, Vec3(file_.inertia[0], file_.inertia[1], file_.inertia[2]).asDiagonal()};
  }

  RigidWheelFile file_;
};

}  // namespace

std::unique_ptr<TireSpec> read_rigid_wheel(const nlohmann::json& file, const TireOptions& options) {
  JsonReader reader(file, options.file.string());
  RigidWheelFile f;
  for (const char* key : {"Name", "Type", "Template", "Visualization", "Contact Mesh", "rim"}) reader.skip(key);
  read_keys(reader, f);
  const std::vector<double> inertia = reader.numbers("Inertia", 3);
  for (std::size_t k = 0; k < 3; ++k) {
    if (!(inertia[k] > 0.0)) reader.fail("Inertia", fmt::format("holds {:g}, expected numbers above 0", inertia[k]));
    f.inertia[k] = inertia[k];
  }
  f.contact = read_chrono_contact(reader.child("Contact Material"));
  if (reader.has("Contact Mesh"))
    f.remarks.emplace_back("Contact Mesh", fmt::format("is left out: the wheel is a cylinder of {:g} m by {:g} m",
                                                       2.0 * f.radius, f.width));
  reader.finish();
  return std::make_unique<RigidWheelSpec>(std::move(f), options);
}

std::unique_ptr<TireSpec> make_rigid(std::unique_ptr<TireSpec> flexible) {
  return std::make_unique<RigidSpec>(std::move(flexible));
}

}  // namespace furrow::tire
