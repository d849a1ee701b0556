#include "terrain/soil/soil_tests.hpp"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <functional>
#include <mutex>
#include <string>
#include <system_error>
#include <thread>

#include "protocol/core/error.hpp"
#include "terrain/dem/beds/loaded_lid.hpp"
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"
#include "terrain/soil/tools.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSettleSteps = 12e3;  // that a bed takes to settle, about
constexpr double kReposeSteps = 30e3;
constexpr double kNarrow = 36.0;                        // sides of the box that shows how deep a bed becomes, radii
constexpr int kMetreSamples = 300;                      // of a curve of a plate in metres
constexpr double kStripLength = 10.0;                   // of strips, radii
constexpr double kConeDepth = 0.15;                     // of the mean of a cone in metres [Brixius 1987], m
constexpr double kConeWidths = 6.0;                     // of the largest cone: its bed
constexpr double kLeastConeWidth = 24.0;                // radii
constexpr auto kTick = std::chrono::milliseconds(100);  // between looks at what is done
constexpr double kReferenceStep = 6e-3;                 // s per m of grain radius, for estimates of the work

/// One bed and what is done on it.
struct Job {
  double settling = 0.0, testing = 0.0;  // estimated work, grain-steps
  std::function<void(const Job&, const WorkCall&)> run;
  double work() const { return settling + testing; }
  /// Progress of the part [from, to] of the tests that follow settling.
  WorkCall settle_call(const WorkCall& call) const {
    const double share = settling / work();
    return [=](double done) { call(share * done); };
  }
  WorkCall test_call(const WorkCall& call, double from, double to) const {
    const double share = settling / work();
    return [=](double done) { call(share + (1.0 - share) * (from + (to - from) * done)); };
  }
};

/// Runs jobs on a few threads; the calling one reports.
class JobPool {
 public:
  JobPool(const std::vector<Job>& jobs, int threads, const ProgressCall& progress)
      : jobs_(jobs), done_(jobs.size()), progress_(progress) {
    for (auto& d : done_) d = 0.0;
    for (const Job& job : jobs) total_ += job.work();
    threads_ = std::clamp(threads, 1, static_cast<int>(jobs.size()));
  }

  void run() {
    std::vector<std::thread> threads;
    try {
      for (int t = 0; t < threads_; ++t) threads.emplace_back([this] { take_jobs(); });
    } catch (const std::system_error& error) {
      threads_ = static_cast<int>(threads.size());  // those that the system grants do the work
      if (threads_ == 0) throw limit_error(std::string("no thread could be started: ") + error.what());
    }
    while (working_ < threads_) {
      std::this_thread::sleep_for(kTick);
      try {
        report();
      } catch (...) {
        fail(std::current_exception());
      }
    }
    for (std::thread& thread : threads) thread.join();
    if (error_) std::rethrow_exception(error_);
  }

 private:
  struct Stop {};

  void take_jobs() {
    for (std::size_t k; (k = next_++) < jobs_.size() && !stop_;) {
      try {
        jobs_[k].run(jobs_[k], [&, k](double share) {
          if (stop_) throw Stop{};
          done_[k] = share;
        });
        done_[k] = 1.0;
      } catch (const Stop&) {
      } catch (...) {
        fail(std::current_exception());
      }
    }
    ++working_;
  }
  void fail(std::exception_ptr error) {
    const std::lock_guard lock(mutex_);
    if (!error_) error_ = error;
    stop_ = true;
  }
  void report() {
    if (!progress_ || stop_) return;
    double sum = 0.0;
    for (std::size_t k = 0; k < jobs_.size(); ++k) sum += jobs_[k].work() * done_[k];
    progress_("soil tests", sum / total_);
  }

  const std::vector<Job>& jobs_;
  std::vector<std::atomic<double>> done_;
  const ProgressCall& progress_;
  double total_ = 0.0;
  int threads_ = 1;
  std::atomic<std::size_t> next_{0};
  std::atomic<int> working_{0};  // threads that have ended
  std::atomic<bool> stop_{false};
  std::mutex mutex_;
  std::exception_ptr error_;
};

