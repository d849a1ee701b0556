// Natural frequencies of inflated tires by circumferential order, and where the layered tire is no stable static body.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::verify;

std::string size(int n, int m) { return std::to_string(n) + " x " + std::to_string(m); }

TEST(TireModes, order_by_order_equals_the_whole_ring) {
  TireFile file = small_file("hmmwv_lumped.json", 12, 8);
  file.bead.layers = file.sidewall.layers = file.tread.layers;
  file.materials[file.tread.layers[0].material].density = 1000.0;
  file.pressure = 0.0;
  const InflatedRing ring(file);
  std::vector<double> by_order;
  for (int order = -5; order <= 6; ++order)
    for (const double f : ring.frequencies(order, 4)) by_order.push_back(f);
  std::sort(by_order.begin(), by_order.end());
  const ShellPatch patch(ring_patch_mesh(ring.mesh, false), shell_layers(file, file.tread));
  Supports beads(patch.nodes());
  for (int i = 0; i < ring.mesh.columns; ++i)
    beads.fix({ring.mesh.node(i, 0), ring.mesh.node(i, ring.mesh.rows - 1)}, "xyzabc");
  const Vector whole = lowest_eigenvalues(restrict_to(patch.tangent(patch.reference()), beads.free()),
                                          restrict_to(patch.mass(1000.0), beads.free()), 6);
  verification::Worst worst("modes order by order", "frequency, Hz, 12 x 8", 1e-4, "sparse eigenproblem of the whole ring");
  for (int k = 0; k < 6; ++k) worst.add(by_order[k], std::sqrt(whole[k]) / (2 * 3.14159265358979323846), 0.0, std::to_string(k + 1));
}

TEST(TireModes, frequencies_converge_with_the_mesh) {
  for (const char* name : {"hmmwv_lumped.json", "toroidal.json"})
    for (int order = 0; order <= 3; ++order) {
      double f[3][2];
      const int widths[3] = {12, 24, 48}, columns[3] = {45, 90, 180};
      for (int k = 0; k < 3; ++k) {
        const Vector two = InflatedRing(small_file(name, columns[k], widths[k])).frequencies(order, 2);
        f[k][0] = two[0], f[k][1] = two[1];
      }
      for (int mode = 0; mode < 2; ++mode) {
        const double limit = f[2][mode] + (f[2][mode] - f[1][mode]) / 3;
        for (int k = 0; k < 3; ++k)
          verify(std::string("inflated ") + name,
                 "order " + std::to_string(order) + ", frequency " + std::to_string(mode + 1) + ", Hz, " + size(columns[k], widths[k]),
                 f[k][mode], limit, 20.0 / (widths[k] * widths[k]), "extrapolated in the mesh");
      }
    }
}

TEST(TireModes, trap) {
  for (const auto [columns, width] : {std::pair(90, 24), std::pair(180, 48)})
    for (const double pressure : {0.0, 10e3, 20e3, 30e3, 50e3, 100e3, 200e3}) {
      TireFile file = small_file("hmmwv_layered.json", columns, width);
      file.pressure = pressure;
      const InflatedRing ring(file);
      std::printf("%d %.0f:", columns, pressure);
      for (int order = 0; order <= columns / 2; order += columns / 30) std::printf(" %d:%.0f", order, ring.frequencies(order, 1)[0]);
      std::printf("\n");
    }
}

}  // namespace
}  // namespace furrow::test
