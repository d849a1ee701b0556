#include "nodes/calibrate/kind.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"
#include "protocol/files/data_files.hpp"

namespace furrow::calibrate {
namespace {

constexpr double kUsualSigma = 0.01;  // of the largest |y|

}  // namespace

double Parameter::on_scale(double value) const {
  return logarithmic ? std::log(value / lower) / std::log(upper / lower) : (value - lower) / (upper - lower);
}

double Parameter::off_scale(double share) const {
  if (share == 0.0) return lower;
  if (share == 1.0) return upper;
  return logarithmic ? lower * std::exp(share * std::log(upper / lower)) : lower + share * (upper - lower);
}

double Parameter::slope(double share) const {
  return logarithmic ? off_scale(share) * std::log(upper / lower) : upper - lower;
}

std::size_t points_of(const std::vector<Target>& targets) {
  std::size_t points = 0;
  for (const Target& target : targets) points += target.y.size();
  return points;
}

bool CalibrationModel::fits(std::string_view name) const {
  return std::find(names_.begin(), names_.end(), name) != names_.end();
}

bool takes(OrderedJsonReader& reader, const std::string& key) {
  reader.skip(key);
  return reader.given(key);
}

std::string target_name(OrderedJsonReader& reader, const std::string& otherwise) {
  const std::string name = reader.text_or("name", otherwise);
  if (name.empty() || name.find_first_of(",\"") != std::string::npos)
    reader.fail("name", "expected a name without commas and quotes");
  return name;
}

TargetKeys read_target_keys(OrderedJsonReader& reader, const std::filesystem::path& study) {
  TargetKeys keys;
  keys.target.data = find_file(reader.text("data"), reader.full("data"), study);
  keys.target.name = target_name(reader, keys.target.data.stem().string());
  if (takes(reader, "sigma")) keys.sigma = reader.positive("sigma");
  if (takes(reader, "weight")) keys.weight = reader.positive("weight");
  return keys;
}

void set_sigma(TargetKeys& keys, const std::vector<double>& of_data) {
  Target& target = keys.target;
  FURROW_ASSERT(!target.y.empty(), target.name);
  double largest = 0.0;
  for (const double y : target.y) largest = std::max(largest, std::abs(y));
  const double usual = keys.sigma > 0.0 ? keys.sigma : kUsualSigma * (largest > 0.0 ? largest : 1.0);
  target.sigma = of_data.empty() ? std::vector<double>(target.y.size(), usual) : of_data;
  for (double& sigma : target.sigma) sigma /= std::sqrt(keys.weight);
}

}  // namespace furrow::calibrate
