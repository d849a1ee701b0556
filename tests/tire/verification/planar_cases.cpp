#include "tests/tire/verification/planar_cases.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "tire/planar/planar_spec.hpp"

namespace furrow::test {

tire::PlanarParams aligator() {
  const std::string path = TIRE_DATA "/aligator_planar.json";
  return tire::read_planar_file(nlohmann::json::parse(std::ifstream(path)), path).params;
}

tire::PlanarParams meshed(tire::PlanarParams params, int around) {
  params.size.rings = static_cast<int>(std::lround(double(params.size.rings) * around / params.size.around));
  params.size.around = around;
  return params;
}

double Compression::regression() const {
  double product = 0.0, square = 0.0;
  for (const auto& [deflection, force] : curve) product += deflection * force, square += deflection * deflection;
  return product / square;
}

Compression compressed(const tire::PlanarParams& params, double deflection, int points) {
  tire::PlanarStatic wheel(params, tire::PlanarGround::plate(params.size.radius));
  Compression c;
  c.elements = wheel.elements().size();
  for (int k = 0; k <= points; ++k) {
    const double d = deflection * k / points;
    const tire::PlanarReport report = wheel.move_to({0.0, params.size.radius - d});
    EXPECT_TRUE(report.converged) << d << " m, free force " << report.residual << " N";
    c.curve.emplace_back(d, wheel.force());
  }
  return c;
}

}  // namespace furrow::test
