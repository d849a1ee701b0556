// LIGGGHTS as an engine of grains: one instance on the ranks of the terrain, driven by its own commands.
#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include <mpi.h>

#include <atom.h>
#include <atom_vec.h>
#include <comm.h>
#include <domain.h>
#include <force.h>
#include <input.h>
#include <integrate.h>
#include <irregular.h>
#include <lammps.h>
#include <modify.h>
#include <update.h>

#include "terrain/liggghts/cell_order.hpp"
#include "terrain/liggghts/engine.hpp"
#include "terrain/liggghts/plugin/fix_furrow.hpp"
#include "terrain/liggghts/plugin/pair_furrow.hpp"

namespace {

/// Names Modify::fix_map, which is private, in an explicit instantiation [C++ standard, 13.9.3, access checking].
template <auto kMember>
struct Opened {
  friend auto fix_map_of() { return kMember; }
};
auto fix_map_of();
template struct Opened<&LAMMPS_NS::Modify::fix_map>;

}  // namespace

namespace furrow::terrain::liggghts {
namespace {

using LAMMPS_NS::LAMMPS;

constexpr double kMargin = 10.0;  // margin around the bin, largest radii: nothing is deleted before it is reported

std::string number(double v) {
  char text[40];
  std::snprintf(text, sizeof text, "%.17g", v);
  return text;
}

class LiggghtsEngine final : public Engine {
 public:
  explicit LiggghtsEngine(const EngineSetup& setup) : setup_(setup) {
    int initialized = 0;
    MPI_Initialized(&initialized);
    if (!initialized) MPI_Init(nullptr, nullptr);
    MPI_Comm_dup(setup.communicator ? MPI_Comm_f2c(*setup.communicator) : MPI_COMM_SELF, &communicator_);
    int ranks = 1;
    MPI_Comm_size(communicator_, &ranks);
    std::string words[] = {"liggghts", "-log", "none", "-screen", "none"};
    char* argv[] = {words[0].data(), words[1].data(), words[2].data(), words[3].data(), words[4].data()};
    lmp_ = std::make_unique<LAMMPS>(5, argv, communicator_);
    (*lmp_->force->pair_map)["gran"] = [](LAMMPS* l) -> LAMMPS_NS::Pair* { return new PairFurrow(l); };
    (*(lmp_->modify->*fix_map_of()))["furrow"] = [](LAMMPS* l, int n, char** words) -> LAMMPS_NS::Fix* {
      return new FixFurrow(l, n, words);
    };
    const dem::Bin& bin = setup.bin;
    const double room = kMargin * setup.largest, across = bin.periodic_y ? 0.0 : room;
    // LIGGGHTS makes no lists of its own, and exchanges grains only when the fix asks for it.
    const double reach = (1.0 + kGhostRoom) * setup.skin;
    // Each `run` begins and ends with a line of LIGGGHTS' own sums; none of these is wanted, nor a count of grains.
    for (const std::string& line :
         {std::string("atom_style sphere"), std::string("atom_modify sort 0 0"),
          std::string(bin.periodic_y ? "boundary f p fs" : "boundary f f fs"), std::string("newton off"),
          std::string("communicate single vel yes"), std::string("units si"),
          "processors " + std::to_string(ranks) + " 1 1",
          "region bin block " + number(-room) + " " + number(bin.length + room) + " " +
              number(-0.5 * bin.width - across) + " " + number(0.5 * bin.width + across) + " " + number(-room) + " " +
              number(setup.top + room) + " units box",
          std::string("create_box 1 bin"), "neighbor " + number(reach) + " bin",
          std::string("neigh_modify delay 0 every 2000000000 check no"), std::string("pair_style gran"),
          std::string("pair_coeff * *"), std::string("thermo_style custom step"),
          std::string("thermo_modify lost ignore"), std::string("fix furrow all furrow")})
      command(line);
    pair_ = static_cast<PairFurrow*>(lmp_->force->pair);
    fix_ = static_cast<FixFurrow*>(lmp_->modify->fix[lmp_->modify->find_fix("furrow")]);
    pair_->set_up(setup);
    fix_->set_up(setup, *pair_);
    if (!setup.borders.empty()) set_borders(setup.borders);
  }
  ~LiggghtsEngine() override {
    lmp_.reset();
    int finalized = 0;
    MPI_Finalized(&finalized);
    if (!finalized) MPI_Comm_free(&communicator_);
  }

