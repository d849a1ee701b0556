// What happens to grains in a step beside their contacts with each other: Furrow adds the forces of walls and tires, then
// the grains move. Keeps what each grain carries, also from rank to rank.
#pragma once

#include <array>
#include <vector>

#include <fix.h>

#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/plugin/pair_furrow.hpp"

namespace furrow::terrain::liggghts {

class FixFurrow final : public LAMMPS_NS::Fix {
 public:
  FixFurrow(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
  ~FixFurrow() override;

  void set_up(const EngineSetup& setup, PairFurrow& pair) { setup_ = setup, pair_ = &pair; }
  void set_work(StepWork& work) { work_ = &work; }
  void set_times(const StepTimes& times) { times_ = times; }
  OwnGrains own();
  /// Where owned grain i stood when the lists were made, m.
  const std::array<double, 3>& list_position(int i) const { return listed_.at(i); }
  void set_list_position(int i, const std::array<double, 3>& x) { listed_.at(i) = x; }

  int setmask() override;
  void setup_pre_neighbor() override { pre_neighbor(); }
  void pre_neighbor() override;
  void pre_force(int) override;
  void post_force(int) override;
  void final_integrate() override;
  void grow_arrays(int most) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override { carried_.at(i).clear(); }
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;

 private:
  EngineSetup setup_;
  PairFurrow* pair_ = nullptr;
  StepWork* work_ = nullptr;
  StepTimes times_;
  bool losses_ = false;  // wanted of this step
  std::vector<std::vector<Carried>> carried_;
  std::vector<std::array<double, 3>> listed_;  // m
};

}  // namespace furrow::terrain::liggghts
