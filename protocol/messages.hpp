// The messages of the co-simulation, one struct per kind. At synchronization t_n every node sends the messages that
// describe the interval [t_{n-1}, t_n] or the instant t_n, and receives those of its peers; then all advance by H.
//
//   rig → tire k      RimMotion       rim frame at t_n
//   tire k → rig      SpindleReport   wrench over the last interval, less the tire's own rigid-body inertia & weight
//   tire k → terrain  SurfaceMotion   vertices at t_n
//   terrain → tire k  TerrainForces   nodal forces over the last interval
//   terrain → rig     TerrainReport   sums of the same forces, and the terrain's own measurements
//
// Some tires follow their rim on ground that answers at once. They get the forces of the interval that begins, in a
// second exchange before all advance (nodes/ranks/node.hpp):
//
//   tire k → terrain  SurfaceMotion   vertices at t_{n+1}
//   terrain → tire k  TerrainForces   nodal forces over [t_n, t_{n+1}]
//   tire k → rig      PromptWrench    wrench over the same interval
//
// The ranks of a terrain exchange messages of the kind `group` (protocol/transport_group.hpp). A message is packed and
// saved by the list of fields next to its struct.
#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "protocol/core/fields.hpp"
#include "protocol/core/surface.hpp"
#include "protocol/core/terrain_state.hpp"
#include "protocol/core/tire_diagnostics.hpp"

namespace furrow {

inline constexpr std::int32_t kProtocolVersion = 10;

enum class Role : std::int32_t { rig = 0, tire = 1, terrain = 2 };
/// "rig", "tire", "terrain".
std::string to_string(Role role);

/// A partner, identified by its role and never by its world rank.
struct Address {
  Role role = Role::rig;
  std::int32_t index = 0;  // which tire; which rank of a terrain, 0 being its leader; 0 for the rig
  bool operator==(const Address&) const = default;
};
void visit_fields(FieldsOf<Address> auto& s, auto&& visit) {
  visit(s.role, Field{"role", ""});
  visit(s.index, Field{"index"});
}
/// The node with this number: the rig is 0, then come the tires, then the ranks of the terrain.
Address address_of(int node, int tire_count);
/// "rig", "tire 0", "terrain", or "terrain 0" if the terrain has several ranks.
std::string to_string(const Address& address, int terrain_ranks = 1);

/// Tag of a message on the wire: its kind, never a step number.
enum class MessageKind : std::int32_t {
  node_card = 1,
  surface_setup = 2,
  terrain_setup = 3,
  rim_motion = 4,
  spindle_report = 5,
  surface_motion = 6,
  terrain_forces = 7,
  terrain_report = 8,
  final_report = 9,
  control = 10,
  run_folder = 11,
  checkpoint_part = 12,
  group = 13,
};
std::string to_string(MessageKind kind);

/// Describes a node and what it expects of the others; all nodes exchange it before anything else.
struct NodeCard {
  static constexpr MessageKind kKind = MessageKind::node_card;
  std::int32_t protocol_version = kProtocolVersion;
  Address self;
  std::string node_kind;        // "drawbar", "ancf", "rigid", "dem", …
  std::string scenario_digest;  // hash of the completed scenario
  double step = 0.0;            // communication step H, s
  std::int64_t steps = 0;       // number of communication steps
  std::int64_t from_step = 0;   // the first step: 0, or that of the checkpoint from which the run continues
  std::int32_t substeps = 1;
  std::int32_t wheel_count = 0;  // rig: wheels it carries
  std::int32_t tire_count = 0;   // rig, terrain: tires they expect
  std::int32_t threads = 1;
  std::int32_t pid = 0;
  std::string host;
  MassProperties tire_mass;  // tire: rigid-body mass properties, added to the rim body by the rig
  double tire_radius = 0.0;  // tire: undeformed radius of the contact surface, m
  double tire_width = 0.0;   // tire: tread width, m
  double tire_reach = 0.0;   // tire: its reach below the rim centre, inflated, with the camber of the rig, m
  std::int64_t size = 0;     // grains or coordinates, for reports
};
void visit_fields(FieldsOf<NodeCard> auto& s, auto&& visit) {
  visit(s.protocol_version, Field{"protocol_version"});
  visit(s.self, Field{"self", ""});
  visit(s.node_kind, Field{"node_kind", ""});
  visit(s.scenario_digest, Field{"scenario_digest", ""});
  visit(s.step, Field{"step", "s"});
  visit(s.steps, Field{"steps"});
  visit(s.from_step, Field{"from_step"});
  visit(s.substeps, Field{"substeps"});
  visit(s.wheel_count, Field{"wheel_count"});
  visit(s.tire_count, Field{"tire_count"});
  visit(s.threads, Field{"threads"});
  visit(s.pid, Field{"pid"});
  visit(s.host, Field{"host", ""});
  visit(s.tire_mass, Field{"tire_mass", ""});
  visit(s.tire_radius, Field{"tire_radius", "m"});
  visit(s.tire_width, Field{"tire_width", "m"});
  visit(s.tire_reach, Field{"tire_reach", "m"});
  visit(s.size, Field{"size"});
}

/// tire k → terrain, once: connectivity and material of its contact surface.
struct SurfaceSetup {
  static constexpr MessageKind kKind = MessageKind::surface_setup;
  SurfaceMesh mesh;
  ContactMaterial material;
};
void visit_fields(FieldsOf<SurfaceSetup> auto& s, auto&& visit) {
  visit(s.mesh, Field{"mesh", ""});
  visit(s.material, Field{"material", ""});
}

/// terrain → rig, once, after settling.
struct TerrainSetup {
  static constexpr MessageKind kKind = MessageKind::terrain_setup;
  std::vector<double> top_height;   // highest point of the terrain under each tire's box, m
  std::vector<double> mean_height;  // mean undisturbed surface height h₀ there, m
  double floor_height = 0.0;        // m
  double settle_wall_s = 0.0;
  std::int64_t grains = 0;
};
void visit_fields(FieldsOf<TerrainSetup> auto& s, auto&& visit) {
  visit(s.top_height, Field{"top_height", "m"});
  visit(s.mean_height, Field{"mean_height", "m"});
  visit(s.floor_height, Field{"floor_height", "m"});
  visit(s.settle_wall_s, Field{"settle_wall_s", "s"});
  visit(s.grains, Field{"grains"});
}

/// Header that every message of the run loop carries, checked on receipt.
struct StepHeader {
  std::int64_t step = 0;  // n
  double time = 0.0;      // t_n, s
};
void visit_fields(FieldsOf<StepHeader> auto& s, auto&& visit) {
  visit(s.step, Field{"step"});
  visit(s.time, Field{"time", "s"});
}

/// Order that all nodes carry out after the same interval, the first that begins when all of them have it.
enum class Order : std::int32_t {
  go_on = 0,
  checkpoint = 1,  // save
  stop = 2,        // save and end: a signal asked for it
};

/// Stands for the step of an end that is not determined yet.
inline constexpr std::int64_t kNotYet = std::numeric_limits<std::int64_t>::max();

struct RimMotion {
  static constexpr MessageKind kKind = MessageKind::rim_motion;
  StepHeader header;
  RimState rim;
  Order order = Order::go_on;      // due at synchronization n + 1
  std::int64_t ends_at = kNotYet;  // step at which the run is complete before its planned end, at least n + 2
};
void visit_fields(FieldsOf<RimMotion> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.rim, Field{"rim", ""});
  visit(s.order, Field{"order", ""});
  visit(s.ends_at, Field{"ends_at"});
}

