// Large deformations of thin shells, isotropic and cross-ply: tabulated finite-element results.
//   Sze, Liu, Lo (2004), Popular benchmark problems for geometric nonlinear analysis of shells, Finite Elem. Anal.
//   Des. 40, doi:10.1016/j.finel.2003.11.001 (Abaqus S4R; consistent units, none stated).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tests/tire/verification/curves.hpp"
#include "tests/tire/verification/mesh_size.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::curve_point;
using verification::verify;

using std::numbers::pi;
const char* kSource = "Sze, Liu & Lo 2004 doi:10.1016/j.finel.2003.11.001";

bool near(double a, double b) { return std::abs(a - b) < 1e-6; }

/// Load, and the two deflections that the table gives.
struct Row {
  double load, first, second;
};

/// Judges two deflections along one path; errors are relative to the largest deflection in the table.
struct Judge {
  std::string name, mesh;
  const char* names[2];
  double tolerance;

  void compare(const std::vector<Row>& table, const Row& ours, const Row& reference) const {
    const double value[2] = {ours.first, ours.second}, known[2] = {reference.first, reference.second},
                 largest[2] = {table.back().first, table.back().second};
    for (int k = 0; k < 2; ++k) {
      verification::curve_point(name, std::string(names[k]) + ", " + mesh, ours.load, value[k], known[k]);
      verification::verify(name, std::string(names[k]) + " at P/Pmax = " + verification::brief(ours.load) + ", " + mesh,
                           value[k], known[k], tolerance, kSource, largest[k]);
    }
  }
};

// --- § 3.3: a ring cut open, one edge clamped, the other lifted by a line force

const std::vector<Row> kSlit = {{0.05, 2.455, 3.370},  {0.1, 4.277, 5.876},    {0.25, 7.602, 10.288},
                                {0.5, 10.468, 13.768}, {0.75, 12.310, 15.842}, {1.0, 13.891, 17.528}};

void slit_plate(int n, int m, double tolerance) {
  const PatchMesh mesh = grid_mesh(n, m, [](double s, double t) {
    const double r = 10 - 4 * t, a = 2 * pi * s;
    return std::pair(Vec3(r * std::cos(a), r * std::sin(a), 0), Vec3(0, 0, 1));
  });
  const ShellPatch patch(mesh, {isotropic_layer(0.03, 21e6, 0.0)});
  std::vector<int> clamp;
  Vector load = Vector::Zero(patch.coordinates());
  const int edge = n * (m + 1);
  for (int j = 0; j <= m; ++j) {
    clamp.push_back(j);
    load[6 * (edge + j) + 2] = 0.8 * 4.0 / m * (j == 0 || j == m ? 0.5 : 1.0);
  }
  StaticPath path(patch, Supports(patch.nodes()).fix(clamp, "xyzabc"), load);
  const Judge judge{"slit annular plate", size(n, m), {"inner edge", "outer edge"}, tolerance};
  for (const Row& row : kSlit) {
    ASSERT_TRUE(path.go_to(row.load));
    judge.compare(kSlit, {row.load, path.q()[6 * (edge + m) + 2], path.q()[6 * edge + 2]}, row);
  }
}

TEST(Published, slit_annular_plate) {
  slit_plate(30, 6, 0.04);
  slit_plate(80, 10, 0.01);
}

// --- § 3.4: a hemisphere with an 18° hole, pulled and pushed at four points; a quarter is modelled

const std::vector<Row> kHemisphere = {
    {0.05, 0.855, 0.955}, {0.25, 2.596, 3.833}, {0.5, 3.406, 5.902}, {0.75, 3.816, 7.234}, {1.0, 4.067, 8.178}};

