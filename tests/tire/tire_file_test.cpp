// Tire files: reading them, and errors with file, key and allowed values.
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "protocol/core/error.hpp"
#include "tire/shell_mesh.hpp"
#include "tire/tires.hpp"

namespace furrow::tire {
namespace {

using nlohmann::json;

class TireFileTest : public ::testing::Test {
 protected:
  std::string write(const std::string& text) {
    const auto file = folder_.path() / "tire.json";
    std::ofstream(file) << text;
    return file.string();
  }
  /// The error on reading this text, without the file's name.
  std::string complaint(const std::string& text) {
    const std::string file = write(text);
    return without_file(refusal(ExitCode::bad_input, [&] { read_tire_file(file); }), file);
  }

  testing::TemporaryFolder folder_;
  const json good_ = json::parse(std::ifstream(TIRE_DATA "/hmmwv_layered.json"));
};

TEST_F(TireFileTest, layered_hmmwv_holds_the_reference_layup) {
  const TireFile f = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  EXPECT_EQ(f.elements_circumference, 90);
  EXPECT_EQ(f.elements_width(), 24);
  EXPECT_DOUBLE_EQ(f.pressure, 200e3);
  EXPECT_DOUBLE_EQ(f.structural_damping, 0.005);
  EXPECT_NEAR(f.bead.thickness(), 6.0e-3, 1e-12);
  EXPECT_NEAR(f.sidewall.thickness(), 1.1e-3, 1e-12);
  EXPECT_NEAR(f.tread.thickness(), 2.1e-3, 1e-12);
  EXPECT_EQ(f.profile.size(), 71u);
  EXPECT_DOUBLE_EQ(f.contact.friction, 0.9);
}

TEST_F(TireFileTest, shipped_files_make_both_models) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json", "toroidal.json", "passenger_205_55r16.json"}) {
    TireOptions options;
    options.file = std::string(TIRE_DATA "/") + name;
    options.elements_circumference = 12;
    options.elements_width = 6;
    EXPECT_EQ(make_tire(options)->coordinates(), 12 * 7 * 6) << name;
    options.rigid = true;
    EXPECT_GT(make_tire(options)->mass_properties().mass, 1.0) << name;
  }
}

TEST_F(TireFileTest, options_replace_the_file_s_values_and_split_sections_in_proportion) {
  TireFile f = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  set_elements_width(f, 12);
  EXPECT_EQ(f.bead.elements_per_side, 1);
  EXPECT_EQ(f.sidewall.elements_per_side, 2);
  EXPECT_EQ(f.tread.elements_per_side, 3);
  EXPECT_THROW(set_elements_width(f, 7), Error);
  EXPECT_THROW(set_elements_width(f, 4), Error);
}

