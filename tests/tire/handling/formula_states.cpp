// Writes a tire property file that uses every coefficient, random states within and around its ranges, and the forces
// of tire/handling in them. formula_peer_test.py evaluates the same file independently.
//
// usage: formula_states FILE.tir STATES.csv [FILE.tir that is there already, or 6.1]
#include <algorithm>
#include <fstream>
#include <iostream>
#include <random>
#include <string>

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "tests/tire/handling/example_tire.hpp"
#include "tire/handling/magic_formula.hpp"
#include "tire/handling/tir_file.hpp"

int main(int argc, char** argv) {
  using namespace furrow::tire::handling;
  if (argc < 3) return 2;
  try {
    const std::string given = argc > 3 ? argv[3] : "";
    const MagicFormula tire = given.empty() ? example_tire() : given == "6.1" ? later_tire() : read_tir(given);
    std::ofstream(argv[1]) << tir_text(tire, {});
    std::mt19937 random(7);
    const auto within = [&](const Range& range, double beyond) {
      const double middle = 0.5 * (range.least + range.most), half = 0.5 * (range.most - range.least);
      return middle + beyond * half * (2.0 * std::uniform_real_distribution<double>()(random) - 1.0);
    };
    std::ofstream out(argv[2]);
    out << "Fz_N,kappa,alpha_rad,gamma_rad,Vx_m_s,Fx_N,Fy_N,Mx_Nm,My_Nm,Mz_Nm\n";
    for (int n = 0; n < 4000; ++n) {
      const double beyond = n % 10 == 0 ? 1.3 : 1.0;
      SlipState at;
      at.load = std::max(10.0, within(tire.load, beyond));
      at.slip = within(tire.slip, beyond) * (n % 3 == 0 ? 0.1 : 1.0);
      at.slip_angle = within(tire.slip_angle, beyond) * (n % 5 == 0 ? 0.1 : 1.0);
      at.camber = within(tire.camber, beyond);
      at.speed = 30.0 * std::uniform_real_distribution<double>()(random);
      const HandlingForces f = evaluate(tire, at);
      out << fmt::format("{},{},{},{},{},{},{},{},{},{}\n", at.load, at.slip, at.slip_angle, at.camber, at.speed, f.fx,
                         f.fy, f.mx, f.my, f.mz);
    }
    return out.good() ? 0 : 1;
  } catch (const furrow::Error& error) {
    std::cerr << error.what() << "\n";
    return 1;
  }
}