  void place(std::span<const NewGrain> grains, bool own_only) override {
    LAMMPS_NS::Atom& atom = *lmp_->atom;
    const double lo = lmp_->domain->sublo[0], hi = lmp_->domain->subhi[0];
    for (const NewGrain& grain : grains) {
      double at[3] = {grain.exchange_position[0], grain.exchange_position[1], grain.exchange_position[2]};
      if (!own_only && !(at[0] >= lo && at[0] < hi)) continue;
      atom.avec->create_atom(1, at);
      const int i = atom.nlocal - 1;
      atom.tag[i] = grain.id + 1;
      atom.radius[i] = grain.radius;
      const double size = grain.radius / setup_.grain.radius;
      atom.rmass[i] = setup_.grain.mass * size * size * size;
      std::copy_n(grain.velocity.data(), 3, atom.v[i]);
      std::copy_n(grain.spin.data(), 3, atom.omega[i]);
      fix_->set_arrays(i);
      if (grain.position != grain.exchange_position || grain.list_position != grain.exchange_position)
        moved_[grain.id + 1] = {grain.list_position, grain.position};
    }
  }

  void remember(std::span<const PairRecord> records) override { records_.assign(records.begin(), records.end()); }

  void begin(StepWork& work, bool exchange) override {
    LAMMPS_NS::Atom& atom = *lmp_->atom;
    LAMMPS_NS::bigint own = atom.nlocal;
    MPI_Allreduce(&own, &atom.natoms, 1, MPI_LMP_BIGINT, MPI_SUM, communicator_);
    fix_->set_work(work);
    make_ready();
    const auto move = [&](std::array<double, 3> Moved::*to) {
      for (int i = 0; i < atom.nlocal; ++i)
        if (const auto it = moved_.find(atom.tag[i]); it != moved_.end())
          std::copy_n((it->second.*to).data(), 3, atom.x[i]);
    };
    give_records();  // now, because the first set-up of a run clears the arrays of a fix
    move(&Moved::list_position);
    lmp_->comm->forward_comm();  // ghosts follow
    fix_->make_lists();
    move(&Moved::position);
    fix_->look_again();
    if (exchange) fix_->set_exchange_due();
    moved_ = {};
  }

  void set_coefficients(const dem::ContactCoefficients& pair) override { pair_->set_coefficients(pair); }

  void run(int steps, const StepTimes& times) override {
    // Like the command `run`, without its lines of output and its barriers before and after.
    LAMMPS_NS::Update& update = *lmp_->update;
    update.dt = times.dt;
    pair_->set_since(times.since);
    fix_->set_times(times);
    update.whichflag = 1;
    update.nsteps = steps;
    update.firststep = update.beginstep = update.ntimestep;
    update.laststep = update.endstep = update.ntimestep + steps;
    update.integrate->run(steps);
    update.whichflag = 0;
  }

  void move_borders(std::span<const double> borders) override {
    lmp_->modify->setup_pre_exchange();
    set_borders(borders);
    LAMMPS_NS::Irregular(lmp_.get()).migrate_atoms();
    put_in_order();
    make_ready();
    fix_->make_lists();
    fix_->look_again();
  }

  bool exchange_due() const override { return fix_->exchange_due(); }

  OwnGrains own() override { return fix_->own(); }

  std::vector<NewGrain> own_state() override {
    const LAMMPS_NS::Atom& atom = *lmp_->atom;
    std::vector<NewGrain> all(atom.nlocal);
    for (int i = 0; i < atom.nlocal; ++i) {
      NewGrain& g = all[i];
      g.id = atom.tag[i] - 1;
      g.radius = atom.radius[i];
      std::copy_n(atom.x[i], 3, g.position.data());
      std::copy_n(atom.v[i], 3, g.velocity.data());
      std::copy_n(atom.omega[i], 3, g.spin.data());
      g.list_position = fix_->list_position(i);
      g.exchange_position = fix_->exchange_position(i);
    }
    return all;
  }
  std::vector<PairRecord> own_pairs() override { return pair_->records(); }
  int own_ghosts() const override { return lmp_->atom->nghost; }
  std::int64_t list_builds() const override { return pair_->lists().builds(); }

