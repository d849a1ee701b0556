// The Cholesky factor of a step's tangent, kept from step to step and renewed in the sectors that have aged.
//
// For a change of a free node's q', equation (2) of shell_integrator.hpp has the tangent
//   A = M/h² + c B(q_f)ᵀ D̂ B(q_f) + ½ (geometric and pressure parts) + ½ K + C/h,   c = 1 + τ/h + Σ g_i b_i,
// in its symmetric form; K and C are those of the contact (shell_contact.hpp). As c is some hundred, a degree of local
// rotation matters, and A ages where the tire deforms. So the ring is cut into sectors, and the factor is renewed in
// those whose shape, in rim axes, has changed. These are around the contact patch, which travels through the rim's
// axes, and where the tire sways or wrinkles. A sector's age is the largest relative change of an edge, a director or a
// contact tangent. The factor's bits depend on the shapes alone, so only the shapes are saved.
#pragma once

#include <cstdint>
#include <vector>

#include "protocol/core/archive.hpp"
#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"
#include "tire/ancf/shell_carcass.hpp"
#include "tire/ancf/shell_contact.hpp"
#include "tire/ancf/shell_factor.hpp"
#include "tire/ancf/shell_layout.hpp"
#include "tire/ancf/shell_mass.hpp"

namespace furrow::tire {

struct SectorFactorParams {
  double damping = 0.005;  // τ, s
  double age = 0.01;  // of a sector at which it is renewed: largest relative change of an edge or a director; 0: always
  double contact_age = 0.5;  // change of a node's contact tangent, relative to its stiffness, that counts as `age`
  int worth = 30;            // iterations that a renewal may cost
  int threads = 1;           // of a step; results do not depend on them

  /// 1 + τ/h: stress from the strains of a step of h, relative to the static stress.
  double coefficient(double h) const { return 1.0 + damping / h; }
};

class SectorFactor {
 public:
  /// `shell` and `mass` must outlive it.
  SectorFactor(const ShellLayout& layout, const ShellCarcass& shell, const ShellMass& mass,
               const SectorFactorParams& params);
  SectorFactor(const SectorFactor&) = delete;
  SectorFactor& operator=(const SectorFactor&) = delete;

  /// The data of a step on which the factor depends; coordinates have their padding filled.
  struct Step {
    double h = 0.0;       // s
    const RimState& rim;  // at its end
    const Field& q;       // coordinates at its beginning: m, –
    const Field& q_new;   // coordinates at its end, as predicted or corrected so far
    const ShellContact& contact;
  };

  /// Starts without a factor and counts from zero.
  void start();
  /// Renews the factor for a step in sectors that are too old. Attempt 1, after a failure, renews all sectors that have
  /// aged at all; attempts from 2 on make a new factor. @returns false when there is no factor
  bool prepare(const Step& step, int attempt);
  /// x = A⁻¹ rhs on the free rows, in world axes of a rim turned by `turn`; padding of x is zero there.
  void solve(const Mat3& turn, const Field& rhs, Field& x) { factor_.solve(turn, rhs, x, params_.threads); }
  /// Notes that a step has taken `count` iterations: more than one indicates an old factor.
  void note_iterations(int count);

  std::int64_t renewals() const { return renewals_; }  // whole or in part
  double work() const { return work_; }                // cost of the renewals, in whole factorizations

  /// Processor time spent, s, cumulative; not part of the state.
  struct Times {
    double jacobian = 0.0, factorize = 0.0;
  };
  const Times& times() const { return times_; }

  /// Under "factor/".
  void save(Archive& archive) const;
  /// Makes the factor from the saved shapes, with the bits it had. @throws Error(io)
  void restore(const Archive& archive);

 private:
  friend void visit_fields(FieldsOf<SectorFactor> auto& s, auto&& visit) {
    visit(s.valid_, furrow::Field{"valid", ""});
    visit(s.h_, furrow::Field{"step", "s"});
    visit(s.excess_, furrow::Field{"excess"});
    visit(s.renewals_, furrow::Field{"renewals"});
    visit(s.work_, furrow::Field{"work"});
  }

  void note_shape(int sector, const Step& step);
  void build(const std::vector<char>& which);
  void build_sector(int sector);
  bool renew(const std::vector<char>& which, const Step& step);
  double age(int sector, const Field& q_new, const Mat3& turn) const;
  double contact_age(int sector, double h) const;
  void note_contact(const Step& step, const Mat3& turn);

  SectorFactorParams params_;
  ShellLayout layout_;
  const ShellCarcass& shell_;
  const ShellMass& mass_;
  std::vector<double> weight_;  // of the nodes under standard gravity, [column * rows + row], N
  ShellFactor factor_;

  // Coordinates in rim axes at the ends of a step, sector by sector, from which the factor was made.
  ShellLayout made_layout_;
  Field made_old_, made_new_;
  std::vector<char> geometric_;        // sectors made with their geometric stiffness
  std::vector<double> made_pressure_;  // Pa, by sector
  // Contact tangents in rim axes, [column * rows + row], N/m: now, and in the factor; empty until there is one.
  std::vector<Mat3> contact_now_, contact_made_;
  bool valid_ = false;
  double h_ = 0.0;  // s
  int excess_ = 0;  // iterations beyond one per step since the last renewal

  std::int64_t renewals_ = 0;
  double work_ = 0.0;  // in whole factorizations
  std::vector<double> age_;
  std::vector<char> which_;
  Times times_;
};

}  // namespace furrow::tire
