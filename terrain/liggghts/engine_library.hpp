// Finds and loads the library that holds the engine. Only ranks of a terrain that uses it load it.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

/// Beside the program, or above it for programs of the tests; empty: nowhere.
std::filesystem::path find_engine_library();

/// Why this program cannot use the engine, for people; empty: it can.
std::string engine_library_problem();

/// @throws Error(bad_input) with that
void require_engine_library();

/// @throws Error(bad_input) that says what to install when there is no such library, it cannot be loaded or is that of
/// another version
std::unique_ptr<Engine> make_engine(const EngineSetup& setup);

}  // namespace furrow::terrain::liggghts
