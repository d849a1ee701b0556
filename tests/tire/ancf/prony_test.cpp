// The generalised Maxwell branches: a stretched ring against the closed forms of relaxation and loss modulus.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "small_tire.hpp"
#include "tire/ancf/inflation.hpp"

namespace furrow::test {
namespace {

/// A ring without pressure whose strains are all ½ (λ² − 1) times those of the metric.
struct Panel {
  tire::TireFile file = small_file("toroidal.json", 12, 6);
  tire::ShellMesh mesh;
  tire::ShellCarcass shell;
  tire::ShellLayout layout;
  tire::Field start;
  tire::ShellCarcass::Step step;

  explicit Panel(std::vector<tire::MaxwellBranch> prony)
      : mesh(tire::make_shell_mesh(file)), shell(with(file, std::move(prony)), mesh), layout(shell.layout()) {
    start = tire::undeformed(mesh);
    shell.begin(start, step);
  }
  static tire::TireFile with(tire::TireFile file, std::vector<tire::MaxwellBranch> prony) {
    file.pressure = 0.0;
    file.prony = std::move(prony);
    return file;
  }
  tire::Field stretched(double strain) const {
    tire::Field q = start;
    for (double& x : q) x *= std::sqrt(1.0 + 2.0 * strain);
    return q;
  }
  /// One step of h to a stretch; forces there, with τ of the Kelvin–Voigt law.
  tire::Field go(double strain, double h, double damping, tire::ShellCarcass::Energies& energies) {
    const tire::Field q = stretched(strain);
    tire::Field f(layout.size());
    shell.prepare(step, h);
    shell.forces(q, q, step, 1.0 + damping / h, f, 1);
    energies = shell.accept(step);
    return f;
  }
};

double norm(const tire::Field& f) {
  double total = 0.0;
  for (const double x : f) total += x * x;
  return std::sqrt(total);
}

const std::vector<tire::MaxwellBranch> kTwo{{0.3, 0.01}, {0.2, 0.1}};

TEST(Prony, a_stretched_panel_relaxes_as_the_sum_of_exponentials) {
  const double h = 1e-4, strain = 0.01;
  Panel panel(kTwo), elastic({});
  tire::ShellCarcass::Energies energies;
  const double settled = norm(elastic.go(strain, h, 0.0, energies));
  double lost = 0.0, stored = 0.0;
  for (int n = 0; n < 3000; ++n) {
    const double force = norm(panel.go(strain, h, 0.0, energies)) / settled;
    lost += energies.relaxed, stored += energies.stored;
    double exact = 1.0;  // strain rises at a constant rate over the first step
    for (const auto& [g, tau] : kTwo) exact += g * std::exp(-n * h / tau) * -std::expm1(-h / tau) * tau / h;
    EXPECT_NEAR(force, exact, 1e-12) << "step " << n;
    double sudden = 1.0;  // at the middle of the rise
    for (const auto& [g, tau] : kTwo) sudden += g * std::exp(-(n + 0.5) * h / tau);
    EXPECT_NEAR(force, sudden, 1e-5) << "step " << n;
    EXPECT_GE(energies.relaxed, 0.0);
  }
  // The whole energy of the branches, at first ½ g D̂ E² each, is lost in the end.
  tire::Field none;
  elastic.shell.strains(elastic.start, none);
  const double whole = elastic.shell.account(elastic.stretched(strain), none).elastic;
  EXPECT_NEAR(lost + stored, 0.5 * whole, 2e-2 * whole * 0.5);
  EXPECT_LT(stored, 0.01 * lost);
}

TEST(Prony, loss_per_cycle_of_a_harmonic_strain_is_pi_times_the_loss_modulus) {
  // E'' / E_∞ = ωτ + Σ g_i ωτ_i / (1 + ω²τ_i²)  (Tschoegl 1989, The phenomenological theory of linear viscoelastic
  // behavior, ch. 3), E' / E_∞ = 1 + Σ g_i ω²τ_i² / (1 + ω²τ_i²)
  const double strain = 0.004, damping = 2e-4;
  for (const double omega : {8.0, 50.0, 100.0, 600.0}) {
    Panel panel(kTwo);
    tire::Field none;
    panel.shell.strains(panel.start, none);
    const double twice = 2.0 * panel.shell.account(panel.stretched(strain), none).elastic;  // D̂ : E₁²
    const int steps = 400;
    const double h = 2.0 * std::numbers::pi / omega / steps;
    const int cycles = 3 + static_cast<int>(std::ceil(1.0 / (h * steps)));  // ten longest relaxation times
    double loss = 0.0, change = 0.0;
    for (int n = 1; n <= cycles * steps; ++n) {
      tire::ShellCarcass::Energies energies;
      panel.go(strain * std::sin(omega * h * n), h, damping, energies);
      if (n <= (cycles - 1) * steps) continue;
      loss += energies.relaxed + damping / h * energies.change;
      change += energies.elastic + energies.stored;
    }
    double modulus = omega * damping;
    for (const auto& [g, tau] : kTwo) modulus += g * omega * tau / (1.0 + std::pow(omega * tau, 2));
    const double exact = std::numbers::pi * twice * modulus;
    EXPECT_NEAR(loss, exact, 2e-4 * exact) << "omega " << omega;
    EXPECT_LT(std::abs(change), 1e-3 * exact) << "omega " << omega;  // a closed cycle
  }
}

/// Power lost in the carcass of a tire that rolls, W.
double rolling_loss(const std::vector<tire::MaxwellBranch>& prony) {
  tire::TireFile file = small_file();
  file.structural_damping = 0.002;
  file.prony = prony;
  Rolling rolling(file);
  double before = 0.0;
  for (int n = 0; n < 1000; ++n) {
    if (n == 400) before = rolling.tire.diagnostics().dissipation;
    rolling.interval(n);
  }
  return (rolling.tire.diagnostics().dissipation - before) / (600 * rolling.step);
}

TEST(Prony, branches_raise_the_rolling_loss_the_more_the_stiffer_they_are) {
  const double without = rolling_loss({}), some = rolling_loss({{0.1, 0.01}}), more = rolling_loss({{0.2, 0.01}});
  EXPECT_GT(without, 1.0);
  EXPECT_GT(some, 1.05 * without);
  EXPECT_GT(more - without, 1.5 * (some - without));
}

TEST(Prony, restored_tire_with_branches_and_a_changing_pressure_continues_bit_for_bit) {
  tire::TireFile file = small_file();
  file.prony = kTwo;
  expect_restart_bit_for_bit(file, [](tire::AncfTire& which, int n) { which.set_pressure(2e5 - 400.0 * n); });
}

}  // namespace
}  // namespace furrow::test
