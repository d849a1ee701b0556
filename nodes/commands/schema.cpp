// `furrow schema`: the JSON schemas of the users' files, for editors and scripts.
#include <array>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

#include "nodes/commands/command_table.hpp"
#include "nodes/scenario/scenario_schema.hpp"
#include "protocol/core/error.hpp"
#include "protocol/files/json_text.hpp"
#include "protocol/files/key_schema.hpp"
#include "tire/tires.hpp"
#include "vehicle/driver/read_driver.hpp"
#include "vehicle/spec/read_vehicle.hpp"

namespace furrow::commands {
namespace {

struct FileSchema {
  const char* kind;
  nlohmann::ordered_json (*make)();
};
constexpr auto kSchemas = std::to_array<FileSchema>({
    {"scenario", scenario::scenario_schema},
    {"tire", tire::tire_schema},
    {"vehicle", vehicle::vehicle_schema},
    {"driver", vehicle::driver_schema},
});

ExitCode print_schema(const std::string& kind) {
  std::vector<std::string> kinds;
  for (const FileSchema& schema : kSchemas) {
    if (kind == schema.kind) {
      std::cout << schema_text(schema.make());
      return ExitCode::done;
    }
    kinds.emplace_back(schema.kind);
  }
  throw input_error("schema", kind, "is unknown, expected " + one_of(kinds));
}

Action schema_options(CLI::App& command, Typed&) {
  const auto kind = std::make_shared<std::string>();
  command.add_option("KIND", *kind, "Print the schema of these files: scenario, tire, vehicle or driver.")->required();
  return [kind] { return print_schema(*kind); };
}

}  // namespace

Command schema_entry() {
  return {.name = "schema",
          .task = task::ask,
          .purpose = "Print the JSON schema of a kind of files, for editors.",
          .options = schema_options,
          .examples = {{"schema scenario", "Give an editor the keys of scenarios."}},
          .quiet = false};
}

}  // namespace furrow::commands
