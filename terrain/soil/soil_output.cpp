#include "terrain/soil/soil_output.hpp"

#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "protocol/files/text_file.hpp"

namespace furrow::terrain::soil {

using Json = nlohmann::ordered_json;

void write_soil_tables(const std::filesystem::path& folder, const SoilRun& run) {
  const auto write = [&](bool tested, const char* name, std::string text, const auto& add_rows) {
    if (!tested) return;
    add_rows([&](const auto& test, std::initializer_list<double> values) {
      fmt::format_to(std::back_inserter(text), "{},{:.9g}\n", test.specimen.seed, fmt::join(values, ","));
    });
    write_whole_file(folder / name, text);
  };
  // Plates given in metres differ in more than their b.
  const bool metres = !run.plan.plate_beds.empty() && run.plan.plate_beds.front().exact;
  write(run.options.plate, "plate.csv",
        metres ? "seed,width_m,sinkage_m,pressure_Pa,diameter_m,bed_depth_m\n" : "seed,width_m,sinkage_m,pressure_Pa\n",
        [&](const auto& row) {
          for (const auto& tests : run.results.plate)
            for (const auto& t : tests)
              for (std::size_t k = 0; k < t.result.curve.sinkage.size(); ++k) {
                const PlateResult& r = t.result;
                const double width = r.curve.width, z = r.curve.sinkage[k], p = r.curve.pressure[k];
                if (metres)
                  row(t, {width, z, p, r.disc ? r.size : 0.0, t.specimen.height});
                else
                  row(t, {width, z, p});
              }
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
  // Value of the cone of the index, or of all sizes.
  const auto cones = [&](const auto& row, bool all) {
    const std::size_t each = run.plan.cones.size();
    for (std::size_t at = 0; at < run.results.cone.size(); at += all ? 1 : each) {
      const auto& t = run.results.cone[at];
      const double diameter = run.plan.cones[at % each].diameter * run.options.material.radius;
      for (std::size_t k = 0; k < t.result.depth.size(); ++k)
        if (all)
          row(t, {diameter, t.result.depth[k], t.result.pressure[k]});
        else
          row(t, {t.result.depth[k], t.result.pressure[k]});
    }
  };
  write(run.options.cone, "cone.csv", "seed,depth_m,pressure_Pa\n", [&](const auto& row) { cones(row, false); });
  write(run.options.cone, "cones.csv", "seed,base_diameter_m,depth_m,pressure_Pa\n",
        [&](const auto& row) { cones(row, true); });
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

namespace {

constexpr double kOpenAccount = 0.1;  // of the displaced volume, left over by the account

std::string plate_text(const Json& plate) {
  double displaced = 0.0, depth = 0.0, count = 0.0;
  for (const Json& test : plate["tests"])
    displaced += test["displaced_m3"].get<double>(), depth += test["bed_depth_m"].get<double>(), count += 1.0;
  const auto shares = [&](const std::string& of) {
    const auto share = [&](const char* name) { return 1e2 * plate[of + name].get<double>(); };
    return fmt::format("heaved {:.0f} %, compacted {:.0f} %, not accounted for {:.1f} %", share("heaved_share"),
                       share("compacted_share"), share("volume_residual_share"));
  };
  const bool open = std::abs(plate["volume_residual_share"].get<double>()) > kOpenAccount;
  return fmt::format(
      "furrow: {} {:.4g} mm on {:.3g} mm: p = {:.4g} kPa (z/10 mm)^{:.3g}; displaced {:.3g} cm³: {}{}{}\n",
      plate["shape"].get<std::string>(), 1e3 * plate["size_m"].get<double>(), 1e3 * depth / count,
      1e-3 * plate["k"].get<double>() * std::pow(0.01, plate["n"].get<double>()), plate["n"].get<double>(),
      1e6 * displaced / count, shares(""),
      plate["unloaded_heaved_share"].is_number() ? "; unloaded: " + shares("unloaded_") : "",
      open ? "; the account does not close: too few grains across the plate, or too little sinkage" : "");
}

std::string cone_text(const Json& cone) {
  if (cone["cones"].size() < 2) return "";
  const Json &mean = cone["band"]["mean_Pa"], &gradient = cone["band"]["gradient_Pa_per_m"];
  return fmt::format(
      "furrow: cones of {} sizes: mean from 0 to {:.3g} mm {:.3g} to {:.3g} kPa, gradient {:.3g} to {:.3g} MPa/m\n",
      cone["cones"].size(), 1e3 * cone["mean_depth_m"][1].get<double>(), 1e-3 * mean[0].get<double>(),
      1e-3 * mean[1].get<double>(), 1e-6 * gradient[0].get<double>(), 1e-6 * gradient[1].get<double>());
}

}  // namespace

std::string soil_text(const Json& soil) {
  const bool quick = soil.value("quick", false);
  std::string text;
  const auto value = [&](const char* name, double factor) {
    const auto in = [&](const Json& from) {
      return from.contains(name) && from[name].is_number() ? factor * from[name].get<double>() : NAN;
    };
    const double error = in(soil["standard_error"]);
    if (std::isfinite(error)) return fmt::format("{:.4g} ± {:.2g}", in(soil), error);
    // Two digits, if the value is not more accurate.
    return quick ? fmt::format("about {:.2g}", in(soil)) : fmt::format("{:.4g} (no error)", in(soil));
  };
  if (soil["k_phi"].is_number())
    text += fmt::format("furrow: plate sinkage: n {}, k_c {} kN/m^(n+1), k_φ {} kN/m^(n+2)\n", value("n", 1.0),
                        value("k_c", 1e-3), value("k_phi", 1e-3));
  if (soil.contains("plate"))
    for (const Json& plate : soil["plate"]["plates"]) text += plate_text(plate);
  if (soil["cohesion_Pa"].is_number())
    text += fmt::format("furrow: direct shear: c {} kPa, φ {}°, K {} mm; with c = 0: φ {}°\n",
                        value("cohesion_Pa", 1e-3), value("friction_angle_deg", 1.0), value("janosi_K_m", 1e3),
                        value("friction_angle_without_cohesion_deg", 1.0));
  if (soil.contains("interface"))
    for (const Json& face : soil["interface"]["faces"])
      text +=
          fmt::format("furrow: {} plate: friction angle {:.3g}°, K {:.3g} mm; grains there roll by {:.2g} of its way\n",
                      face["face"].get<std::string>(), face["friction_angle_without_adhesion_deg"].get<double>(),
                      1e3 * face["janosi_K_m"].get<double>(), face["roll"].get<double>());
  if (soil["cone_index_Pa"].is_number())
    text += fmt::format(
                "furrow: cone index {} kPa, the mean from {:.4g} to {:.4g} mm of depth; as terrain.cone_index it "
                "shows regressions of traction beside a run\n",
                value("cone_index_Pa", 1e-3), 1e3 * soil["cone"]["index_depth_m"][0].get<double>(),
                1e3 * soil["cone"]["index_depth_m"][1].get<double>()) +
            cone_text(soil["cone"]);
  if (soil["repose_angle_deg"].is_number()) {
    bool slumped = true;
    for (const Json& test : soil["repose"]["tests"])
      if (test["cohesion_Pa"] == soil["grains"]["cohesion_Pa"]) slumped = slumped && test["slumped"].get<bool>();
    text += fmt::format("furrow: angle of repose {}°{}", value("repose_angle_deg", 1.0),
                        slumped ? "" : " (a steep cut stands)");
    if (soil["repose_angle_without_cohesion_deg"].is_number())
      text += fmt::format("; without cohesion {}°", value("repose_angle_without_cohesion_deg", 1.0));
    text += "\n";
  }
  if (quick) return text + fmt::format("furrow: {}\n", soil["not_to_be_quoted"].get<std::string>());
  return text + "furrow: ± is one standard error; 'no error': one bed alone says nothing of it (--seeds)\n";
}

}  // namespace furrow::terrain::soil
