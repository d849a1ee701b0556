#include "tire/planar/planar_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"

namespace furrow::tire {
namespace {

constexpr double kSamePlace = 1e-9;  // of the rim's radius
constexpr int kFewest = 6;           // nodes of a ring

struct Ring {
  std::vector<int> node;
  double shift = 0.0;  // of a step

  int size() const { return static_cast<int>(node.size()); }
  double turn(int j) const { return (j + shift) / size(); }  // from the lowest point, revolutions
  int at(int j) const { return node[j % size()]; }
};

Ring add_ring(PlanarMesh& mesh, double radius, int count, double shift) {
  Ring ring;
  ring.shift = shift;
  for (int j = 0; j < count; ++j) {
    const double angle = 2.0 * std::numbers::pi * (j + shift) / count;
    ring.node.push_back(mesh.nodes());
    mesh.position.x.push_back(radius * std::sin(angle));
    mesh.position.z.push_back(-radius * std::cos(angle));
  }
  return ring;
}

void add_triangle(PlanarMesh& mesh, int a, int b, int c) {
  mesh.triangles.push_back({a, b, c});
  mesh.part.push_back(0);
}

/// Fills the gap between two rings, always along the diagonal that turns less.
void stitch(PlanarMesh& mesh, const Ring& inside, const Ring& outside) {
  int i = 0, o = 0;
  while (i < inside.size() || o < outside.size()) {
    const double outwards = std::abs(outside.turn(o + 1) - inside.turn(i));
    const double inwards = std::abs(inside.turn(i + 1) - outside.turn(o));
    if (i == inside.size() || (o < outside.size() && outwards <= inwards)) {
      add_triangle(mesh, inside.at(i), outside.at(o), outside.at(o + 1));
      ++o;
    } else {
      add_triangle(mesh, inside.at(i), outside.at(o), inside.at(i + 1));
      ++i;
    }
  }
}

}  // namespace

PlanarMesh planar_disc(double radius, int around, double shift) {
  FURROW_ASSERT(radius > 0.0 && around >= kFewest, radius, around);
  PlanarMesh mesh;
  mesh.centre = 0;
  mesh.position.x.push_back(0.0);
  mesh.position.z.push_back(0.0);
  const int rings = static_cast<int>(std::lround(around / 6.0));
  Ring before;
  for (int k = 1; k <= rings; ++k) {
    const int count =
        k == rings ? around : std::max(kFewest, static_cast<int>(std::lround(double(around) * k / rings)));
    const Ring ring = add_ring(mesh, radius * k / rings, count, shift);
    if (k == 1)
      for (int j = 0; j < count; ++j) add_triangle(mesh, mesh.centre, ring.at(j), ring.at(j + 1));
    else
      stitch(mesh, before, ring);
    before = ring;
  }
  mesh.outer = before.node;
  return mesh;
}

// The nodes of a ring are at the angles of the middles of the next ring's chords. For a thickness t, the chords at r +
// t are lower by (r + t)(1 − cos π/n), which must be less than 9/10 of t.
int planar_most_rings(double inner, double outer, int around) {
  const double sagitta = outer * (1.0 - std::cos(std::numbers::pi / around));
  return static_cast<int>(0.9 * (outer - inner) / sagitta);
}

PlanarMesh planar_annulus(double inner, double outer, int rings, int around) {
  FURROW_ASSERT(0.0 < inner && inner < outer && rings >= 1 && around >= kFewest, inner, outer, rings, around);
  FURROW_ASSERT(rings <= planar_most_rings(inner, outer, around), rings, around);
  PlanarMesh mesh;
  Ring before;
  for (int k = 0; k <= rings; ++k) {
    const Ring ring = add_ring(mesh, inner + (outer - inner) * k / rings, around, (rings - k) % 2 == 0 ? 0.0 : 0.5);
    if (k == 0)
      mesh.inner = ring.node;
    else
      stitch(mesh, before, ring);
    before = ring;
  }
  mesh.outer = before.node;
  return mesh;
}

PlanarMesh merged(const PlanarMesh& disc, const PlanarMesh& annulus) {
  FURROW_ASSERT(disc.outer.size() == annulus.inner.size(), disc.outer.size(), annulus.inner.size());
  PlanarMesh mesh = disc;
  std::vector<int> name(annulus.position.size(), -1);
  for (std::size_t j = 0; j < disc.outer.size(); ++j) {
    const int a = disc.outer[j], b = annulus.inner[j];
    FURROW_ASSERT(std::hypot(disc.position.x[a] - annulus.position.x[b], disc.position.z[a] - annulus.position.z[b]) <=
                      kSamePlace * std::hypot(disc.position.x[a], disc.position.z[a]),
                  j);
    name[b] = a;
  }
  for (int n = 0; n < annulus.nodes(); ++n) {
    if (name[n] >= 0) continue;
    name[n] = mesh.nodes();
    mesh.position.x.push_back(annulus.position.x[n]);
    mesh.position.z.push_back(annulus.position.z[n]);
  }
  const int parts = *std::max_element(disc.part.begin(), disc.part.end()) + 1;
  for (int e = 0; e < annulus.elements(); ++e) {
    const auto& t = annulus.triangles[e];
    mesh.triangles.push_back({name[t[0]], name[t[1]], name[t[2]]});
    mesh.part.push_back(parts + annulus.part[e]);
  }
  mesh.rim = disc.outer;
  mesh.outer.clear();
  for (const int n : annulus.outer) mesh.outer.push_back(name[n]);
  return mesh;
}

PlanarMesh planar_wheel(const PlanarWheelSize& size) {
  const double shift = size.rings % 2 == 0 ? 0.0 : 0.5;
  return merged(planar_disc(size.rim_radius, size.around, shift),
                planar_annulus(size.rim_radius, size.radius, size.rings, size.around));
}

}  // namespace furrow::tire
