#include "nodes/series.hpp"

#include <cerrno>
#include <cstring>

#include <fmt/format.h>

#include "protocol/error.hpp"

namespace furrow {
namespace {

using R = SeriesRow;

constexpr SeriesColumn kColumns[] = {
    {"time_s", [](const R& r) { return r.time; }},
    {"slip", [](const R& r) { return r.slip; }},
    {"drawbar_pull_N", [](const R& r) { return r.drawbar_pull; }},
    {"sinkage_m", [](const R& r) { return r.sinkage; }},
    {"vertical_force_N", [](const R& r) { return r.force.z(); }},
    {"force_x_N", [](const R& r) { return r.force.x(); }},
    {"force_y_N", [](const R& r) { return r.force.y(); }},
    {"force_z_N", [](const R& r) { return r.force.z(); }},
    {"spindle_torque_Nm", [](const R& r) { return r.drive_torque; }},
    {"impulse_sent_Ns", [](const R& r) { return r.impulse_sent.z(); }},
    {"impulse_received_Ns", [](const R& r) { return r.impulse_received.z(); }},
    {"energy_error_J", [](const R& r) { return r.energy_error; }},
    {"drawbar_pull_raw_N", [](const R& r) { return r.drawbar_pull_raw; }},
    {"speed_m_per_s", [](const R& r) { return r.speed; }},
    {"spin_rad_per_s", [](const R& r) { return r.spin; }},
    {"position_m", [](const R& r) { return r.position; }},
    {"axle_height_m", [](const R& r) { return r.axle_height; }},
    {"lowest_point_m", [](const R& r) { return r.lowest_point; }},
    {"sinkage_kinematic_m", [](const R& r) { return r.sinkage_kinematic; }},
    {"tractive_effort_N", [](const R& r) { return r.tractive_effort; }},
    {"terrain_resistance_N", [](const R& r) { return -r.normal_force_travel; }},
    {"lateral_force_N", [](const R& r) { return r.lateral_force; }},
    {"aligning_moment_Nm", [](const R& r) { return r.aligning_moment; }},
    {"spindle_force_x_N", [](const R& r) { return r.spindle_force.x(); }},
    {"spindle_force_y_N", [](const R& r) { return r.spindle_force.y(); }},
    {"spindle_force_z_N", [](const R& r) { return r.spindle_force.z(); }},
    {"spindle_moment_x_Nm", [](const R& r) { return r.spindle_moment.x(); }},
    {"spindle_moment_y_Nm", [](const R& r) { return r.spindle_moment.y(); }},
    {"spindle_moment_z_Nm", [](const R& r) { return r.spindle_moment.z(); }},
    {"vertical_momentum_kg_m_per_s", [](const R& r) { return r.vertical_momentum; }},
    {"tire_momentum_travel_kg_m_per_s", [](const R& r) { return r.momentum_x_tire; }},
    {"damper_force_N", [](const R& r) { return r.damper_force; }},
    {"impulse_sent_x_Ns", [](const R& r) { return r.impulse_sent.x(); }},
    {"impulse_sent_y_Ns", [](const R& r) { return r.impulse_sent.y(); }},
    {"impulse_received_x_Ns", [](const R& r) { return r.impulse_received.x(); }},
    {"impulse_received_y_Ns", [](const R& r) { return r.impulse_received.y(); }},
    {"energy_error_abs_J", [](const R& r) { return r.energy_error_abs; }},
    {"rim_energy_error_J", [](const R& r) { return r.rim_energy_error; }},
    {"rim_work_J", [](const R& r) { return r.rim_work; }},
    {"spindle_work_J", [](const R& r) { return r.spindle_work; }},
    {"pull_work_J", [](const R& r) { return r.pull_work; }},
    {"soil_dissipation_J", [](const R& r) { return r.soil_dissipation; }},
    {"tire_dissipation_J", [](const R& r) { return r.tire_dissipation; }},
    {"damper_dissipation_J", [](const R& r) { return r.damper_dissipation; }},
    {"terrain_kinetic_energy_J", [](const R& r) { return r.terrain_kinetic_energy; }},
    {"terrain_potential_energy_J", [](const R& r) { return r.terrain_potential_energy; }},
    {"terrain_elastic_energy_J", [](const R& r) { return r.terrain_elastic_energy; }},
    {"tire_energy_J", [](const R& r) { return r.tire_energy; }},
    {"carried_energy_J", [](const R& r) { return r.carried_energy; }},
    {"contacts_tire", [](const R& r) { return r.contacts_tire; }},
    {"contacts_terrain", [](const R& r) { return r.contacts_terrain; }},
    {"active_share", [](const R& r) { return r.active_share; }},
    {"newton_iterations", [](const R& r) { return r.newton_iterations; }},
    {"factorizations", [](const R& r) { return r.factorizations; }},
    {"transfer_force_residual", [](const R& r) { return r.transfer_force_residual; }},
    {"transfer_moment_residual", [](const R& r) { return r.transfer_moment_residual; }},
};

}  // namespace

std::span<const SeriesColumn> series_columns() { return kColumns; }

SeriesWriter::SeriesWriter(const std::filesystem::path& file)
    : file_(file), stream_(std::fopen(file.c_str(), "wb")) {
  check(stream_ != nullptr);
  std::string header;
  for (const SeriesColumn& column : kColumns)
    header += (header.empty() ? "" : ",") + std::string(column.name);
  header += '\n';
  check(std::fwrite(header.data(), 1, header.size(), stream_) == header.size());
}

SeriesWriter::~SeriesWriter() {
  if (stream_) std::fclose(stream_);
}

void SeriesWriter::check(bool ok) {
  if (!ok) throw io_error(file_.string(), std::string("cannot write: ") + std::strerror(errno));
}

void SeriesWriter::add(const SeriesRow& row) {
  std::string line;
  for (const SeriesColumn& column : kColumns)
    fmt::format_to(std::back_inserter(line), "{}{:.17g}", line.empty() ? "" : ",", column.value(row));
  line += '\n';
  check(std::fwrite(line.data(), 1, line.size(), stream_) == line.size());
}

void SeriesWriter::flush() { check(std::fflush(stream_) == 0); }

}  // namespace furrow
