// The table of tire models: readers of tire files, and agreement of descriptions with the tires made.
#include "tire/tires.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/json_text.hpp"
#include "tire/outward.hpp"
#include "tire/press/press.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

json file_text(const std::string& name) { return json::parse(std::ifstream(TIRE_DATA "/" + name)); }

class TiresTest : public ::testing::Test {
 protected:
  TireOptions written(const json& file) {
    TireOptions options;
    options.file = folder_.path() / "tire.json";
    std::ofstream(options.file) << file;
    options.elements_circumference = 20;
    options.elements_width = 8;
    return options;
  }
  std::string complaint(const json& file) {
    const TireOptions options = written(file);
    return without_file(refusal(ExitCode::bad_input, [&] { read_tire(options); }), options.file);
  }

  testing::TemporaryFolder folder_;
};

TEST_F(TiresTest, a_file_without_a_model_is_a_shell) {
  json file = file_text("hmmwv_layered.json");
  EXPECT_EQ(read_tire(written(file))->describe().kind, "ancf");
  file["model"] = "shell";
  EXPECT_EQ(read_tire(written(file))->describe().kind, "ancf");
}

TEST_F(TiresTest, an_unknown_model_lists_the_valid_ones) {
  json file = file_text("hmmwv_layered.json");
  file["model"] = "brush";
  std::vector<std::string> names;
  for (const TireModel& model : tire_models()) names.emplace_back(model.name);
  const std::string valid = one_of(names);
  EXPECT_EQ(complaint(file), "key 'model': is 'brush', expected " + valid);
  file["model"] = "wheel";
  EXPECT_EQ(complaint(file), "key 'model': is 'wheel', which is not available in this version, expected " + valid);
  file["model"] = 3;
  EXPECT_EQ(complaint(file).substr(0, 11), "key 'model'");
}

TEST_F(TiresTest, a_file_may_say_what_rim_the_tire_is_on) {
  json file = file_text("hmmwv_layered.json");
  for (const bool rigid : {false, true}) {
    TireOptions options = written(file);
    options.rigid = rigid;
    EXPECT_EQ(read_tire(options)->rim().mass, 15.0);
    EXPECT_EQ(read_tire(options)->rim().spin_inertia, 0.7);
  }
  file["rim"].erase("mass");
  EXPECT_LT(read_tire(written(file))->rim().mass, 0.0);
  file["rim"]["mass"] = -1;
  EXPECT_EQ(complaint(file).substr(0, 14), "key 'rim.mass'");
  file["rim"] = {{"weight", 3}};
  EXPECT_EQ(complaint(file).substr(0, 16), "key 'rim.weight'");
  file["rim"] = 15;
  EXPECT_EQ(complaint(file).substr(0, 9), "key 'rim'");
  file.erase("rim");
  EXPECT_LT(read_tire(written(file))->rim().carrier_mass, 0.0);
}

TEST_F(TiresTest, description_is_that_of_the_made_tire) {
  for (const bool rigid : {false, true})
    for (const char* name : {"hmmwv_layered.json", "passenger_205_55r16.json"}) {
      TireOptions options = written(file_text(name));
      options.rigid = rigid;
      const auto spec = read_tire(options);
      const auto tire = spec->make();
      const TireDescription d = spec->describe();
      EXPECT_EQ(d.radius, tire->radius());
      EXPECT_EQ(d.tread_width, tire->tread_width());
      EXPECT_EQ(d.coordinates, tire->coordinates());
      EXPECT_EQ(d.vertices, tire->mesh().vertex_count);
      EXPECT_EQ(d.facets, 20);
      EXPECT_EQ(d.mass.mass, tire->mass_properties().mass);
      EXPECT_EQ(d.mass.inertia, tire->mass_properties().inertia);
      EXPECT_EQ(d.kind, rigid ? "rigid" : "ancf");
      EXPECT_EQ(d.takes_tangents, !rigid);
      EXPECT_EQ(d.memory > 0.0, !rigid);
      EXPECT_EQ(spec->static_test() != nullptr, !rigid);
      double reach = 0.0;  // across; the crown's knots lie inside
      for (const Vec3& vertex : spec->shape().vertex) reach = std::max(reach, 2.0 * std::abs(vertex.y()));
      EXPECT_LE(reach, d.width + 2e-3);
      EXPECT_GE(reach, 0.9 * d.width);
    }
}

