// Checks the recipes of CONTRIBUTING.md, with a dummy of each part that it describes.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "nodes/commands/command_line.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/output/line_builder.hpp"
#include "nodes/scenario/scenario_checks.hpp"
#include "nodes/scenario/schema.hpp"
#include "nodes/scenario/wheel_geometry.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/field_hash.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/rigs.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"
#include "terrain/dem/wall_forces.hpp"
#include "terrain/terrains.hpp"
#include "tests/dummies/held_hub.hpp"
#include "tests/dummies/linear_law.hpp"
#include "tests/dummies/roll_command.hpp"
#include "tests/dummies/spring_mat.hpp"
#include "tests/dummies/spring_wheel.hpp"
#include "tests/refusal.hpp"
#include "tests/terrain/law_promises.hpp"
#include "tire/outward.hpp"
#include "tire/tires.hpp"

// The line that would be in terrain/dem/contact/laws.hpp: listed laws are tested.
namespace furrow::terrain::dem::testing {
using NewLaws = TypesOf<std::tuple<LinearLaw>>::type;
INSTANTIATE_TYPED_TEST_SUITE_P(Dummy, LawPromises, NewLaws, NameOfLaw);
}  // namespace furrow::terrain::dem::testing

namespace furrow {
namespace {

using nlohmann::json;

constexpr double kStep = 1e-3;  // communication step, s

// The lines that would be in tire/tires.cpp, terrain/terrains.cpp and rigs/rigs.cpp.
constexpr tire::TireModel kTire{"spring_wheel", tire::read_spring_wheel};
constexpr rigs::RigKind kRig{"held_hub", "holds a hub", key_list<rigs::HeldHubOptions>(), rigs::read_held_hub};
constexpr terrain::TerrainEntry kTerrain{"spring_mat", "a mat of springs", key_list<terrain::SpringMatOptions>(),
                                         terrain::read_spring_mat};

/// The tire file "spring_wheel.json".
json wheel_file() {
  return {{"format_version", 1}, {"model", "spring_wheel"}, {"radius", 0.4},    {"width", 0.2},
          {"spokes", 36},        {"stiffness", 2e4},        {"damping", 200.0}, {"mass", 30.0}};
}

std::unique_ptr<tire::TireSpec> read_wheel(const json& file) {
  tire::TireOptions options;
  options.file = "spring_wheel.json";
  return kTire.read(file, options);
}

/// Two springs and a rigid wheel in a scenario, as load_scenario would make it.
scenario::Scenario small_scenario() {
  scenario::Scenario s;
  s.file = "scenario.json";
  s.run.end = 0.9;
  s.tires = {read_wheel(wheel_file())};
  s.terrain = kTerrain.read(json::object(), {"scenario.json", "terrain"});
  s.rig = kRig.read(json::object(), {"scenario.json", "rig"});
  return s;
}

/// The error of a scenario's checks, or its warnings.
std::string checked(scenario::Scenario s) {
  const std::shared_ptr<rigs::RigSpec> rig = kRig.read(json::object(), {"scenario.json", "rig"});
  try {
    scenario::check_scenario(s, *rig, scenario::Purpose::run);
  } catch (const Error& error) {
    return error.what();
  }
  std::string text;
  for (const std::string& warning : s.warnings) text += warning + "\n";
  return text;
}

/// The three dummies coupled as by ranks: forces come one step late.
struct Bench {
  std::unique_ptr<tire::Tire> tire;
  std::unique_ptr<terrain::Terrain> terrain;
  std::unique_ptr<rigs::Rig> rig;
  tire::RimTrajectory trajectory;
  std::vector<NodalForces> forces{1};
  std::vector<ContactSums> contact{1};