SpecimenFacts facts(const Specimen& s) {
  SpecimenFacts f{s.options().seed, s.grains(), s.length(), s.width(), s.height(), s.step()};
  f.bulk_density = s.weight() / (s.options().gravity.norm() * s.length() * s.width() * s.height());
  f.solid_fraction = f.bulk_density / s.options().density;
  f.settled = s.settled();
  f.periodic_x = s.options().periodic_x, f.periodic_y = s.options().periodic_y();
  return f;
}

double grains_in(const Box& box, const dem::DemOptions& material) {
  if (box.own) return static_cast<double>(estimate_dem_terrain(material).grains);
  return 0.12 * box.length * box.width * box.depth / dem::mean_volume_ratio(material);
}

/// The box with as many layers as a bed of its depth needs, by the packing of a narrow one that is settled first.
Box to_depth(const dem::DemOptions& material, Box box, std::uint64_t seed, const WorkCall& work) {
  Box narrow = box;
  narrow.length = std::min(box.length, kNarrow), narrow.width = std::min(box.width, kNarrow);
  const Specimen column(material, narrow, seed, [&](double) { work(0.0); });
  const double r = material.radius;
  const double bulk = column.length() * column.width() * column.height() / static_cast<double>(column.grains());  // m³
  dem::DemOptions wide = column.options();
  wide.length = box.length * r, wide.width = box.width * r;
  const double each = static_cast<double>(estimate_dem_terrain(wide).grains) / wide.layers;  // grains of a layer
  box.layers = std::max(1, static_cast<int>(std::lround(box.depth * r * wide.length * wide.width / (bulk * each))));
  return box;
}

/// Makes the list of jobs; each writes to places of its own.
class Planner {
 public:
  Planner(const SoilOptions& options, const SoilPlan& plan, SoilResults& results) : o_(options), grains_(o_.material) {
    grains_.threads = 1;
    dem::DemOptions dry = grains_;
    dry.cohesion = 0.0;
    double shear_way = 0.0, face_way = 0.0, cone_way = 0.0;
    for (const ShearTest& test : plan.shears) shear_way += 1.6 * test.travel;
    for (const ShearTest& test : plan.faces) face_way += 1.2 * test.travel;
    for (const ConeTest& test : plan.cones) cone_way += 1.9 * test.diameter + test.depth + 2.0;
    results.plate.resize(plan.plate_beds.size());
    for (int s = 0; s < o_.seeds; ++s) {
      if (o_.cone)
        add(s, {grains_, plan.cone_box, plan.exact_cone_depth}, plan.cones, steps_for(cone_way), cone_penetration,
            results.cone);
      for (std::size_t k = 0; o_.plate && k < plan.plate_beds.size(); ++k) {
        const PlateBed& bed = plan.plate_beds[k];
        double way = 0.0;
        for (const PlateTest& test : bed.plates) way += test.sinkage + 1.0;
        add(s, {grains_, bed.box, bed.exact}, bed.plates, steps_for(way), plate_sinkage, results.plate[k]);
      }
      if (o_.shear) add(s, {grains_, plan.shear_box}, plan.shears, steps_for(shear_way), direct_shear, results.shear);
      if (o_.interface) add(s, {grains_, plan.shear_box}, plan.faces, steps_for(face_way), direct_shear, results.faces);
      if (!o_.repose) continue;
      add(s, {grains_, plan.repose_box}, {&plan.repose, 1}, kReposeSteps, angle_of_repose, results.repose);
      if (o_.material.cohesion > 0.0)
        add(s, {dry, plan.repose_box}, {&plan.repose, 1}, kReposeSteps, angle_of_repose, results.dry);
    }
    // Threads that have no job of their own help with the others.
    if (!jobs.empty()) grains_.threads = std::max(1, o_.threads / static_cast<int>(jobs.size()));
    // The longest first, so that no thread is left with one at the end.
    std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.work() > b.work(); });
  }

  std::vector<Job> jobs;
  double most_grains = 0.0;  // of a bed, about

 private:
  struct Bed {
    dem::DemOptions material;
    Box box;
    bool exact = false;
  };
  /// Steps for a way of `radii` at the test's speed.
  double steps_for(double radii) const { return radii / o_.speed / kReferenceStep; }
  /// One bed, on which all of these tests are run one after another.
  template <class Test, class Result>
  void add(int s, const Bed& bed, std::type_identity_t<std::span<const Test>> tests, double test_steps,
           Result (*run)(const Specimen&, const Test&, const WorkCall&), std::vector<Tested<Result>>& to) {
    to.resize(o_.seeds * tests.size());
    const auto go = [=, this, &to](const Job& job, const WorkCall& call) {
      const std::uint64_t seed = o_.material.seed + static_cast<std::uint64_t>(s);
      dem::DemOptions material = bed.material;
      material.threads = grains_.threads;
      const WorkCall settling = job.settle_call(call);
      const Specimen specimen(material, bed.exact ? to_depth(material, bed.box, seed, settling) : bed.box, seed,
                              settling);
      const auto count = static_cast<double>(tests.size());
      for (std::size_t k = 0; k < tests.size(); ++k) {
        const WorkCall mine = job.test_call(call, static_cast<double>(k) / count, (k + 1.0) / count);
        to[s * tests.size() + k] = {facts(specimen), run(specimen, tests[k], mine)};
      }
    };
    const double grains = grains_in(bed.box, bed.material);
    most_grains = std::max(most_grains, grains);
    jobs.push_back({kSettleSteps * grains, test_steps * grains, go});
  }

  const SoilOptions& o_;
  dem::DemOptions grains_;
};

