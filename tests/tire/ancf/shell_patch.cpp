#include "tests/tire/ancf/shell_patch.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace furrow::test {

tire::ShellLayer isotropic_layer(double thickness, double young, double poisson) {
  tire::LayerMaterial m;
  m.name = "isotropic";
  m.young_modulus = Vec3::Constant(young);
  m.poisson_ratio = Vec3::Constant(poisson);
  m.shear_modulus = Vec3::Constant(0.5 * young / (1 + poisson));
  return {thickness, 0.0, furrow::tire::stiffness(m, "test")};
}

tire::ShellLayer ply_layer(double thickness, double angle_deg, const Ply& ply) {
  tire::LayerMaterial m;
  m.name = "ply";
  m.young_modulus = Vec3(ply.e_l, ply.e_t, ply.e_t);
  m.poisson_ratio = Vec3(ply.nu_lt, ply.nu_lt, ply.nu_tt);
  m.shear_modulus = Vec3(ply.g_lt, ply.g_lt, ply.g_tt);
  return {thickness, angle_deg * std::numbers::pi / 180, furrow::tire::stiffness(m, "test")};
}

// --- meshes

std::vector<int> PatchMesh::select(const std::function<bool(const Vec3&)>& where) const {
  std::vector<int> list;
  for (int n = 0; n < nodes(); ++n)
    if (where(position[n])) list.push_back(n);
  return list;
}

int PatchMesh::nearest(const Vec3& place) const {
  const auto closer = [&](const Vec3& a, const Vec3& b) { return (a - place).norm() < (b - place).norm(); };
  return static_cast<int>(std::min_element(position.begin(), position.end(), closer) - position.begin());
}

PatchMesh grid_mesh(int n, int m, const std::function<std::pair<Vec3, Vec3>(double s, double t)>& surface) {
  PatchMesh mesh;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= m; ++j) {
      const auto [position, director] = surface(static_cast<double>(i) / n, static_cast<double>(j) / m);
      mesh.position.push_back(position);
      mesh.director.push_back(director);
    }
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j, b = a + m + 1;
      mesh.elements.push_back({a, b, b + 1, a + 1});
    }
  return mesh;
}

PatchMesh plate_mesh(int n, int m, double length, double width) {
  return grid_mesh(n, m, [&](double s, double t) { return std::pair(Vec3(s * length, t * width, 0), Vec3(0, 0, 1)); });
}

PatchMesh distorted_mesh() {
  PatchMesh mesh;
  mesh.position = {{0, 0, 0},     {2, 0, 0},     {2, 1, 0},     {0, 1, 0},
                   {0.4, 0.2, 0}, {1.5, 0.3, 0}, {1.3, 0.8, 0}, {0.6, 0.7, 0}};
  mesh.director.assign(8, Vec3::UnitZ());
  mesh.elements = {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {4, 5, 6, 7}};
  return mesh;
}

// --- elements

ShellPatch::ShellPatch(PatchMesh mesh, std::vector<tire::ShellLayer> layers)
    : mesh_(std::move(mesh)), layers_(std::move(layers)) {
  reference_.resize(coordinates());
  for (int n = 0; n < nodes(); ++n) reference_.segment<6>(6 * n) << mesh_.position[n], mesh_.director[n];
  for (std::size_t e = 0; e < mesh_.elements.size(); ++e) {
    const tire::ElementNodes corners = gather(reference_, static_cast<int>(e));
    stiffness_.push_back(tire::shell_stiffness(corners, layers_));
    raw_.push_back(tire::raw_strains(corners));
  }
  make_pattern();
}

void ShellPatch::make_pattern() {
  std::vector<Eigen::Triplet<double>> entries;
  const auto row = [](const std::array<int, 4>& e, int a) { return 6 * e[a / 6] + a % 6; };
  for (const auto& e : mesh_.elements)
    for (int a = 0; a < 24; ++a)
      for (int b = 0; b < 24; ++b) entries.emplace_back(row(e, a), row(e, b), 0.0);
  pattern_.resize(coordinates(), coordinates());
  pattern_.setFromTriplets(entries.begin(), entries.end());
  for (const auto& e : mesh_.elements)
    for (int b = 0; b < 24; ++b)
      for (int a = 0; a < 24; ++a) {
        const int column = row(e, b), *rows = pattern_.innerIndexPtr();
        const int *first = rows + pattern_.outerIndexPtr()[column], *last = rows + pattern_.outerIndexPtr()[column + 1];
        place_.push_back(static_cast<int>(std::lower_bound(first, last, row(e, a)) - rows));
      }
}