/// tire k → rig.
struct SpindleReport {
  static constexpr MessageKind kKind = MessageKind::spindle_report;
  StepHeader header;
  Wrench wrench;                // on the rim by the tire + m (a − g), for a rig that carries the added mass
  Wrench spindle;               // on the rim by the tire, complete
  Wrench contact;               // on the tire by the terrain as it acted, about the middle of the rim centre's path
  double lowest_point = 0.0;    // lowest contact-surface vertex z, m
  TireDiagnostics diagnostics;  // of the model
  Vec3 impulse_received = Vec3::Zero();  // cumulative, N s
  double impulse_received_abs = 0.0;     // cumulative Σ|impulse per interval|, N s
  Vec3 spindle_impulse = Vec3::Zero();   // by the tire on the rim, complete, cumulative, N s
  Vec3 gravity_impulse = Vec3::Zero();   // cumulative, N s
  double terrain_work = 0.0;             // cumulative Σ f̄·Δx_tire at the vertices, J
  double rim_work = 0.0;                 // cumulative, by the rim on the tire, −(F·displacement + M·turn), J
  std::int64_t newton_iterations = 0;    // cumulative
  std::int64_t factorizations = 0;       // cumulative
  double residual = 0.0;                 // last converged free residual / reference
  bool prompt = false;                   // the wrench acts over the interval of its forces; false: over the next one
  // The tire uses contact tangents: its forces differ from those reported for the same interval.
  bool contact_tangent = false;
  Vec3 impulse_ahead = Vec3::Zero();  // received beyond what the terrain had reported by then, N s
  double ledger = 0.0;                // |Σ| of the differences when last settled, N s
  double ledger_largest = 0.0;        // largest until now, N s
};
void visit_fields(FieldsOf<SpindleReport> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.wrench, Field{"wrench", ""});
  visit(s.spindle, Field{"spindle", ""});
  visit(s.contact, Field{"contact", ""});
  visit(s.lowest_point, Field{"lowest_point", "m"});
  visit_fields(s.diagnostics, visit);  // under the names that they have there
  visit(s.impulse_received, Field{"impulse_received", "N s"});
  visit(s.impulse_received_abs, Field{"impulse_received_abs", "N s"});
  visit(s.spindle_impulse, Field{"spindle_impulse", "N s"});
  visit(s.gravity_impulse, Field{"gravity_impulse", "N s"});
  visit(s.terrain_work, Field{"terrain_work", "J"});
  visit(s.rim_work, Field{"rim_work", "J"});
  visit(s.newton_iterations, Field{"newton_iterations"});
  visit(s.factorizations, Field{"factorizations"});
  visit(s.residual, Field{"residual"});
  visit(s.prompt, Field{"prompt", ""});
  visit(s.contact_tangent, Field{"contact_tangent", ""});
  visit(s.impulse_ahead, Field{"impulse_ahead", "N s"});
  visit(s.ledger, Field{"ledger", "N s"});
  visit(s.ledger_largest, Field{"ledger_largest", "N s"});
}

