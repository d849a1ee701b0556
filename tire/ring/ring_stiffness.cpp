#include "tire/ring/ring_stiffness.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

#include "protocol/core/assert.hpp"
#include "tire/ring/folded_band.hpp"

namespace furrow::tire {
namespace {

using Fields = std::vector<RingField>;

class Stuck {
 public:
  explicit Stuck(const RingSolver& solver)
      : ring_(solver.ring()), n_(ring_.segments()), tangent_(ring_.no_tangent()), held_(solver.contacts().segment) {
    ring_.tangent(solver.state(), tangent_);
    for (std::size_t k = 0; k < solver.corner_gaps().size(); ++k)
      if (solver.contacts().corner[k]) corners_.push_back(solver.corner_gaps()[k]);
    for (int j = 0; j < n_; ++j) axes_.push_back({solver.contact().sine(j), solver.contact().cosine(j)});
  }

  Eigen::Matrix2d stiffness() {
    const Fields ground = with_ground();
    const int corners = 2 * static_cast<int>(corners_.size()), columns = 3 + corners;
    Fields way = right_sides(ground);
    solve(way);
    // For x and z of the ground, −τ and the corners' forces: the remaining unknowns of (1), as a small system.
    Eigen::MatrixXd system(1 + corners, 1 + corners), right(1 + corners, 2);
    for (int c = 0; c < columns; ++c) {
      const Eigen::VectorXd at_corners = corner_ways(way[c]);
      if (c < 2) {
        right(0, c) = sum(way[c]) + sum(ground[c]);
        right.col(c).tail(corners) = -at_corners - corner_ways(ground[c]);
        for (int k = c; k < corners; k += 2) right(1 + k, c) += 1.0;
      } else {
        const double sign = c == 2 ? 1.0 : -1.0;
        system(0, c - 2) = sign * sum(way[c]) + (c == 2 ? 1.0 / tangent_.gas : 0.0);
        system.col(c - 2).tail(corners) = -sign * at_corners;
      }
    }
    // Corners that segments already hold have rows of zero; the smallest solution has zero forces there.
    const Eigen::MatrixXd open = system.completeOrthogonalDecomposition().solve(right);
    Eigen::Matrix2d out = Eigen::Matrix2d::Zero();
    for (int d = 0; d < 2; ++d) {
      RingField total = ground[d];
      for (int j = 0; j < n_; ++j)
        for (int c = 0; c < columns; ++c) {
          const double share = c < 2 ? double(c == d) : (c == 2 ? -open(0, d) : open(c - 2, d));
          total.u[j] += share * way[c].u[j], total.v[j] += share * way[c].v[j];
        }
      out.col(d) = force(total, open.col(d).tail(corners));
    }
    return 0.5 * (out + out.transpose());
  }

 private:
  struct Axes {
    double sine, cosine;
  };

  double sum(const RingField& f) const {
    double total = 0.0;
    for (const double u : f.u) total += u;
    return total;
  }

  /// D: segments that touch move along x, or along z.
  Fields with_ground() const {
    Fields out(2, ring_.zero());
    for (int j = 0; j < n_; ++j) {
      if (!held_[j]) continue;
      out[0].u[j] = axes_[j].sine, out[0].v[j] = axes_[j].cosine;
      out[1].u[j] = -axes_[j].cosine, out[1].v[j] = axes_[j].sine;
    }
    return out;
  }

  /// −K_fc D, 1_f and W_fᵀ; zero on touching segments.
  Fields right_sides(const Fields& ground) const {
    Fields out(3 + 2 * corners_.size(), ring_.zero());
    for (int j = 0; j < n_; ++j) {
      if (held_[j]) continue;
      for (int d = 0; d < 2; ++d) {
        const std::array<double, 2> row = tangent_row(tangent_, ground[d], 0.0, j);
        out[d].u[j] = -row[0], out[d].v[j] = -row[1];
      }
      out[2].u[j] = 1.0;
    }
    for (std::size_t k = 0; k < corners_.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const int j = (corners_[k].first + i) % n_;
        if (held_[j]) continue;
        const double w = corners_[k].share[i];
        out[3 + 2 * k].u[j] = w * axes_[j].sine, out[3 + 2 * k].v[j] = w * axes_[j].cosine;
        out[4 + 2 * k].u[j] = -w * axes_[j].cosine, out[4 + 2 * k].v[j] = w * axes_[j].sine;
      }
    return out;
  }

