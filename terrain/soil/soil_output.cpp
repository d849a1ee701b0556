#include "terrain/soil/soil_output.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "protocol/files/fields_json.hpp"
#include "protocol/files/text_file.hpp"
#include "terrain/dem/grain_sizes.hpp"

namespace furrow::terrain::soil {
namespace {

using json = nlohmann::ordered_json;

constexpr double kDegree = std::numbers::pi / 180.0;  // rad

json number(double value) { return std::isfinite(value) ? json(value) : json(nullptr); }

constexpr double kLeastFreedom = 2.0;            // of an interval: with one, it is wider than what is known without
constexpr double kWidestAngle = 10.0 * kDegree;  // half an interval of an angle that says something, rad
constexpr char kQuickWarning[] =
    "a quick look: one bed in small boxes, with a bias that is larger than its scatter; not to be quoted";

/// Why there is no standard error, or no interval; empty where there is one.
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

/// The parameters: values flat, errors beside them under the same names, or why there is none.
class Parameters {
 public:
  Parameters(json& target, bool quick) : target_(target), quick_(quick) {}
  void add(const char* name, const Measured& m, double unit = 1.0) {
    target_[name] = m.samples > 0 ? number(m.value / unit) : json(nullptr);
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
  json& target_;
  bool quick_;
  json error_, interval_, samples_, because_ = json::object();
};

json box_json(const SpecimenFacts& s, const Box& box) {
  return {{"length_m", s.length},
          {"width_m", s.width},
          {"height_m", s.height},
          {"grains", s.grains},
          {"solid_fraction", s.solid_fraction},
          {"bulk_density_kg_m3", s.bulk_density},
          {"periodic", box.periodic_x   ? box.periodic_y ? "xy" : "x"
                       : box.periodic_y ? "y"
                                        : "none"},
          {"step_s", s.step}};
}

template <class Tests>
bool all_settled(const Tests& tests) {
  for (const auto& t : tests)
    if (!t.specimen.settled) return false;
  return true;
}

json plate_json(const SoilRun& run, double goodness) {
  const auto& tests = run.results.plate;
  const PlateTest& test = run.plan.plates.front();
  json j = {{"what", "rigid rough strip pushed in at constant speed; plane strain"},
            {"box", box_json(tests.front().specimen, run.plan.plate_box)},
            {"beds_settled", all_settled(tests)},
            {"speed_m_s", test.speed},
            {"sinkage_m", test.sinkage * run.options.material.radius},
            {"fitted_from_m", run.plan.plate_from * run.options.material.radius},
            {"r_squared", goodness}};
  double worst = 0.0;
  for (const auto& t : tests) worst = std::max(worst, t.result.balance_error);
  for (const PlateTest& p : run.plan.plates) j["widths_m"].push_back(p.width * run.options.material.radius);
  j["floor_force_error"] = worst;
  return j;
}

json shear_json(const SoilRun& run, double goodness) {
  const auto& tests = run.results.shear;
  const double r = run.options.material.radius;
  const ShearTest& test = run.plan.shears.front();
  json j = {{"what",
             "two toothed plates in a cell periodic along and across; lid under constant load, moved at "
             "constant speed"},
            {"box", box_json(tests.front().specimen, run.plan.shear_box)},
            {"beds_settled", all_settled(tests)},
            {"speed_m_s", test.speed},
            {"travel_m", test.travel * r},
            {"tooth_m", test.tooth * r},
            {"tooth_pitch_m", test.pitch * r},
            {"r_squared", goodness}};
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

json interface_json(const SoilRun& run, const SoilParameters& p) {
  const auto& tests = run.results.faces;
  const double r = run.options.material.radius;
  const ShearTest& test = run.plan.faces.front();
  json j = {{"what",
             "grains sheared along a flat plate and along one with half-grains glued to it, in the cell of the shear "
             "test; stresses at the end of the travel"},
            {"box", box_json(tests.front().specimen, run.plan.shear_box)},
            {"beds_settled", all_settled(tests)},
            {"speed_m_s", test.speed},
            {"travel_m", test.travel * r},
            {"friction", test.friction >= 0.0 ? test.friction : run.options.material.friction}};
  for (const Interface& of : p.interfaces) {
    json face = {{"face", face_name(of.face)}};
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

json cone_json(const SoilRun& run) {
  const double r = run.options.material.radius;
  const ConeTest& test = run.plan.cone;
  return {{"what", "30° cone after ASABE S313.3, base diameter in grains, polished (friction at most 0.3)"},
          {"box", box_json(run.results.cone.front().specimen, run.plan.cone_box)},
          {"beds_settled", all_settled(run.results.cone)},
          {"speed_m_s", test.speed},
          {"base_diameter_m", test.diameter * r},
          {"base_diameter_grains", 0.5 * test.diameter},
          {"shaft_diameter_m", soil::kConeShaft * test.diameter * r},
          {"index_depth_m", {test.index_from * r, test.index_to * r}}};
}

json repose_json(const SoilRun& run) {
  const double r = run.options.material.radius;
  json j = {{"what", "half of a settled bed taken away at once; slope of the flank that remains, on a rough base"},
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

/// The keys of engine scm from the plate and the shear tests; none of a test that was not made or gives no soil.
void add_empirical(const SoilParameters& p, json& terrain) {
  if (p.n.samples > 0 && p.k_phi.value > 0.0 && p.n.value > 0.0) {
    terrain["bekker_k_c"] = p.k_c.value;
    terrain["bekker_k_phi"] = p.k_phi.value;
    terrain["bekker_n"] = p.n.value;
  }
  if (p.phi.samples > 0 && p.phi.value >= 0.0 && p.K.value > 0.0) {
    terrain["mohr_cohesion"] = std::max(p.cohesion.value, 0.0);  // a line through scatter may begin below 0
    terrain["mohr_friction_angle"] = p.phi.value / kDegree;
    terrain["janosi_k"] = p.K.value;
  }
}

}  // namespace

json soil_json(const SoilRun& run) {
  const dem::DemOptions& o = run.options.material;
  const SoilParameters p = soil::soil_parameters(run.results, run.plan, o.radius);
  json j;
  j["format_version"] = 1;
  j["version"] = FURROW_VERSION;
  j["scenario"] = run.scenario;
  j["scenario_digest"] = run.scenario_digest;
  j["quick"] = run.options.quick;
  j["not_to_be_quoted"] = run.options.quick ? json(kQuickWarning) : json(nullptr);
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
                 {"settling_friction", o.settling_friction < 0.0 ? json(nullptr) : json(o.settling_friction)},
                 {"cohesion_Pa", o.cohesion},
                 {"young_modulus_Pa", o.young_modulus},
                 {"bed_generator", o.bed_generator},
                 {"compaction_pressure_Pa", o.compaction_pressure}};
  j["terrain"] = fields_json(o, role::soil);  // all that soil files may say: of the grains,
  add_empirical(p, j["terrain"]);             // and of the soil as a whole
  if (run.options.plate) j["plate"] = plate_json(run, p.bekker_goodness);
  if (run.options.shear) j["shear"] = shear_json(run, p.coulomb_goodness);
  if (run.options.interface) j["interface"] = interface_json(run, p);
  if (run.options.cone) j["cone"] = cone_json(run);
  if (run.options.repose) j["repose"] = repose_json(run);
  j["threads"] = run.options.threads;
  j["wall_s"] = run.wall_s;
  return j;
}

void write_soil_tables(const std::filesystem::path& folder, const SoilRun& run) {
  const auto write = [&](bool tested, const char* name, std::string text, const auto& add_rows) {
    if (!tested) return;
    add_rows([&](const auto& test, std::initializer_list<double> values) {
      fmt::format_to(std::back_inserter(text), "{},{:.9g}\n", test.specimen.seed, fmt::join(values, ","));
    });
    write_whole_file(folder / name, text);
  };
  write(run.options.plate, "plate.csv", "seed,width_m,sinkage_m,pressure_Pa\n", [&](const auto& row) {
    for (const auto& t : run.results.plate)
      for (std::size_t k = 0; k < t.result.curve.sinkage.size(); ++k)
        row(t, {t.result.curve.width, t.result.curve.sinkage[k], t.result.curve.pressure[k]});
  });
  write(run.options.shear, "shear.csv",
        "seed,nominal_normal_stress_Pa,travel_m,shear_stress_Pa,normal_stress_Pa,rise_m\n", [&](const auto& row) {
          for (const auto& t : run.results.shear)
            for (std::size_t k = 0; k < t.result.travel.size(); ++k)
              row(t, {t.result.normal_nominal, t.result.travel[k], t.result.shear[k], t.result.normal[k],
                      t.result.rise[k]});
        });
  write(run.options.interface, "interface.csv",
        "seed,glued,nominal_normal_stress_Pa,travel_m,shear_stress_Pa,normal_stress_Pa,rise_m\n", [&](const auto& row) {
          for (const auto& t : run.results.faces)
            for (std::size_t k = 0; k < t.result.travel.size(); ++k)
              row(t, {t.result.face == Face::glued ? 1.0 : 0.0, t.result.normal_nominal, t.result.travel[k],
                      t.result.shear[k], t.result.normal[k], t.result.rise[k]});
        });
  write(run.options.cone, "cone.csv", "seed,depth_m,pressure_Pa\n", [&](const auto& row) {
    for (const auto& t : run.results.cone)
      for (std::size_t k = 0; k < t.result.depth.size(); ++k) row(t, {t.result.depth[k], t.result.pressure[k]});
  });
  write(run.options.repose, "repose.csv", "seed,cohesion_Pa,x_m,height_before_m,height_after_m\n",
        [&](const auto& row) {
          const auto rows = [&](const auto& tests, double cohesion) {
            for (const auto& t : tests)
              for (std::size_t k = 0; k < t.result.x.size(); ++k)
                row(t, {cohesion, t.result.x[k], t.result.before[k], t.result.after[k]});
          };
          rows(run.results.repose, run.options.material.cohesion);
          rows(run.results.dry, 0.0);
        });
}

std::string soil_text(const json& soil) {
  const bool quick = soil.value("quick", false);
  std::string text;
  const auto value = [&](const char* name, double factor) {
    const auto in = [&](const json& from) {
      return from.contains(name) && from[name].is_number() ? factor * from[name].get<double>() : NAN;
    };
    const double error = in(soil["standard_error"]);
    if (std::isfinite(error)) return fmt::format("{:.4g} ± {:.2g}", in(soil), error);
    // Two digits of what is not known better.
    return quick ? fmt::format("about {:.2g}", in(soil)) : fmt::format("{:.4g} (no error)", in(soil));
  };
  if (soil["k_phi"].is_number())
    text += fmt::format("furrow: plate sinkage: n {}, k_c {} kN/m^(n+1), k_φ {} kN/m^(n+2)\n", value("n", 1.0),
                        value("k_c", 1e-3), value("k_phi", 1e-3));
  if (soil["cohesion_Pa"].is_number())
    text += fmt::format("furrow: direct shear: c {} kPa, φ {}°, K {} mm; with c = 0: φ {}°\n",
                        value("cohesion_Pa", 1e-3), value("friction_angle_deg", 1.0), value("janosi_K_m", 1e3),
                        value("friction_angle_without_cohesion_deg", 1.0));
  if (soil.contains("interface"))
    for (const json& face : soil["interface"]["faces"])
      text +=
          fmt::format("furrow: {} plate: friction angle {:.3g}°, K {:.3g} mm; grains there roll by {:.2g} of its way\n",
                      face["face"].get<std::string>(), face["friction_angle_without_adhesion_deg"].get<double>(),
                      1e3 * face["janosi_K_m"].get<double>(), face["roll"].get<double>());
  if (soil["cone_index_Pa"].is_number())
    text += fmt::format(
        "furrow: cone index {} kPa, the mean from {:g} to {:g} mm of depth; as terrain.cone_index it "
        "shows regressions of traction beside a run\n",
        value("cone_index_Pa", 1e-3), 1e3 * soil["cone"]["index_depth_m"][0].get<double>(),
        1e3 * soil["cone"]["index_depth_m"][1].get<double>());
  if (soil["repose_angle_deg"].is_number()) {
    bool slumped = true;
    for (const json& test : soil["repose"]["tests"])
      if (test["cohesion_Pa"] == soil["grains"]["cohesion_Pa"]) slumped = slumped && test["slumped"].get<bool>();
    text += fmt::format("furrow: angle of repose {}°{}", value("repose_angle_deg", 1.0),
                        slumped ? "" : " (a steep cut stands)");
    if (soil["repose_angle_without_cohesion_deg"].is_number())
      text += fmt::format("; without cohesion {}°", value("repose_angle_without_cohesion_deg", 1.0));
    text += "\n";
  }
  if (quick) return text + "furrow: " + kQuickWarning + "\n";
  return text + "furrow: ± is one standard error; 'no error': one bed alone says nothing of it (--seeds)\n";
}

}  // namespace furrow::terrain::soil
