// The contact laws of terrain/dem between grains, as a pair style of LIGGGHTS with lists of its own. LIGGGHTS' lists
// are not used: they cover all of a rank's grains and are made again with its exchange of grains once one grain has
// moved. Its history of contacts is not used either: pair histories are in the lists, and FixFurrow carries them along.
#pragma once

#include <cstdint>
#include <vector>

#include <pair_gran.h>

#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/plugin/pair_lists.hpp"

namespace furrow::terrain::liggghts {

class PairFurrow final : public LAMMPS_NS::PairGran {
 public:
  explicit PairFurrow(LAMMPS_NS::LAMMPS* lmp) : PairGran(lmp) { needs_neighlist = false; }

  void set_up(const EngineSetup& setup);
  void set_coefficients(const dem::ContactCoefficients& c) { coefficients_ = c; }
  /// For the coming evaluations: histories grow for `since`, s.
  void set_since(double since) { since_ = since; }
  /// Begins a step. @param grains  of this rank
  void begin_step(StepWork& work, const OwnGrains& grains, bool losses) {
    work_ = &work, grains_ = grains, losses_ = losses;
  }
  PairLists& lists() { return lists_; }
  /// The histories in this rank's lists; the rank of the grain with the lower number has a pair across a border.
  std::vector<PairRecord> records();
  /// Sums of the last evaluation.
  const PairSums& sums() const { return sums_; }

  void settings(int, char**) override {}
  void init_granular() override {}
  bool contact_match(const std::string, const std::string) override { return false; }
  int64_t hashcode() override { return 0; }
  double stressStrainExponent() override { return 1.5; }

 private:
  void compute_force(int, int, int) override;
  template <class Law, bool kRoll, bool kSizes>
  void evaluate();

  dem::LawKind law_{};
  bool rolling_ = false, sizes_ = false, losses_ = false;
  double radius_ = 0.0;  // radius of the coefficients, m
  double since_ = 0.0;   // s
  dem::ContactCoefficients coefficients_;
  StepWork* work_ = nullptr;  // of this step, like the grains
  OwnGrains grains_;
  PairSums sums_;
  PairLists lists_;
};

}  // namespace furrow::terrain::liggghts
