// Normal pressure under one node of the grid: Bekker's pressure–sinkage curve with Wong's unloading and reloading.
//
//   first loading      p = (k_c/b + k_φ) zⁿ                                          [Bekker 1969; Wong 2008, §2.4]
//   un- and reloading  p = p_u − k_u (z_u − z),   k_u = k_0 + A_u z_u                    [Wong 2008, §2.4]
//
// z is the depth below the undisturbed surface, (z_u, p_u) where unloading began. The same as an elastic spring k_u
// behind a plastic sinkage z_p that never shrinks, p = k_u (z − z_p), with p_u as its yield pressure:
// z_p = z_u − p_u/k_u is the rut. What is loaded again follows the spring up to p_u and the curve from there: a second
// wheel in a rut meets what the first one left.
//
// Deviations. k_u is at least max(1, n) p_u/z_u: a softer spring would heave the soil above its undisturbed surface or
// give back more work than was done. Where b shrinks the spring bears up to the stiffer curve; where b grows p_u is
// held. Below the yield pressure a damper stands beside the spring, p = k_u (z − z_p) + d ż, cut at 0 and at p_u, so
// that the curve of first loading has no rate in it.
//
// Losses. With e = z − z_p the work per area p dz is d(½ k_u e²) + p dz_p − ½ e² dk_u + d ż dz; the middle two terms
// are the compaction. Between two states they are ½ (p + p′)(z_p′ − z_p) − ½ e e′ (k_u′ − k_u), exact for trapezoids.
//
// [Bekker 1969] M. G. Bekker, Introduction to Terrain–Vehicle Systems, University of Michigan Press.
// [Wong 2008] J. Y. Wong, Theory of Ground Vehicles, 4th ed., Wiley.
#pragma once

namespace furrow::terrain::scm {

struct PressureLaw {
  double k_c = 0.0;             // N/m^(n+1), may be negative
  double k_phi = 0.0;           // N/m^(n+2)
  double n = 1.0;               // -
  double unloading = 0.0;       // k_0, N/m³
  double unloading_rate = 0.0;  // A_u, N/m⁴
  double damping = 0.0;         // d, N s/m³

  /// k_c/b + k_φ, N/m^(n+2): at least a twentieth of k_φ, for negative k_c and small b.
  double modulus(double b) const;
};

/// What the soil under one node remembers.
struct SoilNode {
  double plastic = 0.0;    // z_p ≥ 0, m
  double yield = 0.0;      // p_u, Pa
  double stiffness = 0.0;  // k_u, N/m³; 0: never loaded

  /// Elastic pressure at sinkage z, not above the yield pressure's.
  double elastic(double z) const { return z > plastic ? stiffness * (z - plastic) : 0.0; }
};

/// One step of a node.
struct PressureStep {
  double elastic = 0.0;     // p of the spring at the end, Pa
  double pressure = 0.0;    // with the damper's, ≥ 0: what acts on the surface, Pa
  double compaction = 0.0;  // lost, J/m²
};

/// Moves the node's surface from sinkage `before` to `now` (m, positive down), with ż = `rate` (m/s) at the end.
/// @param modulus k_c/b + k_φ now. A sinkage above the node's surface presses nothing.
/// @pre modulus > 0
PressureStep press(const PressureLaw& law, double modulus, double before, double now, double rate, SoilNode& node);

}  // namespace furrow::terrain::scm
