// Properties of every element: constant states on distorted meshes, no force under rigid motion, forces and tangent
// that are derivatives. The vectorised ring must equal an assembly element by element.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "tests/tire/ancf/shell_patch.hpp"
#include "tests/tire/ancf/small_tire.hpp"
#include "tests/tire/verification/cyclic.hpp"
#include "tests/verification/record.hpp"

namespace furrow::test {
namespace {

using verification::verify;

constexpr double kYoung = 2.0e7, kPoisson = 0.3, kThickness = 0.05;  // Pa, –, m
const char* kExact = "exact constant state";

/// The inner quadrilateral turned by 0, 20 and 40° from a mild to a strong distortion.
PatchMesh twisted_mesh(double degrees) {
  PatchMesh mesh = distorted_mesh();
  const Vec3 centre(0.95, 0.5, 0);
  const Mat3 turn = Eigen::AngleAxisd(degrees * std::numbers::pi / 180, Vec3::UnitZ()).toRotationMatrix();
  for (int n = 4; n < 8; ++n) mesh.position[n] = centre + turn * (mesh.position[n] - centre);
  return mesh;
}

std::vector<int> outside() { return {0, 1, 2, 3}; }

/// Free coordinates from equilibrium, the others as in `exact`.
Vector solve(const ShellPatch& patch, const Supports& supports, const Vector& exact) {
  StaticPath path(patch, supports, Vector::Zero(patch.coordinates()));
  path.prescribe([&](double share, Vector& q) {
    for (int c = 0; c < patch.coordinates(); ++c)
      if (supports.fixed(c)) q[c] = patch.reference()[c] + share * (exact[c] - patch.reference()[c]);
  });
  EXPECT_TRUE(path.go_to(1.0));
  return path.q();
}

std::string mesh_name(double degrees) {
  return "5 elements, inner one turned by " + verification::brief(degrees) + " deg";
}

TEST(Patch, membrane_state) {
  Mat3 f;
  f << 1.04, 0.03, 0, -0.02, 0.98, 0, 0, 0, 1;
  const Mat3 e = 0.5 * (f.transpose() * f - Mat3::Identity());
  f(2, 2) = std::sqrt(1 - 2 * kPoisson / (1 - kPoisson) * (e(0, 0) + e(1, 1)));  // S₃₃ = 0
  const double density = 0.5 * kYoung / (1 - kPoisson * kPoisson) *
                         (e(0, 0) * e(0, 0) + e(1, 1) * e(1, 1) + 2 * kPoisson * e(0, 0) * e(1, 1) +
                          2 * (1 - kPoisson) * e(0, 1) * e(0, 1));
  for (const double turn : {0.0, 20.0, 40.0}) {
    const ShellPatch patch(twisted_mesh(turn), {isotropic_layer(kThickness, kYoung, kPoisson)});
    Vector exact = patch.reference();
    for (int n = 0; n < 8; ++n)
      for (const int s : {0, 3}) exact.segment<3>(6 * n + s) = f * exact.segment<3>(6 * n + s);
    const Vector q = solve(patch, Supports(8).fix(outside(), "xyz"), exact);
    verification::verify("membrane patch", "largest coordinate off, " + mesh_name(turn),
                         (q - exact).cwiseAbs().maxCoeff(), 0.0, 1e-11, kExact, 1.0);
    verification::verify("membrane patch", "energy, J, " + mesh_name(turn), patch.energy(q), density * 2 * kThickness,
                         1e-9, "plane stress");
  }
}

TEST(Patch, thickness_state) {
  const double e33 = 0.5 * (1.02 * 1.02 - 1), c33 = kYoung * (1 - kPoisson) / ((1 + kPoisson) * (1 - 2 * kPoisson));
  for (const double turn : {0.0, 20.0, 40.0}) {
    const ShellPatch patch(twisted_mesh(turn), {isotropic_layer(kThickness, kYoung, kPoisson)});
    Vector exact = patch.reference();
    for (int n = 0; n < 8; ++n) exact[6 * n + 5] = 1.02;
    const Vector q = solve(patch, Supports(8).fix(outside(), "xyzabc").fix({4, 5, 6, 7}, "abc"), exact);
    verification::verify("thickness patch", "largest coordinate off, " + mesh_name(turn),
                         (q - exact).cwiseAbs().maxCoeff(), 0.0, 1e-11, kExact, 1.0);
    verification::verify("thickness patch", "energy, J, " + mesh_name(turn), patch.energy(q),
                         0.5 * c33 * e33 * e33 * 2 * kThickness, 1e-9, "c33 of the material");
  }
}

TEST(Patch, bending_state) {
  const double kxx = 1e-5, kyy = -0.6e-5, kxy = 0.4e-5;  // 1/m; w = ½ (kxx x² + kyy y²) + kxy x y
  const double d = kYoung * std::pow(kThickness, 3) / (12 * (1 - kPoisson * kPoisson));
  const double theory = d * (kxx * kxx + kyy * kyy + 2 * kPoisson * kxx * kyy + 2 * (1 - kPoisson) * kxy * kxy);
  for (const double turn : {0.0, 20.0, 40.0}) {
    const ShellPatch patch(twisted_mesh(turn), {isotropic_layer(kThickness, kYoung, kPoisson)});
    Vector exact = patch.reference();
    for (int n = 0; n < 8; ++n) {
      const double x = exact[6 * n], y = exact[6 * n + 1];
      exact[6 * n + 2] = 0.5 * (kxx * x * x + kyy * y * y) + kxy * x * y;
      exact[6 * n + 3] = -(kxx * x + kxy * y);
      exact[6 * n + 4] = -(kyy * y + kxy * x);
    }
    const Vector q = solve(patch, Supports(8).fix(outside(), "xyzabc"), exact);
    verification::verify("bending patch", "largest deflection off, of the largest, " + mesh_name(turn),
                         (q - exact).cwiseAbs().maxCoeff(), 0.0, 2e-4, kExact, 2e-5);
    verification::verify("bending patch", "energy, J, " + mesh_name(turn), patch.energy(q), theory, 1e-4,
                         "Kirchhoff plate");
  }
}

TEST(Patch, transverse_shear_state) {
  const double gamma = 1e-4, shear = kYoung / (2 * (1 + kPoisson));
  for (const double turn : {0.0, 20.0, 40.0}) {
    const ShellPatch patch(twisted_mesh(turn), {isotropic_layer(kThickness, kYoung, kPoisson)});
    Vector exact = patch.reference();
    for (int n = 0; n < 8; ++n) exact[6 * n + 2] = gamma * exact[6 * n];  // directors stay
    const Vector q = solve(patch, Supports(8).fix(outside(), "xyzabc").fix({4, 5, 6, 7}, "abc"), exact);
    verification::verify("shear patch", "largest coordinate off, of the largest, " + mesh_name(turn),
                         (q - exact).cwiseAbs().maxCoeff(), 0.0, 1e-3, kExact, 2 * gamma);
    verification::verify("shear patch", "energy, J, " + mesh_name(turn), patch.energy(q),
                         0.5 * shear * gamma * gamma * 2 * kThickness, 1e-3, "shear correction factor 1");
  }
}

/// A piece of a sphere of radius 1 m, layered.
ShellPatch dome() {
  const Ply ply{7.56e9, 4.74e7, 1.634e7, 1.634e7, 0.45, 0.45};
  return ShellPatch(grid_mesh(4, 4,
                              [](double s, double t) {
                                const Vec3 d(std::sin(s - 0.4) * std::cos(t), std::sin(t),
                                             std::cos(s - 0.4) * std::cos(t));
                                return std::pair(d, d);
                              }),
                    {ply_layer(2e-3, 45, ply), ply_layer(1e-3, 0, ply), ply_layer(2e-3, -45, ply)});
}

Vector moved(const ShellPatch& patch, const Vector& q, const Mat3& turn, const Vec3& shift) {
  Vector out = q;
  for (int n = 0; n < patch.nodes(); ++n) {
    out.segment<3>(6 * n) = turn * q.segment<3>(6 * n) + shift;
    out.segment<3>(6 * n + 3) = turn * q.segment<3>(6 * n + 3);
  }
  return out;
}

TEST(Patch, rigid_motion_through_many_turns) {
  const ShellPatch patch = dome();
  verification::Worst strain("rigid motion, 100 turns in steps of 37 deg", "largest strain, 4 x 4", 1e-12, "zero");
  verification::Worst force("rigid motion, 100 turns in steps of 37 deg", "largest force over E h L, 4 x 4", 1e-12,
                            "zero");
  const Mat3 step = Eigen::AngleAxisd(37 * std::numbers::pi / 180, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
  Mat3 turn = Mat3::Identity();
  for (int n = 0; n < 973; ++n) {
    turn = Eigen::Quaterniond(step * turn).normalized().toRotationMatrix();
    const Vector q = moved(patch, patch.reference(), turn, 0.01 * n * Vec3(0.3, 1, -0.2));
    double largest = 0.0;
    for (const tire::StrainVector& e : patch.strains(q)) largest = std::max(largest, e.cwiseAbs().maxCoeff());
    strain.add(largest, 0.0, 1.0);
    force.add(patch.forces(q).cwiseAbs().maxCoeff(), 0.0, 7.56e9 * 5e-3 * 1.0);
  }
}

TEST(Patch, stretched_state_turns_with_the_body) {
  const ShellPatch patch = dome();
  std::srand(2);
  const Vector q = patch.reference() + 1e-2 * Vector::Random(patch.coordinates());
  const Mat3 turn = Eigen::AngleAxisd(2.5, Vec3(0.2, 1, 0.4).normalized()).toRotationMatrix();
  const Vector f = patch.forces(q), g = patch.forces(moved(patch, q, turn, Vec3(1, 2, 3)));
  verification::verify("objectivity", "f(R q) - R f(q), 4 x 4", (g - moved(patch, f, turn, Vec3::Zero())).norm(), 0.0,
                       1e-12, "zero", f.norm());
}

TEST(Patch, forces_and_tangent_are_derivatives) {
  const ShellPatch patch = dome();
  std::srand(4);
  const Vector q = patch.reference() + 2e-3 * Vector::Random(patch.coordinates());
  const Vector f = patch.forces(q);
  const Eigen::MatrixXd k = patch.tangent(q);
  verification::Worst gradient("finite differences", "force against energy, 4 x 4", 1e-6, "central differences, 1e-5");
  verification::Worst tangent("finite differences", "tangent against force, 4 x 4", 1e-7, "central differences, 1e-5");
  for (int sample = 0; sample < 40; ++sample) {
    const int c = (37 * sample) % patch.coordinates();
    Vector high = q, low = q;
    high[c] += 1e-5, low[c] -= 1e-5;
    gradient.add(f[c], (patch.energy(high) - patch.energy(low)) / 2e-5, f.cwiseAbs().maxCoeff());
    const Vector column = (patch.forces(high) - patch.forces(low)) / 2e-5;
    tangent.add((k.col(c) - column).cwiseAbs().maxCoeff(), 0.0, column.cwiseAbs().maxCoeff());
  }
}

TEST(Patch, ring_of_the_tire_equals_the_assembly_element_by_element) {
  tire::TireFile file = small_file("hmmwv_lumped.json", 12, 8);
  file.bead.layers = file.sidewall.layers = file.tread.layers;  // one layup, as in a patch
  file.pressure = 0.0;
  const tire::ShellMesh ring = tire::make_shell_mesh(file);
  const tire::ShellCarcass shell(file, ring);
  const ShellPatch patch(ring_patch_mesh(ring, false), tire::shell_layers(file, file.tread));
  std::srand(6);
  const Vector q = patch.reference() + 2e-3 * Vector::Random(patch.coordinates());
  const tire::ShellLayout& layout = shell.layout();
  tire::Field field(layout.size(), 0.0), force(layout.size());
  for (int i = 0; i < ring.columns; ++i)
    for (int j = 0; j < ring.rows; ++j)
      for (const int s : {0, 3}) layout.set(field, i, j, s, q.segment<3>(6 * ring.node(i, j) + s));
  layout.fill_padding(field);
  shell.forces(field, field, tire::Field(shell.strains_size(), 0.0), 1.0, force);
  const Vector f = patch.forces(q);
  double off = 0.0;
  for (int i = 0; i < ring.columns; ++i)
    for (int j = 0; j < ring.rows; ++j)
      for (const int s : {0, 3})
        off = std::max(off, (layout.get(force, i, j, s) - f.segment<3>(6 * ring.node(i, j) + s)).norm());
  verification::verify("vectorised ring", "largest force off, 12 x 8", off, 0.0, 1e-12, "element by element",
                       f.cwiseAbs().maxCoeff());
}

}  // namespace
}  // namespace furrow::test