void hemisphere(int n, double tolerance) {
  const PatchMesh mesh = grid_mesh(n, n, [](double s, double t) {
    const double a = 0.5 * pi * s, b = 0.4 * pi * t;
    const Vec3 d(std::cos(b) * std::cos(a), std::cos(b) * std::sin(a), std::sin(b));
    return std::pair(Vec3(10 * d), d);
  });
  const ShellPatch patch(mesh, {isotropic_layer(0.04, 6.825e7, 0.3)});
  const int a = mesh.nearest({10, 0, 0}), b = mesh.nearest({0, 10, 0});
  Supports supports(patch.nodes());
  supports.fix(mesh.select([](const Vec3& x) { return near(x.y(), 0); }), "yb");
  supports.fix(mesh.select([](const Vec3& x) { return near(x.x(), 0); }), "xa").fix({a}, "z");
  Vector load = Vector::Zero(patch.coordinates());
  load[6 * a] = 200, load[6 * b + 1] = -200;
  const Vector small = linear_solution(patch, supports, load / 200);
  verification::verify("pinched hemisphere, linear", "outward, " + size(n, n), small[6 * a], 0.094, 0.03,
                       "MacNeal & Harder 1985 doi:10.1016/0168-874X(85)90003-4");
  StaticPath path(patch, supports, load);
  const Judge judge{"pinched hemisphere", size(n, n), {"outward", "inward"}, tolerance};
  ASSERT_TRUE(path.go_to(0.01));  // a quartic element has been published here, independent of the table
  const char* quartic = "Elmer, Shell_OpenHemisphere_High_Order_Blending, p = 4";
  verification::verify("pinched hemisphere, 1 % of the load", "outward, " + size(n, n), path.q()[6 * a] - 10, 0.184936,
                       tolerance, quartic);
  verification::verify("pinched hemisphere, 1 % of the load", "inward, " + size(n, n), 10 - path.q()[6 * b + 1],
                       0.189022, tolerance, quartic);
  for (const Row& row : kHemisphere) {
    ASSERT_TRUE(path.go_to(row.load));
    judge.compare(kHemisphere, {row.load, path.q()[6 * a] - 10, 10 - path.q()[6 * b + 1]}, row);
  }
}

TEST(Published, pinched_hemisphere) {
  hemisphere(8, 0.30);
  hemisphere(16, 0.05);
  hemisphere(32, 0.01);
}

// --- § 3.5: an open cylinder pulled at two points; an eighth is modelled. It snaps at P/Pmax = 0.5

struct PullOut {
  static constexpr double kRadius = 4.953, kHalf = 5.175;
  ShellPatch patch;
  int a, b, c;
  Supports supports;

  static PatchMesh make(int n, int m) {
    return grid_mesh(n, m, [](double s, double t) {
      const Vec3 d(std::cos(0.5 * pi * s), 0, std::sin(0.5 * pi * s));
      return std::pair(Vec3(kRadius * d - Vec3(0, kHalf * t, 0)), d);
    });
  }
  PullOut(int n, int m) : patch(make(n, m), {isotropic_layer(0.094, 10.5e6, 0.3125)}), supports(patch.nodes()) {
    const PatchMesh& mesh = patch.mesh();
    a = mesh.nearest({0, 0, kRadius}), b = mesh.nearest({kRadius, 0, 0}), c = mesh.nearest({kRadius, -kHalf, 0});
    supports.fix(mesh.select([](const Vec3& x) { return near(x.z(), 0); }), "zc");
    supports.fix(mesh.select([](const Vec3& x) { return near(x.x(), 0); }), "xa");
    supports.fix(mesh.select([](const Vec3& x) { return near(x.y(), 0); }), "yb");
  }
};

const std::vector<Row> kPullOut = {
    {0.025, 0.819, 0.864}, {0.1, 1.707, 2.217}, {0.3, 2.257, 3.227}, {0.7, 2.672, 4.385}, {1.0, 2.768, 4.551}};

void pull_out(int n, int m, double tolerance) {
  PullOut shell(n, m);
  Vector load = Vector::Zero(shell.patch.coordinates());
  load[6 * shell.a + 2] = 1e4;
  StaticPath path(shell.patch, shell.supports, load);
  const Judge judge{"pull-out of a cylinder", size(n, m), {"pulled point", "side"}, tolerance};
  for (const Row& row : kPullOut) {
    if (path.lambda() < 0.4 && row.load > 0.6) {  // past the snap with the deflection prescribed
      Supports held = shell.supports;
      StaticPath around(shell.patch, held.fix({shell.a}, "z"), Vector::Zero(load.size()));
      around.start(path.q(), path.q()[6 * shell.a + 2]);
      around.prescribe([&](double z, Vector& q) { q[6 * shell.a + 2] = z; });
      for (const double w : {2.4, 2.46, 2.49, 2.52, 2.57, 2.65}) ASSERT_TRUE(around.go_to(PullOut::kRadius + w));
      path.start(around.q(), around.reactions()[6 * shell.a + 2] / 1e4);
    }
    ASSERT_TRUE(path.go_to(row.load));
    judge.compare(kPullOut,
                  {row.load, path.q()[6 * shell.a + 2] - PullOut::kRadius, PullOut::kRadius - path.q()[6 * shell.b]},
                  row);
  }
}

