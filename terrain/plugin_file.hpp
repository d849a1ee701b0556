// Libraries that the program loads while it runs, because their makers' code may be absent: LIGGGHTS, CUDA.
#pragma once

#include <filesystem>
#include <string>

namespace furrow::terrain {

/// The library of this name next to the program, or above it for test programs; empty if not found.
std::filesystem::path find_plugin(const std::string& name);

/// Why a file cannot be loaded without ending the process, for messages: it is cut short; empty if it can.
std::string plugin_problem(const std::filesystem::path& file);

/// Loads a library that stays until the program ends, because its code must outlive its objects. @returns null if it
/// cannot be loaded, and why
void* open_plugin(const std::filesystem::path& file, std::string& why);

/// The function or object of this name in an open library; null if there is none.
void* find_symbol(void* library, const char* name);

}  // namespace furrow::terrain
