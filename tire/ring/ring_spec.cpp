#include "tire/ring/ring_spec.hpp"

#include <algorithm>
#include <array>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/nearest_words.hpp"
#include "protocol/files/reader_fields.hpp"
#include "tire/cylinder.hpp"
#include "tire/extruded/extruded_tire.hpp"
#include "tire/pressure_text.hpp"
#include "tire/ring/ring_carcass.hpp"
#include "tire/ring/ring_modes.hpp"
#include "tire/ring/ring_press.hpp"
#include "tire/tire_file_reader.hpp"

namespace furrow::tire {
namespace {

constexpr double kMostDraw = 0.5;  // of the radius: with more, the sidewall is too soft for its pressure
constexpr double kBytesPerSegment = 1200.0;
constexpr double kSavedBytes = 32.0;  // of a segment
constexpr double kStepShare = 0.04;   // of τ: contact forces come one step late

void check(const RingFile& f) {
  const RingParams& p = f.params;
  const RingMotion& m = f.motion;
  if (!(m.rim_radius < p.radius))
    throw input_error(f.path, "rim_radius",
                      fmt::format("is {:g} m, expected less than the radius of {:g} m", m.rim_radius, p.radius));
  const double least = m.mass * m.rim_radius * m.rim_radius, most = m.mass * p.radius * p.radius;
  if (!(m.spin_inertia > least && m.spin_inertia < most))
    throw input_error(
        f.path, "spin_inertia",
        fmt::format("is {:g} kg m², expected between {:.4g} and {:.4g} kg m²: the whole mass at the rim's "
                    "radius, and at the belt's",
                    m.spin_inertia, least, most));
  if (p.sidewall_2 * p.sidewall_2 > 3.0 * p.sidewall_1 * p.sidewall_3)
    throw input_error(f.path, "sidewall",
                      fmt::format("is {:g}, {:g}, {:g}: the force falls somewhere, expected k2² at most 3 k1 k3",
                                  p.sidewall_1, p.sidewall_2, p.sidewall_3));
}

void check_pressure(const RingFile& f, double pressure, const std::string& key) {
  RingParams p = f.params;
  p.pressure = pressure;
  const double draw = sidewall_draw(p);
  if (!(draw < kMostDraw * f.params.radius))
    throw input_error(f.path, key,
                      fmt::format("at {:g} Pa the sidewall is drawn out by {:.3g} m, expected less than {:.3g} m, half "
                                  "of the radius: a stiffer sidewall or less pressure",
                                  pressure, draw, kMostDraw * f.params.radius));
}

class RingSpec final : public TireSpec {
 public:
  RingSpec(const RingFile& given, RingFile file, const TireOptions& options)
      : TireSpec(options),
        file_(std::move(file)),
        file_segments_(given.params.segments),
        unusual_(unusual_values(given)) {}

  TireDescription describe() const override;
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    return make_extruded_tire(std::make_unique<RingCarcass>(file_.params, file_.motion), shape(), context.gravity);
  }
  TireShape shape() const override;
  std::unique_ptr<StaticTest> static_test() const override {
    return static_test_of([file = file_, mass = mass()](const auto& options, const auto& progress) {
      return press_ring(file.params, file.motion.rim_radius, mass, options, progress);
    });
  }
  std::unique_ptr<ModalTest> modal_test() const override {
    return std::make_unique<RingModes>(file_.params, file_.motion, mass());
  }

  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    auto odd = unusual_;
    if (const std::string text = unusual_text(file_.sidewall[0], 1e3, 1e9, "N/m"); !text.empty())
      odd.emplace_back("sidewall", "k1, " + text);
    if (file_.params.segments < file_segments_)
      odd.emplace_back("segments",
                       fmt::format("of the file is {}, the scenario's tire.elements_circumference makes it {}: the "
                                   "force of fewer segments is rougher",
                                   file_segments_, file_.params.segments));
    return odd;
  }

 private:
  MassProperties mass() const {
    return {file_.motion.mass,
            Vec3(file_.diametral_inertia, file_.motion.spin_inertia, file_.diametral_inertia).asDiagonal()};
  }

  RingFile file_;
  // Of the file without the scenario's changes:
  int file_segments_;
  std::vector<std::pair<std::string, std::string>> unusual_;
};

TireDescription RingSpec::describe() const {
  const RingParams& p = file_.params;
  TireDescription d;
  d.kind = "ring";
  d.name = "flexible ring";
  PressureSchedule pressure = options().pressure;
  if (pressure.empty()) pressure.knots = {{0.0, p.pressure}};
  d.details = fmt::format("{} segments, {} coordinates, {}", p.segments, 2 * p.segments, pressure_text(pressure));
  d.radius = p.radius;
  d.width = d.tread_width = p.width;
  d.section_height = p.radius - file_.motion.rim_radius;
  d.coordinates = 2 * p.segments;
  d.vertices = 2 * p.segments + 2;
  d.facets = p.segments;
  d.mass = mass();
  d.memory = kBytesPerSegment * p.segments;
  d.saved_bytes = kSavedBytes * p.segments;
  d.takes = {"pressure", "friction", "elements_circumference", "structural_damping"};
  d.damping_time = file_.motion.damping;
  d.step_share = kStepShare;
  d.model = {{"draw_m", sidewall_draw(p)}, {"belt_mass_kg", belt_mass(file_.motion, p.radius)}};
  return d;
}

TireShape RingSpec::shape() const {
  TireShape shape = cylinder(file_.params.segments, file_.params.radius, file_.params.width);
  shape.material = file_.contact;
  shape.mass = mass();
  return shape;
}

/// Applies the scenario's choices instead of the file's.
void apply(RingFile& file, const TireOptions& options) {
  if (!options.pressure.empty()) file.params.pressure = options.pressure.at(0.0);
  options.apply_to(file.contact);
  if (options.structural_damping >= 0.0) file.motion.damping = options.structural_damping;
  if (options.elements_circumference == 0) return;
  if (options.elements_circumference < kMinSegments || options.elements_circumference > kMaxSegments)
    throw input_error(
        file.path, "segments",
        fmt::format("is {}, expected {} to {}", options.elements_circumference, kMinSegments, kMaxSegments));
  file.params.segments = options.elements_circumference;
}

}  // namespace

RingFile read_ring_file(const nlohmann::json& document, const std::string& path) {
  JsonReader reader(document, path);
  take_common_keys(reader);
  RingFile f;
  f.path = path;
  RingParams& p = f.params;
  read_keys(reader, f);
  const auto& k = f.sidewall;
  if (!(k[0] > 0.0 && k[1] >= 0.0 && k[2] >= 0.0))
    reader.fail("sidewall",
                fmt::format("is {:g}, {:g}, {:g}, expected k1 above 0, k2 and k3 of 0 or more", k[0], k[1], k[2]));
  p.sidewall_1 = k[0], p.sidewall_2 = k[1], p.sidewall_3 = k[2];
  reader.finish();
  check(f);
  check_pressure(f, p.pressure, "pressure");
  return f;
}

std::unique_ptr<TireSpec> read_ring(const nlohmann::json& file, const TireOptions& options) {
  const RingFile given = read_ring_file(file, options.file.string());
  RingFile ring = given;
  apply(ring, options);
  if (!options.pressure.empty()) check_pressure(ring, options.pressure.highest(), "pressure");
  return std::make_unique<RingSpec>(given, std::move(ring), options);
}

}  // namespace furrow::tire