TEST(Published, pull_out_of_an_open_cylinder) {
  pull_out(12, 8, 0.03);
  pull_out(24, 16, 0.02);
}

// --- § 3.8: a shallow roof, hinged along its straight edges, pushed at the middle; a quarter is modelled

struct Roof {
  const char* name;
  std::vector<tire::ShellLayer> layers;          // angles from the circumference; the paper's from the generator
  std::vector<std::pair<double, double>> table;  // deflection, P/3000
};

std::vector<Roof> roofs() {
  constexpr double h = 12.7;
  const Ply ply{3300, 1100, 660, 440, 0.25, 0.25};
  const tire::ShellLayer along = ply_layer(h / 3, 90, ply), around = ply_layer(h / 3, 0, ply);
  return {{"hinged roof, isotropic",
           {isotropic_layer(h, 3102.75, 0.3)},
           {{0.693, 0.0877},
            {4.477, 0.4686},
            {8.237, 0.6908},
            {11.293, 0.7421},
            {14.188, 0.6182},
            {17.094, 0.2717},
            {19.852, 0.1729},
            {22.875, 0.2950},
            {26.601, 0.6644},
            {29.374, 1.0835}}},
          {"hinged roof, 0/90/0",
           {along, around, along},
           {{0.807, 0.0546},
            {4.548, 0.2494},
            {7.961, 0.3459},
            {9.884, 0.3618},
            {13.458, 0.2778},
            {17.141, 0.0007},
            {19.024, -0.0504},
            {22.707, 0.0194},
            {26.244, 0.2178},
            {30.229, 0.5769}}},
          {"hinged roof, 90/0/90",
           {around, along, around},
           {{0.649, 0.0556},
            {4.781, 0.3389},
            {8.654, 0.5070},
            {12.024, 0.5838},
            {14.192, 0.5970},
            {17.028, 0.5542},
            {19.249, 0.3991},
            {21.318, 0.2789},
            {24.476, 0.3755},
            {29.844, 0.8444}}}};
}

void press_roof(const Roof& roof, int n, double tolerance) {
  static constexpr double kRadius = 2540;
  const PatchMesh mesh = grid_mesh(n, n, [](double s, double t) {
    const Vec3 d(std::sin(0.1 * s), 0, std::cos(0.1 * s));
    return std::pair(Vec3(kRadius * d + Vec3(0, 254 * t, 0)), d);
  });
  const ShellPatch patch(mesh, roof.layers);
  Supports supports(patch.nodes());
  supports.fix(mesh.select([](const Vec3& x) { return near(x.x(), 0); }), "xa");
  supports.fix(mesh.select([](const Vec3& x) { return near(x.y(), 0); }), "yb").fix({0}, "z");
  supports.fix(mesh.select([](const Vec3& x) { return near(x.x(), kRadius * std::sin(0.1)); }), "xyz");
  StaticPath path(patch, supports, Vector::Zero(patch.coordinates()));
  path.prescribe([](double w, Vector& q) { q[2] = kRadius - w; });
  verification::Worst worst(roof.name, "load at a deflection, of the limit load, " + size(n, n), tolerance, kSource);
  double limit = 0.0;
  for (const auto& [w, p] : roof.table)
    if (w < 16) limit = std::max(limit, p);
  for (const auto& [w, p] : roof.table) {
    ASSERT_TRUE(path.go_to(w));
    const double ours = -4 * path.reactions()[2] / 3000;
    verification::curve_point(roof.name, size(n, n), ours, w, p);
    worst.add(ours, p, limit, "w = " + verification::brief(w));
  }
}

TEST(Published, hinged_roofs_snapping_through) {
  for (const Roof& roof : roofs()) {
    press_roof(roof, 8, 0.06);
    press_roof(roof, 16, 0.03);
  }
}

}  // namespace
}  // namespace furrow::test
