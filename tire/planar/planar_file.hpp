// What the file of a planar tire says.
#pragma once

#include <string>

#include "tire/planar/planar_wheel.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct PlanarFile {
  std::string path;
  PlanarParams params;
  ContactMaterial contact;
};

}  // namespace furrow::tire
