// Finds and loads the engine's library. Only ranks of a terrain that uses it load it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

/// The library next to the program, or above it for test programs; empty if not found.
std::filesystem::path find_engine_library();

/// Why this program cannot use the engine, for messages; empty if it can.
std::string engine_library_problem();

/// @throws Error(bad_input) with the text of engine_library_problem()
void require_engine_library();

/// @throws Error(bad_input) stating what to install if there is no such library, it cannot be loaded, or it is of
/// another version
std::unique_ptr<Engine> make_engine(const EngineSetup& setup);

}  // namespace furrow::terrain::liggghts
