// Models with closed forms and a folder for studies, for tests of calibrations.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <functional>
#include <memory>
#include <random>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "nodes/calibrate/calibrate.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "nodes/calibrate/study.hpp"
#include "protocol/core/error.hpp"
#include "tests/refusal.hpp"
#include "tests/temporary_folder.hpp"

namespace furrow::calibrate::testing {

using Curve = std::function<double(double x, std::span<const double> parameters)>;

/// One fitted target y(x) of a function; a value that is not finite counts as no answer.
class CurveModel final : public CalibrationModel {
 public:
  CurveModel(Curve curve, std::vector<double> x, std::vector<double> y, double sigma) : curve_(std::move(curve)) {
    Target target;
    target.name = "curve", target.what = "a curve", target.x_name = "x", target.y_name = "y", target.state = "curve";
    target.sigma.assign(x.size(), sigma);
    target.x = std::move(x), target.y = std::move(y);
    targets_.fitted.push_back(std::move(target));
  }
  std::vector<double> start_values() const override { return {}; }
  Prediction predict(std::span<const double> values, TargetSet set, const ProgressCall& progress) override {
    if (progress) progress("", 0.0);
    ++asked;
    Prediction found;
    for (const Target& target : targets(set))
      for (const double x : target.x) found.values.push_back(curve_(x, values));
    for (const double y : found.values)
      if (!std::isfinite(y)) return {{}, {}, "no answer here"};
    return found;
  }
  nlohmann::ordered_json fitted_file(std::span<const double> values, const std::string& source) const override {
    return {{"values", std::vector<double>(values.begin(), values.end())}, {"source", source}};
  }
  int asked = 0;

 private:
  Curve curve_;
};

inline const CalibrationKind& curve_kind() {
  static const CalibrationKind kind{"curve", "nothing", {}, nullptr, optimize_smooth};
  return kind;
}

/// A study of such a model; the digest covers its data.
inline Calibration study_of(Curve curve, std::vector<double> x, std::vector<double> y,
                            std::vector<Parameter> parameters, int starts = 1, double sigma = 1.0) {
  Calibration c;
  c.file = "study.json", c.start = "start.json", c.name = "study";
  c.kind = &curve_kind();
  c.parameters = std::move(parameters);
  c.starts = starts;
  c.model = std::make_unique<CurveModel>(std::move(curve), std::move(x), std::move(y), sigma);
  c.result = "fitted.json";
  c.digest = "0123456789abcdef";
  return c;
}

inline CalibrationResults calibrated(const Calibration& c) {
  const furrow::testing::TemporaryFolder folder;
  return calibrate(c, folder.path(), {});
}

/// x from `from` to `to` in equal steps.
inline std::vector<double> steps(double from, double to, int count) {
  std::vector<double> x;
  for (int k = 0; k < count; ++k) x.push_back(from + (to - from) * k / (count - 1));
  return x;
}

/// A folder with the files of studies.
class StudyTest : public ::testing::Test {
 protected:
  using json = nlohmann::ordered_json;  // parameters in the order of the file
  /// Key of a study, its wrong value, and part of the message.
  using Wrong = std::vector<std::tuple<const char*, json, const char*>>;

  void write(const std::string& name, const std::string& text) { std::ofstream(folder_.path() / name) << text; }
  Calibration load(const json& study) {
    write("study.json", study.dump());
    return load_calibration(folder_.path() / "study.json");
  }
  std::string complaint(const json& study) {
    const std::string text = refusal(ExitCode::bad_input, [&] { load(study); });
    return text.empty() ? "no error" : text;
  }
  void expect_refused(const json& good, const Wrong& wrong) {
    ASSERT_EQ(complaint(good), "no error");
    for (const auto& [pointer, value, expected] : wrong) {
      json study = good;
      study[json::json_pointer(pointer)] = value;
      EXPECT_TRUE(holds(complaint(study), expected)) << pointer;
    }
  }

  furrow::testing::TemporaryFolder folder_;
};

}  // namespace furrow::calibrate::testing
