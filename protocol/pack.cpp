// One list of fields per message struct serves both directions: visit_fields(stream, message).
#include <array>
#include <type_traits>
#include <utility>

#include "protocol/byte_stream.hpp"
#include "protocol/transport.hpp"

namespace furrow {

// Not in an unnamed namespace: the streams find visit_fields for vectors of messages by their argument's namespace.
template <class Stream, class... Fields>
void each(Stream& stream, Fields&... fields) {
  (stream(fields), ...);
}

// M is the message type or its const; the stream decides the direction.
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, StepHeader>
void visit_fields(Stream& s, M& m) { each(s, m.step, m.time); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, Wrench>
void visit_fields(Stream& s, M& m) { each(s, m.force, m.moment); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, RimState>
void visit_fields(Stream& s, M& m) { each(s, m.position, m.orientation, m.velocity, m.angular_velocity); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, NodeCard>
void visit_fields(Stream& s, M& m) {
  each(s, m.protocol_version, m.self.role, m.self.index, m.node_kind, m.scenario_digest, m.step, m.steps,
       m.from_step, m.substeps, m.wheel_count, m.tire_count, m.threads, m.pid, m.host, m.tire_mass.mass,
       m.tire_mass.inertia, m.tire_radius, m.tire_width, m.tire_reach, m.size);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, SurfaceSetup>
void visit_fields(Stream& s, M& m) {
  auto& c = m.material;
  each(s, m.mesh.vertex_count, m.mesh.triangles, c.young_modulus, c.poisson_ratio, c.friction, c.restitution,
       c.normal_stiffness, c.normal_damping, c.cohesion, c.area_density);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, TerrainSetup>
void visit_fields(Stream& s, M& m) {
  each(s, m.top_height, m.mean_height, m.floor_height, m.settle_wall_s, m.grains);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, RimMotion>
void visit_fields(Stream& s, M& m) {
  visit_fields(s, m.header);
  visit_fields(s, m.rim);
  s(m.order);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, SpindleReport>
void visit_fields(Stream& s, M& m) {
  visit_fields(s, m.header);
  visit_fields(s, m.wrench);
  visit_fields(s, m.spindle);
  each(s, m.lowest_point, m.momentum, m.impulse_received, m.impulse_received_abs, m.terrain_work, m.rim_work,
       m.dissipation, m.kinetic_energy, m.strain_energy, m.newton_iterations, m.factorizations, m.residual,
       m.contact_tangent, m.impulse_ahead, m.ledger, m.ledger_largest);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, SurfaceMotion>
void visit_fields(Stream& s, M& m) {
  visit_fields(s, m.header);
  each(s, m.surface.position, m.surface.velocity, m.order);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, ContactTangent>
void visit_fields(Stream& s, M& m) { each(s, m.stiffness, m.damping, m.position, m.velocity); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, TerrainForces>
void visit_fields(Stream& s, M& m) {
  visit_fields(s, m.header);
  each(s, m.forces.vertex, m.forces.force, m.forces.tangent);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, ContactSums>
void visit_fields(Stream& s, M& m) {
  each(s, m.force, m.normal, m.tangential, m.moment, m.transfer_force_residual, m.transfer_moment_residual,
       m.work, m.contacts);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, TerrainReport>
void visit_fields(Stream& s, M& m) {
  visit_fields(s, m.header);
  auto& t = m.state;
  each(s, t.kinetic_energy, t.potential_energy, t.elastic_energy, t.dissipation, t.energy_removed, t.momentum,
       t.wall_impulse, t.surface_impulse, t.floor_force, t.contacts, t.active, t.list_rebuilds, m.contact);
}
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, HeightField>
void visit_fields(Stream& s, M& m) { each(s, m.x0, m.y0, m.cell, m.nx, m.ny, m.height); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, RunFolder>
void visit_fields(Stream& s, M& m) { s(m.path); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, CheckpointPart>
void visit_fields(Stream& s, M& m) { each(s, m.step, m.file, m.checksum, m.problem); }
template <class Stream, class M>
requires std::is_same_v<std::remove_const_t<M>, FinalReport>
void visit_fields(Stream& s, M& m) {
  each(s, m.self.role, m.self.index, m.state_hash, m.cpu_s, m.compute_s, m.wait_s, m.threads, m.profile);
  visit_fields(s, m.height_before);
  visit_fields(s, m.height_after);
}

template <class M>
std::vector<std::byte> pack(const M& message) {
  ByteWriter writer;
  visit_fields(writer, message);
  return writer.take();
}

template <class M>
M unpack(const std::vector<std::byte>& payload) {
  M message;
  ByteReader reader(payload);
  visit_fields(reader, message);
  reader.finish();
  return message;
}

#define FURROW_MESSAGE(M)                            \
  template std::vector<std::byte> pack<M>(const M&); \
  template M unpack<M>(const std::vector<std::byte>&);
FURROW_MESSAGE(NodeCard)
FURROW_MESSAGE(SurfaceSetup)
FURROW_MESSAGE(TerrainSetup)
FURROW_MESSAGE(RimMotion)
FURROW_MESSAGE(SpindleReport)
FURROW_MESSAGE(SurfaceMotion)
FURROW_MESSAGE(TerrainForces)
FURROW_MESSAGE(TerrainReport)
FURROW_MESSAGE(FinalReport)
FURROW_MESSAGE(CheckpointPart)
FURROW_MESSAGE(RunFolder)
#undef FURROW_MESSAGE

}  // namespace furrow
