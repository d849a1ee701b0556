// The keys of the section `terrain` with engine liggghts: the keys of dem, except those whose value this engine fixes.
#pragma once

#include <string_view>
#include <utility>

#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::liggghts {

struct LiggghtsOptions : dem::DemOptions {
  LiggghtsOptions() {
    precision = "double";
    activity = false;
  }
};

/// Resting grains never sleep, and every contact is computed in double precision, on processors.
constexpr bool is_key_of_dem_only(std::string_view name) {
  return name == "activity" || name == "precision" || name == "device";
}

void visit_fields(FieldsOf<LiggghtsOptions> auto& s, auto&& visit) {
  using Base =
      std::conditional_t<std::is_const_v<std::remove_reference_t<decltype(s)>>, const dem::DemOptions, dem::DemOptions>;
  visit_fields(static_cast<Base&>(s), [&](auto& value, const auto& field) {
    if (!is_key_of_dem_only(field.name)) visit(value, field);
  });
}

}  // namespace furrow::terrain::liggghts
