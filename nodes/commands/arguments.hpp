// What those commands are given that have many options (options.hpp).
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace furrow::commands {

struct SlurmArguments {
  int nodes = 1;
  int cores_per_node = 0;                // 0: whole nodes, whatever they have
  std::string partition, time, account;  // empty: as the cluster has it
  std::filesystem::path out;             // empty: results/<scenario>-job<number of the job>
};

struct SoilArguments {
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  bool quick = false;
  int seeds = 3;
  double speed = 0.1;             // of the tools, m/s
  std::vector<std::string> only;  // plate, shear, cone, repose; empty: all
  std::vector<double> stresses;   // of the shear tests, Pa; empty: the usual ones
};

/// What is not given is as the section `press` of the scenario says.
struct PressArguments {
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  std::optional<std::string> on;                    // plate | cleat | profile
  std::filesystem::path profile;                    // CSV; empty: none
  std::optional<double> deflection;                 // largest, m
  std::optional<int> points;                        // of the curve up to it
  std::optional<double> load;                       // of the footprint, N
  std::optional<double> camber;                     // rad
  std::optional<double> cleat_height, cleat_width;  // m
  std::optional<double> cleat_position;             // of its middle, forward of the axle, m
};

struct ModesArguments {
  std::string tire;           // file, as given or in tire/data/
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  bool plots = true;
  bool csv = false, json = false;     // printed, in place of a folder
  std::optional<int> orders;          // highest circumferential order; none: 8, or half of the elements around
  std::optional<int> count;           // frequencies of each order; none: 3, or the unknowns of a section
  std::optional<double> pressure;     // gauge, Pa; none: the file's
  std::optional<int> around, across;  // elements; none: the file's
};

}  // namespace furrow::commands
