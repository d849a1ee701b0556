// Rules shared by the kinds of suspensions.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "protocol/files/json_reader.hpp"
#include "vehicle/spec/part_spec.hpp"

namespace furrow::vehicle {

inline constexpr double kSamePoint = 1e-6;  // m, up to which two points coincide

// Each @throws Error(bad_input) naming file, key and what was expected.
void check_apart(const JsonReader& reader, const char* key, const Vec3& point, const char* other_key,
                 const Vec3& other);
/// Checks that spring and shock absorber end on one of the given parts.
void check_struts(const JsonReader& reader, const std::optional<SpringSpec>& spring,
                  const std::optional<ShockSpec>& shock, const std::vector<std::string>& parts);

}  // namespace furrow::vehicle
