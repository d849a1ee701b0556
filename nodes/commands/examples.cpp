#include "nodes/commands/examples.hpp"

#include <algorithm>

#include <fmt/format.h>

namespace furrow::commands {
namespace {

struct Example {
  std::string_view command, line, purpose;
};

constexpr Example kExamples[] = {
    {"", "run first_look.json", "Run a wheel on soil, in seconds."},
    {"", "new mine --tire my_tire.json", "Write a scenario of your own."},
    {"", "run mine.json --set rig.slip=0.2 --seeds 5", "Get pull and sinkage with intervals."},
    {"list", "list", "See everything that comes with Furrow."},
    {"list", "list tires --json", "Let a script choose a tire."},
    {"new", "new mine", "Write mine.json: one wheel on cohesive grains."},
    {"new", "new mine --tire my_tire.json --load 5000", "Give your own tire its load, N."},
    {"new", "new trip --vehicle hmmwv.json", "Drive a whole vehicle."},
    {"run", "run first_look.json", "Run a wheel on soil, in seconds."},
    {"run", "run drawbar_pull_small.json --set rig.slip=0.2 --seeds 5", "Get pull and sinkage with intervals."},
    {"run", "run rigid_ground.json --out hard --overwrite", "Choose the folder of the results."},
    {"resume", "resume results/first_look-001", "Go to the end that the scenario gives."},
    {"resume", "resume results/first_look-001 --until 3", "Lengthen a finished run to 3 s."},
    {"validate", "validate drawbar_pull.json", "Learn time, memory and disk of a run before it."},
    {"validate", "validate hmmwv.json", "See axle loads, ride heights and modes."},
    {"ranks", "ranks first_look.json", "See which rank does what."},
    {"ranks", "ranks drawbar_pull.json --slurm --time 240 > job.sh", "Write a batch script for sbatch."},
    {"explain", "explain terrain.cohesion", "See meaning, unit, range and default."},
    {"schema", "schema scenario", "Give an editor the keys of scenarios."},
    {"bed", "bed drawbar_pull_small.json", "Settle a bed that later runs share."},
    {"soil", "soil drawbar_pull_small.json --quick", "Get an impression within seconds."},
    {"soil", "soil drawbar_pull_small.json --only shear", "Measure cohesion and friction angle on three beds."},
    {"press", "press rigid_ground.json --load 6000", "Get the load-deflection curve, and a footprint."},
    {"press", "press cleat_press.json --cleat-height 0.025", "Press the tire on a cleat."},
    {"modes", "modes hmmwv_lumped.json --orders 3", "Get the frequencies of the lowest orders."},
    {"kc", "kc hmmwv.json --travel 0.05", "Move the wheels by 50 mm up and down."},
    {"sweep", "sweep study_slip.json --jobs 2", "Get pull against slip, two runs at once."},
    {"calibrate", "calibrate calibrate_ring.json", "Fit the ring to the shell, with errors."},
    {"report", "report results/first_look-001", "Make plots and report.html of a run."},
    {"report", "report results/a results/b --out both", "Compare runs on one page."},
    {"events", "events results/hmmwv_small-001", "List what happened, and compare the axles."},
    {"bench grains", "bench grains --cohesion 5000 --threads 2", "Time the reference bed with cohesion, on two cores."},
    {"bench tire", "bench tire --tire hmmwv_lumped.json", "Time the steps of this tire."},
};

/// A line each; empty where a command needs none.
std::string examples_of(std::string_view command) {
  std::size_t width = 0;
  for (const Example& example : kExamples)
    if (example.command == command) width = std::max(width, example.line.size());
  std::string text;
  for (const Example& example : kExamples)
    if (example.command == command) text += fmt::format("  furrow {:{}}  {}\n", example.line, width, example.purpose);
  return text;
}

}  // namespace

std::string closing_words(std::string_view command) {
  const std::string examples = examples_of(command);
  return (examples.empty() ? "" : "Examples:\n" + examples + "\n") +
         "Exit codes: 0 done, 2 bad input, 3 the physics failed, 4 a rank was lost, 5 input/output, "
         "6 memory or another limit ran out, 70 a fault of the program itself, 75 stopped by a signal.";
}

}  // namespace furrow::commands