/// The part of a curve that is fitted.
PlateCurve from_sinkage(const PlateCurve& curve, double least) {
  PlateCurve part;
  part.width = curve.width;
  for (std::size_t k = 0; k < curve.sinkage.size(); ++k) {
    if (curve.sinkage[k] < least) continue;
    part.sinkage.push_back(curve.sinkage[k]);
    part.pressure.push_back(curve.pressure[k]);
  }
  return part;
}

VolumeShares shares_of(const std::vector<VolumeAccount>& accounts) {
  if (accounts.empty()) return {};
  const auto mean = [&](const auto& value) {
    std::vector<double> shares;
    for (const VolumeAccount& a : accounts) shares.push_back(value(a) / a.displaced);
    return mean_of(shares);
  };
  return {mean([](const VolumeAccount& a) { return a.heaved; }),
          mean([](const VolumeAccount& a) { return a.compacted; }),
          mean([](const VolumeAccount& a) { return a.residual(); })};
}

/// Means over the seeds, with the values of one fit to all curves: k and n go together.
PlateParameters parameters_of_plate(std::span<const Tested<PlateResult>> tests, std::size_t each, double from) {
  PlateParameters p;
  std::vector<double> k, n;
  std::vector<VolumeAccount> loaded, unloaded;
  std::vector<PlateCurve> all;
  for (std::size_t at = 0; at < tests.size(); at += each) {
    const PlateResult& r = tests[at].result;
    all.push_back(from_sinkage(r.curve, from));
    const PowerFit fit = fit_power({&all.back(), 1});
    k.push_back(fit.k), n.push_back(fit.n);
    loaded.push_back(r.volume);
    if (r.unloaded.displaced > 0.0) unloaded.push_back(r.unloaded);
  }
  const PowerFit fit = fit_power(all);
  p.k = mean_of(k), p.n = mean_of(n);
  p.k.value = fit.k, p.n.value = fit.n;
  p.loaded = shares_of(loaded), p.unloaded = shares_of(unloaded);
  return p;
}

