#include "terrain/soil/tools.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "terrain/dem/contact/contact_mixing.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr int kFacets = 24;             // around the cone
constexpr int kDiscSides = 48;          // must be even
constexpr double kSteelFriction = 0.3;  // of the cone

void quad(SurfaceMesh& mesh, int a, int b, int c, int d) {
  mesh.triangles.push_back({a, b, c});
  mesh.triangles.push_back({a, c, d});
}

}  // namespace

Tool strip_plate(double centre, double width, double half, double z, double height) {
  FURROW_ASSERT(width > 0.0 && half > 0.0 && height > 0.0, width, half, height);
  SurfaceMesh mesh;
  std::vector<Vec3> x;
  const double left = centre - 0.5 * width, right = centre + 0.5 * width;
  for (const double y : {-half, half})
    for (const auto& [px, pz] : {std::pair{left, z + height}, {left, z}, {right, z}, {right, z + height}})
      x.emplace_back(px, y, pz);
  // 0…3 at −half: top left, bottom left, bottom right, top right; 4…7 at +half. Outside: left, down, right.
  for (int k = 0; k < 3; ++k) quad(mesh, k, k + 4, k + 5, k + 1);
  return {std::move(mesh), std::move(x)};
}

Tool disc_plate(double x, double y, double diameter, double z, double height) {
  FURROW_ASSERT(diameter > 0.0 && height > 0.0, diameter, height);
  // n/2 R² sin(2π/n) = π D²/4
  const double turn = 2.0 * std::numbers::pi / kDiscSides;
  const double radius = 0.5 * diameter * std::sqrt(turn / std::sin(turn));
  SurfaceMesh mesh;
  std::vector<Vec3> at;
  for (const double level : {z, z + height})
    for (int k = 0; k < kDiscSides; ++k)
      at.emplace_back(x + radius * std::cos(k * turn), y + radius * std::sin(k * turn), level);
  for (int k = 0; k < kDiscSides; ++k) {
    const int next = (k + 1) % kDiscSides;
    quad(mesh, k, next, next + kDiscSides, k + kDiscSides);
  }
  // Divides the face between chords along y from the corner at +x to that at −x: at most four triangles per corner.
  for (int k = 0; 2 * k < kDiscSides - 2; ++k) {
    const int a = k, b = k + 1, c = (kDiscSides - k) % kDiscSides, d = kDiscSides - k - 1;  // c below a, d below b
    if (a != c) mesh.triangles.push_back({a, c, d});
    if (b != d) mesh.triangles.push_back({a, d, b});
  }
  mesh.triangles.push_back({kDiscSides / 2 - 1, kDiscSides / 2 + 1, kDiscSides / 2});
  return {std::move(mesh), std::move(at)};
}

Tool toothed_sheet(double from, double to, double half, double z, double pitch, double tooth, int sign) {
  FURROW_ASSERT(from < to && half > 0.0, from, to, half);
  FURROW_ASSERT(pitch > 0.0 && tooth > 0.0, pitch, tooth);
  FURROW_ASSERT(sign == 1 || sign == -1, sign);
  SurfaceMesh mesh;
  std::vector<Vec3> x;
  const auto add = [&](double px, double height) {
    for (const double y : {-half, half}) x.emplace_back(px, y, z + sign * height);
    const int n = static_cast<int>(x.size());
    if (n < 4) return;
    // Vertices: previous column n−4 (−half), n−3 (+half); present column n−2, n−1.
    if (sign > 0)
      quad(mesh, n - 4, n - 2, n - 1, n - 3);
    else
      quad(mesh, n - 4, n - 3, n - 1, n - 2);
  };
  add(from, 0.0);
  for (double at = (std::floor(from / pitch) + 0.5) * pitch; at + tooth < to; at += pitch) {
    if (at - tooth <= from) continue;
    add(at - tooth, 0.0);
    add(at, tooth);
    add(at + tooth, 0.0);
  }
  add(to, 0.0);
  return {std::move(mesh), std::move(x)};
}

