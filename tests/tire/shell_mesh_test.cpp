// Geometry and mass of the tire files against figures for the HMMWV tire and closed forms.
#include "tire/shell_mesh.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "tire/natural_spline.hpp"

namespace furrow::tire {
namespace {

struct Made {
  TireFile file;
  ShellMesh mesh;
  std::vector<ElementMass> masses;
  explicit Made(const char* name)
      : file(read_tire_file(std::string(TIRE_DATA "/") + name)),
        mesh(make_shell_mesh(file)),
        masses(element_masses(file, mesh)) {}
};

TEST(ShellMesh, layered_tire_weighs_what_its_layup_says) {
  const Made tire("hmmwv_layered.json");
  const MassProperties m = rigid_mass(tire.mesh, tire.masses);
  EXPECT_NEAR(m.mass, 4.82, 0.02);   // kg
  EXPECT_GT(m.inertia(1, 1), 0.78);  // kg m²
  EXPECT_LT(m.inertia(1, 1), 0.79);
  EXPECT_NEAR(m.inertia(0, 0), m.inertia(2, 2), 1e-12);
}

TEST(ShellMesh, lumped_tire_is_the_heavier_one) {
  const Made tire("hmmwv_lumped.json");
  const MassProperties m = rigid_mass(tire.mesh, tire.masses);
  EXPECT_NEAR(m.mass, 11.5, 0.05);
  EXPECT_NEAR(m.inertia(1, 1), 2.05, 0.01);
}

TEST(ShellMesh, half_torus_mass_matches_pappus) {
  Made tire("toroidal.json");
  tire.file.elements_circumference = 180;
  set_elements_width(tire.file, 60);
  const ShellMesh mesh = make_shell_mesh(tire.file);
  // Half circle of radius a, centroid 2a/π outside the rim radius: A = π a · 2π (R + 2a/π)
  const double a = 0.195, area = std::numbers::pi * a * 2 * std::numbers::pi * (0.35 + 2 * a / std::numbers::pi);
  EXPECT_NEAR(rigid_mass(mesh, element_masses(tire.file, mesh)).mass, 500 * 0.014 * area, 2e-3 * 500 * 0.014 * area);
}

TEST(ShellMesh, tread_rubber_adds_its_mass) {
  Made tire("hmmwv_layered.json");
  tire.file.tread_mass_per_area = 10.0;
  const double heavier =
      rigid_mass(tire.mesh, element_masses(tire.file, tire.mesh)).mass - rigid_mass(tire.mesh, tire.masses).mass;
  EXPECT_NEAR(heavier, 10.0 * 2 * std::numbers::pi * 0.4673 * 0.29,
              1.0);  // meridian length of the tread about 0.29 m
}

TEST(ShellMesh, tread_rubber_on_a_torus_weighs_its_outer_surface_times_mass_per_area) {
  Made tire("toroidal.json");
  tire.file.elements_circumference = 180;
  set_elements_width(tire.file, 60);
  tire.file.tread_mass_per_area = 15.0;
  const ShellMesh mesh = make_shell_mesh(tire.file);
  const MassProperties with = rigid_mass(mesh, element_masses(tire.file, mesh));
  tire.file.tread_mass_per_area = 0.0;
  const MassProperties without = rigid_mass(mesh, element_masses(tire.file, mesh));
  // The tread is the middle half of the half circle: |θ| < π/4 of a tube of radius a = 0.195 + 0.007, on R = 0.35.
  const double a = 0.202, r = 0.35, t = std::numbers::pi / 4, s = std::sin(t);
  const double area = 2 * std::numbers::pi * a * (2 * r * t + 2 * a * s);
  EXPECT_NEAR(with.mass - without.mass, 15.0 * area, 1e-3 * 15.0 * area);
  // ∫ (R + a cos θ)³ 2π a dθ
  const double cube = 2 * std::numbers::pi * a *
                      (2 * t * r * r * r + 6 * r * r * a * s + 3 * r * a * a * (t + s * std::cos(t)) +
                       2 * a * a * a * (s - s * s * s / 3));
  EXPECT_NEAR(with.inertia(1, 1) - without.inertia(1, 1), 15.0 * cube, 2e-3 * 15.0 * cube);
}

TEST(ShellMesh, surface_is_closed_and_faces_outwards) {
  const Made tire("hmmwv_layered.json");
  const SurfaceMesh surface = make_surface_mesh(tire.mesh);
  std::vector<Vec3> x;
  for (int i = 0; i < tire.mesh.columns; ++i)
    for (int j = 0; j < tire.mesh.rows; ++j) x.push_back(tire.mesh.node_position(i, j));
  x.push_back(tire.mesh.disc_centre(0));
  x.push_back(tire.mesh.disc_centre(1));
  ASSERT_EQ(static_cast<int>(x.size()), surface.vertex_count);
  std::map<std::pair<int, int>, int> edges;
  double volume = 0.0;
  for (const auto& t : surface.triangles) {
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
    volume += x[t[0]].dot(x[t[1]].cross(x[t[2]])) / 6;
  }
  for (const auto& [edge, count] : edges) {
    EXPECT_EQ(count, 1);
    EXPECT_EQ(edges.count({edge.second, edge.first}), 1u);
  }
  EXPECT_GT(volume, 0.16);  // m³
  EXPECT_LT(volume, 0.18);
}

TEST(ShellMesh, surface_triangles_are_mirrored_about_the_mid_plane) {
  const Made tire("hmmwv_layered.json");
  const SurfaceMesh surface = make_surface_mesh(tire.mesh);
  const int rows = tire.mesh.rows, nodes = tire.mesh.nodes();
  const auto key = [](std::array<int, 3> t) {
    std::sort(t.begin(), t.end());
    return t;
  };
  std::map<std::array<int, 3>, int> set;
  for (const auto& t : surface.triangles) ++set[key(t)];
  for (const auto& t : surface.triangles) {
    std::array<int, 3> mirrored;
    for (int k = 0; k < 3; ++k)
      mirrored[k] = t[k] >= nodes ? nodes + 1 - (t[k] - nodes) : t[k] - t[k] % rows + (rows - 1 - t[k] % rows);
    EXPECT_EQ(set.count(key(mirrored)), 1u);
  }
}

TEST(NaturalSpline, passes_its_knots_and_reproduces_a_straight_line) {
  const NaturalSpline line({0, 0.3, 0.5, 1}, {1, 1.6, 2, 3});
  EXPECT_NEAR(line.value(0.77), 2.54, 1e-14);
  EXPECT_NEAR(line.slope(0.1), 2.0, 1e-14);
  const NaturalSpline wave({0, 0.25, 0.5, 0.75, 1}, {0, 1, 0, -1, 0});
  EXPECT_NEAR(wave.value(0.25), 1, 1e-15);
  EXPECT_NEAR((wave.value(0.4 + 1e-6) - wave.value(0.4 - 1e-6)) / 2e-6, wave.slope(0.4), 1e-8);
}

}  // namespace
}  // namespace furrow::tire
