// The elastic and pressure forces of a whole ring of layered shell elements. Elements at the same width
// position share their matrices; they are processed row by row in batches of kDoubleLanes around the ring.
//   f = Σ_e B(q_f)ᵀ D̂ [E_old + c (E(q_new) − E_old)] − p ∂V/∂q(q_f),   B = ∂E/∂q,   c a factor of the time
//   integrator
// In a time step, branches of a generalised Maxwell model add Σ g_i D̂ H_i, Ḣ_i = Ė − H_i/τ_i. For a strain that
// changes at a constant rate over the step h, x_i = h/τ_i,
//   H_i' = e^{−x_i} H_i + b_i ΔE,  b_i = (1 − e^{−x_i})/x_i
// holds exactly (Taylor, Pister & Goudreau 1970, Thermomechanical analysis of viscoelastic solids, IJNME 2,
// doi:10.1002/nme.1620020106), and as e^{−2x} + (1 − b)² ≤ 1 a step never adds energy. The stiffness of all branches is
// a multiple of the element's own, so a step needs the one product D̂ ΔE, with or without branches. The pressure acts
// on the current area of the mid-surface; V is the volume between mid-surface and bead discs.
#pragma once

#include "protocol/core/assert.hpp"
#include "tire/ancf/shell_layout.hpp"
#include "tire/ancf/shell_strain.hpp"
#include "tire/shell_mesh.hpp"

namespace furrow::tire {

struct BatchNodes;

class ShellCarcass {
 public:
  ShellCarcass(const TireFile& file, const ShellMesh& mesh);

  const ShellLayout& layout() const { return layout_; }
  double pressure() const { return pressure_; }  // Pa
  void set_pressure(double pressure) { pressure_ = pressure; }
  const StrainMatrix& stiffness(int j) const {
    FURROW_ASSERT(in_range(j, stiffness_.size()), j, stiffness_.size());
    return stiffness_[j];
  }

  /// Strains of all elements: [row][batch][strain][lane].
  std::size_t strains_size() const;
  void strains(const Field& q, Field& e) const;

  /// @param f every coordinate, overwritten
  void forces(const Field& q_new, const Field& q_force, const Field& e_old, double c, Field& f) const;

  struct Energies {
    double elastic = 0.0;  // ½ Σ Eᵀ D̂ E, J
    double change = 0.0;   // Σ ΔEᵀ D̂ ΔE, ΔE the change since the strains given, J
    double stored = 0.0;   // in the branches, ½ Σ g HᵀD̂ H, J
    double relaxed = 0.0;  // dissipated by the branches, J
  };
  /// Replaces the strains in `e` with those of `q`.
  Energies account(const Field& q, Field& e) const;

  /// Data of all elements in a time step, [row][batch][strain][lane].
  struct Step {
    Field strains, stress;             // E_old and D̂ E_old
    Field new_strains, stress_change;  // at q_new, and D̂ (E_new − E_old)
    std::vector<Energies> rows;        // changes over the step, by width position
    // Of the branches, one after the other: H and g D̂ H; and stress + Σ e^{−x} g D̂ H of the current step.
    std::vector<Field> branch_strain, branch_stress;
    Field relaxed_stress;
    double h = 0.0;  // s
  };
  /// Starts at q: sets strains and stress.
  void begin(const Field& q, Step& step) const;
  /// Sets the length of the next step, s. @pre begin() was called for this step; h > 0
  void prepare(Step& step, double h) const;
  /// Contribution of the branches to c for a step of h: Σ g_i b_i.
  double branch_gain(double h) const;
  /// forces() of a step; c is given without the branches. `threads` share the rows; the result does not depend on their
  /// number.
  void forces(const Field& q_new, const Field& q_force, Step& step, double c, Field& f, int threads) const;
  /// Takes the last q_new as the next step's start. @returns changes over the step, and Σ ΔEᵀ D̂ ΔE, J
  Energies accept(Step& step) const;

  /// Volume between the mid-surface and the two cones from the bead loops to `centre`, m³.
  double volume(const Field& q, const Vec3& centre) const;

  /// Resultant of the pressure on the mid-surface and its moment about `centre`; both depend on the bead
  /// loops alone.
  Wrench pressure_resultant(const Field& q, const Vec3& centre) const;

  /// Stress D̂ [E_old + c (E_new − E_old)] of a batch at width position j.
  void batch_stress_at(const Field& q_new, const Field& e_old, double c, int j, int batch, Double4* stress) const;
  void batch_stress_between(const BatchNodes& before, const BatchNodes& now, double c, int j, Double4* stress) const;

 private:
  void accept_branches(Step& step, Energies& total) const;
  void row_forces(const Field& q_new, const Field& q_force, Step& step, double c, int j, Field& f) const;
  /// Double4 of a batch: 1 for elements, 0 for padding.
  Double4 mask(int batch) const;
  void batch_strains_at(const Field& q, int j, int batch, Double4* e) const;
  const double* batch_of(const Field& e, int j, int batch) const {
    return e.data() + static_cast<std::size_t>(j * layout_.batches() + batch) * kStrains * kDoubleLanes;
  }

  ShellLayout layout_;
  std::vector<StrainMatrix> stiffness_;  // D̂ of each width position, J
  std::vector<StrainVector> reference_;  // raw strains of the undeformed element
  std::vector<MaxwellBranch> branches_;
  double pressure_ = 0.0;  // gauge, Pa
};

}  // namespace furrow::tire
