#include "terrain/soil/soil_output.hpp"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "protocol/core/constants.hpp"
#include "protocol/files/fields_json.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::soil {
namespace {

using Json = nlohmann::ordered_json;

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(nullptr); }

constexpr double kBrixiusDepth = 0.15;           // depth down to which the mean cone index is taken, m
constexpr double kLeastFreedom = 2.0;            // of an interval: with one it is wider than prior knowledge
constexpr double kWidestAngle = 10.0 * kDegree;  // largest half interval of a useful angle, rad
constexpr char kQuickWarning[] =
    "a quick look: one bed in small boxes, with a bias that is larger than its scatter; not to be quoted";

/// Why there is no standard error, or no interval; empty if there is one.
std::string no_error_because(const Measured& m, bool quick) {
  if (m.samples == 0) return "not tested";
  if (quick) return kQuickWarning;
  return std::isfinite(m.standard_error) ? "" : "one bed alone: nothing to compare it with; take more --seeds";
}
std::string no_interval_because(const Measured& m, bool quick, bool angle) {
  if (const std::string why = no_error_because(m, quick); !why.empty()) return why;
  if (m.freedom < kLeastFreedom) return "two values alone; take more --seeds";
  if (angle && m.half_interval() > kWidestAngle) return "wider than 10° to either side; take more --seeds";
  return "";
}

/// Writes the parameters: values at the top level, and errors, or the reason for none, under the same names.
class Parameters {
 public:
  Parameters(Json& target, bool quick) : target_(target), quick_(quick) {}
  void add(const char* name, const Measured& m, double unit = 1.0) {
    target_[name] = m.samples > 0 ? number(m.value / unit) : Json(nullptr);
    samples_[name] = m.samples;
    error_[name] = interval_[name] = nullptr;
    if (no_error_because(m, quick_).empty()) error_[name] = number(m.standard_error / unit);
    const std::string why = no_interval_because(m, quick_, unit == kDegree);
    const double half = m.half_interval();
    if (why.empty())
      interval_[name] = {number((m.value - half) / unit), number((m.value + half) / unit)};
    else
      because_[name] = why;
  }
  void finish() {
    target_["standard_error"] = error_;
    target_["interval_95"] = interval_;
    target_["no_interval_because"] = because_;
    target_["samples"] = samples_;
  }

 private:
  Json& target_;
  bool quick_;
  Json error_, interval_, samples_, because_ = Json::object();
};

Json box_json(const SpecimenFacts& s, const Box& box) {
  const std::string periodic = std::string(s.periodic_x ? "x" : "") + (s.periodic_y ? "y" : "");
  return {{"length_m", s.length},
          {"width_m", s.width},
          {"height_m", s.height},
          {"grains", s.grains},
          {"solid_fraction", s.solid_fraction},
          {"bulk_density_kg_m3", s.bulk_density},
          {"own_bed", box.own},
          {"periodic", periodic.empty() ? "none" : periodic},
          {"step_s", s.step}};
}

template <class Tests>
bool all_settled(const Tests& tests) {
  for (const auto& t : tests)
    if (!t.specimen.settled) return false;
  return true;
}

const char* shape_name(const PlateTest& test) { return test.disc ? "disc" : "strip"; }

Json volume_json(const VolumeAccount& volume) {
  return {{"displaced_m3", volume.displaced},
          {"heaved_m3", volume.heaved},
          {"compacted_m3", volume.compacted},
          {"volume_residual_m3", volume.residual()},
          {"solid_fraction_below_before", volume.solid_before},
          {"solid_fraction_below_after", volume.solid_after}};
}

/// p = k zⁿ of each plate, and the volume account of the soil.
Json each_plate_json(const SoilRun& run, const SoilParameters& p) {
  const double r = run.options.material.radius;
  Json list = Json::array();
  for (const PlateParameters& of : p.plates) {
    const PlateTest& test = run.plan.plate_beds[of.bed].plates[of.plate];
    Json plate = {{"shape", shape_name(test)},
                  {"size_m", test.width * r},
                  {"b_m", (test.disc ? 0.5 : 1.0) * test.width * r},
                  {"bed", of.bed}};
    Parameters parameters(plate, run.options.quick);
    parameters.add("k", of.k);
    parameters.add("n", of.n);
    parameters.add("heaved_share", of.loaded.heaved);
    parameters.add("compacted_share", of.loaded.compacted);
    parameters.add("volume_residual_share", of.loaded.residual);
    parameters.add("unloaded_heaved_share", of.unloaded.heaved);
    parameters.add("unloaded_compacted_share", of.unloaded.compacted);
    parameters.add("unloaded_volume_residual_share", of.unloaded.residual);
    parameters.finish();
    const auto& tests = run.results.plate[of.bed];
    for (std::size_t at = of.plate; at < tests.size(); at += run.plan.plate_beds[of.bed].plates.size()) {
      const PlateResult& result = tests[at].result;
      Json one = {{"seed", tests[at].specimen.seed}, {"bed_depth_m", tests[at].specimen.height}};
      one.update(volume_json(result.volume));
      one["floor_force_error"] = number(result.balance_error);
      one["unloaded"] = test.unload ? volume_json(result.unloaded) : Json(nullptr);
      if (test.unload) one["unloaded"]["rebound_m"] = result.rebound;
      plate["tests"].push_back(one);
    }
    list.push_back(plate);
  }
  return list;
}

