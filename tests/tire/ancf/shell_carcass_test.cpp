// The vectorised ring passes against the scalar quadratic forms, finite differences and geometry.
#include "tire/ancf/shell_carcass.hpp"
#include "tire/read_tire_file.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cstdlib>
#include <memory>

#include "tire/ancf/inflation.hpp"
#include "tire/ancf/shell_batch.hpp"
#include "tire/ancf/shell_factor.hpp"
#include "tire/ancf/shell_mass.hpp"

namespace furrow::tire {
namespace {

struct Ring {
  TireFile file = read_tire_file(TIRE_DATA "/hmmwv_layered.json");
  ShellMesh mesh;
  std::unique_ptr<ShellCarcass> shell;
  ShellLayout layout;
  Field strains;  // zero: forces take E(q_new) with c = 1

  explicit Ring(int columns = 10, int width = 6) {
    file.elements_circumference = columns;
    set_elements_width(file, width);
    mesh = make_shell_mesh(file);
    shell = std::make_unique<ShellCarcass>(file, mesh);
    layout = shell->layout();
    strains.assign(shell->strains_size(), 0.0);
  }
  /// The undeformed ring, disturbed between the beads.
  Field disturbed(double amount) const {
    Field q = undeformed(mesh);
    std::srand(3);
    for (int j = 1; j + 1 < layout.rows; ++j)
      for (int c = 0; c < 6; ++c)
        for (int i = 0; i < layout.columns; ++i)
          q[layout.offset(j, c) + i] += (c < 3 ? amount : 10 * amount) * (std::rand() / (0.5 * RAND_MAX) - 1.0);
    layout.fill_padding(q);
    return q;
  }
  Field forces(const Field& q) const {
    Field f(layout.size());
    shell->forces(q, q, strains, 1.0, f);
    return f;
  }
  double potential(const Field& q) const {
    Field e(shell->strains_size(), 0.0);
    return shell->account(q, e).elastic - shell->pressure() * shell->volume(q, Vec3::Zero());
  }
};

TEST(ShellCarcass, strains_vanish_under_a_large_rotation_and_translation) {
  const Ring ring;
  const Mat3 turn = Eigen::AngleAxisd(1.9, Vec3(0.3, 1, -2).normalized()).toRotationMatrix();
  Field q = undeformed(ring.mesh);
  for (int j = 0; j < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i) {
      ring.layout.set(q, i, j, 0, turn * ring.layout.get(q, i, j, 0) + Vec3(9, -2, 1));
      ring.layout.set(q, i, j, 3, turn * ring.layout.get(q, i, j, 3));
    }
  ring.layout.fill_padding(q);
  Field e;
  ring.shell->strains(q, e);
  for (const double strain : e) EXPECT_NEAR(strain, 0.0, 2e-14);
}

TEST(ShellCarcass, vector_strains_equal_the_quadratic_forms) {
  const Ring ring;
  const Field q = ring.disturbed(2e-3);
  Field e;
  ring.shell->strains(q, e);
  Field none;
  ring.shell->strains(undeformed(ring.mesh), none);
  for (int j = 0; j + 1 < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i) {
      ElementNodes now;
      const int column[4] = {i, (i + 1) % ring.layout.columns, (i + 1) % ring.layout.columns, i},
                row[4] = {j, j, j + 1, j + 1};
      for (int n = 0; n < 4; ++n)
        for (int s = 0; s < 2; ++s) now.row(2 * n + s) = ring.layout.get(q, column[n], row[n], 3 * s);
      ElementNodes was;
      const Field start = undeformed(ring.mesh);
      for (int n = 0; n < 4; ++n)
        for (int s = 0; s < 2; ++s) was.row(2 * n + s) = ring.layout.get(start, column[n], row[n], 3 * s);
      const StrainVector reference = raw_strains(now) - raw_strains(was);
      const std::size_t at =
          (static_cast<std::size_t>(j) * ring.layout.batches() + i / kDoubleLanes) * kStrains * kDoubleLanes +
          i % kDoubleLanes;
      for (int k = 0; k < kStrains; ++k) EXPECT_NEAR(e[at + k * kDoubleLanes], reference[k], 1e-13) << "strain " << k;
    }
}

TEST(ShellCarcass, forces_are_the_gradient_of_elastic_energy_less_pressure_work) {
  const Ring ring;
  Field q = ring.disturbed(2e-3);
  const Field f = ring.forces(q);
  double largest = 0.0;
  for (const double value : f) largest = std::max(largest, std::abs(value));
  for (int n = 0; n < 60; ++n) {
    const int j = 1 + n % (ring.layout.rows - 2), c = n % 6, i = (7 * n) % ring.layout.columns;
    const std::size_t k = ring.layout.offset(j, c) + i;
    const double before = q[k], step = 1e-6;
    double difference = 0.0;
    for (const double side : {1.0, -1.0}) {
      q[k] = before + side * step;
      ring.layout.fill_padding(q);
      difference += side * ring.potential(q) / (2 * step);
    }
    q[k] = before;
    EXPECT_NEAR(f[k], difference, 2e-7 * largest) << "row " << j << " component " << c << " column " << i;
  }
}

/// Dense tangent of the free coordinates from the batches, node-major.
Eigen::MatrixXd dense_tangent(const Ring& ring, const Field& q, double geometric = 1.0) {
  const int across = ring.layout.rows - 2, n = 6 * across * ring.layout.columns;
  Eigen::MatrixXd k = Eigen::MatrixXd::Zero(n, n);
  const auto element = std::make_unique<BatchTangent>();
  for (int j = 0; j + 1 < ring.layout.rows; ++j)
    for (int b = 0; b < ring.layout.batches(); ++b) {
      Double4 stress[kStrains];
      ring.shell->batch_stress_at(q, ring.strains, 1.0, j, b, stress);
      BatchNodes nodes;
      nodes.read(ring.layout, q.data(), b * kDoubleLanes, j);
      element->compute(ring.shell->stiffness(j), nodes, stress, 1.0, geometric, ring.shell->pressure());
      for (int lane = 0; lane < kDoubleLanes && b * kDoubleLanes + lane < ring.layout.columns; ++lane) {
        const int i = b * kDoubleLanes + lane, next = (i + 1) % ring.layout.columns;
        const int node[4] = {i * across + j - 1, next * across + j - 1, next * across + j, i * across + j};
        const int row[4] = {j - 1, j - 1, j, j};
        for (int r = 0; r < 24; ++r)
          for (int c = 0; c < 24; ++c) {
            const int rn = row[r / 6], cn = row[c / 6];
            if (rn < 0 || rn >= across || cn < 0 || cn >= across) continue;
            k(6 * node[r / 6] + r % 6, 6 * node[c / 6] + c % 6) +=
                r >= c ? element->k[r][c][lane] : element->k[c][r][lane];
          }
      }
    }
  return k;
}

TEST(ShellCarcass, tangent_is_the_derivative_of_the_forces) {
  const Ring ring;
  Field q = ring.disturbed(2e-3);
  const Eigen::MatrixXd k = dense_tangent(ring, q);
  const int across = ring.layout.rows - 2;
  for (int sample = 0; sample < 12; ++sample) {
    const int i = (5 * sample) % ring.layout.columns, j = 1 + sample % across, c = sample % 6;
    const std::size_t at = ring.layout.offset(j, c) + i;
    const double before = q[at], step = 1e-7;
    q[at] = before + step;
    ring.layout.fill_padding(q);
    const Field high = ring.forces(q);
    q[at] = before - step;
    ring.layout.fill_padding(q);
    const Field low = ring.forces(q);
    q[at] = before;
    const Eigen::VectorXd column = k.col(6 * (i * across + j - 1) + c);
    for (int row = 0; row < k.rows(); ++row) {
      const std::size_t to = ring.layout.offset(1 + (row / 6) % across, row % 6) + row / 6 / across;
      EXPECT_NEAR((high[to] - low[to]) / (2 * step), column[row], 1e-6 * column.cwiseAbs().maxCoeff());
    }
  }
}

TEST(ShellCarcass, pressure_resultant_depends_on_the_bead_loops_alone_and_vanishes_for_a_rigid_rim) {
  Ring ring(12, 6);
  for (const double amount : {0.0, 2e-3, 2e-2}) {
    const Field q = ring.disturbed(amount);
    Field with = ring.forces(q), without(with.size());
    const double pressure = ring.shell->pressure();
    ring.shell->set_pressure(0.0);
    without = ring.forces(q);
    ring.shell->set_pressure(pressure);
    Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
    const Vec3 about(0.1, 0.2, -0.3);
    double scale = 0.0;
    for (int j = 0; j < ring.layout.rows; ++j)
      for (int i = 0; i < ring.layout.columns; ++i) {
        const Vec3 f = ring.layout.get(without, i, j, 0) - ring.layout.get(with, i, j, 0);
        force += f;
        moment += (ring.layout.get(q, i, j, 0) - about).cross(f);
        scale += f.norm();
      }
    EXPECT_LT(force.norm(), 1e-11 * scale);
    const Wrench closed = ring.shell->pressure_resultant(q, about);
    EXPECT_LT((closed.force - force).norm(), 1e-11 * scale);
    EXPECT_LT((closed.moment - moment).norm(), 1e-11 * scale);
  }
}

TEST(ShellCarcass, pressure_resultant_of_an_open_surface_follows_stokes) {
  Ring ring(12, 6);
  Field q = ring.disturbed(5e-3);
  for (int i = 0; i < ring.layout.columns; ++i) q[ring.layout.offset(0, 1) + i] += 0.01 * std::sin(i);  // warped bead
  ring.layout.fill_padding(q);
  const Field with = ring.forces(q);
  const double pressure = ring.shell->pressure();
  ring.shell->set_pressure(0.0);
  const Field without = ring.forces(q);
  ring.shell->set_pressure(pressure);
  Vec3 force = Vec3::Zero(), moment = Vec3::Zero();
  double scale = 0.0;
  for (int j = 0; j < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i) {
      const Vec3 f = ring.layout.get(without, i, j, 0) - ring.layout.get(with, i, j, 0);
      force += f;
      moment += ring.layout.get(q, i, j, 0).cross(f);
      scale += f.norm();
    }
  const Wrench loops = ring.shell->pressure_resultant(q, Vec3::Zero());
  EXPECT_GT(force.norm(), 1e-4 * scale);
  EXPECT_LT((loops.force - force).norm(), 1e-10 * scale);
  EXPECT_LT((loops.moment - moment).norm(), 1e-10 * scale);
}

/// Adds the elastic tangent at q to the given sectors of the factor.
void add_tangent(const Ring& ring, const ShellMass& mass, const Field& q, const std::vector<int>& sectors,
                 ShellFactor& factor) {
  const auto element = std::make_unique<BatchTangent>();
  for (const int b : sectors) {
    factor.clear(b);
    for (int j = 0; j + 1 < ring.layout.rows; ++j) {
      Double4 stress[kStrains];
      ring.shell->batch_stress_at(q, ring.strains, 1.0, j, b, stress);
      BatchNodes nodes;
      nodes.read(ring.layout, q.data(), b * kDoubleLanes, j);
      element->compute(ring.shell->stiffness(j), nodes, stress, 1.0, 0.0, ring.shell->pressure());
      factor.add(*element, mass.element(j), 0.0, j, b);
    }
  }
}

Field random_field(const ShellLayout& layout) {
  Field f(layout.size(), 0.0);
  for (int j = 1; j + 1 < layout.rows; ++j)
    for (int i = 0; i < layout.columns; ++i)
      for (const int s : {0, 3}) layout.set(f, i, j, s, Vec3::Random());
  return f;
}

Eigen::VectorXd free_vector(const ShellLayout& layout, const Field& f) {
  const int across = layout.rows - 2;
  Eigen::VectorXd v(6 * across * layout.columns);
  for (int k = 0; k < v.size(); ++k) v[k] = f[layout.offset(1 + k / 6 % across, k % 6) + k / 6 / across];
  return v;
}

TEST(ShellFactor, solves_the_assembled_matrix_to_single_precision_in_any_orientation) {
  const Ring ring(10, 6);
  const ShellMass mass(ring.mesh, element_masses(ring.file, ring.mesh));
  ShellFactor factor(ring.layout);
  const Field q = ring.disturbed(1e-3);
  add_tangent(ring, mass, q, {0, 1, 2}, factor);
  ASSERT_TRUE(factor.factorize());
  EXPECT_DOUBLE_EQ(factor.work(), 1.0);
  const Field b = random_field(ring.layout);
  Field x(b.size(), 0.0), turned(b.size(), 0.0), z(b.size(), 0.0);
  factor.solve(Mat3::Identity(), b, x);
  const Eigen::MatrixXd k = dense_tangent(ring, q, 0.0);
  const Eigen::VectorXd solution = free_vector(ring.layout, x), rhs = free_vector(ring.layout, b);
  EXPECT_LT((k * solution - rhs).norm(), 1e-6 * k.norm() * solution.norm());
  const Mat3 turn = Eigen::AngleAxisd(0.7, Vec3(1, 2, -1).normalized()).toRotationMatrix();
  for (int j = 1; j + 1 < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i)
      for (const int s : {0, 3}) ring.layout.set(turned, i, j, s, turn * ring.layout.get(b, i, j, s));
  factor.solve(turn, turned, z);
  for (int j = 1; j + 1 < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i)
      for (const int s : {0, 3})
        EXPECT_LT((ring.layout.get(z, i, j, s) - turn * ring.layout.get(x, i, j, s)).norm(),
                  1e-3 * solution.lpNorm<Eigen::Infinity>());
}

TEST(ShellFactor, renewed_in_part_has_the_bits_of_one_made_at_once) {
  const Ring ring(22, 8);
  const ShellMass mass(ring.mesh, element_masses(ring.file, ring.mesh));
  ShellFactor part(ring.layout), whole(ring.layout);
  std::vector<int> all(part.sectors());
  for (int b = 0; b < part.sectors(); ++b) all[b] = b;
  const Field before = ring.disturbed(1e-3), after = ring.disturbed(2e-3);
  add_tangent(ring, mass, before, all, part);
  add_tangent(ring, mass, before, all, whole);
  ASSERT_TRUE(part.factorize());
  for (ShellFactor* factor : {&part, &whole}) add_tangent(ring, mass, after, {3}, *factor);
  ASSERT_TRUE(part.factorize() && whole.factorize());
  EXPECT_LT(part.work(), 0.9);
  EXPECT_DOUBLE_EQ(whole.work(), 1.0);
  const Field b = random_field(ring.layout);
  Field x(b.size(), 0.0), y(b.size(), 0.0);
  part.solve(Mat3::Identity(), b, x);
  whole.solve(Mat3::Identity(), b, y);
  EXPECT_EQ(x, y);
}

TEST(ShellMass, acts_as_the_assembled_element_masses) {
  const Ring ring(10, 6);
  const auto elements = element_masses(ring.file, ring.mesh);
  const ShellMass mass(ring.mesh, elements);
  Field v = ring.disturbed(0.1), p(v.size(), 0.0), reference(v.size(), 0.0);
  mass.apply(v, 1.0, p);
  for (int j = 0; j + 1 < ring.layout.rows; ++j)
    for (int i = 0; i < ring.layout.columns; ++i) {
      const int next = (i + 1) % ring.layout.columns, column[4] = {i, next, next, i}, row[4] = {j, j, j + 1, j + 1};
      for (int a = 0; a < 8; ++a)
        for (int b = 0; b < 8; ++b)
          for (int x = 0; x < 3; ++x)
            reference[ring.layout.offset(row[a / 2], 3 * (a % 2) + x) + column[a / 2]] +=
                elements[j](a, b) * v[ring.layout.offset(row[b / 2], 3 * (b % 2) + x) + column[b / 2]];
    }
  for (std::size_t k = 0; k < p.size(); ++k) EXPECT_NEAR(p[k], reference[k], 1e-14);
}

}  // namespace
}  // namespace furrow::tire
