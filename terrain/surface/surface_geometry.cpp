#include "terrain/surface/surface_geometry.hpp"

#include <algorithm>
#include <cmath>

#include "protocol/core/assert.hpp"

namespace furrow::terrain {
namespace {

constexpr double kRegularisation = 1e-12;
constexpr double kTolerance = 1e-11;  // of the deepest overlap
constexpr int kMaxActive = 6;

TrianglePoint on_edge(const Vec3& from, const Vec3& to, double share, int edge) {
  FURROW_ASSERT(in_range(edge, 3), edge);
  TrianglePoint result;
  result.point = from + share * (to - from);
  result.weight[edge] = 1.0 - share;
  result.weight[(edge + 1) % 3] = share;
  result.region = static_cast<TriangleRegion>(static_cast<int>(TriangleRegion::edge_0) + edge);
  return result;
}

TrianglePoint on_vertex(const Vec3& vertex, int index) {
  FURROW_ASSERT(in_range(index, 3), index);
  TrianglePoint result;
  result.point = vertex;
  result.weight[index] = 1.0;
  result.region = static_cast<TriangleRegion>(static_cast<int>(TriangleRegion::vertex_0) + index);
  return result;
}

/// The candidates that carry a share, with G restricted to them.
struct ActiveSet {
  std::array<int, kMaxActive> index{};
  std::array<double, kMaxActive> lambda{};
  int size = 0;

  bool holds(int i) const {
    FURROW_ASSERT(in_range(size, kMaxActive + 1), size);
    return std::find(index.begin(), index.begin() + size, i) != index.begin() + size;
  }
  void drop(int k) {
    FURROW_ASSERT(in_range(k, size), k, size);
    for (int i = k; i + 1 < size; ++i) {
      index[i] = index[i + 1];
      lambda[i] = lambda[i + 1];
    }
    --size;
  }
};

double coupling(std::span<const Vec3> normal, int i, int j) { return std::max(0.0, normal[i].dot(normal[j])); }

/// Solves G_AA x = δ_A by elimination; G_AA is small and regularised.
std::array<double, kMaxActive> solve_active(const ActiveSet& active, std::span<const Vec3> normal,
                                            std::span<const double> overlap) {
  double g[kMaxActive][kMaxActive + 1];
  const int n = active.size;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j)
      g[i][j] = i == j ? 1.0 + kRegularisation : coupling(normal, active.index[i], active.index[j]);
    g[i][n] = overlap[active.index[i]];
  }
  for (int k = 0; k < n; ++k) {
    // G can lose definiteness only because it is cut off at zero; this guard then keeps the result finite.
    if (std::abs(g[k][k]) < kRegularisation) g[k][k] = kRegularisation;
    for (int i = k + 1; i < n; ++i) {
      const double factor = g[i][k] / g[k][k];
      for (int j = k; j <= n; ++j) g[i][j] -= factor * g[k][j];
    }
  }
  std::array<double, kMaxActive> x{};
  for (int k = n - 1; k >= 0; --k) {
    double sum = g[k][n];
    for (int j = k + 1; j < n; ++j) sum -= g[k][j] * x[j];
    x[k] = sum / g[k][k];
  }
  return x;
}

/// Moves the active λ to their solution, dropping candidates that would turn negative on the way.
void settle_active(ActiveSet& active, std::span<const Vec3> normal, std::span<const double> overlap) {
  while (active.size > 0) {
    const auto x = solve_active(active, normal, overlap);
    double way = 1.0;
    int first_out = -1;
    for (int k = 0; k < active.size; ++k) {
      if (x[k] > 0.0) continue;
      const double share = active.lambda[k] / (active.lambda[k] - x[k] + 1e-300);
      if (first_out < 0 || share < way) {
        way = share;
        first_out = k;
      }
    }
    for (int k = 0; k < active.size; ++k)
      active.lambda[k] = first_out < 0 ? x[k] : active.lambda[k] + way * (x[k] - active.lambda[k]);
    if (first_out < 0) return;
    active.drop(first_out);
  }
}

}  // namespace

