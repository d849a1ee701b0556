#include "tire/ancf/shell_spec.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tire/ancf/ancf_tire.hpp"
#include "tire/ancf/shell_modes.hpp"
#include "tire/ancf/shell_press.hpp"
#include "tire/pressure_text.hpp"
#include "tire/read_tire_file.hpp"
#include "tire/tire_magnitudes.hpp"

namespace furrow::tire {
namespace {

constexpr double kBytesPerCoordinate = 20e3;        // shell matrices, tangent and its factors
constexpr double kBytesPerSavedCoordinate = 110.0;  // coordinates, velocities, coordinates of the factors
// Largest step as a share of τ, without and with contact tangents: tests/studies/steps.md, "Step of the flexible tire".
constexpr double kLateShare = 0.04, kTangentShare = 0.1;

int most_layers(const TireFile& file) {
  return static_cast<int>(std::max({file.bead.layers.size(), file.sidewall.layers.size(), file.tread.layers.size()}));
}

class ShellSpec final : public TireSpec {
 public:
  ShellSpec(const TireFile& given, const TireOptions& options)
      : TireSpec(options), given_(given), file_(tire_file_of(options, given)) {}

  TireDescription describe() const override;
  std::unique_ptr<Tire> make(const TireContext& context) const override {
    ShellIntegratorParams params;
    params.gravity = context.gravity;
    params.threads = context.threads;
    params.tolerance = context.tolerance.value_or(params.tolerance);
    params.age = context.renewal.value_or(params.age);
    return std::make_unique<AncfTire>(file_, params, context.alive);
  }
  TireShape shape() const override { return shell_shape(file_); }
  std::vector<std::pair<std::string, std::string>> unlikely_values() const override {
    auto found = tire::unlikely_values(given_);
    if (!options().rigid && options().pressure.empty() && given_.pressure == 0.0)
      found.emplace_back("pressure", "is 0: the shell carries the load alone; set tire.rigid if the wheel is rigid");
    return found;
  }
  std::unique_ptr<StaticTest> static_test() const override {
    return static_test_of([file = file_](const PressOptions& options, const auto& progress) {
      if (!options.obstacle.profile.empty())
        throw input_error("command line", "--on", "is profile, expected plate or cleat for a layered shell tire");
      return press_tire(file, options, progress);
    });
  }
  std::unique_ptr<ModalTest> modal_test() const override { return std::make_unique<ShellModes>(file_); }

 private:
  TireFile given_;  // without the scenario's choices
  TireFile file_;   // with the scenario's choices
};

TireDescription ShellSpec::describe() const {
  const ShellMesh mesh = make_shell_mesh(file_);
  TireDescription d;
  d.kind = "ancf";
  d.name = "layered shell";
  d.radius = file_.radius;
  for (const ProfileKnot& knot : file_.profile) d.width = std::max(d.width, 2.0 * std::abs(knot.y));
  d.tread_width = tread_width(file_, mesh);
  d.section_height = file_.radius - file_.rim_radius;
  d.coordinates = 6 * mesh.nodes();
  d.vertices = mesh.nodes() + 2;
  d.facets = mesh.columns;
  d.mass = rigid_mass(mesh, element_masses(file_, mesh));
  d.memory = kBytesPerCoordinate * d.coordinates;
  d.saved_bytes = kBytesPerSavedCoordinate * d.coordinates;
  d.takes_tangents = true;
  d.takes = {"pressure", "friction", "elements_circumference", "elements_width", "structural_damping"};
  d.damping_time = file_.structural_damping;
  d.step_share = options().contact_tangent ? kTangentShare : kLateShare;
  d.model = {{"layers", static_cast<double>(most_layers(file_))}};
  PressureSchedule pressure = options().pressure;
  if (pressure.empty()) pressure.knots = {{0.0, file_.pressure}};
  d.details = fmt::format("{} × {} elements, {} coordinates, {}", mesh.columns, mesh.elements_width(), d.coordinates,
                          pressure_text(pressure));
  return d;
}

}  // namespace

TireFile tire_file_of(const TireOptions& options, TireFile file) {
  if (!options.pressure.empty()) file.pressure = options.pressure.at(0.0);
  options.apply_to(file.contact);
  if (options.structural_damping >= 0.0) file.structural_damping = options.structural_damping;
  if (options.elements_circumference != 0) {
    if (options.elements_circumference < 8)
      throw input_error(file.path, "elements_circumference",
                        fmt::format("is {}, expected at least 8", options.elements_circumference));
    file.elements_circumference = options.elements_circumference;
  }
  if (options.elements_width != 0) set_elements_width(file, options.elements_width);
  if (file.elements_circumference > kMaxElements / file.elements_width())
    throw input_error(file.path, "elements_circumference",
                      fmt::format("is {}, with {} elements across, expected at most {} elements in all",
                                  file.elements_circumference, file.elements_width(), kMaxElements));
  return file;
}

TireShape shell_shape(const TireFile& file) {
  const ShellMesh mesh = make_shell_mesh(file);
  TireShape shape;
  shape.mesh = make_surface_mesh(mesh);
  shape.material = file.contact;
  shape.mass = rigid_mass(mesh, element_masses(file, mesh));
  shape.radius = file.radius;
  shape.tread_width = tread_width(file, mesh);
  for (int i = 0; i < mesh.columns; ++i)
    for (int j = 0; j < mesh.rows; ++j) shape.vertex.push_back(mesh.node_position(i, j));
  shape.vertex.push_back(mesh.disc_centre(0));
  shape.vertex.push_back(mesh.disc_centre(1));
  return shape;
}

std::unique_ptr<TireSpec> read_shell(const nlohmann::json& file, const TireOptions& options) {
  return std::make_unique<ShellSpec>(read_tire_file(file, options.file.string()), options);
}

}  // namespace furrow::tire
