// The GPU's geometry of spheres on triangulated surfaces against that of the processor.
#include "terrain/gpu/plugin/facet_geometry.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "terrain/surface/surface_patches.hpp"
#include "terrain/surface/surface_topology.hpp"
#include "tests/terrain/surface_meshes.hpp"

namespace furrow::terrain::gpu {
namespace {

constexpr double kRadius = 6e-3;  // m

Vector triple(const Vec3& v) { return {v.x(), v.y(), v.z()}; }
Vec3 vec(const Vector& v) { return {v.x, v.y, v.z}; }

/// A surface at rest, in the arrays of the GPU.
class SurfaceOnGpu {
 public:
  explicit SurfaceOnGpu(const testing::Surface& s) : shape_(s), topology_(s.mesh) {
    for (const Vec3& x : s.vertex) position_.push_back(triple(x));
    plane_.resize(s.mesh.triangles.size());
    facets_ = {reinterpret_cast<const i32(*)[3]>(shape_.mesh.triangles.data()),
               reinterpret_cast<const i32(*)[3]>(topology_.neighbour.data()),
               topology_.boundary_vertex.data(),
               topology_.first.data(),
               topology_.incident.data(),
               position_.data(),
               plane_.data()};
    for (std::size_t t = 0; t < plane_.size(); ++t) {
      const Vector area = facets_.twice_area(static_cast<i32>(t));
      plane_[t].normal = (1.0 / length(area)) * area;
      plane_[t].offset = dot(plane_[t].normal, position_[shape_.mesh.triangles[t][0]]);
      all_.push_back(static_cast<i32>(t));
    }
  }
  int hits(const Vec3& centre, FacetHit* out) const {
    return facets_.hits(triple(centre), kRadius, all_.data(), static_cast<i32>(all_.size()), out);
  }

 private:
  testing::Surface shape_;
  SurfaceTopology topology_;
  std::vector<Vector> position_;
  std::vector<FacetPlane> plane_;
  std::vector<i32> all_;
  Facets facets_{};
};

/// @returns how many spheres touched
int expect_same_hits(const testing::Surface& surface, const Vec3& lo, const Vec3& hi, int count) {
  const SurfaceCollider collider = surface.collider(kRadius);
  const SurfaceOnGpu on_gpu(surface);
  std::mt19937 bits(23);
  std::uniform_real_distribution<double> any(0.0, 1.0);
  std::array<SurfaceHit, kMaxSurfaceHits> expected;
  FacetHit found[kHits];
  int touched = 0;
  for (int k = 0; k < count; ++k) {
    const Vec3 c = lo + Vec3(any(bits), any(bits), any(bits)).cwiseProduct(hi - lo);
    const int n = collider.hits(c, kRadius, expected);
    EXPECT_EQ(on_gpu.hits(c, found), n) << c.transpose();
    if (::testing::Test::HasFailure()) return touched;
    touched += n > 0 ? 1 : 0;
    for (int h = 0; h < n; ++h) {
      EXPECT_EQ(found[h].triangle, expected[h].triangle) << c.transpose();
      EXPECT_NEAR(found[h].overlap, expected[h].overlap, 1e-13 * kRadius);
      EXPECT_NEAR(found[h].share, expected[h].share, 1e-9);
      EXPECT_LT((vec(found[h].normal) - expected[h].normal).norm(), 1e-9);
      EXPECT_LT((vec(found[h].point) - expected[h].point).norm(), 1e-14);
      for (int w = 0; w < 3; ++w) EXPECT_NEAR(found[h].weight[w], expected[h].weight[w], 1e-12);
    }
  }
  return touched;
}

TEST(FacetGeometry, touches_creases_sheets_fans_and_boxes_where_the_processor_does) {
  std::mt19937 bits(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (const double degrees : {-60.0, -5.0, -0.1, 0.0, 0.01, 1.0, 20.0, 60.0, 90.0})
    EXPECT_GT(expect_same_hits(testing::crease(0.5 * degrees * M_PI / 180.0), {-0.02, -0.02, -0.01}, {0.02, 0.02, 0.02},
                               2000),
              300)
        << degrees;
  for (const double rough : {0.0, 1e-5, 1e-3, 4e-3})
    EXPECT_GT(
        expect_same_hits(testing::sheet(-0.03, -0.03, 0.006, 10, 10, [&](double, double) { return rough * any(bits); }),
                         {-0.025, -0.025, -0.005}, {0.025, 0.025, 0.01}, 2000),
        300)
        << rough;
  for (const int count : {3, 5, 8, 24})
    EXPECT_GT(expect_same_hits(testing::fan(count, 0.03, [&](int k) { return k % 2 ? 4e-3 : -3e-3; }),
                               {-0.01, -0.01, -0.005}, {0.01, 0.01, 0.01}, 2000),
              300)
        << count;
  EXPECT_GT(expect_same_hits(testing::box({-0.01, -0.01, -0.01}, {0.01, 0.012, 0.014}), {-0.02, -0.02, -0.02},
                             {0.02, 0.02, 0.02}, 4000),
            1000);
}

TEST(FacetGeometry, angle_is_that_of_atan2) {
  for (int k = 1; k < 4000; ++k) {
    const double phi = M_PI * k / 4000.0, scale = std::pow(10.0, k % 13 - 6.0);
    EXPECT_NEAR(angle_of(scale * std::sin(phi), scale * std::cos(phi)), phi, 2e-11) << phi;
  }
}

TEST(FacetGeometry, patches_turn_and_take_couples_as_on_the_processor) {
  std::mt19937 bits(9);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  for (int trial = 0; trial < 200; ++trial) {
    const int count = 3 + trial % 9;
    const double flat = trial % 3 == 0 ? 1e-9 : trial % 3 == 1 ? 1e-2 : 1.0;
    std::vector<Vec3> x, v;
    std::vector<int> patch;
    for (int k = 0; k < count; ++k) {
      x.emplace_back(0.02 * any(bits) + 9.0, 0.02 * any(bits), 0.02 * flat * any(bits));
      v.emplace_back(any(bits), any(bits), any(bits));
      patch.push_back(k);
    }
    const PatchTurn expected(patch, x);
    const std::vector<i32> first{0, count}, vertex(patch.begin(), patch.end());
    std::vector<Vector> xs, vs;
    for (int k = 0; k < count; ++k) xs.push_back(triple(x[k])), vs.push_back(triple(v[k]));
    const Patches patches{first.data(), vertex.data(), xs.data(), vs.data()};
    const Patch found = patches.of(0);
    const Vec3 spin = expected.spin(v), moment(any(bits), any(bits), any(bits));
    EXPECT_LT((vec(found.spin) - spin).norm(), 1e-8 * spin.norm()) << trial;
    const Vec3 turn = expected.couple(moment).turn;
    EXPECT_LT((vec(patches.solved(0, found, triple(moment))) - turn).norm(), 1e-8 * turn.norm()) << trial;
    Vec3 force = Vec3::Zero(), given = Vec3::Zero();
    for (int k = 0; k < count; ++k) {
      const Vector arm = xs[k] - found.centre, f = cross(patches.solved(0, found, triple(moment)), arm);
      force += vec(f), given += vec(cross(arm, f));
    }
    EXPECT_LT(force.norm(), 1e-9 * turn.norm() * 0.02 * count);
    EXPECT_LT((given - moment).norm(), 1e-7) << trial;
  }
}

}  // namespace
}  // namespace furrow::terrain::gpu
