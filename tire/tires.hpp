// The tire models, by their names in tire files. A new model is one entry of the table in tires.cpp.
#pragma once

#include <memory>
#include <span>
#include <string_view>

#include <nlohmann/json.hpp>

#include "protocol/files/key_schema.hpp"
#include "protocol/files/read_context.hpp"
#include "tire/tire_spec.hpp"

namespace furrow::tire {

struct TireModel {
  std::string_view name;  // of the key `model` in tire files
  /// Reads a tire file, with the scenario's changes. @throws Error(bad_input) naming file and key
  std::unique_ptr<TireSpec> (*read)(const nlohmann::json& file, const TireOptions& options);
  /// Schema of its files. @param is_default whether files without the key `model` have this model
  nlohmann::ordered_json (*schema)(SchemaWriter& writer, std::string_view model, bool is_default) = nullptr;
};

/// The first is the model of files without the key `model`.
std::span<const TireModel> tire_models();

/// The JSON schema of tire files.
nlohmann::ordered_json tire_schema();

/// Reads the section of a scenario that describes a tire, and the tire's file.
/// @pre the section was checked against the schema. @throws Error(bad_input) naming file and key
std::shared_ptr<const TireSpec> read_tire(const nlohmann::json& section, const ReadContext& context);

/// Reads the tire's file for options that were read already. @throws Error(bad_input); an unknown model lists the valid
/// ones
std::unique_ptr<TireSpec> read_tire(const TireOptions& options);

/// Makes the model of a tire's file. @throws Error(bad_input)
std::unique_ptr<Tire> make_tire(const TireOptions& options);

}  // namespace furrow::tire
