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
#include "terrain/dem/dem_terrain.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSettleSteps = 12e3;  // typical number of steps until a bed has settled
constexpr double kReposeSteps = 30e3;
constexpr double kNarrow = 36.0;                        // sides of the box that gives the depth of a bed, radii
constexpr auto kTick = std::chrono::milliseconds(100);  // between progress reports
constexpr double kReferenceStep = 6e-3;                 // s per m of grain radius, for estimates of the work

/// One bed and the tests on it.
struct Job {
  double settling = 0.0, testing = 0.0;  // estimated work, grain-steps
  std::function<void(const Job&, const WorkCall&)> run;
  double work() const { return settling + testing; }
  /// Progress of settling; test_call gives that of the part [from, to] of the tests that follow.
  WorkCall settle_call(const WorkCall& call) const {
    const double share = settling / work();
    return [=](double done) { call(share * done); };
  }
  WorkCall test_call(const WorkCall& call, double from, double to) const {
    const double share = settling / work();
    return [=](double done) { call(share + (1.0 - share) * (from + (to - from) * done)); };
  }
};

/// Runs jobs on a few threads; the calling thread reports progress.
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
      threads_ = static_cast<int>(threads.size());  // continue with those that the system grants
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

/// The box with as many layers as a bed of its depth needs, from the packing of a narrow bed that is settled first.
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

/// Makes the list of jobs; each job writes its own results.
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
    // Threads without a job of their own help with the others.
    if (!jobs.empty()) grains_.threads = std::max(1, o_.threads / static_cast<int>(jobs.size()));
    // The longest job comes first, so that no thread starts one at the end.
    std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.work() > b.work(); });
  }

  std::vector<Job> jobs;
  double most_grains = 0.0;  // of a bed, approximately

 private:
  struct Bed {
    dem::DemOptions material;
    Box box;
    bool exact = false;
  };
  /// Number of steps for a path of `radii` at the test's speed.
  double steps_for(double radii) const { return radii / o_.speed / kReferenceStep; }
  /// Adds a job: one bed on which all of these tests run one after another.
  template <class Test, class Result>
  void add(int s, const Bed& bed, std::type_identity_t<std::span<const Test>> tests, double test_steps,
           Result (*run)(const Specimen&, const Test&, const WorkCall&), std::vector<Tested<Result>>& to) {
    to.resize(o_.seeds * tests.size());
    const double grains = grains_in(bed.box, bed.material);
    most_grains = std::max(most_grains, grains);
    const auto go = [=, this, &to](const Job& job, const WorkCall& call) {
      const std::uint64_t seed = o_.material.seed + static_cast<std::uint64_t>(s);
      dem::DemOptions material = bed.material;
      material.threads = useful_threads(grains_.threads, grains);
      const WorkCall settling = job.settle_call(call);
      const Specimen specimen(material, bed.exact ? to_depth(material, bed.box, seed, settling) : bed.box, seed,
                              settling);
      const auto count = static_cast<double>(tests.size());
      for (std::size_t k = 0; k < tests.size(); ++k) {
        const WorkCall mine = job.test_call(call, static_cast<double>(k) / count, (k + 1.0) / count);
        to[s * tests.size() + k] = {facts(specimen), run(specimen, tests[k], mine)};
      }
    };
    jobs.push_back({kSettleSteps * grains, test_steps * grains, go});
  }

  const SoilOptions& o_;
  dem::DemOptions grains_;
};

}  // namespace

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

}  // namespace furrow::terrain::soil
