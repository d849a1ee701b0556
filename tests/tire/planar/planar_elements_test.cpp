// The triangles of the planar tire against closed forms, and general properties of elements.
#include "tire/planar/planar_elements.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <numbers>

#include "tests/tire/planar/planar_examples.hpp"

namespace furrow::tire {
namespace {

constexpr PlanarLaw kLaws[] = {PlanarLaw::printed, PlanarLaw::consistent};

/// One triangle with a right angle, legs of 1 m.
PlanarMesh one_triangle() {
  PlanarMesh m;
  m.position.x = {0.0, 1.0, 0.0}, m.position.z = {0.0, 0.0, 1.0};
  m.triangles = {{0, 1, 2}}, m.part = {0};
  return m;
}

PlanarField force_at(PlanarElements elements, const PlanarField& x, const PlanarField& v) {
  PlanarField f(x.size());
  EXPECT_TRUE(elements.force(x, v, f));
  return f;
}

Eigen::Matrix2d turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

TEST(PlanarElements, stress_of_a_given_deformation_is_the_papers) {
  const double e = 2e5, nu = 0.3, mu = e / 2.6, lambda = e * nu / (1.3 * 0.4);
  const PlanarMaterial material{1000.0, e, nu, 0.0};
  Eigen::Matrix2d f;
  f << 1.1, 0.2, -0.1, 0.9;
  const double j = f.determinant();
  for (const PlanarLaw law : kLaws) {
    const PlanarElements elements(one_triangle(), std::array{material}, {.law = law});
    const PlanarStress t = elements.stress(mapped(one_triangle().position, f), 0);
    const Eigen::Matrix2d g = 0.5 * (f * f.transpose() - Eigen::Matrix2d::Identity());
    const double volume = (law == PlanarLaw::printed ? 1.0 : 0.5) * lambda * (j - 1.0 / j);
    const Eigen::Matrix2d expected = 2.0 * mu * g / j + volume * Eigen::Matrix2d::Identity();
    EXPECT_NEAR(t.xx, expected(0, 0), 1e-9 * e);
    EXPECT_NEAR(t.xz, expected(0, 1), 1e-9 * e);
    EXPECT_NEAR(t.zz, expected(1, 1), 1e-9 * e);
  }
}

TEST(PlanarElements, small_strains_follow_hooke_and_the_printed_form_a_larger_poisson_ratio) {
  const double strain = 1e-7;
  Eigen::Matrix2d f = Eigen::Matrix2d::Identity();
  f(0, 0) += strain;
  for (const PlanarLaw law : kLaws) {
    const PlanarElements elements(one_triangle(), std::array{kRubber}, {.law = law});
    const PlanarStress t = elements.stress(mapped(one_triangle().position, f), 0);
    const double mu = 3e5 / 2.9, lambda = 3e5 * 0.45 / (1.45 * 0.1);
    const double doubled = law == PlanarLaw::printed ? 2.0 : 1.0;
    EXPECT_NEAR(t.xx / strain, 2.0 * mu + doubled * lambda, 1.0);
    EXPECT_NEAR(t.zz / strain, doubled * lambda, 1.0);
    // λ' = 2λ, μ' = μ: ν' = λ' / (2 (λ' + μ')), E' = 2 μ' (1 + ν')
    const double poisson = doubled * lambda / (2.0 * (doubled * lambda + mu));
    EXPECT_NEAR(poisson, law == PlanarLaw::printed ? 0.474 : 0.45, 5e-4);
    EXPECT_NEAR(2.0 * mu * (1.0 + poisson) / 3e5, law == PlanarLaw::printed ? 1.016 : 1.0, 1e-3);
  }
}

TEST(PlanarElements, a_stretched_triangle_pulls_its_nodes_together) {
  const PlanarMesh m = one_triangle();
  const PlanarField f =
      force_at(PlanarElements(m, std::array{kRubber}, {}), mapped(m.position, 1.1 * turn(0.0)), PlanarField(3));
  EXPECT_GT(std::min(f.x[0], f.z[0]), 0.0);  // towards the others
  EXPECT_LT(std::max(f.x[1], f.z[2]), 0.0);
  // Half of T n of each side at the corner, T = p I: sides are 1.1 m long.
  const double p = PlanarElements(m, std::array{kRubber}, {}).stress(mapped(m.position, 1.1 * turn(0.0)), 0).xx;
  EXPECT_NEAR(f.x[0], 0.5 * p * 1.1, 1e-9 * p);
  EXPECT_NEAR(f.x[1], -0.5 * p * 1.1, 1e-9 * p);
}

TEST(PlanarElements, mass_is_density_times_area_and_width) {
  const PlanarMesh m = small_wheel(60, 4);
  const PlanarElements elements = wheel_elements(m, {.width = 0.3});
  double mass = 0.0;
  for (const double one : elements.mass()) mass += one;
  const double share = 60 * 0.5 * std::sin(2.0 * std::numbers::pi / 60);  // polygon over r²
  EXPECT_NEAR(mass, 0.3 * share * (900.0 * 0.0625 + 1100.0 * (0.25 - 0.0625)), 1e-9);
  EXPECT_NEAR(PlanarElements(one_triangle(), std::array{kRubber}, {}).mass()[0], 1100.0 / 6.0,
              1e-12);  // ρ|F_I|/6
}

TEST(PlanarElements, rigid_motions_cost_nothing) {
  const PlanarMesh m = small_wheel();
  for (const bool averaged : {false, true})
    for (const PlanarLaw law : kLaws) {
      PlanarElements elements = wheel_elements(m, {.law = law, .averaged = averaged}, 50.0);
      for (const double angle : {0.0, 0.4, 2.0, -3.1}) {
        const PlanarField x = mapped(m.position, turn(angle), 40.0, -3.0);
        PlanarField v = x;  // spin of 10 rad/s, and a velocity
        for (std::size_t n = 0; n < x.size(); ++n) v.x[n] = -10.0 * x.z[n] + 4.0, v.z[n] = 10.0 * x.x[n];
        const double size = 5e6 * 0.05;  // modulus × an element's side
        EXPECT_LT(largest(force_at(elements, x, v)), 1e-11 * size);
        EXPECT_LT(std::abs(elements.energy(x)), 1e-10 * size);
        EXPECT_LT(std::abs(elements.viscous_power(x, v)), 1e-10 * size);
      }
    }
}

TEST(PlanarElements, patch_test_a_linear_map_leaves_inner_nodes_in_balance) {
  PlanarMesh m = planar_disc(1.0, 30);
  const PlanarField wander = random_planar(m.position.size(), 0.03, 7);
  std::vector<char> edge(m.position.size(), 0);
  for (const int n : m.outer) edge[n] = 1;
  for (std::size_t n = 0; n < wander.size(); ++n)
    if (!edge[n]) m.position.x[n] += wander.x[n], m.position.z[n] += wander.z[n];
  Eigen::Matrix2d f;
  f << 1.3, 0.4, -0.2, 0.8;
  for (const bool averaged : {false, true})
    for (const double viscosity : {0.0, 100.0}) {
      PlanarMaterial material = kRubber;
      material.viscosity = viscosity;
      PlanarElements elements(m, std::array{material}, {.averaged = averaged});
      const PlanarField x = mapped(m.position, f), v = mapped(m.position, 3.0 * f);
      const PlanarField force = force_at(elements, x, v);
      for (std::size_t n = 0; n < x.size(); ++n)
        EXPECT_LT(edge[n] ? 0.0 : std::hypot(force.x[n], force.z[n]), 1e-8) << n;
      EXPECT_GT(largest(force), 1e3);
      for (const int e : {0, elements.size() / 2, elements.size() - 1})
        EXPECT_NEAR(elements.stress(x, e).xz, elements.stress(x, 5).xz, 1e-7);
    }
}

TEST(PlanarElements, force_is_the_derivative_of_the_energy_and_tangent_of_the_force) {
  const PlanarMesh m = small_wheel(18, 3);
  Eigen::Matrix2d f;
  f << 0.8, 0.3, 0.1, 1.2;
  const PlanarField x = along(mapped(m.position, f), random_planar(m.position.size(), 0.006, 3), 1.0);
  for (const bool averaged : {false, true})
    for (const PlanarLaw law : kLaws) {
      const PlanarElements elements = wheel_elements(m, {.law = law, .averaged = averaged, .width = 0.7});
      const Eigen::MatrixXd k = assembled(elements, x);
      EXPECT_LT((k - k.transpose()).norm(), 1e-12 * k.norm());
      for (unsigned seed = 10; seed < 14; ++seed) {
        const PlanarField way = random_planar(x.size(), 1.0, seed), still(x.size());
        const double h = 1e-5;
        const PlanarField ahead = along(x, way, h), behind = along(x, way, -h);
        const PlanarField force = force_at(elements, x, still);
        const double slope = (elements.energy(ahead) - elements.energy(behind)) / (2.0 * h);
        EXPECT_NEAR(slope, -dot(force, way), 2e-7 * std::sqrt(dot(force, force) * dot(way, way)));
        const PlanarField change = along(force_at(elements, ahead, still), force_at(elements, behind, still), -1.0);
        double off = 0.0, size = 0.0;
        for (std::size_t n = 0; n < x.size(); ++n)
          for (const int i : {0, 1}) {
            double sum = 0.0;
            for (std::size_t b = 0; b < x.size(); ++b)
              sum += k(2 * n + i, 2 * b) * way.x[b] + k(2 * n + i, 2 * b + 1) * way.z[b];
            off = std::max(off, std::abs(sum + (i == 0 ? change.x[n] : change.z[n]) / (2.0 * h)));
            size = std::max(size, std::abs(sum));
          }
        EXPECT_LT(off, 1e-6 * size) << averaged;
      }
    }
}

TEST(PlanarElements, forces_have_no_resultant_and_viscosity_takes_what_it_says) {
  const PlanarMesh m = small_wheel();
  const PlanarField x = along(m.position, random_planar(m.position.size(), 0.008, 5), 1.0);
  const PlanarField v = random_planar(x.size(), 2.0, 6), still(x.size());
  for (const bool averaged : {false, true}) {
    const PlanarElements elements = wheel_elements(m, {.averaged = averaged}, 80.0);
    const PlanarField moving = force_at(elements, x, v), resting = force_at(elements, x, still);
    double sum_x = 0.0, sum_z = 0.0, moment = 0.0;
    for (std::size_t n = 0; n < x.size(); ++n)
      sum_x += moving.x[n], sum_z += moving.z[n], moment += moving.x[n] * x.z[n] - moving.z[n] * x.x[n];
    const double size = largest(moving);
    EXPECT_LT(std::abs(sum_x) + std::abs(sum_z) + std::abs(moment), 1e-11 * size);
    const double power = elements.viscous_power(x, v);
    EXPECT_GT(power, 0.0);
    EXPECT_NEAR(dot(resting, v) - dot(moving, v), power, 1e-10 * power);
  }
}

TEST(PlanarElements, a_triangle_turned_inside_out_and_a_missing_number_are_noticed) {
  const PlanarMesh m = one_triangle();
  PlanarElements elements(m, std::array{kRubber}, {});
  PlanarField x = m.position, f(3);
  x.x[1] = -0.1;
  EXPECT_FALSE(elements.force(x, PlanarField(3), f));
  x.x[1] = std::nan("");
  EXPECT_FALSE(elements.force(x, PlanarField(3), f));
}

/// Static solution with linear stiffness at rest: unknowns of nodes with a held direction are zero.
Eigen::VectorXd linear_solution(const PlanarElements& elements, const PlanarMesh& mesh, const Eigen::VectorXd& load,
                                const std::vector<int>& held) {
  Eigen::MatrixXd k = assembled(elements, mesh.position);
  for (const int u : held) k.row(u).setZero(), k.col(u).setZero(), k(u, u) = 1.0;
  Eigen::VectorXd right = load;
  for (const int u : held) right[u] = 0.0;
  return k.llt().solve(right);
}

TEST(PlanarElements, thick_ring_under_pressure_converges_to_lame) {
  // u(r) = p a² / (b² − a²) · (1 + ν)/E · [(1 − 2ν) r + b²/r]                       [Timoshenko & Goodier, art. 28]
  const double a = 0.3, b = 0.5, p = 100.0, e = 3e5, nu = 0.3;
  const double exact = p * a * a / (b * b - a * a) * (1 + nu) / e * ((1 - 2 * nu) * a + b * b / a);
  double before = 1.0;
  for (const int size : {1, 2, 4}) {
    const PlanarMesh m = planar_annulus(a, b, 3 * size, 24 * size);
    const PlanarElements elements(m, std::array{PlanarMaterial{1000.0, e, nu, 0.0}}, {});
    Eigen::VectorXd load = Eigen::VectorXd::Zero(2 * m.nodes());
    const int n = static_cast<int>(m.inner.size());
    for (int j = 0; j < n; ++j) {
      const int s = m.inner[j], t = m.inner[(j + 1) % n];
      const double dx = m.position.x[t] - m.position.x[s], dz = m.position.z[t] - m.position.z[s];
      for (const int node : {s, t}) load[2 * node] += 0.5 * p * dz, load[2 * node + 1] -= 0.5 * p * dx;
    }
    // Held against translation and rotation, which is without reaction: x of the lowest and the highest node, z of one.
    const int low = m.outer[0], high = m.outer[n / 2];
    const Eigen::VectorXd u = linear_solution(elements, m, load, {2 * low, 2 * high, 2 * m.outer[n / 4] + 1});
    double mean = 0.0;
    for (const int node : m.inner)
      mean += (u[2 * node] * m.position.x[node] + u[2 * node + 1] * m.position.z[node]) / a / n;
    const double off = std::abs(mean / exact - 1.0);
    EXPECT_LT(off, 0.35 * before) << size;
    before = off;
  }
  EXPECT_LT(before, 4e-3);
}

TEST(PlanarElements, disc_under_diametral_load_converges_to_the_closed_form) {
  // Plane strain, load P per width at both ends of a diameter of length d. At the centre σ = 2P/(πd) across and
  // −6P/(πd) along; the diameter across grows by P/E' (4/π − 1 + ν'), E' = E/(1 − ν²), ν' = ν/(1 − ν)
  // [Timoshenko & Goodier, art. 41; Hondros 1959].
  const double radius = 0.25, load = 10.0, e = 1e6, nu = 0.3;
  const double plane_e = e / (1 - nu * nu), plane_nu = nu / (1 - nu);
  const double growth = load / plane_e * (4.0 / std::numbers::pi - 1.0 + plane_nu);
  double before = 1.0;
  for (const int around : {24, 48, 96}) {
    const PlanarMesh m = planar_disc(radius, around);
    const PlanarElements elements(m, std::array{PlanarMaterial{1000.0, e, nu, 0.0}}, {});
    Eigen::VectorXd push = Eigen::VectorXd::Zero(2 * m.nodes());
    const int low = m.outer[0], high = m.outer[around / 2], side = m.outer[around / 4], other = m.outer[3 * around / 4];
    push[2 * low + 1] = load, push[2 * high + 1] = -load;
    const Eigen::VectorXd u = linear_solution(elements, m, push, {0, 1, 2 * low});  // the centre, and against turning
    const double off = std::abs((u[2 * side] - u[2 * other]) / growth - 1.0);
    EXPECT_LT(off, 0.5 * before) << around;
    before = off;
    if (around < 96) continue;
    PlanarField x = m.position;
    for (int n = 0; n < m.nodes(); ++n) x.x[n] += u[2 * n], x.z[n] += u[2 * n + 1];
    double across = 0.0, along_load = 0.0;
    for (int n = 0; n < 6; ++n) across += elements.stress(x, n).xx / 6, along_load += elements.stress(x, n).zz / 6;
    EXPECT_NEAR(across, load / (std::numbers::pi * radius), 0.03 * load / (std::numbers::pi * radius));
    EXPECT_NEAR(along_load, -3.0 * load / (std::numbers::pi * radius), 0.03 * load / radius);
  }
  EXPECT_LT(before, 1e-2);
}

/// Cells of two triangles each over the given length and height, its middle at the origin; nodes row by row from below.
PlanarMesh strip(double length, double height, int along, int through) {
  PlanarMesh m;
  m.position = PlanarField((along + 1) * (through + 1));
  for (int k = 0; k <= through; ++k)
    for (int i = 0; i <= along; ++i) {
      m.position.x[k * (along + 1) + i] = length * (static_cast<double>(i) / along - 0.5);
      m.position.z[k * (along + 1) + i] = height * (static_cast<double>(k) / through - 0.5);
    }
  for (int k = 0; k < through; ++k)
    for (int i = 0; i < along; ++i) {
      const int a = k * (along + 1) + i, b = a + along + 1;
      m.triangles.push_back({a, a + 1, b + 1}), m.triangles.push_back({a, b + 1, b});
    }
  m.part.assign(m.triangles.size(), 0);
  return m;
}

/// Bending of a strip by linear stresses on its ends, relative to M (1 − ν²)/(E I) of plane strain.
double bending(double poisson_ratio, bool averaged, int size) {
  const double length = 1.0, height = 0.2, e = 3e5, moment = 1.0;
  const int along = 10 * size, through = 2 * size;
  const PlanarMesh m = strip(length, height, along, through);
  const PlanarElements elements(m, std::array{PlanarMaterial{1000.0, e, poisson_ratio, 0.0}}, {.averaged = averaged});
  const double inertia = height * height * height / 12.0, cell = height / through;
  Eigen::VectorXd push = Eigen::VectorXd::Zero(2 * m.nodes());
  for (int k = 0; k < through; ++k) {  // sides of the ends, with a stress that is linear between their nodes
    const double below = height * (static_cast<double>(k) / through - 0.5) * moment / inertia,
                 above = below + cell * moment / inertia;
    const int low = k * (along + 1), high = low + along + 1;
    for (const auto& [end, sign] : {std::pair{along, 1.0}, std::pair{0, -1.0}}) {
      push[2 * (low + end)] += sign * cell * (2.0 * below + above) / 6.0;
      push[2 * (high + end)] += sign * cell * (below + 2.0 * above) / 6.0;
    }
  }
  // Held in the middle, x and z, and at the end of the middle line, z: without reactions.
  const int middle = through / 2 * (along + 1), centre = middle + along / 2;
  const Eigen::VectorXd u = linear_solution(elements, m, push, {2 * centre, 2 * centre + 1, 2 * middle + 1});
  const double sagitta =
      0.5 * u[2 * (middle + along) + 1];  // the other end, over the middle, were both ends free to turn
  return -8.0 * sagitta / (length * length) / (moment * (1.0 - poisson_ratio * poisson_ratio) / (e * inertia));
}

TEST(PlanarElements, averaged_volumes_take_the_locking_out_of_bending_near_incompressibility) {
  // Pure bending in plane strain, [Timoshenko & Goodier, art. 21] with E/(1 − ν²).
  // Pure bending in plane strain: a beam's, with E/(1 − ν²) [Timoshenko & Goodier, art. 21]. A mesh twice as fine has a
  // third to a quarter of the error, but not with locked triangles.
  for (const bool averaged : {false, true}) {
    const double coarse = 1.0 - bending(0.3, averaged, 2), fine = 1.0 - bending(0.3, averaged, 4);
    EXPECT_LT(fine, 0.06) << averaged;
    EXPECT_LT(fine, coarse / 3.0) << averaged;
  }
  EXPECT_NEAR(bending(0.499, true, 4), 1.0, 0.05);
  EXPECT_LT(1.0 - bending(0.499, true, 4), (1.0 - bending(0.499, true, 2)) / 3.0);
  EXPECT_LT(bending(0.499, false, 4), 0.25);
}

}  // namespace
}  // namespace furrow::tire
