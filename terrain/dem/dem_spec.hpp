// The terrain made of grains, engine dem, as a scenario describes it.
#pragma once

#include <memory>
#include <vector>

#include <nlohmann/json.hpp>

#include "protocol/files/data_files.hpp"
#include "protocol/files/json_fields.hpp"
#include "protocol/files/read_context.hpp"
#include "terrain/dem/dem_options.hpp"

namespace furrow::terrain::dem {

/// @pre the section was checked against the schema. @throws Error(bad_input) when the bed's file does not exist
std::unique_ptr<TerrainSpec> read_dem_spec(const nlohmann::json& section, const ReadContext& context);

/// Properties of any engine with these grains, except its name.
TerrainDescription describe_grains(const DemOptions& options);
std::vector<TerrainFile> bed_files(const DemOptions& options);
/// Sets the density of the grains if that of the bed is prescribed. @throws Error(bad_input)
void take_bulk_density(DemOptions& options);
/// Reads the keys of a section into `options`, whichever struct lists them, and finds the bed's file.
template <HasFields Options>
void read_grain_keys(const nlohmann::json& section, const ReadContext& context, Options& options) {
  options.scenario = context.file;
  read_fields(section, options);
  take_bulk_density(options);
  if (!options.bed.empty()) options.bed = find_file(options.bed, context.key("bed"), context.file).string();
}

/// Makes the spec for a program that has its options already.
std::unique_ptr<TerrainSpec> make_dem_spec(const DemOptions& options);

}  // namespace furrow::terrain::dem
