// What a rig itself says of a wheel's tire.
#pragma once

#include <nlohmann/json.hpp>

namespace furrow::rigs {

struct WheelTire {
  nlohmann::json section;  // of the scenario, `tires.<k>`, where that says nothing else
  int axle = 0;            // wheels of one axle may share an entry of `tires`
};

}  // namespace furrow::rigs
