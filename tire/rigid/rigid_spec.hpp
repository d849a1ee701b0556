// Rigid wheels: any tire that the key `tire.rigid` holds rigid, and the wheels of Project Chrono's files.
#pragma once

#include <memory>
#include <string_view>

#include <nlohmann/json_fwd.hpp>

#include "tire/tire_spec.hpp"

namespace furrow::tire {

/// A tire with the shape, mass and contact of `flexible`, which it keeps. It takes no contact tangents.
std::unique_ptr<TireSpec> make_rigid(std::unique_ptr<TireSpec> flexible);

/// The "Template" of its public layout that read_rigid_wheel() reads.
inline constexpr std::string_view kRigidWheel = "RigidTire";

/// A cylinder of the file's radius, width, mass and inertia; the mesh of its contact is left out.
/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_rigid_wheel(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
