#include "tire/tire_file_reader.hpp"

#include <fmt/format.h>

#include "protocol/files/json_text.hpp"

namespace furrow::tire {
namespace {

constexpr int kFormatVersion = 1;
constexpr double kShortest = 1e-4, kLongest = 100.0;  // m

}  // namespace

void take_common_keys(JsonReader& reader) {
  reader.check_version(kFormatVersion, true);
  for (const char* key : {"model", "rim", "name", "source", "$schema"}) reader.skip(key);
}

int choice_of(JsonReader& reader, const std::string& key, std::string_view first, std::string_view second) {
  const std::string given = reader.text_or(key, std::string(second));
  if (given == first) return 0;
  if (given == second) return 1;
  reader.fail(key, fmt::format("is '{}', expected {}", given, one_of({std::string(first), std::string(second)})));
}

double length_of(JsonReader& reader, const std::string& key) {
  const double length = reader.positive(key);
  if (length < kShortest || length > kLongest)
    reader.fail(key, fmt::format("is {} m, expected {} to {} m", number_text(length), kShortest, kLongest));
  return length;
}

ContactMaterial read_contact(JsonReader reader) {
  ContactMaterial c;
  c.young_modulus = reader.positive("young_modulus");
  c.poisson_ratio = reader.not_negative("poisson_ratio");
  c.friction = reader.not_negative("friction");
  c.restitution = reader.not_negative("restitution");
  c.normal_stiffness = reader.positive("normal_stiffness");
  c.normal_damping = reader.not_negative("normal_damping");
  if (c.poisson_ratio >= 0.5)
    reader.fail("poisson_ratio", fmt::format("is {}, expected 0 to below 0.5", c.poisson_ratio));
  if (c.restitution > 1.0) reader.fail("restitution", fmt::format("is {}, expected 0 to 1", c.restitution));
  reader.finish();
  return c;
}

}  // namespace furrow::tire
