// Handles a step of the grains besides their contacts with each other: lists are made when they are due, Furrow adds
// the forces of walls and tires, then the grains move. Keeps the data that each grain carries, also from rank to rank.
//
// When lists are due. All ranks make their lists when a grain of any rank has moved by half the skin s since they were
// made: then the ghosts of a continued run are where their owners have them. How far grains have moved is checked only
// when the fastest of each step could have come that far.
//
// When grains change ranks. LIGGGHTS' exchange, which also renews the ghosts, is due on all ranks together, and rarely.
// Its reach for ghosts is kGhostRoom skins wider than that of the lists, so that grains may stray: in x from the rank's
// part, in y from a periodic bin. Let [lo, hi] be the rank's part, r the largest radius, and m the distance that the
// fastest grain moves in two steps. A rank asks for an exchange if, when it makes its lists, one of its own grains
//   is outside of [lo − s/2 + m, hi + s/2 − m],                                                               (1)
//   or was not sent as a ghost over a border and has come as near to it as 2r + 3s/2 + m.                     (2)
// Until the lists after these, and in the step by which the exchange is late, a grain moves by at most s/2 and the
// motion in m. So a grain is at most s beyond the border, and a grain that is not among its ghosts is at least 2r + s
// from the border: they cannot touch. Ranks agree on this by one number, sent while the pairs are evaluated.
#pragma once

#include <array>
#include <memory_resource>
#include <vector>

#include <mpi.h>

#include <fix.h>

#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/plugin/pair_furrow.hpp"

namespace furrow::terrain::liggghts {

/// Reach of LIGGGHTS' ghosts beyond that of the lists, skins.
inline constexpr double kGhostRoom = 1.0;

class FixFurrow final : public LAMMPS_NS::Fix {
 public:
  FixFurrow(LAMMPS_NS::LAMMPS* lmp, int narg, char** arg);
  ~FixFurrow() override;

  void set_up(const EngineSetup& setup, PairFurrow& pair) { setup_ = setup, pair_ = &pair; }
  void set_work(StepWork& work) { work_ = &work; }
  void set_times(const StepTimes& times) { times_ = times; }
  OwnGrains own();
  /// Position of grain i when the lists were made, and when it could last change its rank, m.
  const std::array<double, 3>& list_position(int i) const { return listed_.at(i); }
  const std::array<double, 3>& exchange_position(int i) const { return exchanged_.at(i); }
  /// Histories of own grain i's pairs, until the next lists are made.
  std::vector<PairOf>& pairs_of(int i) { return pairs_.at(i); }

  void make_lists();
  /// Call it after other code has moved grains or set their velocities.
  void look_again();
  /// Whether grains change ranks in the coming step; the same on all ranks.
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
  MotionSums sums_;       // of this step, if wanted
  double way_ = 0.0;      // bound on the displacement of own grains since the lists were made, m
  double fastest_ = 0.0;  // speed of the fastest own grain, m/s
  MPI_Request asking_ = MPI_REQUEST_NULL;
  int asks_ = 0, any_asks_ = 0;                  // for an exchange: this rank, any rank
  std::pmr::unsynchronized_pool_resource pool_;  // keeps carried data together, as few grains carry any
  std::pmr::vector<CarriedList> carried_{&pool_};
  std::vector<std::vector<PairOf>> pairs_;                 // while there are no lists
  std::vector<std::array<double, 3>> listed_, exchanged_;  // m
};

}  // namespace furrow::terrain::liggghts