TEST_F(TiresTest, every_model_says_all_of_its_diagnostics_and_has_its_outside_outside) {
  for (const bool rigid : {false, true}) {
    TireOptions options = written(file_text("hmmwv_layered.json"));
    options.rigid = rigid;
    const auto tire = make_tire(options);
    tire->place(RimState());
    EXPECT_EQ(first_missing(tire->diagnostics()), nullptr);
    SurfaceState state;
    tire->surface(state);
    EXPECT_NO_THROW(require_outward(tire->mesh(), state.position, Vec3::Zero(), "tire.json"));
    SurfaceMesh inside_out = tire->mesh();
    for (auto& triangle : inside_out.triangles) std::swap(triangle[0], triangle[1]);
    EXPECT_THROW(require_outward(inside_out, state.position, Vec3::Zero(), "tire.json"), Error);
    SurfaceMesh one_turned = tire->mesh();
    std::swap(one_turned.triangles[7][0], one_turned.triangles[7][1]);
    expect_refused(ExitCode::bad_input, {"tire.json: the contact surface has two triangles"},
                   [&] { require_outward(one_turned, state.position, Vec3::Zero(), "tire.json"); });
  }
  EXPECT_STREQ(first_missing(TireDiagnostics()), "kinetic_energy");
}

TEST_F(TiresTest, keys_of_the_scenario_that_a_model_does_not_take_are_told) {
  TireOptions options = written(file_text("hmmwv_layered.json"));
  options.pressure.knots = {{0.0, 2e5}};
  options.structural_damping = 1e-3;
  options.friction = 0.5;
  options.substeps = 2;
  EXPECT_EQ(idle_keys(*read_tire(options)), std::vector<std::string>());
  const std::vector<std::string> takes = read_tire(options)->describe().takes,
                                 known = field_names<TireOptions>(role::key);
  for (const std::string& key : takes) EXPECT_NE(std::find(known.begin(), known.end(), key), known.end()) << key;
}

TEST_F(TiresTest, step_advice_is_a_share_of_the_damping_time_and_larger_with_contact_tangents) {
  TireOptions options = written(file_text("hmmwv_layered.json"));
  options.structural_damping = 0.01;
  const TireDescription late = read_tire(options)->describe();
  options.contact_tangent = true;
  const TireDescription answering = read_tire(options)->describe();
  EXPECT_EQ(late.damping_time, 0.01);
  EXPECT_GT(late.step_share, 0.0);
  EXPECT_GT(answering.step_share, late.step_share);
  options.rigid = true;
  EXPECT_EQ(read_tire(options)->describe().step_share, 0.0);
}

TEST_F(TiresTest, a_rigid_tire_takes_no_contact_tangents) {
  const json section = {{"file", TIRE_DATA "/hmmwv_layered.json"}, {"rigid", true}, {"contact_tangent", true}};
  EXPECT_EQ(refusal(ExitCode::bad_input,
                    [&] {
                      read_tire(section, ReadContext{"test.json", "tires.1"});
                    }),
            "test.json: key 'tires.1.contact_tangent': is true, expected false for a rigid tire");
}

TEST_F(TiresTest, grousers_need_a_rigid_tire_a_height_and_a_thickness) {
  const auto told = [](const json& more) {
    json section = {{"file", TIRE_DATA "/rigid_drum.json"}, {"rigid", true}};
    section.update(more);
    return refusal(ExitCode::bad_input, [&] { read_tire(section, ReadContext{"test.json", "tire"}); });
  };
  const json whole = {{"grousers", 24}, {"grouser_height", 0.005}, {"grouser_thickness", 0.002}};
  const auto with = [&](const char* key, const json& value) {
    json changed = whole;
    changed[key] = value;
    return told(changed);
  };
  EXPECT_EQ(told(whole), "");
  TireOptions options;
  options.file = TIRE_DATA "/rigid_drum.json";
  options.rigid = true;
  const TireDescription smooth = read_tire(options)->describe();
  options.grousers = 24, options.grouser_height = 0.005, options.grouser_thickness = 0.002;
  EXPECT_EQ(read_tire(options)->describe().grouser_height, 0.005);
  EXPECT_EQ(read_tire(options)->describe().radius, smooth.radius);
  EXPECT_EQ(with("rigid", false),
            "test.json: key 'tire.grousers': is 24, expected 0 for a tire that is not rigid (tire.rigid)");
  EXPECT_EQ(with("grouser_height", nullptr),
            "test.json: key 'tire.grouser_height': is not given, expected above 0 m for grousers");
  EXPECT_EQ(with("grouser_height", 0.06),
            "test.json: key 'tire.grouser_height': is 0.06 m, expected less than the radius of 0.058 m");
  EXPECT_EQ(
      with("grouser_thickness", 0.02),
      "test.json: key 'tire.grouser_thickness': is 0.02 m, expected less than the pitch of 24 grousers, 0.01518 m");
  EXPECT_EQ(told({{"grouser_height", 0.005}}),
            "test.json: key 'tire.grouser_height': is given, expected the number of 'grousers' as well");
}

