// Any tire held rigid, by the key `tire.rigid`.
#pragma once

#include <memory>

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// A tire with the shape, mass and contact of `flexible`, which it keeps. It takes no contact tangents.
std::unique_ptr<TireSpec> make_rigid(std::unique_ptr<TireSpec> flexible);

}  // namespace furrow::tire