  explicit Bench(const json& rig_section) {
    tire = read_wheel(wheel_file())->make();
    terrain = kTerrain.read(json{{"mat_stiffness", 1e7}}, {"scenario.json", "terrain"})->make({});
    rig = kRig.read(rig_section, {"scenario.json", "rig"})->make();
  }
  void place() {
    rig->add_tire_mass(0, tire->mass_properties(), tire->radius());
    const double height = tire->radius();
    rig->place(std::span(&height, 1));
    tire->place(rig->rim(0));
    trajectory = tire::RimTrajectory(rig->rim(0));
    SurfaceState surface;
    tire->surface(surface);
    terrain->attach(tire->mesh(), tire->material(), surface);
  }
  void step() {
    std::vector<SurfaceState> surface(1);
    tire->surface(surface[0]);
    const NodalForces acting = forces[0];
    trajectory.extend(rig->rim(0), kStep);
    ASSERT_TRUE(terrain->advance(surface, kStep, 2, forces, contact).ok);
    ASSERT_TRUE(tire->advance(trajectory, acting, 2).ok);
    const Wrench wrench = tire->spindle_wrench();
    ASSERT_TRUE(rig->advance(std::span(&wrench, 1), kStep, 1).ok);
  }
  void save(Archive& archive) const {
    tire->save(archive);
    terrain->save(archive);
    rig->save(archive);
    trajectory.save(archive);
  }
  void restore(const Archive& archive) {
    tire->restore(archive);
    terrain->restore(archive);
    rig->restore(archive);
    trajectory.restore(archive);
  }
};

TEST(Dummies, wheel_pressed_on_a_mat_gives_the_force_of_two_springs_in_series) {
  const double depth = 2e-3;  // less than the 6 mm at which the next spoke of 36 touches
  Bench bench({{"depth", depth}, {"lowering", 0.1}});
  bench.place();
  for (int n = 0; n < 200; ++n) bench.step();
  // At the bottom a pair of vertices: A = w · chord / 2 each, k of the wheel in series with κ A of the mat.
  const double chord = 2.0 * 0.4 * std::sin(std::numbers::pi / 36), mat = 1e7 * 0.2 * chord / 2.0, wheel = 2e4;
  const double expected = 2.0 * depth * wheel * mat / (wheel + mat);
  EXPECT_NEAR(bench.contact[0].force.z(), expected, 1e-9 * expected);
  const TerrainMomenta mat_given = bench.terrain->gather_state().momenta;
  EXPECT_NEAR(mat_given.wall_impulse.z(), -mat_given.surface_impulse.z(), 1e-12);
  const double weight = 30.0 * 9.81;
  EXPECT_NEAR(bench.tire->spindle_wrench().force.z(), expected - weight, 1e-4 * expected);
}

TEST(Dummies, work_of_the_hub_is_stored_or_dissipated) {
  Bench bench({{"depth", 4e-3}, {"lowering", 0.02}});
  bench.place();
  double hub = 0.0;  // work on the wheel, J
  for (int n = 0; n < 400; ++n) {
    const double before = bench.trajectory.end().position.z();
    bench.step();
    hub -= bench.tire->spindle_wrench().force.z() * (bench.trajectory.end().position.z() - before);
  }
  const tire::TireDiagnostics tire = bench.tire->diagnostics();
  const TerrainState mat = bench.terrain->gather_state();
  const double gravity = 30.0 * 9.81 * 4e-3, stored = tire.strain_energy() + mat.elastic_energy;
  EXPECT_GT(stored, 0.1);
  EXPECT_NEAR(hub + gravity, stored + tire.dissipation, 0.05 * stored);  // forces come a step late
}

TEST(Dummies, restored_run_continues_bit_for_bit) {
  Bench whole({{"depth", 5e-3}, {"spin", 3.0}});
  whole.place();
  for (int n = 0; n < 20; ++n) whole.step();
  Archive archive;
  whole.save(archive);
  Bench parts({{"depth", 5e-3}, {"spin", 3.0}});
  parts.place();
  parts.restore(archive);
  parts.forces = whole.forces;  // they belong to the node
  for (int n = 0; n < 20; ++n) whole.step(), parts.step();
  Hash a, b;
  whole.tire->add_state(a);
  parts.tire->add_state(b);
  EXPECT_EQ(a.value(), b.value());
  EXPECT_EQ(whole.contact[0].force, parts.contact[0].force);
}

TEST(Dummies, key_out_of_range_is_refused_by_its_name) {
  expect_refused(ExitCode::bad_input, {"terrain.mat_stiffness"}, [&] {
    kTerrain.read(json{{"mat_stiffness", -1.0}}, {"scenario.json", "terrain"});
  });
}

TEST(Dummies, tire_file_is_refused_by_file_key_and_value) {
  const auto complaint = [](const char* key, const json& value) {
    json file = wheel_file();
    file[key] = value;
    if (value.is_null()) file.erase(key);
    try {
      read_wheel(file);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ExitCode::bad_input);
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  const std::string file = "spring_wheel.json: key ";
  EXPECT_EQ(complaint("radius", "big"), file + "'radius': is 'big', expected a number");
  EXPECT_EQ(complaint("radius", -1.0), file + "'radius': is -1 m, expected a number, 0.01 or more m");
  EXPECT_EQ(complaint("width", nullptr), file + "'width': is missing, expected a number");
  EXPECT_EQ(complaint("stifness", 1.0), file + "'stifness': is unknown, expected 'stiffness'?");
  EXPECT_TRUE(complaint("spokes", 35.5).starts_with(file + "'spokes': is 35.5, expected a whole number"));
  EXPECT_TRUE(complaint("format_version", 99).starts_with(file + "'format_version': is 99: the file is newer"));
  EXPECT_EQ(complaint("name", "a wheel of springs"), "accepted");
}

TEST(Dummies, what_a_tire_does_not_take_from_the_scenario_is_told) {
  scenario::Scenario s = small_scenario();
  EXPECT_EQ(checked(s), "");
  tire::TireOptions options;
  options.file = "spring_wheel.json";
  options.friction = 0.5;
  options.pressure.knots = {{0.0, 2e5}};
  s.tires = {kTire.read(wheel_file(), options)};
  EXPECT_EQ(checked(s), "scenario.json: key 'tire.pressure': is ignored: a spring wheel tire does not use it\n");
}

TEST(Dummies, a_terrain_without_contact_tangents_refuses_tires_that_ask_for_them) {
  scenario::Scenario s = small_scenario();
  tire::TireOptions options;
  options.contact_tangent = true;
  s.tires = {kTire.read(wheel_file(), options)};
  EXPECT_EQ(checked(s),
            "scenario.json: key 'tire.contact_tangent': is true, expected false: spring mat (terrain.engine "
            "'spring_mat') gives no contact tangents");
  s.tires_listed = true;
  EXPECT_TRUE(holds(checked(s), "key 'tires.0.contact_tangent'"));
}

/// A rig that forgets a wheel.
class HalfDescribed final : public rigs::RigSpec {
 public:
  std::size_t wheel_count() const override { return 2; }
  rigs::RigDescription describe(std::span<const rigs::WheelSize>, double) const override {
    rigs::RigDescription d;
    d.kind = "half";
    d.wheels.resize(1);
    return d;
  }
  std::unique_ptr<rigs::Rig> make() const override { return nullptr; }
  void fill_starts(std::span<const rigs::WheelSize>, double, std::optional<double>, std::span<const double>) override {}
  void complete(json&) const override {}
};

TEST(Dummies, a_rig_that_describes_fewer_wheels_than_it_has_is_refused_by_name) {
  scenario::Scenario s = small_scenario();
  s.tires.push_back(s.tires.front());
  s.rig = std::make_shared<HalfDescribed>();
  const std::string told = refusal(ExitCode::bad_input, [&] { scenario::describe_rig(s); });
  EXPECT_TRUE(
      told.starts_with("scenario.json: key 'rig.type': the rig 'half' describes 1 of its 2 wheels, expected all"))
      << told;
}

TEST(Dummies, wheel_says_all_of_its_diagnostics_has_its_outside_outside_and_a_material_for_grains) {
  const auto wheel = read_wheel(wheel_file())->make();
  wheel->place(RimState());
  EXPECT_EQ(first_missing(wheel->diagnostics()), nullptr);
  SurfaceState state;
  wheel->surface(state);
  EXPECT_NO_THROW(tire::require_outward(wheel->mesh(), state.position, Vec3::Zero(), "spring_wheel.json"));
  SurfaceMesh turned = wheel->mesh();
  for (auto& triangle : turned.triangles) std::swap(triangle[0], triangle[1]);
  EXPECT_THROW(tire::require_outward(turned, state.position, Vec3::Zero(), "spring_wheel.json"), Error);
  for (const char* law : {"mindlin", "hertz_tanh"})
    EXPECT_NO_THROW(terrain::dem::check_material(wheel->material(), terrain::dem::law_from(law), 0)) << law;
}

TEST(Dummies, key_is_a_line_in_the_list_from_which_schema_and_checks_follow) {
  SchemaWriter writer;
  nlohmann::ordered_json section = object_schema("A dummy.");
  kTerrain.keys.add_to(writer, section);
  section["default"] = nlohmann::ordered_json::object();
  const scenario::Schema schema(json{{"type", "object"}, {"properties", {{"terrain", section}}}});
  json document = {{"terrain", json::object()}};
  schema.fill_defaults(document);
  EXPECT_TRUE(schema.problems(document).empty());
  terrain::SpringMatOptions options;
  read_fields(document["terrain"], options);
  EXPECT_EQ(options.mat_stiffness, terrain::SpringMatOptions().mat_stiffness) << "the default is the member's";
  EXPECT_EQ(schema.problems({{"terrain", {{"mat_stiffness", 0}}}}).size(), 1U);
  const std::vector<scenario::Problem> misspelt = schema.problems({{"terrain", {{"mat_stifness", 1e7}}}});
  ASSERT_EQ(misspelt.size(), 1U);
  EXPECT_TRUE(holds(misspelt[0].what, "terrain.mat_stiffness"));
}

TEST(Dummies, key_changes_a_digest_only_where_it_is_not_the_default) {
  terrain::SpringMatOptions options;
  const auto digest = [&] {
    Hash hash;
    add_fields(hash, options, role::key);
    return hash.value();
  };
  const std::uint64_t standard = digest();
  EXPECT_EQ(standard, Hash().value());
  options.mat_damping = 10.0;
  EXPECT_NE(digest(), standard);
}

TEST(Dummies, column_of_a_rig_is_the_mean_of_its_lines_intervals) {
  Bench bench(json{{"depth", 2e-3}});
  bench.place();
  const std::vector<rigs::Subject> subjects = bench.rig->subjects();
  ASSERT_EQ(subjects.size(), 1U);
  ASSERT_EQ(subjects[0].columns.size(), 1U);
  EXPECT_STREQ(subjects[0].columns[0].name, "hub_load_N");
  EXPECT_STREQ(subjects[0].columns[0].unit, "N");
  output::LineBuilder lines(subjects[0].columns);
  double sum = 0.0, value = 0.0;
  for (int n = 0; n < 10; ++n) {
    bench.step();
    bench.rig->measure(0, std::span(&value, 1));
    lines.add(std::span(&value, 1));
    sum += bench.tire->spindle_wrench().force.z();
  }
  EXPECT_DOUBLE_EQ(lines.take()[0], sum / 10.0);
}

TEST(Dummies, grain_under_a_new_law_rebounds_from_the_floor_as_a_damped_spring) {
  using namespace terrain::dem;
  DemOptions options;
  options.normal_stiffness = 1e5;  // N/m
  options.normal_damping = 2.0;    // N s/m
  const GrainProperties grain = grain_properties(options.radius, options.density);
  const ContactMaterial material = grain_material(options);
  const MixedPair pair{.a = material,
                       .b = material,
                       .radius = grain.radius,
                       .reduced_radius = grain.radius,
                       .mass = grain.mass,
                       .slide_mass = grain.mass / 3.5,
                       .inertia = grain.inertia,
                       .friction = material.friction,
                       .rolling = options.rolling_friction};
  const ContactCoefficients floor(LinearLaw::mix(pair, options));
  Grains grains;
  grains.resize(1);
  grains.position[0] = {0.5, 0.0, grain.radius, grain.radius};
  grains.velocity[0] = {0.0, 0.0, -1.0, 0.0};
  Strip strip;
  strip.last = 1;
  strip.walls.push_back({.grain = 0, .wall = kFloor, .tangential = {}, .rolling = {}});
  const double dt = 1e-8;
  ContactTotals sums;
  Quad force, torque;
  do {
    force = torque = {};
    wall_forces<LinearLaw, false, false>(grains, strip, 0, 1, {.length = 1.0, .width = 1.0}, grain.radius,
                                         {floor, floor, floor}, dt, {.forces = false, .losses = true},
                                         {&force, &torque}, sums);
    grains.velocity[0].z += dt * force.z / grain.mass;
    grains.position[0].z += dt * grains.velocity[0].z;
  } while (grains.position[0].z < grain.radius);
  // δ = (v/ω_d) e^{−γt} sin ω_d t; the force ends where k δ + c δ̇ = 0, at tan ω_d t = −2 γ ω_d / (ω_d² − γ²).
  const double gamma = 0.5 * options.normal_damping / grain.mass;
  const double omega = std::sqrt(options.normal_stiffness / grain.mass - gamma * gamma);
  const double end = (std::numbers::pi - std::atan2(2.0 * gamma * omega, omega * omega - gamma * gamma)) / omega;
  const double rebound = -std::exp(-gamma * end) * (std::cos(omega * end) - gamma / omega * std::sin(omega * end));
  EXPECT_NEAR(grains.velocity[0].z, rebound, 1e-3);
  EXPECT_NEAR(dt * sums.sample.power.normal_damping, 0.5 * grain.mass * (1.0 - rebound * rebound), 2e-3 * grain.mass);
}

/// Output or error of `furrow` on this command line, with the dummy's command in addition to its own.
std::string printed(std::vector<std::string> words) {
  std::vector<char*> argv;
  for (std::string& word : words) argv.push_back(word.data());
  std::vector<commands::Command> all = commands::all_commands();
  all.push_back(commands::roll_entry());
  testing::internal::CaptureStdout();
  std::string error;
  try {
    commands::CommandLine(static_cast<int>(argv.size()), argv.data(), all).execute();
  } catch (const Error& refused) {
    error = refused.what();
  }
  return testing::internal::GetCapturedStdout() + error;
}

TEST(Dummies, command_is_an_entry_with_its_options_and_its_place_in_the_help) {
  EXPECT_EQ(printed({"furrow", "roll", "2", "--radius", "0.4"}), "5 rad/s\n");
  EXPECT_EQ(printed({"furrow", "roll", "2"}), "4 rad/s\n");
  const std::string all = printed({"furrow", "--help"});
  const std::size_t heading = all.find("Ask before a run:"), own = all.find("  roll "), next = all.find("Test tires");
  EXPECT_TRUE(heading < own && own < next) << all;
  const std::string help = printed({"furrow", "roll", "--help"});
  EXPECT_NE(help.find("Print the angular speed of a wheel that rolls freely."), std::string::npos) << help;
  EXPECT_NE(help.find("furrow roll 2 --radius 0.4  Roll a small wheel."), std::string::npos) << help;
  EXPECT_EQ(help.find("--quiet"), std::string::npos) << help;
}

TEST(Dummies, command_line_of_a_command_is_refused_by_what_is_wrong) {
  EXPECT_NE(printed({"furrow", "roll"}).find("SPEED is required, see furrow roll --help"), std::string::npos)
      << printed({"furrow", "roll"});
  EXPECT_NE(printed({"furrow", "roll", "2", "--radius", "0"}).find("is 0, expected a number above 0"),
            std::string::npos);
  EXPECT_EQ(printed({"furrow", "rol", "2"}), "command line: unknown command 'rol'; did you mean 'roll'?");
}

}  // namespace
}  // namespace furrow
