// `furrow explain`: the meaning of a key of a scenario or of a calibration study.
#include <memory>
#include <string>

#include "nodes/calibrate/explain.hpp"
#include "nodes/commands/command_table.hpp"
#include "nodes/commands/wrapped.hpp"
#include "nodes/scenario/explain.hpp"
#include "protocol/core/error.hpp"

namespace furrow::commands {
namespace {

ExitCode explain(const std::string& key) {
  if (key.ends_with(".json"))
    throw input_error("explain", key, "is the name of a file, expected a key; 'furrow validate' checks a file");
  const std::string text =
      calibrate::explains_calibrations(key) ? calibrate::explain_calibration(key) : scenario::explain(key);
  print_text(text, Piped::whole_lines);
  return ExitCode::done;
}

Action explain_options(CLI::App& command, Typed&) {
  const auto key = std::make_shared<std::string>();
  command.add_option("KEY", *key,
                     "Explain the key of this dotted path, for example terrain.cohesion, or calibrate for calibration "
                     "studies (default: list all keys of a scenario).");
  return [key] { return explain(*key); };
}

}  // namespace

Command explain_entry() {
  return {.name = "explain",
          .task = task::ask,
          .purpose = "Explain a key of a scenario or of a calibration study, or list all keys of a scenario.",
          .options = explain_options,
          .examples = {{"explain terrain.cohesion", "See meaning, unit, range and default."}},
          .quiet = false};
}

}  // namespace furrow::commands
