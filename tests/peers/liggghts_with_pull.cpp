// LIGGGHTS with a constant pull between grains that touch: liggghts_with_pull DECK LOG PULL_N DIAMETER_M
//
// Runs a deck through LIGGGHTS's library, one rank. Its `fix pull all external pf/callback 1 1` gets F_c along the line
// of centres for every pair nearer than a diameter, added after the contact forces: the Coulomb limit is taken from the
// elastic force, as with the engine's cohesion. LIGGGHTS's own cohesion models do not have this law.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iostream>
#include <string>
#include <vector>

#include <mpi.h>

#include <domain.h>
#include <fix_external.h>
#include <lammps.h>
#include <library.h>
#include <modify.h>

namespace {

/// Pairs within a diameter and a skin, and the pull on those that touch.
class Pull {
 public:
  Pull(LAMMPS_NS::LAMMPS* program, double force, double diameter)
      : domain_(program->domain), force_(force), diameter_(diameter), skin_(0.1 * diameter) {}

  void add(int count, const int* ids, double** x, double** pull) {
    for (int g = 0; g < count; ++g) pull[g][0] = pull[g][1] = pull[g][2] = 0.0;
    if (stale(count, ids, x)) list(count, ids, x);
    for (const auto& [i, j] : pairs_) {
      double d[3] = {x[i][0] - x[j][0], x[i][1] - x[j][1], x[i][2] - x[j][2]};
      domain_->minimum_image(d);
      const double square = d[0] * d[0] + d[1] * d[1] + d[2] * d[2];
      if (!(square < diameter_ * diameter_)) continue;
      const double factor = force_ / std::sqrt(square);
      for (int a = 0; a < 3; ++a) pull[i][a] -= factor * d[a], pull[j][a] += factor * d[a];
    }
  }

 private:
  bool stale(int count, const int* ids, double** x) const {
    if (static_cast<int>(ids_.size()) != count) return true;
    const double most = 0.25 * skin_ * skin_;
    for (int g = 0; g < count; ++g) {
      double d[3] = {x[g][0] - at_[3 * g], x[g][1] - at_[3 * g + 1], x[g][2] - at_[3 * g + 2]};
      domain_->minimum_image(d);
      if (ids[g] != ids_[g] || !(d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < most)) return true;
    }
    return false;
  }

  /// Cells of one reach; along a periodic side their number divides it.
  void list(int count, const int* ids, double** x) {
    ids_.assign(ids, ids + count);
    at_.resize(3 * count);
    pairs_.clear();
    const double reach = diameter_ + skin_;
    int cells[3];
    for (int a = 0; a < 3; ++a) cells[a] = std::max(1, static_cast<int>(domain_->prd[a] / reach));
    std::vector<std::vector<int>> in(static_cast<std::size_t>(cells[0]) * cells[1] * cells[2]);
    const auto cell = [&](int g, int a) {
      const double share = (x[g][a] - domain_->boxlo[a]) / domain_->prd[a];
      const int k = static_cast<int>(std::floor(share * cells[a]));
      const int periodic[3] = {domain_->xperiodic, domain_->yperiodic, domain_->zperiodic};
      return periodic[a] ? (k % cells[a] + cells[a]) % cells[a] : std::clamp(k, 0, cells[a] - 1);
    };
    const auto index = [&](int cx, int cy, int cz) {
      return (static_cast<std::size_t>(cz) * cells[1] + cy) * cells[0] + cx;
    };
    for (int g = 0; g < count; ++g) {
      for (int a = 0; a < 3; ++a) at_[3 * g + a] = x[g][a];
      in[index(cell(g, 0), cell(g, 1), cell(g, 2))].push_back(g);
    }
    if (cells[0] < 3 || cells[1] < 3) std::cerr << "liggghts_with_pull: error: the box is too small\n", std::exit(2);
    for (int i = 0; i < count; ++i)
      for (int dz = -1; dz <= 1; ++dz) {
        const int cz = cell(i, 2) + dz;
        if (cz < 0 || cz >= cells[2]) continue;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const int cx = (cell(i, 0) + dx + cells[0]) % cells[0], cy = (cell(i, 1) + dy + cells[1]) % cells[1];
            for (const int j : in[index(cx, cy, cz)]) {
              if (j <= i) continue;
              double d[3] = {x[i][0] - x[j][0], x[i][1] - x[j][1], x[i][2] - x[j][2]};
              domain_->minimum_image(d);
              if (d[0] * d[0] + d[1] * d[1] + d[2] * d[2] < reach * reach) pairs_.emplace_back(i, j);
            }
          }
      }
  }

  LAMMPS_NS::Domain* domain_;
  double force_, diameter_, skin_;  // N, m, m
  std::vector<int> ids_;            // when the list was made
  std::vector<double> at_;
  std::vector<std::pair<int, int>> pairs_;
};

void call_back(void* pull, LAMMPS_NS::bigint, int count, int* ids, double** x, double** force) {
  static_cast<Pull*>(pull)->add(count, ids, x, force);
}

}  // namespace

int main(int argc, char** argv) {
  MPI_Init(&argc, &argv);
  if (argc != 5) return std::cerr << "usage: liggghts_with_pull DECK LOG PULL_N DIAMETER_M\n", 2;
  std::vector<std::string> words = {"liggghts", "-log", argv[2], "-screen", "/dev/null"};
  std::vector<char*> arguments;
  for (std::string& word : words) arguments.push_back(word.data());
  void* handle = nullptr;
  lammps_open(static_cast<int>(arguments.size()), arguments.data(), MPI_COMM_WORLD, &handle);
  auto* program = static_cast<LAMMPS_NS::LAMMPS*>(handle);
  Pull pull(program, std::atof(argv[3]), std::atof(argv[4]));
  std::ifstream deck(argv[1]);
  for (std::string line; std::getline(deck, line);) {
    lammps_command(handle, line.c_str());
    if (line.rfind("fix pull ", 0) != 0) continue;
    const int k = program->modify->find_fix("pull");
    static_cast<LAMMPS_NS::FixExternal*>(program->modify->fix[k])->set_callback(call_back, &pull);
  }
  lammps_close(handle);
  MPI_Finalize();
}