TEST_F(TireFileTest, every_mistake_names_its_key) {
  const std::vector<json> many(101, {{"relative_modulus", 0.1}, {"relaxation_time", 0.1}});
  const struct {
    const char* pointer;
    json value;
    const char* said;
  } kWrong[] = {
      {"/presure", 1, "key 'presure': is unknown, expected 'pressure'?"},
      {"/contact/frction", 1, "key 'contact.frction': is unknown, expected 'friction'?"},
      {"/template", "ring", "key 'template': is 'ring', expected one of: ancf_shell, ANCFTire"},
      {"/radius", -0.4, "key 'radius': is -0.4 m, expected a number, 0.0001 to 100 m"},
      {"/radius", "big", "key 'radius': is 'big', expected a number"},
      {"/radius", 1e300, "key 'radius': is 1e300 m, expected a number, 0.0001 to 100 m"},
      {"/pressure", -1, "key 'pressure': is -1 Pa, expected a number, 0 or more Pa"},
      {"/pressure", nullptr, "key 'pressure': is null, expected a number"},
      {"/elements_circumference", 4.5, "key 'elements_circumference': is 4.5, expected a whole number from 8 to 10000"},
      {"/elements_circumference", 1000000000,
       "key 'elements_circumference': is 1e9, expected a whole number from 8 to 10000"},
      {"/sections/tread/elements_per_side", 1000000,
       "key 'sections.tread.elements_per_side': is 1e6, expected a whole number from 1 to 500"},
      {"/prony", many, "key 'prony': has 101 branches, expected at most 100"},
      {"/sections/tread/layers/1/material", "steel",
       "key 'sections.tread.layers[1].material': is 'steel', expected one of: carcass cord, rubber, steel cord"},
      {"/sections/bead/layers", json::array(), "key 'sections.bead.layers': is empty, expected at least one layer"},
      {"/profile/3", {0.5, 0.01}, "key 'profile[3]': expected three numbers t, x, y"},
      {"/prony", {{{"relative_modulus", 0.1}}}, "key 'prony[0].relaxation_time': is missing, expected a number"},
      {"/prony",
       {{{"relative_modulus", 0}, {"relaxation_time", 0.1}}},
       "key 'prony[0].relative_modulus': is 0, expected a number, above 0"},
      {"/tread_mass_per_area", -1, "key 'tread_mass_per_area': is -1 kg/m², expected a number, 0 or more kg/m²"},
      {"/profile/3/0", 0.001, "key 'profile[3]': expected t to increase"},
      {"/profile/3/1", -0.1, "key 'profile[3]': lies below the rim radius, expected x of zero or above"},
      {"/radius", 0.6, "key 'profile': rises to"},
      {"/materials/rubber/poisson_ratio", 0.6, "key 'materials.rubber.poisson_ratio'"},
      {"/format_version", 99, "key 'format_version': is 99: the file is newer than this program, expected at most 1"},
  };
  for (const auto& [pointer, value, said] : kWrong) {
    json changed = good_;
    changed[json::json_pointer(pointer)] = value;
    EXPECT_TRUE(complaint(changed.dump()).starts_with(said)) << complaint(changed.dump());
  }
  for (const auto& [key, said] :
       {std::pair(
            "template",
            "is missing, expected one of: ancf_shell, ANCFTire, ReissnerTire; or 'model' in a tire of another kind"),
        {"radius", "is missing, expected a number"}}) {
    json changed = good_;
    changed.erase(key);
    EXPECT_EQ(complaint(changed.dump()), std::string("key '") + key + "': " + said);
  }
}

/// x = r (1 − s²), y = w (s³ − c s)/(1 − c) with s from −1 to 1 has a loop for c > 0: y turns back between ±√(c/3).
TEST_F(TireFileTest, a_meridian_that_crosses_itself_is_refused_where_it_does) {
  const auto with_loop = [&](double c) {
    json changed = good_;
    changed["profile"] = json::array();
    for (int k = 0; k <= 60; ++k) {
      const double s = k / 30.0 - 1.0;
      changed["profile"].push_back({k / 60.0, 0.2 * (1.0 - s * s), 0.127 * (s * s * s - c * s) / (1.0 - c)});
    }
    changed["radius"] = changed["rim_radius"].get<double>() + 0.2;
    return complaint(changed.dump());
  };
  // s = ±√c is passed twice, at y = 0 and x = 0.2 (1 − c), and t = (1 ± √c)/2.
  EXPECT_EQ(with_loop(0.6),
            "key 'profile': crosses itself at x = 0.08 m, y = 0 m, between t = 0.11 and t = 0.89, "
            "expected a meridian without a loop");
  EXPECT_EQ(with_loop(-0.6), "");
  json many = good_;
  many["profile"] = json(std::vector<json>(2001, {0.0, 0.0, 0.0}));
  for (std::size_t k = 0; k < 2001; ++k) many["profile"][k][0] = static_cast<double>(k) / 2000.0;
  EXPECT_EQ(complaint(many.dump()), "key 'profile': has 2001 knots, expected 4 to 2000");
}

TEST_F(TireFileTest, names_that_are_no_single_line_are_refused) {
  json changed = good_;
  changed["template"] = "ring\n\x1b[31m";
  EXPECT_EQ(complaint(changed.dump()),
            "key 'template': is 'ring\\n\\x1b[31m', expected one line of at most 4096 bytes");
}