  /// K_ff⁻¹ of fields that are zero on segments that touch.
  void solve(Fields& fields) {
    RingTangent apart = tangent_;
    for (int d = 0; d < 3; ++d)
      for (int j = 0; j < n_; ++j) {
        if (!held_[j] && !held_[(j + d) % n_]) continue;
        apart.uv[d][j] = apart.vu[d][j] = 0.0;
        apart.uu[d][j] = apart.vv[d][j] = d == 0 ? tangent_.uu[0][j] : 0.0;
      }
    FoldedBand band(n_);
    const bool definite = band.factorize(apart);
    FURROW_ASSERT(definite, n_);
    constexpr std::size_t kLanes = FoldedBand::kLanes;
    std::vector<double> lanes;
    for (std::size_t first = 0; first < fields.size(); first += kLanes) {
      lanes.assign(band.entries(), 0.0);
      const std::size_t together = std::min(kLanes, fields.size() - first);
      for (std::size_t lane = 0; lane < together; ++lane)
        for (int j = 0; j < n_; ++j) {
          const std::size_t at = kLanes * band.place(j) + lane;
          lanes[at] = fields[first + lane].u[j], lanes[at + kLanes] = fields[first + lane].v[j];
        }
      band.solve(lanes.data());
      for (std::size_t lane = 0; lane < together; ++lane)
        for (int j = 0; j < n_; ++j) {
          const std::size_t at = kLanes * band.place(j) + lane;
          fields[first + lane].u[j] = lanes[at], fields[first + lane].v[j] = lanes[at + kLanes];
        }
    }
  }

  /// W f: displacements of the belt along x and z over each corner.
  Eigen::VectorXd corner_ways(const RingField& f) const {
    Eigen::VectorXd out = Eigen::VectorXd::Zero(2 * static_cast<Eigen::Index>(corners_.size()));
    for (std::size_t k = 0; k < corners_.size(); ++k)
      for (int i = 0; i < 3; ++i) {
        const int j = (corners_[k].first + i) % n_;
        out.segment<2>(2 * static_cast<Eigen::Index>(k)) += corners_[k].share[i] * along_ground(j, f.u[j], f.v[j]);
      }
    return out;
  }

  Eigen::Vector2d along_ground(int j, double u, double v) const {
    const auto [s, c] = axes_[j];
    return {u * s + v * c, v * s - u * c};
  }

  /// Force of the ground: the tangent's forces on touching segments minus the corners' share there, plus the corners'
  /// forces.
  Eigen::Vector2d force(const RingField& change, const Eigen::VectorXd& corner_force) const {
    Eigen::Vector2d total = Eigen::Vector2d::Zero();
    const double all = sum(change);
    for (int j = 0; j < n_; ++j) {
      if (!held_[j]) continue;
      const std::array<double, 2> row = tangent_row(tangent_, change, all, j);
      total += along_ground(j, row[0], row[1]);
    }
    for (std::size_t k = 0; k < corners_.size(); ++k) {
      double elsewhere = 0.0;  // share of the corner's force on segments that do not touch
      for (int i = 0; i < 3; ++i)
        if (!held_[(corners_[k].first + i) % n_]) elsewhere += corners_[k].share[i];
      total += elsewhere * corner_force.segment<2>(2 * static_cast<Eigen::Index>(k));
    }
    return total;
  }

  const RingMechanics& ring_;
  int n_;
  RingTangent tangent_;
  std::vector<char> held_;  // segments that touch
  std::vector<CornerGap> corners_;
  std::vector<Axes> axes_;
};

}  // namespace

Eigen::Matrix2d ring_ground_stiffness(const RingSolver& solver) { return Stuck(solver).stiffness(); }

}  // namespace furrow::tire