  void command(const std::string& line) override {
    std::string text = line;
    lmp_->input->one(text.data());
  }

 private:
  /// Exchanges grains. LIGGGHTS would exchange them again in the step after this, for a restart file that nobody
  /// requested; the step number is raised so that this step does not occur.
  void make_ready() {
    command("run 0 pre yes post no");
    ++lmp_->update->ntimestep;
  }

  /// Sorts grains by cells and numbers, as those from several ranks are in the order in which messages arrived.
  void put_in_order() {
    LAMMPS_NS::Atom& atom = *lmp_->atom;
    const auto place = [&](int i) { return place_in_order(atom.x[i], atom.tag[i], setup_.largest); };
    std::vector<int> from(atom.nlocal);
    std::iota(from.begin(), from.end(), 0);
    std::sort(from.begin(), from.end(), [&](int a, int b) { return place(a) < place(b); });
    const int spare = atom.nlocal;
    if (spare >= atom.nmax) atom.avec->grow(0);
    for (int first = 0; first < spare; ++first) {
      if (from[first] == first) continue;
      atom.avec->copy(first, spare, 0);
      int to = first;
      for (; from[to] != first; to = std::exchange(from[to], to)) atom.avec->copy(from[to], to, 0);
      atom.avec->copy(spare, to, 0);
      from[to] = to;
    }
  }

  /// Gives the saved histories of touching grains to this rank's own grains.
  void give_records() {
    std::unordered_map<int, int> own;  // by tag
    for (int i = 0; i < lmp_->atom->nlocal; ++i) own.emplace(lmp_->atom->tag[i], i);
    // Across a periodic side both grains have listed a pair, so it is saved twice.
    const auto give = [&](int tag, int partner, const PairHistory& history) {
      const auto found = own.find(tag);
      if (found == own.end()) return;
      std::vector<PairOf>& pairs = fix_->pairs_of(found->second);
      for (const PairOf& known : pairs)
        if (known.partner == partner) return;
      pairs.push_back({partner, history});
    };
    for (const PairRecord& r : records_) {
      const PairHistory h{{r.tangential[0], r.tangential[1], r.tangential[2], r.root_overlap},
                          {r.rolling[0], r.rolling[1], r.rolling[2], 0.0}};
      give(r.i + 1, r.j + 1, h);
      give(r.j + 1, r.i + 1, h.turned());
    }
    records_ = {};
  }

  void set_borders(std::span<const double> borders) {
    LAMMPS_NS::Comm& comm = *lmp_->comm;
    const LAMMPS_NS::Domain& domain = *lmp_->domain;
    comm.uniform = 0;
    for (std::size_t k = 0; k < borders.size(); ++k)
      comm.xsplit[k + 1] = (borders[k] - domain.boxlo[0]) / (domain.boxhi[0] - domain.boxlo[0]);
    lmp_->domain->set_local_box();
  }

  EngineSetup setup_;
  MPI_Comm communicator_ = MPI_COMM_NULL;
  std::unique_ptr<LAMMPS> lmp_;
  PairFurrow* pair_ = nullptr;
  FixFurrow* fix_ = nullptr;
  std::vector<PairRecord> records_;  // until begin()
  struct Moved {
    std::array<double, 3> list_position{}, position{};
  };
  std::unordered_map<int, Moved> moved_;  // by tag: earlier positions; until begin()
};

}  // namespace
}  // namespace furrow::terrain::liggghts

extern "C" {

int furrow_engine_version() { return furrow::terrain::liggghts::kEngineVersion; }

furrow::terrain::liggghts::Engine* furrow_make_engine(const furrow::terrain::liggghts::EngineSetup& setup) {
  return new furrow::terrain::liggghts::LiggghtsEngine(setup);
}
}
