#include "tire/modes.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/files/text_file.hpp"

namespace furrow::tire {

LowestModes lowest_modes(const Eigen::MatrixXcd& stiffness, const Eigen::MatrixXcd& mass, int count) {
  FURROW_ASSERT(count >= 1 && count <= stiffness.rows(), count, stiffness.rows());
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd> solver(stiffness, mass);
  FURROW_ASSERT(solver.info() == Eigen::Success, count);
  return {solver.eigenvalues().head(count), solver.eigenvectors().leftCols(count)};
}

Eigen::VectorXd lowest_squares(const Eigen::MatrixXcd& stiffness, const Eigen::MatrixXcd& mass, int count) {
  FURROW_ASSERT(count >= 1 && count <= stiffness.rows(), count, stiffness.rows());
  return Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXcd>(stiffness, mass, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .head(count);
}

double signed_frequency(double square) {
  return std::copysign(std::sqrt(std::abs(square)), square) / (2.0 * std::numbers::pi);
}

nlohmann::ordered_json modes_json(const ModesResults& results) {
  nlohmann::ordered_json j;
  j["pressure_Pa"] = results.pressure ? nlohmann::ordered_json(*results.pressure) : nlohmann::ordered_json();
  j["mass_kg"] = results.mass.mass;
  j["sections"] = results.around;
  j["stable"] = std::ranges::all_of(results.modes, [](const Mode& mode) { return mode.frequency >= 0.0; });
  j["modes"] = nlohmann::ordered_json::array();
  for (const Mode& mode : results.modes)
    j["modes"].push_back({{"order", mode.order}, {"number", mode.number}, {"frequency_Hz", mode.frequency}});
  return j;
}

std::string modes_csv(const ModesResults& results) {
  std::string text = "order,number,frequency_Hz\n";
  for (const Mode& mode : results.modes)
    fmt::format_to(std::back_inserter(text), "{},{},{:.9g}\n", mode.order, mode.number, mode.frequency);
  return text;
}

void write_mode_tables(const std::filesystem::path& folder, const ModesResults& results) {
  write_whole_file(folder / "modes.csv", modes_csv(results));
  std::string text = "y_m,radius_m,y_to_m,radius_to_m,from,to\n";
  for (const auto& [from, to] : results.lines) {
    const SectionNode &a = results.section[from], &b = results.section[to];
    fmt::format_to(std::back_inserter(text), "{:.6g},{:.6g},{:.6g},{:.6g},{},{}\n", a.y, a.radius, b.y, b.radius, from,
                   to);
  }
  write_whole_file(folder / "section.csv", text);
  text =
      "order,number,node,y_m,radius_m,tangential,tangential_imaginary,axial,axial_imaginary,radial,radial_"
      "imaginary\n";
  for (const Mode& mode : results.modes)
    for (std::size_t j = 0; j < mode.shape.size(); ++j) {
      const SectionNode& node = results.section[j];
      const auto& [tangential, axial, radial] = mode.shape[j];
      fmt::format_to(std::back_inserter(text), "{},{},{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}\n",
                     mode.order, mode.number, j, node.y, node.radius, tangential.real(), tangential.imag(),
                     axial.real(), axial.imag(), radial.real(), radial.imag());
    }
  write_whole_file(folder / "shapes.csv", text);
}

}  // namespace furrow::tire