Json plate_json(const SoilRun& run, const SoilParameters& p) {
  const double r = run.options.material.radius;
  const PlateTest& test = run.plan.plate_beds.front().plates.front();
  Json j = {{"what", run.plan.plate_beds.front().exact
                         ? "rigid rough plates in metres pushed in at constant speed; b of a disc is its radius"
                         : "rigid rough strip pushed in at constant speed; plane strain"},
            {"box", box_json(run.results.plate.front().front().specimen, run.plan.plate_beds.front().box)},
            {"beds_settled", true},
            {"speed_m_s", test.speed},
            {"sinkage_m", test.sinkage * r},
            {"fitted_from_m", run.plan.plate_from * r},
            {"r_squared", p.bekker_goodness}};
  double worst = 0.0;
  for (std::size_t bed = 0; bed < run.results.plate.size(); ++bed) {
    const auto& tests = run.results.plate[bed];
    if (!all_settled(tests)) j["beds_settled"] = false;
    for (const auto& t : tests) worst = t.result.balance_error < worst ? worst : t.result.balance_error;  // NaN stays
    Json one = {{"box", box_json(tests.front().specimen, run.plan.plate_beds[bed].box)},
                {"r_squared", p.beds[bed].k_c.samples > 0 ? Json(p.beds[bed].goodness) : Json(nullptr)}};
    Parameters parameters(one, run.options.quick);
    parameters.add("k_c", p.beds[bed].k_c);
    parameters.add("k_phi", p.beds[bed].k_phi);
    parameters.add("n", p.beds[bed].n);
    parameters.finish();
    j["beds"].push_back(one);
  }
  for (const PlateTest& plate : run.plan.plate_beds.front().plates) j["widths_m"].push_back(plate.width * r);
  j["plates"] = each_plate_json(run, p);
  j["floor_force_error"] = number(worst);
  return j;
}

/// The first entries of the tests in the shear cell.
template <class Tests>
Json cell_json(const char* what, const SoilRun& run, const Tests& tests, const ShearTest& test) {
  return {{"what", what},
          {"box", box_json(tests.front().specimen, run.plan.shear_box)},
          {"beds_settled", all_settled(tests)},
          {"speed_m_s", test.speed},
          {"travel_m", test.travel * run.options.material.radius}};
}

Json shear_json(const SoilRun& run, double goodness) {
  const auto& tests = run.results.shear;
  const double r = run.options.material.radius;
  const ShearTest& test = run.plan.shears.front();
  Json j = cell_json(
      "two toothed plates in a cell periodic along and across; lid under constant load, moved at constant speed", run,
      tests, test);
  j["tooth_m"] = test.tooth * r;
  j["tooth_pitch_m"] = test.pitch * r;
  j["r_squared"] = goodness;
  double floor = 0.0, shear = 0.0;
  for (const auto& t : tests) {
    floor = std::max(floor, t.result.floor_error), shear = std::max(shear, t.result.shear_error);
    const double density = run.options.material.density;
    // I = γ̇ d √(ρ/p)
    const double rate = test.speed / t.result.height;
    j["tests"].push_back(
        {{"seed", t.specimen.seed},
         {"normal_stress_Pa", t.result.normal_mean},
         {"tau_max_Pa", t.result.janosi.tau_max},
         {"secant_friction_angle_deg", std::atan(t.result.janosi.tau_max / t.result.normal_mean) / kDegree},
         {"janosi_K_m", t.result.janosi.K},
         {"r_squared", t.result.janosi.goodness},
         {"final_shear_stress_Pa", t.result.final_shear},
         {"height_m", t.result.height},
         {"rise_m", t.result.rise.back()},
         {"inertial_number", rate * 2.0 * r * std::sqrt(density / t.result.normal_mean)}});
  }
  j["floor_force_error"] = floor;
  j["shear_force_error"] = shear;
  return j;
}

