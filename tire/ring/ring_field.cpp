#include "tire/ring/ring_field.hpp"

namespace furrow::tire {

void add_local(RingTangent& t, int first, const std::array<double, 36>& matrix, double factor) {
  const int n = static_cast<int>(t.uu[0].size());
  for (int a = 0; a < 3; ++a)
    for (int b = a; b < 3; ++b) {
      const int j = (first + a) % n, d = b - a;
      const double* const at = &matrix[12 * a + 2 * b];
      t.uu[d][j] += factor * at[0], t.uv[d][j] += factor * at[1];
      t.vu[d][j] += factor * at[6], t.vv[d][j] += factor * at[7];
    }
}

std::array<double, 2> tangent_row(const RingTangent& k, const RingField& change, double sum, int j) {
  const int n = static_cast<int>(change.u.size());
  double u = k.gas * sum, v = 0.0;
  for (int d = 0; d < 3; ++d) {
    const int after = (j + d) % n, before = (j + n - d) % n;
    u += k.uu[d][j] * change.u[after] + k.uv[d][j] * change.v[after];
    v += k.vu[d][j] * change.u[after] + k.vv[d][j] * change.v[after];
    if (d == 0) continue;
    u += k.uu[d][before] * change.u[before] + k.vu[d][before] * change.v[before];
    v += k.uv[d][before] * change.u[before] + k.vv[d][before] * change.v[before];
  }
  return {u, v};
}

}  // namespace furrow::tire
