#include "rigs/rigs.hpp"

#include <array>
#include <vector>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include "protocol/core/error.hpp"
#include "protocol/files/json_fields.hpp"
#include "rigs/drawbar_spec.hpp"

namespace furrow::rigs {
namespace {

constexpr std::array<RigKind, 1> kKinds{{{"drawbar", read_drawbar}}};

}  // namespace

std::span<const RigKind> rig_kinds() { return kKinds; }

std::unique_ptr<RigSpec> read_rig(const nlohmann::json& section, const ReadContext& context) {
  RigOptions options;
  read_fields(section, options);
  std::vector<std::string_view> valid;
  for (const RigKind& kind : kKinds) {
    if (kind.name == options.type) return kind.read(section, context);
    valid.push_back(kind.name);
  }
  throw input_error(context.file, context.key("type"),
                    fmt::format("is '{}', expected {}{}", options.type, valid.size() > 1 ? "one of: " : "",
                                fmt::join(valid, ", ")));
}

}  // namespace furrow::rigs
