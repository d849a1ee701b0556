#include "tire/planar/planar_spec.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/cylinder.hpp"
#include "tire/planar/planar_carcass.hpp"
#include "tire/planar/planar_modes.hpp"
#include "tire/planar/planar_press.hpp"
#include "tire/planar/planar_tire.hpp"
#include "tire/tire_file_reader.hpp"

namespace furrow::tire {
namespace {

constexpr double kBytesPerElement = 3000.0;  // of the static test's factor
constexpr double kSavedBytes = 32.0;         // of a node

void check(const PlanarFile& f) {
  const PlanarWheelSize& s = f.params.size;
  if (!(s.rim_radius < s.radius))
    throw input_error(f.path, "rim_radius",
                      fmt::format("is {:g} m, expected less than the radius of {:g} m", s.rim_radius, s.radius));
  const int most = std::min(kMostRings, planar_most_rings(s.rim_radius, s.radius, s.around));
  if (s.rings > most)
    throw input_error(
        f.path, "elements_radial",
        fmt::format("is {}, expected 1 to {} for {} elements around: more cut each other", s.rings, most, s.around));
}

class PlanarSpec final : public TireSpec {
 public:
  PlanarSpec(const PlanarFile& given, PlanarFile file, const TireOptions& options)
      : TireSpec(options), file_(std::move(file)), unusual_(unusual_values(given)) {}

  TireDescription describe() const override;
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    PlanarFile file = file_;
    if (context.ground_friction) file.params.friction = std::min(file.params.friction, *context.ground_friction);
    return make_planar_tire(file, shape(), context.gravity, context.ground_profile);
  }
  TireShape shape() const override {
    TireShape shape = cylinder(file_.params.size.around, file_.params.size.radius, file_.params.options.width);
    shape.material = file_.contact;
    shape.mass = mass();
    return shape;
  }
  std::unique_ptr<StaticTest> static_test() const override {
    return static_test_of([params = file_.params, mass = mass()](const auto& options, const auto& progress) {
      return press_planar(params, mass, options, progress);
    });
  }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override { return unusual_; }
  /// On a rim that replaces the disc.
  std::unique_ptr<ModalTest> modal_test() const override {
    PlanarParams params = file_.params;
    params.disc_in_run = PlanarDisc::rigid;
    return std::make_unique<PlanarModes>(params);
  }

 private:
  MassProperties mass() const { return planar_mass(file_.params); }

  PlanarFile file_;
  std::vector<std::pair<std::string, std::string>> unusual_;  // of the file without the scenario's changes
};

TireDescription PlanarSpec::describe() const {
  const PlanarParams& p = file_.params;
  const PlanarMesh mesh = planar_wheel(p.size);  // that is pressed
  const PlanarCarcass carcass(p);
  const double limit = carcass.step_limit();
  TireDescription d;
  d.kind = "planar";
  d.name = "planar finite-element tire";
  d.details = fmt::format("{} x {} triangles, {} coordinates, explicit steps of at most {:.3g} s", p.size.around,
                          2 * p.size.rings, 2 * carcass.mesh().nodes(), p.step_share * limit);
  d.radius = p.size.radius;
  d.width = d.tread_width = p.options.width;
  d.section_height = p.size.radius - p.size.rim_radius;
  d.coordinates = 2 * carcass.mesh().nodes();
  d.vertices = 2 * p.size.around + 2;
  d.facets = p.size.around;
  d.mass = mass();
  d.memory = kBytesPerElement * mesh.elements();
  d.saved_bytes = kSavedBytes * carcass.mesh().nodes();
  if (p.contact == PlanarContactOf::penalty)
    d.own_contact = "whose key contact_law 'penalty' holds for rigid ground that is alike across",
    d.own_contact_in_plane = true;
  d.takes = {"friction", "elements_circumference"};
  d.model = {{"elements", static_cast<double>(carcass.mesh().elements())}, {"step_limit_s", limit}};
  return d;
}

/// Applies the scenario's choices instead of the file's. A change of the number of elements around changes the number
/// through the tire by the same factor.
void apply(PlanarFile& file, const TireOptions& options) {
  options.apply_to(file.contact);
  file.params.friction = file.contact.friction;
  if (options.elements_circumference == 0) return;
  const int around = options.elements_circumference;
  if (around < kLeastAround || around > kMostAround)
    throw input_error(file.path, "elements_circumference",
                      fmt::format("is {}, expected {} to {}", around, kLeastAround, kMostAround));
  PlanarWheelSize& size = file.params.size;
  const double rings = static_cast<double>(size.rings) * around / size.around;
  size.around = around;
  size.rings = std::clamp(static_cast<int>(std::lround(rings)), 1,
                          std::min(kMostRings, planar_most_rings(size.rim_radius, size.radius, around)));
}

}  // namespace

PlanarFile read_planar_file(const nlohmann::json& document, const std::string& path) {
  JsonReader reader(document, path);
  take_common_keys(reader);
  PlanarFile f;
  f.path = path;
  PlanarParams& p = f.params;
  read_keys(reader, f);
  p.options.averaged = f.volume == PlanarVolume::averaged;
  p.friction = f.contact.friction;
  reader.finish();
  check(f);
  return f;
}

std::unique_ptr<TireSpec> read_planar(const nlohmann::json& file, const TireOptions& options) {
  const PlanarFile given = read_planar_file(file, options.file.string());
  PlanarFile planar = given;
  apply(planar, options);
  return std::make_unique<PlanarSpec>(given, std::move(planar), options);
}

}  // namespace furrow::tire
