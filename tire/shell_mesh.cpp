#include "tire/shell_mesh.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "tire/natural_spline.hpp"

namespace furrow::tire {
namespace {

constexpr std::array<double, 3> kGauss{-0.77459666924148337704, 0.0, 0.77459666924148337704};
constexpr std::array<double, 3> kWeight{5.0 / 9.0, 8.0 / 9.0, 5.0 / 9.0};

Vec3 blend(const std::array<double, 4>& w, const std::array<Vec3, 4>& v) {
  return w[0] * v[0] + w[1] * v[1] + w[2] * v[2] + w[3] * v[3];
}

/// The bilinear element of column 0 at width position j.
struct Corner {
  std::array<Vec3, 4> r, d;
  Corner(const ShellMesh& mesh, int j) {
    FURROW_ASSERT(in_range(j, mesh.elements_width()), j, mesh.elements_width());
    FURROW_ASSERT(mesh.position.size() == static_cast<std::size_t>(mesh.rows), mesh.position.size(), mesh.rows);
    FURROW_ASSERT(mesh.director.size() == static_cast<std::size_t>(mesh.rows), mesh.director.size(), mesh.rows);
    const Mat3 next = mesh.turn(1);
    r = {mesh.position[j], next * mesh.position[j], next * mesh.position[j + 1], mesh.position[j + 1]};
    d = {mesh.director[j], next * mesh.director[j], next * mesh.director[j + 1], mesh.director[j + 1]};
  }
  /// Volume per dξ dη dz.
  double jacobian(double xi, double eta, double z) const {
    const std::array<double, 4> n1{-(1 - eta) / 4, (1 - eta) / 4, (1 + eta) / 4, -(1 + eta) / 4};
    const std::array<double, 4> n2{-(1 - xi) / 4, -(1 + xi) / 4, (1 + xi) / 4, (1 - xi) / 4};
    const Vec3 g1 = blend(n1, r) + z * blend(n1, d), g2 = blend(n2, r) + z * blend(n2, d);
    return g1.cross(g2).dot(blend(shape(xi, eta), d));
  }
  static std::array<double, 4> shape(double xi, double eta) {
    return {(1 - xi) * (1 - eta) / 4, (1 + xi) * (1 - eta) / 4, (1 + xi) * (1 + eta) / 4, (1 - xi) * (1 + eta) / 4};
  }
};

/// Adds mass `dm` (kg) at (ξ, η, z).
void add_point(ElementMass& m, double xi, double eta, double z, double dm) {
  const auto n = Corner::shape(xi, eta);
  Eigen::Matrix<double, 8, 1> row;
  for (int a = 0; a < 4; ++a) row[2 * a] = n[a], row[2 * a + 1] = z * n[a];
  m += dm * row * row.transpose();
}

}  // namespace

double ShellMesh::pitch() const {
  FURROW_ASSERT(columns > 0, columns);
  return 2.0 * std::numbers::pi / columns;
}

Mat3 ShellMesh::turn(int i) const { return Eigen::AngleAxisd(i * pitch(), Vec3::UnitY()).toRotationMatrix(); }

Vec3 ShellMesh::disc_centre(int side) const {
  FURROW_ASSERT(in_range(side, 2) && !position.empty(), side, position.size());
  return Vec3(0.0, (side == 0 ? position.front() : position.back()).y(), 0.0);
}

ShellMesh make_shell_mesh(const TireFile& file) {
  std::vector<double> t, x, y;
  for (const ProfileKnot& knot : file.profile) t.push_back(knot.t), x.push_back(knot.x), y.push_back(knot.y);
  const NaturalSpline height(t, x), axial(t, y);
  ShellMesh mesh;
  mesh.columns = file.elements_circumference;
  mesh.rows = file.elements_width() + 1;
  for (int j = 0; j < mesh.rows; ++j) {
    const double s = static_cast<double>(j) / (mesh.rows - 1);
    const Vec3 r(0.0, axial.value(s), file.rim_radius + height.value(s));
    const Vec3 normal(0.0, -height.slope(s), axial.slope(s));  // e_t × tangent
    if (!(r.z() > 0.0) || !(normal.norm() > 1e-6))
      throw input_error(file.path, "profile",
                        fmt::format("cannot be used at t = {:.3f}: it meets the axis or stands still", s));
    mesh.position.push_back(r);
    mesh.director.push_back(normal.normalized());
  }
  for (int j = 0; j + 1 < mesh.rows; ++j) {
    const double half = 0.5 * file.section(j).thickness();
    const Corner corner(mesh, j);
    for (const double z : {-half, half})
      if (!(corner.jacobian(-1, -1, z) > 0.0 && corner.jacobian(-1, 1, z) > 0.0))
        throw input_error(
            file.path, "profile",
            fmt::format("folds back between t = {:.3f} and {:.3f}: the curvature radius is below half the thickness",
                        static_cast<double>(j) / (mesh.rows - 1), static_cast<double>(j + 1) / (mesh.rows - 1)));
  }
  return mesh;
}

SurfaceMesh make_surface_mesh(const ShellMesh& mesh) {
  FURROW_ASSERT(mesh.columns >= 3 && mesh.rows >= 2, mesh.columns, mesh.rows);
  SurfaceMesh surface;
  surface.vertex_count = mesh.nodes() + 2;
  const int left = mesh.nodes(), right = left + 1, last = mesh.rows - 1;
  for (int i = 0; i < mesh.columns; ++i) {
    const int next = (i + 1) % mesh.columns;
    for (int j = 0; j < last; ++j) {
      const int a = mesh.node(i, j), b = mesh.node(next, j), c = mesh.node(next, j + 1), d = mesh.node(i, j + 1);
      if (2 * j < last) {
        surface.triangles.push_back({a, b, c});
        surface.triangles.push_back({a, c, d});
      } else {
        surface.triangles.push_back({a, b, d});
        surface.triangles.push_back({b, c, d});
      }
    }
    surface.triangles.push_back({mesh.node(next, 0), mesh.node(i, 0), left});
    surface.triangles.push_back({mesh.node(i, last), mesh.node(next, last), right});
  }
  return surface;
}

std::vector<ElementMass> element_masses(const TireFile& file, const ShellMesh& mesh) {
  FURROW_ASSERT(file.elements_width() == mesh.elements_width(), file.elements_width(), mesh.elements_width());
  std::vector<ElementMass> masses;
  for (int j = 0; j < mesh.elements_width(); ++j) {
    ElementMass m = ElementMass::Zero();
    const Corner corner(mesh, j);
    const Section& section = file.section(j);
    const bool tread = &section == &file.tread;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) {
        double z = -0.5 * section.thickness();
        for (const Layer& layer : section.layers) {
          for (int c = 0; c < 3; ++c) {
            const double zc = z + 0.5 * layer.thickness * (1.0 + kGauss[c]);
            const double volume = corner.jacobian(kGauss[a], kGauss[b], zc) * kWeight[a] * kWeight[b] * 0.5 *
                                  layer.thickness * kWeight[c];
            add_point(m, kGauss[a], kGauss[b], zc, file.materials[layer.material].density * volume);
          }
          z += layer.thickness;
        }
        if (tread)
          add_point(m, kGauss[a], kGauss[b], z,
                    file.tread_mass_per_area * corner.jacobian(kGauss[a], kGauss[b], z) * kWeight[a] * kWeight[b]);
      }
    masses.push_back(m);
  }
  return masses;
}

