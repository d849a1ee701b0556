// `furrow explain`: what a key of a scenario or of a calibration study means.
#include "nodes/scenario/explain.hpp"
#include "nodes/calibrate/explain.hpp"
#include "nodes/commands/questions.hpp"
#include "nodes/commands/wrapped.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {

ExitCode explain_command(const std::string& key) {
  if (key.ends_with(".json"))
    throw input_error("explain", key, "is the name of a file, expected a key; 'furrow validate' checks a file");
  const std::string text =
      calibrate::explains_calibrations(key) ? calibrate::explain_calibration(key) : scenario::explain(key);
  print_text(text, Piped::whole_lines);
  return ExitCode::done;
}

}  // namespace furrow::commands
