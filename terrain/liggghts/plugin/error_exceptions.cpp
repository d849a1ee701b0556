// Turns LIGGGHTS' errors into exceptions. Its own functions end the process, on a communicator of only some of the
// ranks. These functions are not virtual; the definitions here come first when the library's symbols are looked up.
#include <string>

#include <error.h>

#include <compute.h>
#include <fix.h>

#include "terrain/liggghts/engine.hpp"

namespace LAMMPS_NS {
namespace {

using furrow::terrain::liggghts::EngineError;

[[noreturn]] void fail(const char* file, int line, const std::string& text, bool on_all) {
  const std::string path(file ? file : "");
  const std::string name = path.substr(path.find_last_of('/') + 1);
  throw EngineError(text + " (" + name + ":" + std::to_string(line) + ")", on_all);
}

}  // namespace

void Error::all(const char* file, int line, const char* text) { fail(file, line, text, true); }
void Error::universe_all(const char* file, int line, const char* text) { fail(file, line, text, true); }
void Error::fix_error(const char* file, int line, Fix* fix, const char* text) {
  fix_error(file, line, fix, fix->style, text);
}
void Error::fix_error(const char* file, int line, Fix*, const char* style, const char* text) {
  fail(file, line, "fix " + std::string(style) + ": " + text, true);
}
void Error::compute_error(const char* file, int line, Compute* compute, const char* text) {
  fail(file, line, "compute " + std::string(compute->style) + ": " + text, true);
}
void Error::one(const char* file, int line, const char* text) { fail(file, line, text, false); }
void Error::universe_one(const char* file, int line, const char* text) { fail(file, line, text, false); }

}  // namespace LAMMPS_NS
