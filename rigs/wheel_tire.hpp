// The tire of a wheel as the rig itself gives it.
#pragma once

#include <nlohmann/json.hpp>

namespace furrow::rigs {

struct WheelTire {
  nlohmann::json section;  // of the scenario, `tires.<k>`, unless the scenario gives another
  int axle = 0;            // wheels of one axle may share an entry of `tires`
};

}  // namespace furrow::rigs