TEST_F(TiresTest, pressure_tables_run_forward_in_time) {
  const json section = {{"file", TIRE_DATA "/hmmwv_layered.json"}, {"pressure", json::array({{0.5, 2e5}, {0.5, 1e5}})}};
  EXPECT_EQ(refusal(ExitCode::bad_input,
                    [&] {
                      read_tire(section, ReadContext{"test.json", "tire"});
                    }),
            "test.json: key 'tire.pressure.1.0': is 0.5 s, expected a time after that of the entry "
            "before, 0.5 s");
}

/// The public layout of a rigid tire: a cylinder.
TEST_F(TiresTest, a_rigid_tire_of_project_chrono_is_a_rigid_wheel) {
  const json good = json::parse(R"({"Name": "Wheel", "Type": "Tire", "Template": "RigidTire", "Radius": 0.25,
    "Width": 0.1, "Mass": 4, "Inertia": [0.08, 0.12, 0.08], "Contact Material": {"Coefficient of Friction": 0.7,
    "Coefficient of Restitution": 0.1, "Properties": {"Young Modulus": 2e7, "Poisson Ratio": 0.3}}})");
  const auto read = [&](const json& file) {
    TireOptions options;
    options.file = written(file).file;
    return read_tire(options);
  };
  const auto said = [&](auto change) {
    json file = good;
    change(file);
    return complaint(file);
  };
  const auto wheel = read(good);
  const TireDescription d = wheel->describe();
  EXPECT_EQ(d.kind, "rigid");
  EXPECT_EQ(d.radius, 0.25);
  EXPECT_EQ(d.tread_width, 0.1);
  EXPECT_FALSE(d.deflects);
  EXPECT_TRUE(wheel->unlikely_values().empty());
  const auto made = wheel->make();
  EXPECT_EQ(made->mass_properties().mass, 4.0);
  EXPECT_EQ(made->mass_properties().inertia.diagonal(), Vec3(0.08, 0.12, 0.08));
  const TireShape shape = wheel->shape();
  EXPECT_EQ(shape.material.friction, 0.7);
  EXPECT_EQ(shape.material.young_modulus, 2e7);
  EXPECT_EQ(static_cast<int>(shape.vertex.size()), d.vertices);
  double most = 0.0, widest = 0.0;
  for (const Vec3& x : shape.vertex)
    most = std::max(most, std::hypot(x.x(), x.z())), widest = std::max(widest, std::abs(x.y()));
  EXPECT_NEAR(most, 0.25, 1e-12);
  EXPECT_NEAR(widest, 0.05, 1e-12);

  EXPECT_EQ(said([](json&) {}), "");
  EXPECT_EQ(said([](json& j) { j.erase("Inertia"); }).substr(0, 13), "key 'Inertia'");
  EXPECT_EQ(said([](json& j) { j["Inertia"] = {1, 0, 1}; }), "key 'Inertia': holds 0, expected numbers above 0");
  EXPECT_EQ(said([](json& j) { j["Radius"] = -0.25; }).substr(0, 12), "key 'Radius'");
  EXPECT_EQ(said([](json& j) { j["Raduis"] = 1; }), "key 'Raduis': is unknown, expected 'Radius'?");
  json odd = good;
  odd["Contact Mesh"] = {{"Mesh Filename", "wheel.obj"}};
  odd["Inertia"] = {0.05, 0.2, 0.05};
  const auto told = read(odd)->unlikely_values();
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].second, "is 0.2 kg m² about the axle, more than the sum of the others: no body has that");
  EXPECT_EQ(told[1].second, "is left out: the wheel is a cylinder of 0.5 m by 0.1 m");
}

}  // namespace
}  // namespace furrow::tire
