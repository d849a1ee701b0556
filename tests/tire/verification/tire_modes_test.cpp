// Natural frequencies of inflated tires by circumferential order, and pressures at which the layered tire is unstable.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/tire/verification/mesh_size.hpp"
#include "tests/verification/record.hpp"
#include "tire/ancf/press_solver.hpp"

namespace furrow::test {
namespace {

using verification::verify;

TEST(TireModes, order_by_order_equals_the_whole_ring) {
  tire::TireFile file = small_file("hmmwv_lumped.json", 12, 8);
  file.bead.layers = file.sidewall.layers = file.tread.layers;
  file.materials[file.tread.layers[0].material].density = 1000.0;
  file.pressure = 0.0;
  const InflatedCarcass ring(file);
  std::vector<double> by_order;
  for (int order = -5; order <= 6; ++order)
    for (const double f : ring.frequencies(order, 4)) by_order.push_back(f);
  std::sort(by_order.begin(), by_order.end());
  const ShellPatch patch(ring_patch_mesh(ring.mesh, false), tire::shell_layers(file, file.tread));
  Supports beads(patch.nodes());
  for (int i = 0; i < ring.mesh.columns; ++i)
    beads.fix({ring.mesh.node(i, 0), ring.mesh.node(i, ring.mesh.rows - 1)}, "xyzabc");
  const Vector whole = lowest_eigenvalues(restrict_to(patch.tangent(patch.reference()), beads.free()),
                                          restrict_to(patch.mass(1000.0), beads.free()), 6);
  verification::Worst worst("modes order by order", "frequency, Hz, 12 x 8", 1e-4,
                            "sparse eigenproblem of the whole ring");
  for (int k = 0; k < 6; ++k)
    worst.add(by_order[k], std::sqrt(whole[k]) / (2 * std::numbers::pi), 0.0, std::to_string(k + 1));
}

TEST(TireModes, frequencies_converge_with_the_mesh) {
  for (const char* name : {"hmmwv_lumped.json", "toroidal.json"})
    for (int order = 0; order <= 3; ++order) {
      double f[3][2];
      const int widths[3] = {12, 24, 48}, columns[3] = {45, 90, 180};
      for (int k = 0; k < 3; ++k) {
        const Vector two = InflatedCarcass(small_file(name, columns[k], widths[k])).frequencies(order, 2);
        f[k][0] = two[0], f[k][1] = two[1];
      }
      for (int mode = 0; mode < 2; ++mode) {
        const double limit = f[2][mode] + (f[2][mode] - f[1][mode]) / 3;
        for (int k = 0; k < 3; ++k)
          verification::verify(std::string("inflated ") + name,
                               "order " + std::to_string(order) + ", frequency " + std::to_string(mode + 1) + ", Hz, " +
                                   size(columns[k], widths[k]),
                               f[k][mode], limit, 25.0 / (widths[k] * widths[k]), "extrapolated in the mesh");
      }
    }
}

/// Orders from 1 to half the columns whose smallest eigenvalue is negative, and the curve over all of them.
std::vector<int> unstable_orders(int columns, int width, double pressure) {
  tire::TireFile file = small_file("hmmwv_layered.json", columns, width);
  file.pressure = pressure;
  const InflatedCarcass ring(file);
  std::vector<int> list;
  for (int order = 0; order <= columns / 2; order += columns / 90) {
    const double f = ring.frequencies(order, 1)[0];
    if (f < 0) list.push_back(order);
    verification::curve_point("layered tire, lowest frequency by order, Hz",
                              verification::brief(pressure / 1e3) + " kPa, " + size(columns, width), order, f);
  }
  return list;
}

/// Lowest pressure at which the layered tire is unstable, by bisection to 500 Pa.
double first_unstable(const std::function<bool(const InflatedCarcass&)>& is_stable) {
  double stable = 20e3, unstable = 50e3;
  while (unstable - stable > 500) {
    tire::TireFile file = small_file("hmmwv_layered.json", 90, 24);
    file.pressure = 0.5 * (stable + unstable);
    (is_stable(InflatedCarcass(file)) ? stable : unstable) = file.pressure;
  }
  return unstable;
}

/// Stability by the static solver, whose tangent is assembled from all elements: it accepts a stable tire at once.
bool factor_of_the_whole_ring_exists(const InflatedCarcass& ring) {
  struct NotAtOnce {};
  tire::PressSolver solver(ring.file, ring.mesh, ring.q, {});
  int steps = 0;
  try {
    solver.press(0.0, [&] {
      if (++steps > 1) throw NotAtOnce();
    });
  } catch (const NotAtOnce&) {
    return false;
  }
  return true;
}

TEST(LayeredTire, is_no_stable_static_body_at_full_pressure) {
  // Negative frequencies are growth rates: the belts' edges carry compressive hoop force and wrinkle.
  EXPECT_TRUE(unstable_orders(90, 24, 0.0).empty());
  EXPECT_TRUE(unstable_orders(90, 24, 20e3).empty());
  const std::vector<int> at_fifty = unstable_orders(90, 24, 50e3), coarse = unstable_orders(90, 24, 200e3);
  ASSERT_FALSE(coarse.empty());
  ASSERT_FALSE(at_fifty.empty());
  verification::verify("layered tire at 50 kPa", "lowest unstable order, 90 x 24", at_fifty.front(), 45, 0.05,
                       "directors tilted alternately from column to column");
  // Start of the alternating tilt, by the eigenvalue of its order and by the whole ring's factor.
  const double by_order = first_unstable([](const InflatedCarcass& ring) { return ring.smallest_eigenvalue(45) >= 0; });
  verification::verify("layered tire", "pressure at which the alternating tilt sets in, Pa, 90 x 24", by_order,
                       first_unstable(factor_of_the_whole_ring_exists), 0.03,
                       "first failed Cholesky factorization of the whole ring's tangent");
  // On the finer mesh the wrinkles are shorter, and the alternating tilt is gone below them.
  EXPECT_TRUE(unstable_orders(180, 48, 50e3).empty());
  const std::vector<int> fine = unstable_orders(180, 48, 200e3);
  ASSERT_FALSE(fine.empty());
  EXPECT_GT(fine.front(), coarse.front());
}

}  // namespace
}  // namespace furrow::test