tire::ElementNodes ShellPatch::gather(const Vector& q, int e) const {
  tire::ElementNodes nodes;
  for (int n = 0; n < 4; ++n) {
    nodes.row(2 * n) = q.segment<3>(6 * mesh_.elements[e][n]);
    nodes.row(2 * n + 1) = q.segment<3>(6 * mesh_.elements[e][n] + 3);
  }
  return nodes;
}

ShellPatch::Gradient ShellPatch::gradient(const tire::ElementNodes& nodes) {
  Gradient b;
  for (int k = 0; k < tire::kStrains; ++k) {
    const tire::ElementNodes row = tire::strain_forms()[k] * nodes;
    for (int a = 0; a < 8; ++a) b.block<1, 3>(k, 3 * a) = row.row(a);
  }
  return b;
}

ShellPatch::ElementStrains ShellPatch::strains(const Vector& q) const {
  ElementStrains e(raw_.size());
  for (std::size_t k = 0; k < e.size(); ++k) e[k] = tire::raw_strains(gather(q, static_cast<int>(k))) - raw_[k];
  return e;
}

ShellPatch::ElementStrains ShellPatch::stresses(const ElementStrains& strains) const {
  ElementStrains s(strains.size());
  for (std::size_t k = 0; k < s.size(); ++k) s[k] = stiffness_[k] * strains[k];
  return s;
}

double ShellPatch::energy(const Vector& q) const {
  const ElementStrains e = strains(q);
  double total = 0.0;
  for (std::size_t k = 0; k < e.size(); ++k) total += 0.5 * e[k].dot(stiffness_[k] * e[k]);
  return total;
}

Vector ShellPatch::forces(const Vector& q, const ElementStrains& stress) const {
  Vector f = Vector::Zero(coordinates());
  for (std::size_t k = 0; k < raw_.size(); ++k) {
    const Eigen::Matrix<double, 24, 1> fe = gradient(gather(q, static_cast<int>(k))).transpose() * stress[k];
    for (int n = 0; n < 4; ++n) f.segment<6>(6 * mesh_.elements[k][n]) += fe.segment<6>(6 * n);
  }
  return f;
}

Sparse ShellPatch::tangent(const Vector& q, const ElementStrains& stress, double material, double geometric) const {
  Sparse total = pattern_;
  std::fill(total.valuePtr(), total.valuePtr() + total.nonZeros(), 0.0);
  const int* place = place_.data();
  for (std::size_t k = 0; k < raw_.size(); ++k, place += 576) {
    const Gradient b = gradient(gather(q, static_cast<int>(k)));
    const Gradient db = material * (stiffness_[k] * b);
    ElementTangent kt = b.transpose() * db;
    tire::NodeMatrix h = tire::NodeMatrix::Zero();
    for (int s = 0; s < tire::kStrains; ++s) h += stress[k][s] * tire::strain_forms()[s];
    for (int a = 0; a < 8; ++a)
      for (int c = 0; c < 8; ++c)
        for (int x = 0; x < 3; ++x) kt(3 * a + x, 3 * c + x) += geometric * h(a, c);
    for (int entry = 0; entry < 576; ++entry) total.valuePtr()[place[entry]] += kt.data()[entry];
  }
  return total;
}

ShellPatch::ElementStrains ShellPatch::linear_stresses(const Vector& q, const Vector& change) const {
  ElementStrains s(raw_.size());
  for (std::size_t k = 0; k < raw_.size(); ++k) {
    const tire::ElementNodes at = gather(q, static_cast<int>(k)), by = gather(change, static_cast<int>(k));
    tire::StrainVector e = tire::raw_strains(at) - raw_[k];
    for (int r = 0; r < tire::kStrains; ++r) e[r] += (at.transpose() * tire::strain_forms()[r] * by).trace();
    s[k] = stiffness_[k] * e;
  }
  return s;
}