TEST_F(TireFileTest, files_that_are_not_json_objects_are_refused) {
  EXPECT_EQ(complaint(""), "is empty, expected a tire file in JSON");
  EXPECT_TRUE(complaint("{\"template\": ").starts_with("1:14: is not valid JSON"));
  EXPECT_TRUE(complaint("{\"radius\": NaN}").starts_with("1:12: is not valid JSON"));
  EXPECT_TRUE(holds(complaint("{\"radius\": 1e400}"), "key 'radius': is a number too large"));
  EXPECT_EQ(complaint("\xff\xfe\""), "1:1: byte 0xff is not UTF-8, expected a tire file in JSON in UTF-8");
  EXPECT_EQ(complaint("[1, 2]"), "is not an object, expected a tire file in JSON");
  EXPECT_EQ(complaint("{\"radius\": 1, \"radius\": 2}"), "key 'radius': is given twice, expected once");
  EXPECT_THROW(read_tire_file(folder_.path()), Error);
  EXPECT_THROW(read_tire_file(folder_.path() / "none.json"), Error);
}

/// The layered tire in the public layout.
json public_layout(const TireFile& f) {
  json j = {{"Name", "HMMWV"},
            {"Type", "Tire"},
            {"Template", "ANCFTire"},
            {"Tire Radius", f.radius},
            {"Rim Radius", f.rim_radius},
            {"Rim Width", f.rim_width},
            {"8-Node Elements", false},
            {"Structural Damping Coefficient", f.structural_damping},
            {"Default Pressure", f.pressure},
            {"Number Elements Circumference", 90}};
  j["Contact Material"] = {
      {"Coefficient of Friction", 0.9},
      {"Coefficient of Restitution", 0.1},
      {"Properties", {{"Young Modulus", 2e6}, {"Poisson Ratio", 0.3}}},
      {"Coefficients",
       {{"Normal Stiffness", 2e6}, {"Normal Damping", 13}, {"Tangential Stiffness", 1e6}, {"Tangential Damping", 0}}}};
  for (const LayerMaterial& m : f.materials)
    j["Materials"].push_back({{"Type", "Orthotropic"},
                              {"Density", m.density},
                              {"E", {m.young_modulus.x(), m.young_modulus.y(), m.young_modulus.z()}},
                              {"nu", {m.poisson_ratio.x(), m.poisson_ratio.y(), m.poisson_ratio.z()}},
                              {"G", {m.shear_modulus.x(), m.shear_modulus.y(), m.shear_modulus.z()}}});
  const std::pair<const char*, const Section*> sections[] = {
      {"Bead Section", &f.bead}, {"Sidewall Section", &f.sidewall}, {"Tread Section", &f.tread}};
  for (const auto& [name, s] : sections) {
    json entry = {{"Number Elements", s->elements_per_side}};
    for (const Layer& layer : s->layers) {
      entry["Layer Thickness"].push_back(layer.thickness);
      entry["Ply Angle"].push_back(std::lround(layer.angle * 180 / 3.14159265358979));
      entry["Material ID"].push_back(layer.material);
    }
    j[name] = entry;
  }
  for (const ProfileKnot& k : f.profile) j["Profile"].push_back({k.t, k.x, k.y});
  return j;
}

TEST_F(TireFileTest, public_layout_gives_the_same_tire_as_ours) {
  const TireFile ours = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  const TireFile theirs = read_tire_file(write(public_layout(ours).dump()));
  EXPECT_EQ(theirs.elements_width(), ours.elements_width());
  EXPECT_DOUBLE_EQ(theirs.contact.young_modulus, 2e6);
  const auto mass = [](const TireFile& f) {
    const ShellMesh mesh = make_shell_mesh(f);
    return rigid_mass(mesh, element_masses(f, mesh)).mass;
  };
  EXPECT_DOUBLE_EQ(mass(theirs), mass(ours));
}

