// Results of `furrow modes`: the lowest natural frequencies of a tire on a rim at rest, by circumferential order.
//
// A tire with equal sections vibrates in û e^{i n θ}, û in axes that turn with the sections. For each order n,
// stiffness and mass of the whole tire reduce to small Hermitian matrices,
//   K_n û = ω² M_n û,   K_n = Σ over the elements of one section T_eᴴ k_e T_e,
// T_e contains the turn and the phase of each node [Thomas 1979]. From order 1 on, every frequency has two modes,
// turned against each other by a quarter of a wave.
//
// Thomas, Dynamics of rotationally periodic structures, Int. J. Numer. Methods Eng. 14 (1979) 81,
// doi:10.1002/nme.1620140107.
#pragma once

#include <array>
#include <complex>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <nlohmann/json.hpp>

#include "protocol/core/progress_call.hpp"
#include "protocol/core/surface.hpp"

namespace furrow::tire {

struct ModesOptions {
  int orders = 8;  // highest circumferential order
  int count = 3;   // of each order
};

/// A node of a section of the tire at rest, inflated.
struct SectionNode {
  double y = 0.0, radius = 0.0;  // along the axle, m; m
};

struct Mode {
  int order = 0, number = 0;  // number from 1, by frequency
  double frequency = 0.0;     // Hz; negative: growth rate over 2π of an unstable shape
  /// Amplitudes of the section's nodes: tangential (forward at the top), along the axle, radial. The largest is 1.
  std::vector<std::array<std::complex<double>, 3>> shape;
};

struct ModesResults {
  std::vector<Mode> modes;
  std::vector<SectionNode> section;
  std::vector<std::array<int, 2>> lines;  // between nodes of the section, for pictures
  MassProperties mass;                    // of the whole tire
  std::optional<double> pressure;         // gauge, Pa; if the model has one
  int around = 0;                         // sections
};

/// Modal test of a model that vibrates, as TireSpec::modal_test() makes it.
class ModalTest {
 public:
  virtual ~ModalTest() = default;
  virtual int sections() const = 0;  // around; orders up to half of them
  virtual int unknowns() const = 0;  // of one section; also the number of modes of each order
  /// @pre 0 ≤ orders ≤ sections()/2, 1 ≤ count ≤ unknowns(). @throws Error(physics) if the tire cannot be inflated
  virtual ModesResults modes(const ModesOptions& options, const ProgressCall& progress) const = 0;
};

/// The lowest eigenvalues ω², 1/s², and their vectors as columns.
struct LowestModes {
  Eigen::VectorXd squares;
  Eigen::MatrixXcd vectors;
};
/// @pre mass is positive definite, count ≤ its size
LowestModes lowest_modes(const Eigen::MatrixXcd& stiffness, const Eigen::MatrixXcd& mass, int count);

/// The eigenvalues ω² alone, in a third of the time.
Eigen::VectorXd lowest_squares(const Eigen::MatrixXcd& stiffness, const Eigen::MatrixXcd& mass, int count);

/// ω² → Hz, with the sign of ω².
double signed_frequency(double square);

/// Frequency and shape of eigenvector k; `at` picks the amplitudes of a node.
template <class At>
Mode mode_of(const LowestModes& lowest, int order, int k, int nodes, At&& at) {
  Mode mode{order, k + 1, signed_frequency(lowest.squares[k]), {}};
  std::complex<double> largest = 0.0;
  for (int j = 0; j < nodes; ++j) {
    mode.shape.push_back(at(lowest.vectors.col(k), j));
    for (const auto& value : mode.shape.back())
      if (std::abs(value) > std::abs(largest)) largest = value;
  }
  for (auto& node : mode.shape)
    for (auto& value : node) value /= largest;
  return mode;
}

/// summary.json without the keys that identify the tire.
nlohmann::ordered_json modes_json(const ModesResults& results);
/// One line for each mode.
std::string modes_csv(const ModesResults& results);
/// modes.csv, section.csv and shapes.csv. @throws Error(io)
void write_mode_tables(const std::filesystem::path& folder, const ModesResults& results);

}  // namespace furrow::tire