Tool flat_sheet(double from, double to, double half, double z) {
  FURROW_ASSERT(from < to && half > 0.0, from, to, half);
  SurfaceMesh mesh;
  quad(mesh, 0, 1, 3, 2);
  return {std::move(mesh), {{from, -half, z}, {from, half, z}, {to, -half, z}, {to, half, z}}};
}

Tool studded_sheet(double from, double to, double half, double z, double radius) {
  FURROW_ASSERT(from < to && half > 0.0 && radius > 0.0, from, to, half, radius);
  const double row = std::numbers::sqrt3 * radius, facet = radius / 3.0;
  // Depth of the studs below the sheet: rows along x, every other one shifted by a radius.
  const auto depth = [&](double x, double y) {
    double deepest = 0.0;
    const double near = std::round(y / row);
    for (const double n : {near - 1.0, near, near + 1.0}) {
      const double shift = std::fmod(std::abs(n), 2.0) * radius;
      const double dx = std::remainder(x - shift, 2.0 * radius), dy = y - n * row;
      deepest = std::max(deepest, radius * radius - dx * dx - dy * dy);
    }
    return std::sqrt(deepest);
  };
  const int nx = static_cast<int>(std::ceil((to - from) / facet)), ny = static_cast<int>(std::ceil(2.0 * half / facet));
  SurfaceMesh mesh;
  std::vector<Vec3> x;
  for (int i = 0; i <= nx; ++i)
    for (int j = 0; j <= ny; ++j) {
      const double px = from + (to - from) * i / nx, py = half * (2.0 * j / ny - 1.0);
      x.emplace_back(px, py, z - depth(px, py));
      if (i == 0 || j == 0) continue;
      const int here = i * (ny + 1) + j, back = here - (ny + 1);
      quad(mesh, back - 1, back, here, here - 1);
    }
  return {std::move(mesh), std::move(x)};
}

double cone_height(double diameter, double angle) {
  FURROW_ASSERT(diameter > 0.0 && angle > 0.0 && angle < std::numbers::pi, diameter, angle);
  return 0.5 * diameter / std::tan(0.5 * angle);
}

double cone_base_area(double diameter) {
  FURROW_ASSERT(diameter > 0.0, diameter);
  const double turn = 2.0 * std::numbers::pi / kFacets;
  return 0.125 * kFacets * diameter * diameter * std::sin(turn);
}

Tool cone_on_shaft(const Vec3& point, double diameter, double angle, double shaft, double shaft_length) {
  FURROW_ASSERT(shaft > 0.0 && shaft_length > 0.0, shaft, shaft_length);
  SurfaceMesh mesh;
  std::vector<Vec3> x{point};
  const double base = cone_height(diameter, angle);
  const auto ring = [&](double radius, double z) {
    for (int k = 0; k < kFacets; ++k) {
      const double phi = 2.0 * std::numbers::pi * k / kFacets;
      x.push_back(point + Vec3(radius * std::cos(phi), radius * std::sin(phi), z));
    }
  };
  ring(0.5 * diameter, base);
  ring(0.5 * shaft * diameter, base);
  ring(0.5 * shaft * diameter, base + shaft_length);
  x.push_back(point + Vec3(0.0, 0.0, base + shaft_length));
  const int top = static_cast<int>(x.size()) - 1;
  for (int k = 0; k < kFacets; ++k) {
    const int a = 1 + k, b = 1 + (k + 1) % kFacets;
    mesh.triangles.push_back({0, b, a});
    for (int level = 0; level < 2; ++level) {
      const int low = level * kFacets, high = low + kFacets;
      quad(mesh, a + low, b + low, b + high, a + high);
    }
    mesh.triangles.push_back({a + 2 * kFacets, b + 2 * kFacets, top});
  }
  return {std::move(mesh), std::move(x)};
}

ContactMaterial rough_material(const dem::DemOptions& grains) {
  ContactMaterial m = dem::grain_material(grains);
  m.cohesion = 0.0;
  return m;
}

ContactMaterial smooth_material(const dem::DemOptions& grains) {
  ContactMaterial m = rough_material(grains);
  m.friction = std::min(m.friction, kSteelFriction);
  return m;
}

}  // namespace furrow::terrain::soil