Json interface_json(const SoilRun& run, const SoilParameters& p) {
  const auto& tests = run.results.faces;
  const ShearTest& test = run.plan.faces.front();
  Json j = cell_json(
      "grains sheared along a flat plate and along one with half-grains glued to it, in the cell of the shear test; "
      "stresses at the end of the travel",
      run, tests, test);
  j["friction"] = test.friction >= 0.0 ? test.friction : run.options.material.friction;
  for (const Interface& of : p.interfaces) {
    Json face = {{"face", face_name(of.face)}};
    Parameters parameters(face, run.options.quick);
    parameters.add("friction_angle_deg", of.delta, kDegree);
    parameters.add("adhesion_Pa", of.adhesion);
    parameters.add("friction_angle_without_adhesion_deg", of.delta_alone, kDegree);
    parameters.add("janosi_K_m", of.K);
    parameters.add("roll", of.roll);
    parameters.add("sliding_share", of.sliding);
    parameters.finish();
    j["faces"].push_back(face);
  }
  for (const auto& [specimen, t] : tests)
    j["tests"].push_back({{"seed", specimen.seed},
                          {"face", face_name(t.face)},
                          {"normal_stress_Pa", t.normal_mean},
                          {"final_shear_stress_Pa", t.final_shear},
                          {"tau_max_Pa", t.janosi.tau_max},
                          {"janosi_K_m", t.janosi.K},
                          {"rise_m", t.rise.back()},
                          {"roll", t.roll},
                          {"sliding_share", t.sliding},
                          {"solid_fraction_at_face", t.solid},
                          {"shear_force_error", t.shear_error}});
  return j;
}

/// The lowest and the highest of the cones' values.
Json band(const std::vector<ConeParameters>& cones, Measured ConeParameters::*value) {
  const auto less = [&](const ConeParameters& a, const ConeParameters& b) {
    return (a.*value).value < (b.*value).value;
  };
  const auto [least, most] = std::minmax_element(cones.begin(), cones.end(), less);
  return {number(((*least).*value).value), number(((*most).*value).value)};
}

Json cone_json(const SoilRun& run, const SoilParameters& p) {
  const double r = run.options.material.radius;
  const ConeTest& test = run.plan.cones.front();
  const auto& tests = run.results.cone;
  // The same depth for all cones, so that their values are comparable.
  double reached = tests.front().result.reached;
  for (const auto& t : tests) reached = std::min(reached, t.result.reached);
  Json j = {{"what", "30° cone after ASABE S313.3, base diameter in grains, polished (friction at most 0.3)"},
            {"box", box_json(tests.front().specimen, run.plan.cone_box)},
            {"beds_settled", all_settled(tests)},
            {"speed_m_s", test.speed},
            {"base_diameter_m", test.diameter * r},
            {"base_diameter_grains", 0.5 * test.diameter},
            {"shaft_diameter_m", soil::kConeShaft * test.diameter * r},
            {"index_depth_m", {test.index_from * r, std::min(test.index_to * r, reached)}},
            {"mean_depth_m", {0.0, reached}},
            {"mean_depth_is", reached > 0.999 * kBrixiusDepth
                                  ? "0 to 150 mm"
                                  : "from 0 to where the cones were pushed in this bed, not to 150 mm"}};
  for (std::size_t k = 0; k < p.cones.size(); ++k) {
    Json cone = {{"base_diameter_m", run.plan.cones[k].diameter * r},
                 {"base_diameter_grains", 0.5 * run.plan.cones[k].diameter}};
    Parameters parameters(cone, run.options.quick);
    parameters.add("index_Pa", p.cones[k].index);
    parameters.add("mean_Pa", p.cones[k].mean);
    parameters.add("gradient_Pa_per_m", p.cones[k].gradient);
    parameters.finish();
    j["cones"].push_back(cone);
  }
  j["band"] = {{"index_Pa", band(p.cones, &ConeParameters::index)},
               {"mean_Pa", band(p.cones, &ConeParameters::mean)},
               {"gradient_Pa_per_m", band(p.cones, &ConeParameters::gradient)}};
  return j;
}

