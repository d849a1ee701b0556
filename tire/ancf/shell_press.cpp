#include "tire/ancf/shell_press.hpp"

#include "protocol/core/assert.hpp"
#include "tire/ancf/inflation.hpp"
#include "tire/ancf/press_solver.hpp"

namespace furrow::tire {

PressResults press_tire(const TireFile& file, const PressOptions& options, const ProgressCall& progress) {
  FURROW_ASSERT(options.points > 0 && options.deflection > 0.0, options.points, options.deflection);
  const ShellMesh mesh = make_shell_mesh(file);
  const ShellCarcass shell(file, mesh);
  InflationReport inflation;
  const auto inflating = [&] {
    if (progress) progress("inflating", 0.0);
  };
  PressSolver solver(file, mesh, inflate(shell, mesh, inflation, inflating), options.obstacle);
  PressResults results;
  results.pressure = file.pressure;
  results.mass = rigid_mass(mesh, element_masses(file, mesh));
  results.inflation_growth = solver.largest_radius() - file.radius;
  results.start_height = solver.start_height();
  double done = 0.0;
  PressModel model;
  model.press = [&](double deflection) {
    return solver.press(deflection, [&] {
      if (progress) progress("pressing", done);
    });
  };
  model.footprint = [&] { return solver.footprint(); };
  model.stiffness = [&] { return solver.ground_stiffness(); };
  model.unpressed = [&] {
    results.runout = solver.runout();
    results.director_runout = solver.director_runout();
  };
  measure_press(
      options, model, [&](double share) { done = share; }, results);
  return results;
}

}  // namespace furrow::tire
