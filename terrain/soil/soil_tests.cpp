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
#include "terrain/dem/grain_sizes.hpp"
#include "terrain/dem/solver_setup.hpp"

namespace furrow::terrain::soil {
namespace {

constexpr double kSettleSteps = 12e3;  // that a bed takes to settle, about
constexpr double kReposeSteps = 30e3;
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
  return f;
}

double grains_in(const Box& box) { return 0.12 * box.length * box.width * box.depth; }

/// Makes the list of jobs; each writes to places of its own.
class Planner {
 public:
  Planner(const SoilOptions& options, const SoilPlan& plan, SoilResults& results) : o_(options) {
    dem::DemOptions dry = o_.material;
    dry.cohesion = 0.0;
    double plate_way = 0.0, shear_way = 0.0, face_way = 0.0;
    for (const PlateTest& test : plan.plates) plate_way += test.sinkage + 1.0;
    for (const ShearTest& test : plan.shears) shear_way += 1.6 * test.travel;
    for (const ShearTest& test : plan.faces) face_way += 1.2 * test.travel;
    const double cone_way = 1.9 * plan.cone.diameter + plan.cone.depth + 2.0;
    for (int s = 0; s < o_.seeds; ++s) {
      if (o_.cone)
        add(s, o_.material, plan.cone_box, {&plan.cone, 1}, steps_for(cone_way), cone_penetration, results.cone);
      if (o_.plate)
        add(s, o_.material, plan.plate_box, plan.plates, steps_for(plate_way), plate_sinkage, results.plate);
      if (o_.shear) add(s, o_.material, plan.shear_box, plan.shears, steps_for(shear_way), direct_shear, results.shear);
      if (o_.interface)
        add(s, o_.material, plan.shear_box, plan.faces, steps_for(face_way), direct_shear, results.faces);
      if (!o_.repose) continue;
      add(s, o_.material, plan.repose_box, {&plan.repose, 1}, kReposeSteps, angle_of_repose, results.repose);
      if (o_.material.cohesion > 0.0)
        add(s, dry, plan.repose_box, {&plan.repose, 1}, kReposeSteps, angle_of_repose, results.dry);
    }
    // The longest first, so that no thread is left with one at the end.
    std::stable_sort(jobs.begin(), jobs.end(), [](const Job& a, const Job& b) { return a.work() > b.work(); });
  }

  std::vector<Job> jobs;

 private:
  /// Steps for a way of `radii` at the test's speed.
  double steps_for(double radii) const { return radii / o_.speed / kReferenceStep; }
  /// One bed, on which all of these tests are run one after another.
  template <class Test, class Result>
  void add(int s, const dem::DemOptions& material, const Box& box, std::type_identity_t<std::span<const Test>> tests,
           double test_steps, Result (*run)(const Specimen&, const Test&, const WorkCall&),
           std::vector<Tested<Result>>& to) {
    to.resize(o_.seeds * tests.size());
    const auto go = [=, this, &box, &to](const Job& job, const WorkCall& call) {
      const std::uint64_t seed = o_.material.seed + static_cast<std::uint64_t>(s);
      const Specimen specimen(material, box, seed, job.settle_call(call));
      const auto count = static_cast<double>(tests.size());
      for (std::size_t k = 0; k < tests.size(); ++k) {
        const WorkCall mine = job.test_call(call, static_cast<double>(k) / count, (k + 1.0) / count);
        to[s * tests.size() + k] = {facts(specimen), run(specimen, tests[k], mine)};
      }
    };
    jobs.push_back({kSettleSteps * grains_in(box), test_steps * grains_in(box), go});
  }

  const SoilOptions& o_;
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

void plate_parameters(const SoilResults& results, const SoilPlan& plan, double radius, SoilParameters& p) {
  std::vector<PlateCurve> all;
  for (const auto& tested : results.plate) all.push_back(from_sinkage(tested.result.curve, plan.plate_from * radius));
  if (all.empty()) return;
  std::vector<double> k_c, k_phi, n;
  const std::size_t each = plan.plates.size();
  for (std::size_t from = 0; from + each <= all.size(); from += each) {
    const BekkerFit fit = fit_bekker(std::span(all).subspan(from, each));
    k_c.push_back(fit.k_c), k_phi.push_back(fit.k_phi), n.push_back(fit.n);
  }
  const BekkerFit fit = fit_bekker(all);
  p.k_c = mean_of(k_c), p.k_phi = mean_of(k_phi), p.n = mean_of(n);
  // k and n go together: the values are those of one fit to all curves, the errors those between seeds.
  p.k_c.value = fit.k_c, p.k_phi.value = fit.k_phi, p.n.value = fit.n;
  p.bekker_goodness = fit.goodness;
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

SoilPlan soil_plan(const SoilOptions& o) {
  SoilPlan plan;
  if (o.quick) {
    plan.plate_box = {40.0, 8.0, 16.0};
    plan.shear_box = {18.0, 8.0, 10.0};
    plan.cone_box = {20.0, 20.0, 26.0};
    plan.repose_box = {60.0, 8.0, 16.0, false, true};
    plan.cone.diameter = 4.0;  // at the depths of the whole test: pressure grows with depth
    plan.repose.cut = 20.0;
  }
  // Grains must not meet their own images: three cells of the neighbour search between periodic sides.
  const double least = 6.0001 * (dem::largest_radius(o.material) / o.material.radius + dem::kSkinShare);
  for (Box* box : {&plan.plate_box, &plan.shear_box, &plan.cone_box, &plan.repose_box}) {
    if (box->periodic_x) box->length = std::max(box->length, least);
    if (box->periodic_y) box->width = std::max(box->width, least);
  }
  for (const double width : o.quick ? std::vector{5.0, 10.0} : std::vector{10.0, 20.0}) {
    PlateTest test;
    test.width = width;
    test.speed = o.speed;
    if (o.quick) test.sinkage = 4.0, test.samples = 50;
    plan.plates.push_back(test);
  }
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
  plan.cone.speed = o.speed;
  if (o.quick) plan.cone.samples = 50;
  return plan;
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
  p.cone_index = mean_over(results.cone, [](const ConeResult& r) { return r.index; });
  p.repose = mean_over(results.repose, [](const ReposeResult& r) { return r.angle; });
  p.repose_dry = mean_over(results.dry, [](const ReposeResult& r) { return r.angle; });
  return p;
}

}  // namespace furrow::terrain::soil
