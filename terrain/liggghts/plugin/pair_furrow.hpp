// The contact laws of terrain/dem between grains, as a pair style of LIGGGHTS. Its name there must be `gran`:
// FixContactHistory::init of LIGGGHTS 3.8 looks for no other.
#pragma once

#include <cstdint>
#include <span>
#include <unordered_map>

#include <pair_gran.h>

#include "terrain/liggghts/engine.hpp"

namespace furrow::terrain::liggghts {

class PairFurrow final : public LAMMPS_NS::PairGran {
 public:
  static constexpr int kTangential = 0, kRoot = 3, kRolling = 4;  // in the history of a pair
  static constexpr int kValues = 7;

  explicit PairFurrow(LAMMPS_NS::LAMMPS* lmp) : PairGran(lmp) {}

  void set_up(const EngineSetup& setup);
  void set_coefficients(const dem::ContactCoefficients& c) { coefficients_ = c; }
  /// The coming evaluations: histories grow for `since`, s.
  void set_since(double since) { since_ = since; }
  void want_losses(bool yes) { losses_ = yes; }
  void remember(std::span<const PairRecord> records);
  /// The histories that this rank's lists hold, of its grains; a pair across a border by the rank of the lower number.
  std::vector<PairRecord> records();
  /// Of the last evaluation.
  const PairSums& sums() const { return sums_; }

  void settings(int, char**) override;
  void init_granular() override {}
  bool contact_match(const std::string, const std::string) override { return false; }
  int64_t hashcode() override { return 0; }
  double stressStrainExponent() override { return 1.5; }

 private:
  void compute_force(int, int, int) override;
  template <class Law, bool kRoll, bool kSizes>
  void evaluate();
  void recall();
  double held(const double* history, double r_i, double r_j) const;

  dem::LawKind law_ = dem::LawKind::mindlin;
  bool rolling_ = false, sizes_ = false, losses_ = false;
  double radius_ = 0.0;  // for which the coefficients are, m
  double since_ = 0.0;   // s
  dem::ContactCoefficients coefficients_;
  PairSums sums_;
  std::unordered_map<std::uint64_t, PairRecord> remembered_;  // until the first evaluation
};

}  // namespace furrow::terrain::liggghts
