// What those commands are given that have many options (options.hpp).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace furrow::commands {

struct SlurmArguments {
  int nodes = 1;
  int cores_per_node = 0;  // 0: whole nodes, whatever they have
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

struct PressArguments {
  std::filesystem::path out;  // empty: a fresh folder under results/
  bool overwrite = false;
  std::string obstacle = "plate";                    // plate | cleat | profile
  std::filesystem::path profile;                     // CSV; empty: none
  double deflection = 0.02;                          // largest, m
  int points = 10;                                   // of the curve up to it
  double load = 4561.65;                             // of the footprint, N
  double cleat_height = 0.025, cleat_width = 0.025;  // m
  double cleat_position = 0.0;                       // of its middle, forward of the axle, m
};

}  // namespace furrow::commands
