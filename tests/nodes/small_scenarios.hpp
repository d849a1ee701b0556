// Scenarios of one wheel for whole co-simulations in one process.
#pragma once

#include <filesystem>
#include <string>

#include "nodes/scenario/scenario.hpp"
#include "terrain/dem/dem_spec.hpp"
#include "terrain/rigid/ground_spec.hpp"
#include "tests/rigs/reference_options.hpp"
#include "tire/tires.hpp"

namespace furrow::testing {

inline std::filesystem::path tire_file(const std::string& name) {
  return std::filesystem::path(FURROW_SOURCE_FOLDER) / "tire" / "data" / name;
}

/// A scenario of one wheel; its rig and tire can be changed until it is made.
struct OneWheel : scenario::Scenario {
  rigs::DrawbarRigOptions wheel_rig = testing::reference_options();
  tire::TireOptions wheel_tire;
  scenario::Scenario made() const {
    scenario::Scenario scenario = *this;
    scenario.rig = rigs::drawbar_spec({wheel_rig});
    scenario.tires = {tire::read_tire(wheel_tire)};
    return scenario;
  }
};

inline OneWheel rigid_wheel_on_plane() {
  OneWheel scenario;
  scenario.name = "test";
  scenario.digest = "test";
  scenario.wheel_rig.mode = "fixed_angular_speed";
  scenario.wheel_rig.slip = 0.2;
  scenario.wheel_rig.angular_speed = 4.0;
  scenario.wheel_rig.ramp = 0.05;
  scenario.wheel_rig.touchdown_damping = 12e3;
  scenario.wheel_rig.touchdown_time = 0.2;
  scenario.wheel_rig.start = 1.0;
  tire::TireOptions& tire = scenario.wheel_tire;
  tire.file = tire_file("hmmwv_layered.json");
  tire.rigid = true;
  tire.elements_circumference = 60;
  tire.elements_width = 12;
  scenario.terrain = terrain::make_ground_spec({});
  scenario.run.step = 1e-4;
  scenario.run.end = 0.3;
  scenario.output.frame_interval = 0.0;
  return scenario;
}

inline OneWheel rigid_wheel_on_grains() {
  OneWheel scenario = rigid_wheel_on_plane();
  scenario.wheel_rig.carrier_mass = 20.0;
  scenario.wheel_rig.touchdown_damping = 300.0;
  scenario.wheel_rig.start = 0.55;
  terrain::dem::DemOptions grains;
  grains.radius = 0.03;
  grains.layers = 2;
  grains.length = 1.6;
  grains.width = 0.5;
  grains.cohesion = 10e3;
  grains.cache = false;
  grains.activity = false;
  scenario.terrain = terrain::dem::make_dem_spec(grains);
  return scenario;
}

}  // namespace furrow::testing