namespace {

/// Position in ξ, η, z of each of the points of shell_points().
struct Place {
  double xi, eta, z;
};
std::vector<Place> point_places(const std::vector<tire::ShellLayer>& layers) {
  const double gauss[3] = {-std::sqrt(0.6), 0.0, std::sqrt(0.6)};
  double total = 0.0;
  for (const tire::ShellLayer& layer : layers) total += layer.thickness;
  std::vector<Place> places;
  for (const double eta : {-tire::kGaussPoint, tire::kGaussPoint})
    for (const double xi : {-tire::kGaussPoint, tire::kGaussPoint}) {
      double bottom = -0.5 * total;
      for (const tire::ShellLayer& layer : layers) {
        for (const double g : gauss) places.push_back({xi, eta, bottom + 0.5 * layer.thickness * (1 + g)});
        bottom += layer.thickness;
      }
    }
  return places;
}

}  // namespace

Sparse ShellPatch::mass(double density) const {
  constexpr double sx[4] = {-1, 1, 1, -1}, se[4] = {-1, -1, 1, 1};
  Sparse total = pattern_;
  const std::vector<Place> places = point_places(layers_);
  const int* place = place_.data();
  for (std::size_t k = 0; k < raw_.size(); ++k, place += 576) {
    const auto points = tire::shell_points(gather(reference_, static_cast<int>(k)), layers_);
    tire::NodeMatrix m = tire::NodeMatrix::Zero();
    for (std::size_t p = 0; p < points.size(); ++p) {
      Eigen::Matrix<double, 8, 1> row;
      for (int n = 0; n < 4; ++n) {
        row[2 * n] = 0.25 * (1 + sx[n] * places[p].xi) * (1 + se[n] * places[p].eta);
        row[2 * n + 1] = places[p].z * row[2 * n];
      }
      m += density * points[p].volume * row * row.transpose();
    }
    for (int c = 0; c < 24; ++c)
      for (int r = c % 3; r < 24; r += 3) total.valuePtr()[place[24 * c + r]] += m(r / 3, c / 3);
  }
  return total;
}

Eigen::Matrix<double, 6, 1> ShellPatch::resultants(const Vector& q, int e) const {
  const tire::StrainVector strain = tire::raw_strains(gather(q, e)) - raw_[e];
  const auto points = tire::shell_points(gather(reference_, e), layers_);
  const std::vector<Place> places = point_places(layers_);
  Eigen::Matrix<double, tire::kEnhanced, tire::kEnhanced> k =
      Eigen::Matrix<double, tire::kEnhanced, tire::kEnhanced>::Zero();
  Eigen::Matrix<double, tire::kEnhanced, 1> b = Eigen::Matrix<double, tire::kEnhanced, 1>::Zero();
  for (const tire::ShellPoint& p : points) {
    const auto& c = layers_[p.layer].stiffness;
    k += p.volume * p.enhanced_map.transpose() * c * p.enhanced_map;
    b += p.volume * p.enhanced_map.transpose() * c * (p.strain_map * strain);
  }
  const Eigen::Matrix<double, tire::kEnhanced, 1> alpha = -k.ldlt().solve(b);
  Eigen::Matrix<double, 6, 1> sum = Eigen::Matrix<double, 6, 1>::Zero();
  double volume = 0.0, thickness = 0.0;
  for (const tire::ShellLayer& layer : layers_) thickness += layer.thickness;
  for (std::size_t p = 0; p < points.size(); ++p) {
    const tire::ShellLayer& layer = layers_[points[p].layer];
    const Eigen::Matrix<double, 6, 1> s =
        layer.stiffness * (points[p].strain_map * strain + points[p].enhanced_map * alpha);
    const double c = std::cos(layer.angle), n = std::sin(layer.angle);
    const Vec3 here(c * c * s[0] + n * n * s[1] - 2 * c * n * s[2], n * n * s[0] + c * c * s[1] + 2 * c * n * s[2],
                    c * n * (s[0] - s[1]) + (c * c - n * n) * s[2]);
    sum.head<3>() += points[p].volume * here;
    sum.tail<3>() += points[p].volume * places[p].z * here;
    volume += points[p].volume;
  }
  return sum * thickness / volume;
}

// --- supports and solutions

Supports& Supports::fix(const std::vector<int>& nodes, const char* which) {
  constexpr std::string_view kNames = "xyzabc";
  for (const int n : nodes)
    for (const char* c = which; *c != '\0'; ++c) fixed_[6 * n + static_cast<int>(kNames.find(*c))] = 1;
  return *this;
}

std::vector<int> Supports::free() const {
  std::vector<int> list;
  for (std::size_t c = 0; c < fixed_.size(); ++c)
    if (fixed_[c] == 0) list.push_back(static_cast<int>(c));
  return list;
}

