// Which model a tire file's options give. A new model is one line in make_tire.
#include <fmt/format.h>

#include "protocol/core/error.hpp"
#include "tire/ancf/ancf_tire.hpp"
#include "tire/read_tire_file.hpp"
#include "tire/rigid/rigid_tire.hpp"
#include "tire/tire.hpp"

namespace furrow::tire {

TireFile tire_file_of(const TireOptions& options) {
  return tire_file_of(options, read_tire_file(options.file));
}

TireFile tire_file_of(const TireOptions& options, TireFile file) {
  if (!options.pressure.empty()) file.pressure = options.pressure.at(0.0);
  if (options.friction >= 0.0) file.contact.friction = options.friction;
  if (options.structural_damping >= 0.0) file.structural_damping = options.structural_damping;
  if (options.elements_circumference != 0) {
    if (options.elements_circumference < 8)
      throw input_error(file.path, "elements_circumference",
                        fmt::format("is {}, expected at least 8", options.elements_circumference));
    file.elements_circumference = options.elements_circumference;
  }
  if (options.elements_width != 0) set_elements_width(file, options.elements_width);
  return file;
}

std::unique_ptr<Tire> make_tire(const TireOptions& options) {
  const TireFile file = tire_file_of(options);
  if (options.rigid) return std::make_unique<RigidTire>(file);
  return std::make_unique<AncfTire>(file);
}

}  // namespace furrow::tire
