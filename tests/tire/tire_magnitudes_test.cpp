#include "tire/tire_magnitudes.hpp"
#include "tests/refusal.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

namespace furrow::tire {
namespace {

TireFile file(const std::string& name) { return read_tire_file(TIRE_DATA "/" + name); }

TEST(TireMagnitudes, shipped_tires_have_nothing_odd) {
  for (const char* name : {"hmmwv_layered.json", "hmmwv_lumped.json", "passenger_205_55r16.json", "toroidal.json"})
    EXPECT_TRUE(unlikely_values(file(name)).empty()) << name << ": " << unlikely_values(file(name)).front().first;
}

TEST(TireMagnitudes, another_unit_is_named_with_its_key) {
  TireFile tire = file("passenger_205_55r16.json");
  tire.pressure = 2.4;                          // bar
  tire.materials.front().density *= 1e-3;       // g/cm³
  tire.materials.back().young_modulus *= 1e-6;  // MPa
  tire.tread.layers.front().thickness *= 1e3;   // mm
  tire.bead.layers.front().angle = 240.0 * 3.14159265 / 180.0;
  tire.rim_width = 0.02;
  tire.tread_mass_per_area = 7000.0;
  tire.structural_damping = 5.0;  // ms
  tire.contact.friction = 90.0;   // per cent
  std::string keys;
  for (const auto& [key, what] : unlikely_values(tire)) keys += key + " ";
  for (const char* key :
       {"density", "young_modulus", "sections.tread.layers.0.thickness", "sections.bead.layers.0.angle_deg",
        "rim_width", "pressure", "tread_mass_per_area", "structural_damping", "contact.friction"})
    EXPECT_TRUE(holds(keys, key)) << key << " is not among " << keys;
}

TEST(TireMagnitudes, what_is_odd_about_many_layers_is_said_once) {
  TireFile tire = file("hmmwv_layered.json");
  Layer thin = tire.tread.layers.front();
  thin.thickness = 1e-7;
  thin.angle = 2.0;
  tire.tread.layers.assign(100000, thin);
  const auto found = unlikely_values(tire);
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0].first, "sections.tread.layers.0.thickness");
  EXPECT_EQ(found[0].second, "is 1e-07 m, tires have 1e-05 to 0.05: another unit? (and 99999 more like it)");
  EXPECT_EQ(found[1].first, "sections.tread.layers.0.angle_deg");
}

}  // namespace
}  // namespace furrow::tire
