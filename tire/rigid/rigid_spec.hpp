// Any tire held rigid: what `tire.rigid` makes of its model.
#pragma once

#include <memory>

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// The shape, mass and contact of `flexible`, which it keeps; it takes no contact tangents.
std::unique_ptr<TireSpec> make_rigid(std::unique_ptr<TireSpec> flexible);

}  // namespace furrow::tire
