#include "nodes/output/series.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include <fmt/format.h>

#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"

namespace furrow::output {
namespace {

using R = SeriesRow;

constexpr SeriesColumn kColumns[] = {
    {"time_s", 1.0, [](R& r) { return &r.time; }},
    {"slip", 1.0, [](R& r) { return &r.slip; }},
    {"drawbar_pull_N", 1.0, [](R& r) { return &r.drawbar_pull; }},
    {"sinkage_m", 1.0, [](R& r) { return &r.sinkage; }},
    {"vertical_force_N", 1.0, [](R& r) { return &r.force.z(); }},
    {"force_x_N", 1.0, [](R& r) { return &r.force.x(); }},
    {"force_y_N", 1.0, [](R& r) { return &r.force.y(); }},
    {"force_z_N", 1.0, [](R& r) { return &r.force.z(); }},
    {"spindle_torque_Nm", 1.0, [](R& r) { return &r.drive_torque; }},
    {"impulse_sent_Ns", 1.0, [](R& r) { return &r.impulse_sent.z(); }},
    {"impulse_received_Ns", 1.0, [](R& r) { return &r.impulse_received.z(); }},
    {"energy_error_J", 1.0, [](R& r) { return &r.energy_error; }},
    {"drawbar_pull_raw_N", 1.0, [](R& r) { return &r.drawbar_pull_raw; }},
    {"speed_m_per_s", 1.0, [](R& r) { return &r.speed; }},
    {"spin_rad_per_s", 1.0, [](R& r) { return &r.spin; }},
    {"position_m", 1.0, [](R& r) { return &r.position; }},
    {"axle_height_m", 1.0, [](R& r) { return &r.axle_height; }},
    {"lowest_point_m", 1.0, [](R& r) { return &r.lowest_point; }},
    {"sinkage_kinematic_m", 1.0, [](R& r) { return &r.sinkage_kinematic; }},
    {"tractive_effort_N", 1.0, [](R& r) { return &r.tractive_effort; }},
    {"terrain_resistance_N", -1.0, [](R& r) { return &r.normal_force_travel; }},
    {"lateral_force_N", 1.0, [](R& r) { return &r.lateral_force; }},
    {"aligning_moment_Nm", 1.0, [](R& r) { return &r.aligning_moment; }},
    {"spindle_force_x_N", 1.0, [](R& r) { return &r.spindle_force.x(); }},
    {"spindle_force_y_N", 1.0, [](R& r) { return &r.spindle_force.y(); }},
    {"spindle_force_z_N", 1.0, [](R& r) { return &r.spindle_force.z(); }},
    {"spindle_moment_x_Nm", 1.0, [](R& r) { return &r.spindle_moment.x(); }},
    {"spindle_moment_y_Nm", 1.0, [](R& r) { return &r.spindle_moment.y(); }},
    {"spindle_moment_z_Nm", 1.0, [](R& r) { return &r.spindle_moment.z(); }},
    {"vertical_momentum_kg_m_per_s", 1.0, [](R& r) { return &r.vertical_momentum; }},
    {"tire_momentum_travel_kg_m_per_s", 1.0, [](R& r) { return &r.momentum_x_tire; }},
    {"damper_force_N", 1.0, [](R& r) { return &r.damper_force; }},
    {"impulse_sent_x_Ns", 1.0, [](R& r) { return &r.impulse_sent.x(); }},
    {"impulse_sent_y_Ns", 1.0, [](R& r) { return &r.impulse_sent.y(); }},
    {"impulse_received_x_Ns", 1.0, [](R& r) { return &r.impulse_received.x(); }},
    {"impulse_received_y_Ns", 1.0, [](R& r) { return &r.impulse_received.y(); }},
    {"energy_error_abs_J", 1.0, [](R& r) { return &r.energy_error_abs; }},
    {"rim_energy_error_J", 1.0, [](R& r) { return &r.rim_energy_error; }},
    {"rim_work_J", 1.0, [](R& r) { return &r.rim_work; }},
    {"spindle_work_J", 1.0, [](R& r) { return &r.spindle_work; }},
    {"pull_work_J", 1.0, [](R& r) { return &r.pull_work; }},
    {"soil_dissipation_J", 1.0, [](R& r) { return &r.soil_dissipation; }},
    {"tire_dissipation_J", 1.0, [](R& r) { return &r.tire_dissipation; }},
    {"damper_dissipation_J", 1.0, [](R& r) { return &r.damper_dissipation; }},
    {"terrain_kinetic_energy_J", 1.0, [](R& r) { return &r.terrain_kinetic_energy; }},
    {"terrain_potential_energy_J", 1.0, [](R& r) { return &r.terrain_potential_energy; }},
    {"terrain_elastic_energy_J", 1.0, [](R& r) { return &r.terrain_elastic_energy; }},
    {"tire_energy_J", 1.0, [](R& r) { return &r.tire_energy; }},
    {"carried_energy_J", 1.0, [](R& r) { return &r.carried_energy; }},
    {"contacts_tire", 1.0, [](R& r) { return &r.contacts_tire; }},
    {"contacts_terrain", 1.0, [](R& r) { return &r.contacts_terrain; }},
    {"active_share", 1.0, [](R& r) { return &r.active_share; }},
    {"newton_iterations", 1.0, [](R& r) { return &r.newton_iterations; }},
    {"factorizations", 1.0, [](R& r) { return &r.factorizations; }},
    {"transfer_force_residual", 1.0, [](R& r) { return &r.transfer_force_residual; }},
    {"transfer_moment_residual", 1.0, [](R& r) { return &r.transfer_moment_residual; }},
    {"iso_force_x_N", 1.0, [](R& r) { return &r.iso_force.x(); }},
    {"iso_force_y_N", 1.0, [](R& r) { return &r.iso_force.y(); }},
    {"iso_force_z_N", 1.0, [](R& r) { return &r.iso_force.z(); }},
    {"iso_moment_x_Nm", 1.0, [](R& r) { return &r.iso_moment.x(); }},
    {"iso_moment_y_Nm", 1.0, [](R& r) { return &r.iso_moment.y(); }},
    {"iso_moment_z_Nm", 1.0, [](R& r) { return &r.iso_moment.z(); }},
    {"slip_angle_rad", 1.0, [](R& r) { return &r.slip_angle; }},
    {"camber_angle_rad", 1.0, [](R& r) { return &r.camber_angle; }},
    {"loaded_radius_m", 1.0, [](R& r) { return &r.loaded_radius; }},
    {"effective_rolling_radius_m", 1.0, [](R& r) { return &r.effective_rolling_radius; }},
    {"tractive_efficiency", 1.0, [](R& r) { return &r.tractive_efficiency; }},
    {"motion_resistance_coefficient", 1.0, [](R& r) { return &r.motion_resistance; }},
};

std::string header_line() {
  std::string header;
  for (const SeriesColumn& column : kColumns)
    header += (header.empty() ? "" : ",") + std::string(column.name);
  return header + '\n';
}

/// The line at `text`, which ends in a line feed; null when it is none.
const char* read_line(const char* text, SeriesRow& row) {
  FURROW_ASSERT(text != nullptr, kColumns[0].name);
  for (const SeriesColumn& column : kColumns) {
    char* end = nullptr;
    const double value = std::strtod(text, &end);
    const bool last = &column == std::end(kColumns) - 1;
    if (end == text || *end != (last ? '\n' : ',')) return nullptr;
    *column.field(row) = column.sign * value;
    text = end + 1;
  }
  return text;
}

}  // namespace

std::span<const SeriesColumn> series_columns() { return kColumns; }

SeriesWriter::SeriesWriter(const std::filesystem::path& file)
    : file_(file), stream_(std::fopen(file.c_str(), "wb")) {
  check(stream_ != nullptr);
  write(header_line());
}

SeriesWriter::SeriesWriter(const std::filesystem::path& file, const checkpoint::SeriesMark& mark,
                           std::vector<SeriesRow>& rows)
    : file_(file), stream_(std::fopen(file.c_str(), "rb+")) {
  FURROW_ASSERT(mark.bytes >= 0 && mark.lines >= 0, mark.bytes, mark.lines);
  if (!stream_)
    throw io_error(file_.string(), std::string("cannot be opened to go on with it: ") + std::strerror(errno));
  std::string text(static_cast<std::size_t>(mark.bytes), '\0');
  text.resize(std::fread(text.data(), 1, text.size(), stream_.get()));
  hash_.add(text);
  const std::string header = header_line();
  if (hash_.hex() != mark.checksum || !text.starts_with(header))
    throw io_error(file_.string(), "does not hold the lines that the checkpoint knows: it was changed since");
  const char* at = text.c_str() + header.size();
  for (std::int64_t line = 0; line < mark.lines; ++line) {
    at = read_line(at, rows.emplace_back());
    if (!at) throw io_error(file_.string(), fmt::format("line {} cannot be read", line + 2));
  }
  bytes_ = mark.bytes;
  lines_ = mark.lines;
  check(ftruncate(fileno(stream_.get()), bytes_) == 0);
  check(std::fseek(stream_.get(), 0, SEEK_END) == 0);
}

void SeriesWriter::check(bool ok) {
  if (!ok) throw io_error(file_.string(), std::string("cannot write: ") + std::strerror(errno));
}

void SeriesWriter::write(const std::string& text) {
  FURROW_ASSERT(!text.empty() && text.back() == '\n', text.size());
  check(std::fwrite(text.data(), 1, text.size(), stream_.get()) == text.size());
  hash_.add(text);
  bytes_ += static_cast<std::int64_t>(text.size());
}

void SeriesWriter::add(const SeriesRow& row) {
  std::string line;
  for (const SeriesColumn& column : kColumns)
    fmt::format_to(std::back_inserter(line), "{}{:.17g}", line.empty() ? "" : ",", column.value(row));
  line += '\n';
  write(line);
  ++lines_;
}

void SeriesWriter::flush() { check(std::fflush(stream_.get()) == 0); }

checkpoint::SeriesMark SeriesWriter::mark() {
  flush();
  check(fsync(fileno(stream_.get())) == 0);
  return {bytes_, lines_, hash_.hex()};
}

}  // namespace furrow::output
