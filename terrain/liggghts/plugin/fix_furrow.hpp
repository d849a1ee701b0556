// What happens to grains in a step beside their contacts with each other: lists are made where they are due, Furrow
// adds the forces of walls and tires, then the grains move. Keeps what each grain carries, also from rank to rank.
//
// When lists are due. All ranks make their lists when a grain of any has moved by half the skin s since they were made:
// then the ghosts of a continued run stand where they stood, as their owners know. How far grains moved is looked at
// only when the fastest of each step could have come that far.
//
// When grains change ranks. LIGGGHTS' exchange, which also renews the ghosts, is due on all ranks alike and seldom. Its
// reach for ghosts is wider by kGhostRoom skins than that of the lists, so that grains may stray: in x from the rank's
// part, in y from a periodic bin. With its part [lo, hi], the largest radius r, and m what the fastest grain moves in
// two steps, a rank asks for it when, as it makes its lists, a grain of its own
//   stands outside of [lo − s/2 + m, hi + s/2 − m],                                                           (1)
//   or was not sent as a ghost over a border and has come as near to it as 2r + 3s/2 + m.                     (2)
// Until the lists after these, and in the step that the exchange comes late, a grain moves by s/2 and what is in m at
// most. So a grain is no farther than s beyond the border, and what is not among its ghosts no nearer to it than 2r +
// s: they cannot touch. Ranks agree on it by one number, which travels while the pairs are evaluated.
#pragma once

#include <array>
#include <memory_resource>
#include <vector>

#include <mpi.h>

#include <fix.h>

#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/plugin/pair_furrow.hpp"

namespace furrow::terrain::liggghts {

/// Of LIGGGHTS' ghosts beyond the reach of the lists, skins.
inline constexpr double kGhostRoom = 1.0;

class FixFurrow final : public LAMMPS_NS::Fix {
 public:
  FixFurrow(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
  ~FixFurrow() override;

  void set_up(const EngineSetup& setup, PairFurrow& pair) { setup_ = setup, pair_ = &pair; }
  void set_work(StepWork& work) { work_ = &work; }
  void set_times(const StepTimes& times) { times_ = times; }
  OwnGrains own();
  /// Where grain i stood when the lists were made, and when it last could change its rank, m.
  const std::array<double, 3>& list_position(int i) const { return listed_.at(i); }
  const std::array<double, 3>& exchange_position(int i) const { return exchanged_.at(i); }
  /// What own grain i remembers of its pairs, until the next lists are made.
  std::vector<PairOf>& pairs_of(int i) { return pairs_.at(i); }

  /// Makes this rank's lists where the grains stand now.
  void make_lists();
  /// Grains were moved, or given velocities, by somebody else.
  void look_again();
  /// In the coming step grains change ranks. Alike on all ranks.
  bool exchange_due() const;
  void set_exchange_due();

  int setmask() override;
  void setup_pre_exchange() override { pre_exchange(); }
  void pre_exchange() override;
  void setup_pre_neighbor() override { note_exchange(); }
  void pre_neighbor() override;
  void pre_force(int) override;
  void final_integrate() override;
  void grow_arrays(int most) override;
  void copy_arrays(int from, int to, int) override;
  void set_arrays(int i) override { carried_.at(i).clear(), pairs_.at(i).clear(); }
  int pack_exchange(int i, double* buffer) override;
  int unpack_exchange(int i, double* buffer) override;

 private:
  bool lists_due();
  bool strayed() const;
  void note_exchange();
  template <bool kSums, bool kSizes>
  void move();

  EngineSetup setup_;
  PairFurrow* pair_ = nullptr;
  StepWork* work_ = nullptr;
  StepTimes times_;
  StepWish wish_;         // of this step
  MotionSums sums_;       // of this step, where wanted
  double way_ = 0.0;      // that no own grain has exceeded since the lists were made, m
  double fastest_ = 0.0;  // own grain, m/s
  MPI_Request asking_ = MPI_REQUEST_NULL;
  int asks_ = 0, any_asks_ = 0;                  // for an exchange: this rank, any rank
  std::pmr::unsynchronized_pool_resource pool_;  // keeps what is carried together: few grains carry anything
  std::pmr::vector<CarriedList> carried_{&pool_};
  std::vector<std::vector<PairOf>> pairs_;                 // while there are no lists
  std::vector<std::array<double, 3>> listed_, exchanged_;  // m
};

}  // namespace furrow::terrain::liggghts