Json repose_json(const SoilRun& run) {
  const double r = run.options.material.radius;
  Json j = {{"what", "half of a settled bed taken away at once; slope of the flank that remains, on a rough base"},
            {"box", box_json(run.results.repose.front().specimen, run.plan.repose_box)},
            {"beds_settled", all_settled(run.results.repose) && all_settled(run.results.dry)},
            {"cut_m", run.plan.repose.cut * r},
            {"base_m", run.plan.repose.base * r}};
  const auto list = [&](const auto& tests, bool dry) {
    for (const auto& t : tests)
      j["tests"].push_back({{"seed", t.specimen.seed},
                            {"cohesion_Pa", dry ? 0.0 : run.options.material.cohesion},
                            {"angle_deg", t.result.angle / kDegree},
                            {"cut_height_m", t.result.height},
                            {"slumped", t.result.slumped},
                            {"moved_m2", t.result.moved},
                            {"at_rest", t.result.at_rest},
                            {"time_s", t.result.time}});
  };
  list(run.results.repose, false);
  list(run.results.dry, true);
  return j;
}

/// Adds the keys of engine scm from the plate and the shear tests; skips tests that were not made or give no soil.
void add_empirical(const SoilParameters& p, Json& terrain) {
  if (p.n.samples > 0 && p.k_phi.value > 0.0 && p.n.value > 0.0) {
    terrain["bekker_k_c"] = p.k_c.value;
    terrain["bekker_k_phi"] = p.k_phi.value;
    terrain["bekker_n"] = p.n.value;
  }
  if (p.phi.samples > 0 && p.phi.value >= 0.0 && p.K.value > 0.0) {
    const bool below = p.cohesion.value < 0.0;  // the fitted line begins below 0: that through 0 replaces it
    terrain["mohr_cohesion"] = below ? 0.0 : p.cohesion.value;
    terrain["mohr_friction_angle"] = (below ? p.phi_alone.value : p.phi.value) / kDegree;
    terrain["janosi_k"] = p.K.value;
  }
}

}  // namespace

Json soil_json(const SoilRun& run) {
  const dem::DemOptions& o = run.options.material;
  const SoilParameters p = soil::soil_parameters(run.results, run.plan, o.radius);
  Json j;
  j["format_version"] = 1;
  j["version"] = FURROW_VERSION;
  j["scenario"] = run.scenario;
  j["scenario_digest"] = run.scenario_digest;
  j["quick"] = run.options.quick;
  j["not_to_be_quoted"] = run.options.quick ? Json(kQuickWarning) : Json(nullptr);
  j["seeds"] = run.options.seeds;
  j["first_seed"] = o.seed;
  Parameters parameters(j, run.options.quick);
  parameters.add("k_c", p.k_c);
  parameters.add("k_phi", p.k_phi);
  parameters.add("n", p.n);
  parameters.add("cohesion_Pa", p.cohesion);
  parameters.add("friction_angle_deg", p.phi, kDegree);
  parameters.add("friction_angle_without_cohesion_deg", p.phi_alone, kDegree);
  parameters.add("janosi_K_m", p.K);
  parameters.add("final_cohesion_Pa", p.final_cohesion);
  parameters.add("final_friction_angle_deg", p.final_phi, kDegree);
  parameters.add("cone_index_Pa", p.cone_index);
  parameters.add("repose_angle_deg", p.repose, kDegree);
  parameters.add("repose_angle_without_cohesion_deg", p.repose_dry, kDegree);
  parameters.finish();
  j["units"] = {{"k_c", "N/m^(n+1)"}, {"k_phi", "N/m^(n+2)"}, {"n", "-"}};
  j["grains"] = {{"law", o.law},
                 {"radius_m", o.radius},
                 {"radius_median_by_mass_m", dem::median_radius_by_mass(o)},
                 {"density_kg_m3", o.density},
                 {"friction", o.friction},
                 {"rolling_friction", o.rolling_friction},
                 {"size_distribution", o.size_distribution},
                 {"size_spread", o.size_spread},
                 {"settling_friction", o.settling_friction < 0.0 ? Json(nullptr) : Json(o.settling_friction)},
                 {"cohesion_Pa", o.cohesion},
                 {"young_modulus_Pa", o.young_modulus},
                 {"bed_generator", o.bed_generator},
                 {"compaction_pressure_Pa", o.compaction_pressure}};
  j["terrain"] = fields_json(o, role::soil);  // all keys that soil files may have: of the grains,
  add_empirical(p, j["terrain"]);             // and of the soil as a whole
  if (run.options.plate) j["plate"] = plate_json(run, p);
  if (run.options.shear) j["shear"] = shear_json(run, p.coulomb_goodness);
  if (run.options.interface) j["interface"] = interface_json(run, p);
  if (run.options.cone) j["cone"] = cone_json(run, p);
  if (run.options.repose) j["repose"] = repose_json(run);
  j["threads"] = run.options.threads;
  j["wall_s"] = run.wall_s;
  return j;
}

}  // namespace furrow::terrain::soil
