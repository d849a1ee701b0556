// `furrow schema`: the JSON schemas of the files that people write, for editors and scripts.
#include <array>
#include <iostream>
#include <string>
#include <vector>

#include "nodes/commands/commands.hpp"
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

}  // namespace

ExitCode schema_command(const std::string& kind) {
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

}  // namespace furrow::commands
