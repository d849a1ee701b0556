// The optimizer for models that answer quickly and without noise: bounded least squares (least_squares.hpp) from
// several starts.
#include <limits>

#include "nodes/calibrate/least_squares.hpp"
#include "nodes/calibrate/objective.hpp"
#include "nodes/calibrate/optimum.hpp"
#include "protocol/core/error.hpp"

namespace furrow::calibrate {
namespace {

constexpr int kMostDraws = 100;  // for a random start at which the model answers

}  // namespace

Optimum optimize_smooth(Objective& objective, const OptimizerOptions& options) {
  Optimum optimum;
  Draw draw(options.seed);
  optimum.squares = std::numeric_limits<double>::infinity();
  for (int k = 0; k < options.starts; ++k) {
    double iterations = 0.0;
    const auto residuals = [&](const Eigen::VectorXd& place, Eigen::VectorXd& r, Eigen::MatrixXd* J) {
      // Few starts need many iterations: half of a start counts as done after 20 iterations.
      if (J && options.progress)
        options.progress((k + iterations / (iterations + 20.0)) / options.starts), ++iterations;
      const auto found = objective.residuals(place);
      if (found) r = *found;
      const auto derivatives = found && J ? objective.jacobian(place, r) : std::nullopt;
      if (derivatives) *J = *derivatives;
      return found && (!J || derivatives);
    };
    Eigen::VectorXd begin = objective.start();
    for (int n = 0; k > 0 && n < kMostDraws; ++n)
      if (begin = draw.place(objective.parameters()); objective.residuals(begin)) break;
    const Least least = least_squares(residuals, objective.points(), begin);
    StartResult result{begin, least.place, std::nullopt, least.iterations, least.ended};
    if (const auto r = objective.residuals(result.end))
      result.squares = r->squaredNorm();
    else
      result.ended = "the model has no answer: " + objective.predict(result.end).problem;
    if (result.squares && *result.squares < optimum.squares)
      optimum.squares = *result.squares, optimum.place = result.end;
    optimum.starts.push_back(result);
  }
  const std::string file = objective.calibration().file.string();
  if (optimum.place.size() == 0)
    throw physics_error("{}: the model has no answer at any of the {} starts: {}", file, options.starts,
                        objective.predict(objective.start()).problem);
  optimum.residuals = *objective.residuals(optimum.place);
  const auto J = objective.jacobian(optimum.place, optimum.residuals);
  if (!J)
    throw physics_error("{}: the least lies where the model has no answer on either side: narrower bounds are needed",
                        file);
  optimum.jacobian = *J;
  return optimum;
}

}  // namespace furrow::calibrate