Sparse restrict_to(const Sparse& k, const std::vector<int>& free) {
  std::vector<int> number(k.rows(), -1);
  for (std::size_t a = 0; a < free.size(); ++a) number[free[a]] = static_cast<int>(a);
  Sparse part(static_cast<int>(free.size()), static_cast<int>(free.size()));
  part.reserve(k.nonZeros());
  for (std::size_t b = 0; b < free.size(); ++b) {
    part.startVec(static_cast<int>(b));
    for (Sparse::InnerIterator it(k, free[b]); it; ++it)
      if (number[it.row()] >= 0) part.insertBack(number[it.row()], static_cast<int>(b)) = it.value();
  }
  part.finalize();
  return part;
}

Vector restrict_to(const Vector& v, const std::vector<int>& free) {
  Vector part(static_cast<int>(free.size()));
  for (std::size_t a = 0; a < free.size(); ++a) part[static_cast<int>(a)] = v[free[a]];
  return part;
}

namespace {

void scatter(const Vector& part, const std::vector<int>& free, Vector& v) {
  for (std::size_t a = 0; a < free.size(); ++a) v[free[a]] = part[static_cast<int>(a)];
}

constexpr double kTolerance = 1e-9;  // of the last change, relative to the largest coordinate
constexpr int kMaxIterations = 25;
constexpr double kMinStep = 1e-5;  // of λ

}  // namespace

bool StaticPath::newton(double lambda, Vector& q) {
  Vector change = Vector::Zero(q.size()), target = q;
  if (motion_) motion_(lambda, target);
  change = target - q;  // of the prescribed coordinates
  for (const int c : free_) change[c] = 0.0;
  auto stress = patch_.stresses(patch_.strains(q));
  const double size = q.cwiseAbs().maxCoeff();
  for (int n = 0; n < kMaxIterations; ++n) {
    const Sparse k = patch_.tangent(q, stress);
    const Vector r = lambda * load_ - patch_.forces(q) - k * change;
    const Sparse part = restrict_to(k, free_);
    if (!analyzed_) solver_.analyzePattern(part);
    analyzed_ = true;
    solver_.factorize(part);
    if (solver_.info() != Eigen::Success) return false;
    scatter(solver_.solve(restrict_to(r, free_)), free_, change);
    const double largest = change.cwiseAbs().maxCoeff();
    if (!(largest < 10.0 * size)) return false;
    stress = patch_.linear_stresses(q, change);
    q += change;
    if (largest < kTolerance * size) return true;
    change.setZero();
  }
  return false;
}

bool StaticPath::go_to(double lambda) {
  double step = lambda - lambda_;
  while (std::abs(lambda - lambda_) > 1e-12) {
    const bool last = std::abs(step) >= std::abs(lambda - lambda_);
    const double next = last ? lambda : lambda_ + step;
    Vector q = q_;
    if (newton(next, q)) {
      q_ = q;
      lambda_ = next;
      step *= 2.0;
    } else {
      step = 0.5 * (next - lambda_);
      if (std::abs(step) < kMinStep) return false;
    }
  }
  return true;
}

Vector linear_solution(const ShellPatch& patch, const Supports& supports, const Vector& load) {
  const std::vector<int> free = supports.free();
  const Eigen::SimplicialLDLT<Sparse> solver(restrict_to(patch.tangent(patch.reference()), free));
  Vector u = Vector::Zero(patch.coordinates());
  scatter(solver.solve(restrict_to(load, free)), free, u);
  return u;
}

Vector lowest_eigenvalues(const Sparse& k, const Sparse& m, int count) {
  const int n = static_cast<int>(k.rows()), p = std::min(n, 2 * count + 4);
  const Eigen::SimplicialLDLT<Sparse> solver(k);
  std::srand(5);
  Eigen::MatrixXd x = Eigen::MatrixXd::Random(n, p);
  Vector values = Vector::Constant(count, std::numeric_limits<double>::max());
  for (int iteration = 0; iteration < 200; ++iteration) {
    const Eigen::MatrixXd mx = m * x, y = solver.solve(mx);
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> small(y.transpose() * mx, y.transpose() * (m * y));
    x = y * small.eigenvectors();
    const Vector now = small.eigenvalues().head(count);
    const double change = ((now - values).array() / now.array()).abs().maxCoeff();
    values = now;
    if (change < 1e-11) break;
  }
  return values;
}

}  // namespace furrow::test
