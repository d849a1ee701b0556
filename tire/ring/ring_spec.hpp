// The flexible-ring tire as an entry of the table of models: its file, what a scenario changes of it, what it says of
// itself.
#pragma once

#include <memory>
#include <string>

#include <nlohmann/json_fwd.hpp>

#include "tire/ring/ring_params.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct RingFile {
  std::string path;
  RingParams params;
  RingMotion motion;
  double diametral_inertia = 0.0;  // kg m²
  ContactMaterial contact;
};

/// @throws Error(bad_input) naming file and key
RingFile read_ring_file(const nlohmann::json& file, const std::string& path);

/// @throws Error(bad_input) naming file and key
std::unique_ptr<TireSpec> read_ring(const nlohmann::json& file, const TireOptions& options);

}  // namespace furrow::tire
