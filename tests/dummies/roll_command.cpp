#include "tests/dummies/roll_command.hpp"

#include <iostream>
#include <memory>

#include "protocol/files/json_text.hpp"

namespace furrow::commands {
namespace {

struct RollArguments {
  double speed = 0.0;   // v, m/s
  double radius = 0.5;  // R, m
};

ExitCode roll(const RollArguments& arguments) {
  std::cout << number_text(arguments.speed / arguments.radius) << " rad/s\n";
  return ExitCode::done;
}

Action roll_options(CLI::App& command, Typed&) {
  const auto arguments = std::make_shared<RollArguments>();
  command.add_option("SPEED", arguments->speed, "Roll at this speed, m/s.")->required();
  command.add_option("--radius", arguments->radius, "Set the radius of the wheel, m.")
      ->check(above_zero())
      ->capture_default_str();
  return [arguments] { return roll(*arguments); };
}

}  // namespace

Command roll_entry() {
  return {.name = "roll",
          .task = task::ask,
          .purpose = "Print the angular speed of a wheel that rolls freely.",
          .options = roll_options,
          .examples = {{"roll 2 --radius 0.4", "Roll a small wheel."}},
          .quiet = false};
}

}  // namespace furrow::commands
