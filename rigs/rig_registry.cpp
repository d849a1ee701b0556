#include "rigs/rig_registry.hpp"

#include "protocol/core/error.hpp"

namespace furrow::rigs {

std::unique_ptr<Rig> make_rig(const std::string& type, const DrawbarRigOptions& options) {
  if (type == "drawbar") return make_drawbar_rig(options);
  throw input_error("scenario", "rig.type", "unknown rig '" + type + "'; expected drawbar");
}

}  // namespace furrow::rigs
