// CONTRIBUTING.md kept true: a dummy of each thing that it tells how to add, made as it says.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include <nlohmann/json.hpp>

#include "nodes/output/line_builder.hpp"
#include "nodes/scenario/schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/field_hash.hpp"
#include "protocol/files/json_fields.hpp"
#include "terrain/terrains.hpp"
#include "tests/dummies/held_hub.hpp"
#include "tests/dummies/spring_mat.hpp"
#include "tests/dummies/spring_wheel.hpp"

namespace furrow {
namespace {

using nlohmann::json;

constexpr double kStep = 1e-3;  // communication step, s

template <HasFields T>
std::vector<Field> fields_of() {
  std::vector<Field> fields;
  const T options{};
  visit_fields([&](const Field& field, const auto&) { fields.push_back(field); }, options);
  return fields;
}

// The lines that would stand in tire/tires.cpp, terrain/terrains.cpp and rigs/rigs.cpp.
constexpr tire::TireModel kTire{"spring_wheel", tire::read_spring_wheel};
constexpr rigs::RigKind kRig{"held_hub", rigs::read_held_hub};
constexpr terrain::TerrainEntry kTerrain{"spring_mat", fields_of<terrain::SpringMatOptions>,
                                         terrain::read_spring_mat};

/// The three dummies coupled as ranks couple them: forces one step late.
struct Bench {
  std::unique_ptr<tire::Tire> tire;
  std::unique_ptr<terrain::Terrain> terrain;
  std::unique_ptr<rigs::Rig> rig;
  tire::RimTrajectory trajectory;
  std::vector<NodalForces> forces{1};
  std::vector<ContactSums> contact{1};

  explicit Bench(const json& rig_section) {
    tire::TireOptions options;
    options.file = "spring_wheel.json";
    tire = kTire.read(json{{"radius", 0.4}, {"width", 0.2}}, options)->make();
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
  const double chord = 2.0 * 0.4 * std::sin(std::numbers::pi / 36), mat = 1e7 * 0.2 * chord / 2.0,
               wheel = 2e4;
  const double expected = 2.0 * depth * wheel * mat / (wheel + mat);
  EXPECT_NEAR(bench.contact[0].force.z(), expected, 1e-9 * expected);
  EXPECT_NEAR(bench.terrain->state().wall_impulse.z(), -bench.terrain->state().surface_impulse.z(), 1e-12);
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
  const TerrainState mat = bench.terrain->state();
  const double gravity = 30.0 * 9.81 * 4e-3, stored = tire.strain_energy + mat.elastic_energy;
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
  try {
    kTerrain.read(json{{"mat_stiffness", -1.0}}, {"scenario.json", "terrain"});
    FAIL() << "not refused";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("terrain.mat_stiffness"), std::string::npos) << error.what();
  }
}

TEST(Dummies, key_is_a_field_and_an_entry_of_the_schema) {
  // The entry as it would stand in rigs/scenario.schema.json.
  const scenario::Schema schema(json::parse(R"({"type": "object", "properties": {"terrain": {
      "type": "object", "additionalProperties": false, "default": {}, "properties": {"mat_stiffness": {
        "type": "number", "exclusiveMinimum": 0, "default": 1e7, "unit": "N/m³",
        "description": "stiffness of the mat per area"}}}}})"));
  json document = {{"terrain", json::object()}};
  schema.fill_defaults(document);
  EXPECT_TRUE(schema.problems(document).empty());
  terrain::SpringMatOptions options;
  read_fields(document["terrain"], options);
  EXPECT_EQ(options.mat_stiffness, terrain::SpringMatOptions().mat_stiffness)
      << "the schema's default is the struct's";
  EXPECT_EQ(schema.problems({{"terrain", {{"mat_stiffness", 0}}}}).size(), 1U);
  const std::vector<scenario::Problem> misspelt = schema.problems({{"terrain", {{"mat_stifness", 1e7}}}});
  ASSERT_EQ(misspelt.size(), 1U);
  EXPECT_NE(misspelt[0].what.find("terrain.mat_stiffness"), std::string::npos) << misspelt[0].what;
  for (const std::string& name : field_names<terrain::SpringMatOptions>(role::key))
    EXPECT_EQ(schema.find("terrain." + name) != nullptr, name == "mat_stiffness") << name;
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

}  // namespace
}  // namespace furrow