BedParameters parameters_of_bed(std::span<const Tested<PlateResult>> tests, std::size_t each, double from) {
  BedParameters p;
  std::vector<PlateCurve> all;
  for (const auto& tested : tests) all.push_back(from_sinkage(tested.result.curve, from));
  const auto other = [&](const PlateCurve& curve) { return curve.width != all.front().width; };
  if (std::none_of(all.begin(), all.end(), other)) return p;
  std::vector<double> k_c, k_phi, n;
  for (std::size_t at = 0; at + each <= all.size(); at += each) {
    const BekkerFit fit = fit_bekker(std::span(all).subspan(at, each));
    k_c.push_back(fit.k_c), k_phi.push_back(fit.k_phi), n.push_back(fit.n);
  }
  const BekkerFit fit = fit_bekker(all);
  p.k_c = mean_of(k_c), p.k_phi = mean_of(k_phi), p.n = mean_of(n);
  // k and n go together: the values are those of one fit to all curves, the errors those between seeds.
  p.k_c.value = fit.k_c, p.k_phi.value = fit.k_phi, p.n.value = fit.n;
  p.goodness = fit.goodness;
  return p;
}

void plate_parameters(const SoilResults& results, const SoilPlan& plan, double radius, SoilParameters& p) {
  const double from = plan.plate_from * radius;
  for (std::size_t bed = 0; bed < results.plate.size(); ++bed) {
    const std::span<const Tested<PlateResult>> tests = results.plate[bed];
    const std::size_t each = plan.plate_beds[bed].plates.size();
    if (tests.empty()) return;
    for (std::size_t k = 0; k < each; ++k) {
      p.plates.push_back(parameters_of_plate(tests.subspan(k), each, from));
      p.plates.back().bed = bed, p.plates.back().plate = k;
    }
    p.beds.push_back(parameters_of_bed(tests, each, from));
  }
  if (p.beds.empty()) return;
  const BedParameters& bed = p.beds[plan.deepest()];
  p.k_c = bed.k_c, p.k_phi = bed.k_phi, p.n = bed.n, p.bekker_goodness = bed.goodness;
}

void cone_parameters(const SoilResults& results, const SoilPlan& plan, SoilParameters& p) {
  const std::size_t each = plan.cones.size();
  for (std::size_t k = 0; k < each && k < results.cone.size(); ++k) {
    std::vector<double> index, mean, gradient;
    for (std::size_t at = k; at < results.cone.size(); at += each) {
      const ConeResult& r = results.cone[at].result;
      index.push_back(r.index), mean.push_back(r.mean), gradient.push_back(r.gradient);
    }
    p.cones.push_back({mean_of(index), mean_of(mean), mean_of(gradient)});
  }
  if (!p.cones.empty()) p.cone_index = p.cones.front().index;
}

void shear_parameters(const SoilResults& results, SoilParameters& p) {
  if (results.shear.empty()) return;
  std::vector<double> normal, most, final, K;
  for (const auto& tested : results.shear) {
    const ShearResult& r = tested.result;
    normal.push_back(r.normal_mean);
    most.push_back(r.janosi.tau_max);
    final.push_back(r.final_shear);
    K.push_back(r.janosi.K);
  }
  const CoulombFit fit = fit_coulomb(normal, most), late = fit_coulomb(normal, final);
  p.cohesion = fit.cohesion, p.phi = fit.phi, p.coulomb_goodness = fit.goodness;
  p.final_cohesion = late.cohesion, p.final_phi = late.phi;
  p.phi_alone = fit_friction(normal, most);
  p.K = mean_of(K);
}