/// tire k → rig, from a prompt tire, after its report, which has the same kind.
struct PromptWrench {
  static constexpr MessageKind kKind = MessageKind::spindle_report;
  StepHeader header;
  Wrench wrench;  // as SpindleReport::wrench, over the interval that begins
};
void visit_fields(FieldsOf<PromptWrench> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.wrench, Field{"wrench", ""});
}

struct SurfaceMotion {
  static constexpr MessageKind kKind = MessageKind::surface_motion;
  StepHeader header;
  SurfaceState surface;
  Order order = Order::go_on;      // due now; the terrain gets it through the tires
  std::int64_t ends_at = kNotYet;  // as the rig sent it, at least n + 1
};
void visit_fields(FieldsOf<SurfaceMotion> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.surface, Field{"surface", ""});
  visit(s.order, Field{"order", ""});
  visit(s.ends_at, Field{"ends_at"});
}

/// terrain → tire k.
struct TerrainForces {
  static constexpr MessageKind kKind = MessageKind::terrain_forces;
  StepHeader header;
  NodalForces forces;
};
void visit_fields(FieldsOf<TerrainForces> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.forces, Field{"forces", ""});
}

/// terrain → rig.
struct TerrainReport {
  static constexpr MessageKind kKind = MessageKind::terrain_report;
  StepHeader header;
  TerrainState state;
  std::vector<ContactSums> contact;  // one per tire
};
void visit_fields(FieldsOf<TerrainReport> auto& s, auto&& visit) {
  visit(s.header, Field{"header", ""});
  visit(s.state, Field{"state", ""});
  visit(s.contact, Field{"contact", ""});
}

/// rig → every node, before the handshake of a program's run: the folder for the results.
struct RunFolder {
  static constexpr MessageKind kKind = MessageKind::run_folder;
  std::string path;
};
void visit_fields(FieldsOf<RunFolder> auto& s, auto&& visit) { visit(s.path, Field{"path", ""}); }

/// Every node → rig, once it has written its part of a checkpoint or failed to write it.
struct CheckpointPart {
  static constexpr MessageKind kKind = MessageKind::checkpoint_part;
  std::int64_t step = 0;
  std::string file;      // name in the checkpoint's folder
  std::string checksum;  // of the state in the file
  std::string problem;   // why the part could not be written; empty: it was written
};
void visit_fields(FieldsOf<CheckpointPart> auto& s, auto&& visit) {
  visit(s.step, Field{"step"});
  visit(s.file, Field{"file", ""});
  visit(s.checksum, Field{"checksum", ""});
  visit(s.problem, Field{"problem", ""});
}

/// Every node → rig at the end.
struct FinalReport {
  static constexpr MessageKind kKind = MessageKind::final_report;
  Address self;
  std::uint64_t state_hash = 0;
  // Times of the stepping loop, s: processor time, and the wall time spent on computing, communicating and waiting.
  double cpu_s = 0.0, compute_s = 0.0, communicate_s = 0.0, wait_s = 0.0;
  std::int32_t threads = 1;
  std::int64_t grains = 0;                  // of this rank of a terrain
  std::int64_t grains_begin = 0;            // the same number when the run began; 0: not known
  std::vector<double> profile;              // StepProfile::times(); empty unless the run asks for it
  HeightField height_before, height_after;  // terrain
};
void visit_fields(FieldsOf<FinalReport> auto& s, auto&& visit) {
  visit(s.self, Field{"self", ""});
  visit(s.state_hash, Field{"state_hash"});
  visit(s.cpu_s, Field{"cpu_s", "s"});
  visit(s.compute_s, Field{"compute_s", "s"});
  visit(s.communicate_s, Field{"communicate_s", "s"});
  visit(s.wait_s, Field{"wait_s", "s"});
  visit(s.threads, Field{"threads"});
  visit(s.grains, Field{"grains"});
  visit(s.grains_begin, Field{"grains_begin"});
  visit(s.profile, Field{"profile", "s"});
  visit(s.height_before, Field{"height_before", ""});
  visit(s.height_after, Field{"height_after", ""});
}

}  // namespace furrow