// T = ½ ωᵀ J ω with the nodal velocities ω × r and ω × d: J = Σ M_ab (x_a·x_b I − x_a x_bᵀ), x = r or d; the
// sum over the columns averages the two axes across the spin.
MassProperties rigid_mass(const ShellMesh& mesh, const std::vector<ElementMass>& masses) {
  FURROW_ASSERT(masses.size() == static_cast<std::size_t>(mesh.elements_width()), masses.size(), mesh.elements_width());
  MassProperties properties;
  Mat3 one = Mat3::Zero();
  for (int j = 0; j < mesh.elements_width(); ++j) {
    const Corner corner(mesh, j);
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const Vec3& xa = a % 2 == 0 ? corner.r[a / 2] : corner.d[a / 2];
        const Vec3& xb = b % 2 == 0 ? corner.r[b / 2] : corner.d[b / 2];
        one += masses[j](a, b) * (xa.dot(xb) * Mat3::Identity() - xa * xb.transpose());
        if (a % 2 == 0 && b % 2 == 0) properties.mass += mesh.columns * masses[j](a, b);
      }
  }
  for (int i = 0; i < mesh.columns; ++i) properties.inertia += mesh.turn(i) * one * mesh.turn(i).transpose();
  properties.inertia = (0.5 * (properties.inertia + properties.inertia.transpose())).eval();
  return properties;
}

double tread_width(const TireFile& file, const ShellMesh& mesh) {
  FURROW_ASSERT(mesh.rows == file.elements_width() + 1, mesh.rows, file.elements_width());
  const int first = file.bead.elements_per_side + file.sidewall.elements_per_side;
  return mesh.position[mesh.rows - 1 - first].y() - mesh.position[first].y();
}

}  // namespace furrow::tire