TEST_F(TireFileTest, public_layout_mistakes_name_their_key) {
  const json good = public_layout(read_tire_file(TIRE_DATA "/hmmwv_layered.json"));
  const auto with = [&](auto change) {
    json changed = good;
    change(changed);
    return complaint(changed.dump());
  };
  EXPECT_EQ(with([](json&) {}), "");
  EXPECT_EQ(with([](json& j) { j["Tire Radios"] = 1; }), "key 'Tire Radios': is unknown, expected 'Tire Radius'?");
  EXPECT_EQ(with([](json& j) { j["Template"] = "FialaTire"; }),
            "key 'Template': is 'FialaTire', expected one of: ancf_shell, ANCFTire, ReissnerTire");
  EXPECT_EQ(with([](json& j) { j["Tread Section"]["Material ID"][0] = 7; }),
            "key 'Tread Section.Material ID': holds 7, expected whole numbers from 0 to 2");
  EXPECT_EQ(with([](json& j) { j["Materials"][0]["Type"] = "Fabric"; }),
            "key 'Materials[0].Type': is 'Fabric', expected one of: Isotropic, Orthotropic");
  EXPECT_EQ(with([](json& j) { j["Template"] = "ReissnerTire"; }).substr(0, 21), "key 'Materials[0].Ey'");
}

/// The nodes of 8-node elements lie at their corners and in the middle of their sides.
TEST_F(TireFileTest, a_tire_of_eight_node_elements_has_their_nodes) {
  json file = public_layout(read_tire_file(TIRE_DATA "/hmmwv_layered.json"));
  const TireFile four = read_tire_file(write(file.dump()));
  file["8-Node Elements"] = true;
  const TireFile eight = read_tire_file(write(file.dump()));
  EXPECT_EQ(eight.elements_circumference, 2 * four.elements_circumference);
  EXPECT_EQ(eight.elements_width(), 2 * four.elements_width());
  for (int j = 0; j < four.elements_width(); ++j)
    for (int half : {0, 1}) EXPECT_EQ(eight.section(2 * j + half).thickness(), four.section(j).thickness());
}

/// σ_x = E_x/(1 − ν²E_y/E_x) (ε_x + ν E_y/E_x ε_y), and no stress through the thickness.
TEST_F(TireFileTest, a_tire_of_reissner_shells_bears_plane_stress) {
  json file = public_layout(read_tire_file(TIRE_DATA "/hmmwv_layered.json"));
  file["Template"] = "ReissnerTire";
  file.erase("8-Node Elements");
  file["Materials"] = {{{"Type", "Orthotropic"},
                        {"Density", 1000},
                        {"Ex", 4e8},
                        {"Ey", 1e8},
                        {"nu", 0.4},
                        {"Gxy", 3e7},
                        {"Gxz", 2e7},
                        {"Gyz", 1e7}},
                       {{"Type", "Isotropic"}, {"Density", 1000}, {"E", 1e7}, {"nu", 0.45}},
                       {{"Type", "Isotropic"}, {"Density", 1000}, {"E", 1e7}, {"nu", 0.45}}};
  file["Lugs"] = json::array();
  file["Tire Radius"] = 0.4973;  // with the lugs
  const TireFile read = read_tire_file(write(file.dump()));
  const auto c = stiffness(read.materials[0], "tire.json");
  const double whole = 1.0 - 0.4 * 0.4 * 0.25;
  EXPECT_NEAR(c(0, 0), 4e8 / whole, 1.0);
  EXPECT_NEAR(c(0, 1), 0.4 * 1e8 / whole, 1.0);
  EXPECT_NEAR(c(1, 1), 1e8 / whole, 1.0);
  EXPECT_EQ(read.materials[0].shear_modulus, Vec3(3e7, 2e7, 1e7));
  EXPECT_NEAR(stiffness(read.materials[1], "tire.json")(0, 0), 1e7 / (1.0 - 0.45 * 0.45), 0.1);
  for (int m : {0, 1})
    for (int k : {0, 1, 2}) EXPECT_NEAR(stiffness(read.materials[m], "tire.json")(3, k), 0.0, 1e-3);
  ASSERT_EQ(read.remarks.size(), 2u);
  EXPECT_EQ(read.remarks[0].first, "Lugs");
  EXPECT_EQ(read.remarks[1].second, "is 0.4973 m, but the profile rises to 0.4673 m, which holds");
  EXPECT_NEAR(read.radius, 0.4673, 1e-6);
  file["Materials"][0].erase("Gyz");
  EXPECT_EQ(complaint(file.dump()).substr(0, 22), "key 'Materials[0].Gyz'");
}

}  // namespace
}  // namespace furrow::tire
