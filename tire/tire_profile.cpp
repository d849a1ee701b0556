#include "tire/tire_profile.hpp"

#include <cmath>

#include <fmt/format.h>

namespace furrow::tire {

using nlohmann::json;

std::vector<ProfileKnot> read_profile(JsonReader& reader, const std::string& key) {
  std::vector<ProfileKnot> profile;
  for (const json& row : reader.array(key)) {
    const std::size_t k = profile.size();
    const bool three =
        row.is_array() && row.size() == 3 && row[0].is_number() && row[1].is_number() && row[2].is_number();
    if (!three) reader.fail(fmt::format("{}[{}]", key, k), "expected three numbers t, x, y");
    profile.push_back({row[0].get<double>(), row[1].get<double>(), row[2].get<double>()});
    if (profile[k].x < -1e-9)
      reader.fail(fmt::format("{}[{}]", key, k), "lies below the rim radius, expected x of zero or above");
    if (k > 0 && !(profile[k].t > profile[k - 1].t))
      reader.fail(fmt::format("{}[{}]", key, k), "expected t to increase");
  }
  if (profile.size() < 4) reader.fail(key, fmt::format("has {} knots, expected at least 4", profile.size()));
  if (std::abs(profile.front().t) > 1e-9 || std::abs(profile.back().t - 1.0) > 1e-9)
    reader.fail(key,
                fmt::format("runs from t = {} to {}, expected 0 to 1", profile.front().t, profile.back().t));
  if (!(profile.back().y > profile.front().y))
    reader.fail(key, "expected y to run from the left (negative) to the right bead");
  return profile;
}

}  // namespace furrow::tire