void face_parameters(const SoilResults& results, SoilParameters& p) {
  for (const Face face : {Face::flat, Face::glued}) {
    std::vector<double> normal, final, K, roll, sliding;
    for (const auto& [specimen, r] : results.faces) {
      if (r.face != face) continue;
      normal.push_back(r.normal_mean), final.push_back(r.final_shear), K.push_back(r.janosi.K);
      roll.push_back(r.roll), sliding.push_back(r.sliding);
    }
    if (normal.empty()) continue;
    const CoulombFit fit = fit_coulomb(normal, final);
    p.interfaces.push_back({.face = face,
                            .delta = fit.phi,
                            .adhesion = fit.cohesion,
                            .delta_alone = fit_friction(normal, final),
                            .K = mean_of(K),
                            .roll = mean_of(roll),
                            .sliding = mean_of(sliding)});
  }
}

}  // namespace

std::size_t SoilPlan::deepest() const {
  const auto shallower = [](const PlateBed& a, const PlateBed& b) { return a.box.depth < b.box.depth; };
  return std::max_element(plate_beds.begin(), plate_beds.end(), shallower) - plate_beds.begin();
}

PlateTest plate_test(const SoilOptions& o, double size, bool disc, double sinkage) {
  const double r = o.material.radius;
  return {.width = size / r,
          .sinkage = sinkage / r,
          .speed = o.speed,
          .samples = kMetreSamples,
          .disc = disc,
          .unload = true};
}

PlateBed plate_bed(const SoilOptions& o, const std::vector<PlateTest>& plates, double depth) {
  PlateBed bed{.plates = plates, .exact = true};
  const double r = o.material.radius;
  double widest = 0.0;
  bool discs = false;
  for (const PlateTest& plate : plates) widest = std::max(widest, plate.width), discs |= plate.disc;
  const double length = o.bed_width > 0.0 ? o.bed_width / r : kWidths * widest;
  bed.box = {length, discs ? length : kStripLength, depth / r};
  bed.box.own = o.own_bed;
  return bed;
}

namespace {

/// Periodic boxes: grains must not meet their own images, so three cells of the neighbour search between their sides.
void widen(const SoilOptions& o, Box& box) {
  const double least = 6.0001 * (dem::largest_radius(o.material) / o.material.radius + dem::kSkinShare);
  if (box.periodic_x) box.length = std::max(box.length, least);
  if (box.periodic_y) box.width = std::max(box.width, least);
}

void plan_plates(const SoilOptions& o, SoilPlan& plan) {
  if (o.discs.empty() && o.strips.empty()) {
    PlateBed bed;
    if (o.quick) bed.box = {40.0, 8.0, 16.0};
    for (const double width : o.quick ? std::vector{5.0, 10.0} : std::vector{10.0, 20.0}) {
      PlateTest test;
      test.width = width;
      test.speed = o.speed;
      if (o.quick) test.sinkage = 4.0, test.samples = 50;
      bed.plates.push_back(test);
    }
    plan.plate_beds = {bed};
    return;
  }
  double least = 1e300, most = 0.0;  // m
  for (const auto* sizes : {&o.discs, &o.strips})
    for (const double size : *sizes) least = std::min(least, size), most = std::max(most, size);
  const double sinkage = o.sinkage > 0.0 ? o.sinkage : kSinkage * least;
  std::vector<PlateTest> plates;
  for (const double width : o.strips) plates.push_back(plate_test(o, width, false, sinkage));
  for (const double diameter : o.discs) plates.push_back(plate_test(o, diameter, true, sinkage));
  for (const double depth : o.own_bed || o.depths.empty() ? std::vector{kDepths * most} : o.depths)
    plan.plate_beds.push_back(plate_bed(o, plates, depth));
  plan.plate_from = 2.0;
}

/// Cones that are read between the same depths, as pressure grows with depth.
void plan_cones(const SoilOptions& o, SoilPlan& plan) {
  const double r = o.material.radius;
  const auto add = [&](double diameter) {
    ConeTest test{.diameter = diameter, .speed = o.speed};
    if (o.quick) test.samples = 50;
    if (!o.cones.empty() || o.own_bed) test.depth = test.index_to = kConeDepth / r, test.index_from = 0.0;
    plan.cones.push_back(test);
  };
  double widest = 0.0;  // m
  for (const double diameter : o.cones) add(diameter / r), widest = std::max(widest, diameter);
  plan.cone_box.own = o.own_bed;
  if (o.cones.empty()) {
    for (const double diameter : o.quick ? std::vector{4.0, 3.0, 5.0} : std::vector{6.0, 4.5, 8.0}) add(diameter);
    return;
  }
  const double width = std::max(o.bed_width > 0.0 ? o.bed_width / r : kConeWidths * widest / r, kLeastConeWidth);
  const double room = cone_height(widest, kConeAngle) + widest;  // m, below the base of the deepest
  const double depth =
      o.depths.empty() ? kConeDepth + 1.05 * room : *std::max_element(o.depths.begin(), o.depths.end());
  plan.cone_box.length = plan.cone_box.width = width, plan.cone_box.depth = depth / r;
  plan.exact_cone_depth = true;
}

}  // namespace

