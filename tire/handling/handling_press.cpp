#include "tire/handling/handling_press.hpp"

#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "tire/handling/magic_formula.hpp"

namespace furrow::tire::handling {

PressResults press_handling(const MagicFormula& tire, const MassProperties& mass, const PressOptions& options) {
  if (!options.obstacle.profile.empty() || options.obstacle.height > 0.0)
    throw input_error("command line", "--on",
                      "is not 'plate', expected plate: a handling tire's file says nothing of other ground");
  if (options.obstacle.camber != 0.0)
    throw input_error(
        options.camber_from, options.camber_key,
        fmt::format("is {:g} rad, expected 0: a handling tire's file says nothing of pressing at a camber angle",
                    options.obstacle.camber));
  const double most = tire.dimension.unloaded_radius - tire.dimension.rim_radius;
  if (options.deflection >= most)
    throw input_error(options.deflection_from, options.deflection_key,
                      fmt::format("is {:g} m, expected less than {:.4g} m, where the tire is pressed down to its rim",
                                  options.deflection, most));
  PressModel model;
  model.press = [&](double deflection) {
    const double force = spring_force(tire, deflection);
    return PressPoint{deflection, force, 0.0, 0, 0, {{0.0, 0.0, force}, Vec3::Zero()}};
  };
  model.footprint = [] { return std::vector<PressSample>{}; };
  PressResults results;
  results.mass = mass;
  results.start_height = tire.dimension.unloaded_radius;
  results.stiffness_missing = "a handling tire's file says nothing of a ground that sticks";
  measure_press(
      options, model, [](double) {}, results);
  return results;
}

}  // namespace furrow::tire::handling
