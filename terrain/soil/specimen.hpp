// A bed of a scenario's grains for tests: a box sized in grain radii that settles like the scenario's bed, or that bed.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "protocol/core/archive.hpp"
#include "terrain/dem/dem_options.hpp"
#include "terrain/dem/quad.hpp"

namespace furrow::terrain::soil {

/// Called from time to time with the share done, 0…1, of the present work; may throw to stop it.
using WorkCall = std::function<void(double share)>;

struct Box {
  double length = 0.0, width = 0.0, depth = 0.0;  // wanted, in grain radii
  bool periodic_x = true, periodic_y = true;
  int layers = 0;    // of grains dropped; 0: about as many as the depth requires
  bool own = false;  // use the scenario's bed, whatever its size: from its file, the cache, or settled now
};

/// Step for tests of these grains, s: a fixed share of the stable one, or their own if unstable steps are allowed.
double test_step(const dem::DemOptions& material);

class Specimen {
 public:
  /// Fills the box and lets it settle, with the generator and the compaction of `material`; reads a file only if the
  /// box is the scenario's own. Uses material.threads.
  Specimen(const dem::DemOptions& material, const Box& box, std::uint64_t seed, const WorkCall& work);

  /// The settled bed, ready for tools. Each call returns a new one in the same state.
  /// @param each_substep is called in every substep of its advances and may throw to stop
  std::unique_ptr<Terrain> terrain(std::function<void()> each_substep = {}) const;

  const dem::DemOptions& options() const { return options_; }
  double length() const { return options_.length; }  // m
  double width() const { return options_.width; }    // m
  double height() const { return height_; }          // mean surface height, m
  double top() const { return top_; }                // highest grain top, m
  double step() const { return options_.step; }      // s
  std::int64_t grains() const { return grains_; }
  double weight() const;  // N
  bool settled() const { return settled_; }
  /// Positions x y z and radii w of all grains, m.
  const std::vector<dem::Quad>& positions() const { return positions_; }

 private:
  void put_in(const Box& box);

  dem::DemOptions options_;
  Archive bed_;
  std::vector<dem::Quad> positions_;
  double height_ = 0.0, top_ = 0.0;
  std::int64_t grains_ = 0;
  bool settled_ = true;
};

}  // namespace furrow::terrain::soil