SoilPlan soil_plan(const SoilOptions& o) {
  SoilPlan plan;
  if (o.quick) {
    plan.shear_box = {18.0, 8.0, 10.0};
    plan.cone_box = {20.0, 20.0, 26.0};
    plan.repose_box = {60.0, 8.0, 16.0, false, true};
    plan.repose.cut = 20.0;
  }
  plan_plates(o, plan);
  plan_cones(o, plan);
  for (Box* box : {&plan.shear_box, &plan.cone_box, &plan.repose_box}) widen(o, *box);
  for (PlateBed& bed : plan.plate_beds) widen(o, bed.box);
  const double hardest = std::min(100e3, dem::grain_modulus(o.material) / 200.0);
  const std::vector<double> chosen{0.2 * hardest, 0.5 * hardest, hardest};
  for (const double stress : o.stresses.empty() ? chosen : o.stresses) {
    ShearTest test;
    test.normal_stress = stress;
    test.speed = o.speed;
    if (o.quick) test.travel = 4.0, test.samples = 50;
    plan.shears.push_back(test);
  }
  for (const Face face : {Face::flat, Face::glued})
    for (const double stress : o.stresses.empty() ? std::vector{2e3, 5e3, 10e3, 20e3} : o.stresses) {
      ShearTest test{.normal_stress = stress, .travel = 40.0, .speed = o.speed, .face = face};
      test.friction = o.face_friction;
      if (o.quick) test.travel = 8.0, test.samples = 50;
      plan.faces.push_back(test);
    }
  return plan;
}

SoilWork soil_work(const SoilOptions& options, const SoilPlan& plan) {
  SoilResults results;
  const Planner planner(options, plan, results);
  SoilWork work{planner.most_grains, 0.0};
  for (const Job& job : planner.jobs) work.grain_steps += job.work();
  return work;
}

SoilResults run_soil_tests(const SoilOptions& options, const SoilPlan& plan, const ProgressCall& progress) {
  SoilResults results;
  const Planner planner(options, plan, results);
  if (!planner.jobs.empty()) JobPool(planner.jobs, options.threads, progress).run();
  return results;
}

SoilParameters soil_parameters(const SoilResults& results, const SoilPlan& plan, double radius) {
  SoilParameters p;
  plate_parameters(results, plan, radius, p);
  shear_parameters(results, p);
  face_parameters(results, p);
  const auto mean_over = [](const auto& tests, const auto& value) {
    std::vector<double> values;
    for (const auto& tested : tests) values.push_back(value(tested.result));
    return values.empty() ? Measured{} : mean_of(values);
  };
  cone_parameters(results, plan, p);
  p.repose = mean_over(results.repose, [](const ReposeResult& r) { return r.angle; });
  p.repose_dry = mean_over(results.dry, [](const ReposeResult& r) { return r.angle; });
  return p;
}

}  // namespace furrow::terrain::soil