TrianglePoint closest_point(const Vec3& p, const Vec3& a, const Vec3& b, const Vec3& c) {
  FURROW_ASSERT((b - a).cross(c - a).squaredNorm() != 0.0, a.transpose(), b.transpose(), c.transpose());
  const Vec3 ab = b - a, ac = c - a, ap = p - a;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap);
  if (d1 <= 0.0 && d2 <= 0.0) return on_vertex(a, 0);

  const Vec3 bp = p - b;
  const double d3 = ab.dot(bp), d4 = ac.dot(bp);
  if (d3 >= 0.0 && d4 <= d3) return on_vertex(b, 1);

  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return on_edge(a, b, d1 / (d1 - d3), 0);

  const Vec3 cp = p - c;
  const double d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d6 >= 0.0 && d5 <= d6) return on_vertex(c, 2);

  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return on_edge(c, a, 1.0 - d2 / (d2 - d6), 2);

  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) return on_edge(b, c, (d4 - d3) / (d4 - d3 + d5 - d6), 1);

  const double sum = va + vb + vc;
  TrianglePoint result;
  result.weight[1] = vb / sum;
  result.weight[2] = vc / sum;
  result.weight[0] = 1.0 - result.weight[1] - result.weight[2];
  result.point = a + result.weight[1] * ab + result.weight[2] * ac;
  return result;
}

int solve_push_out(std::span<const Vec3> normal, std::span<const double> overlap, std::span<double> lambda) {
  FURROW_ASSERT(normal.size() == overlap.size() && lambda.size() == overlap.size(), normal.size(), overlap.size(),
                lambda.size());
  FURROW_ASSERT(overlap.size() <= static_cast<std::size_t>(kMaxCandidates), overlap.size());
  const int n = static_cast<int>(overlap.size());
  std::fill(lambda.begin(), lambda.end(), 0.0);
  if (n == 0) return 0;
  const int deepest = static_cast<int>(std::max_element(overlap.begin(), overlap.end()) - overlap.begin());
  const double tolerance = kTolerance * overlap[deepest];

  static_assert(kMaxCandidates <= 32);
  std::uint32_t left_out = 0;
  ActiveSet active;
  active.size = 1;
  active.index[0] = deepest;
  active.lambda[0] = overlap[deepest] / (1.0 + kRegularisation);
  for (int round = 0; round < 4 * kMaxActive && active.size < kMaxActive; ++round) {
    double worst = tolerance;
    int next = -1;
    for (int i = 0; i < n; ++i) {
      if (active.holds(i) || (left_out >> i & 1u)) continue;
      double lack = overlap[i];
      for (int k = 0; k < active.size; ++k) lack -= active.lambda[k] * coupling(normal, i, active.index[k]);
      if (lack > worst) {
        worst = lack;
        next = i;
      }
    }
    if (next < 0) break;
    active.index[active.size] = next;
    active.lambda[active.size] = 0.0;
    ++active.size;
    settle_active(active, normal, overlap);
    if (!active.holds(next)) left_out |= 1u << next;
  }
  int count = 0;
  for (int k = 0; k < active.size; ++k) {
    const int i = active.index[k];
    lambda[i] = std::min(active.lambda[k] * (1.0 + kRegularisation), overlap[i]);
    if (lambda[i] > 0.0) ++count;
  }
  return count;
}

void share_depth(std::span<const Vec3> normal, std::span<const double> overlap, std::span<double> shared) {
  FURROW_ASSERT(normal.size() == overlap.size() && shared.size() == overlap.size(), normal.size(), overlap.size(),
                shared.size());
  constexpr double kFull = 0.7, kNone = 0.3;  // cosines between which w falls from 1 to 0
  for (std::size_t i = 0; i < overlap.size(); ++i) {
    shared[i] = overlap[i];
    for (std::size_t j = 0; j < overlap.size(); ++j) {
      if (overlap[j] <= overlap[i]) continue;
      const double w = std::clamp((normal[i].dot(normal[j]) - kNone) / (kFull - kNone), 0.0, 1.0);
      shared[i] = std::max(shared[i], overlap[i] + w * (overlap[j] - overlap[i]));
    }
  }
}

}  // namespace furrow::terrain
