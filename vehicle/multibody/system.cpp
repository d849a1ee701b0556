// Building, queries, saving; the stepping is in system_step.cpp.
#include "vehicle/multibody/system.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "protocol/core/archive_fields.hpp"
#include "protocol/core/assert.hpp"
#include "protocol/core/error.hpp"
#include "protocol/core/saved_number.hpp"

namespace furrow::vehicle {
namespace {

constexpr std::int64_t kMostSteps = std::int64_t{1} << 53;  // largest count in a double

const Vec3 kGroundPosition = Vec3::Zero();
const Mat3 kGroundAxes = Mat3::Identity();

template <class Acting>  // motors or force elements
std::vector<double> last_forces(const std::vector<Acting>& all) {
  std::vector<double> forces;
  for (const Acting& one : all) forces.push_back(one.last_force);
  return forces;
}

template <class Acting>
void take_last_forces(const std::vector<double>& forces, std::vector<Acting>& all) {
  for (std::size_t k = 0; k < all.size(); ++k) all[k].last_force = forces[k];
}

}  // namespace

int System::add_body(const std::string& name, double mass, const Mat3& inertia, const BodyState& state) {
  Body body;
  body.name = name;
  bodies_.push_back(body);
  const int index = body_count() - 1;
  set_mass_properties(index, mass, inertia);
  set_state(index, state);
  prepared_ = false;
  return index;
}

void System::set_mass_properties(int index, double mass, const Mat3& inertia) {
  FURROW_ASSERT(in_range(index, bodies_.size()), index, bodies_.size());
  Body& body = bodies_[index];
  const bool symmetric = (inertia - inertia.transpose()).norm() <= 1e-12 * inertia.norm();
  if (!(mass > 0.0) || !std::isfinite(mass) || !symmetric || inertia.llt().info() != Eigen::Success)
    throw physics_error("body '" + body.name + "': mass and inertia must be positive");
  body.mass = mass;
  body.inertia = inertia;
  body.inertia_inverse = inertia.inverse();
  set_state(index, body.state);
}

int System::add_joint(JointKind kind, const std::string& name, int a, int b, const JointPlace& place) {
  FURROW_ASSERT(a >= kGround && a < body_count() && b >= kGround && b < body_count(), name, a, b, body_count());
  FURROW_ASSERT(a != b, name, a);
  Joint joint;
  joint.name = name;
  joint.kind = kind;
  joint.a = a;
  joint.b = b;
  joint.first_row = static_cast<int>(constraint_rows_.size());
  const std::vector<Row> rows = make_joint_rows(joint, pose(a), pose(b), place);
  joint.row_count = static_cast<int>(rows.size());
  constraint_rows_.insert(constraint_rows_.end(), rows.begin(), rows.end());
  row_motor_.resize(constraint_rows_.size(), -1);
  joints_.push_back(joint);
  reactions_.emplace_back();
  prepared_ = false;
  return static_cast<int>(joints_.size()) - 1;
}

int System::add_motor(const std::string& name, int joint, MotionFunction motion) {
  FURROW_ASSERT(in_range(joint, joints_.size()), name, joint, joints_.size());
  FURROW_ASSERT(motion != nullptr, name);
  Motor motor;
  motor.name = name;
  motor.joint = joint;
  motor.row = static_cast<int>(constraint_rows_.size());
  motor.motion = std::move(motion);
  constraint_rows_.push_back(free_coordinate(joints_[joint]));
  row_motor_.push_back(static_cast<int>(motors_.size()));
  motors_.push_back(std::move(motor));
  prepared_ = false;
  return static_cast<int>(motors_.size()) - 1;
}

int System::add_joint_element(const std::string& name, int joint, ForceLaw law) {
  FURROW_ASSERT(in_range(joint, joints_.size()), name, joint, joints_.size());
  FURROW_ASSERT(law != nullptr, name);
  elements_.push_back({name, free_coordinate(joints_[joint]), std::move(law), 0.0});
  prepared_ = false;
  return static_cast<int>(elements_.size()) - 1;
}

int System::add_line_element(const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b,
                             ForceLaw law) {
  FURROW_ASSERT(law != nullptr, name);
  const Row row = line_row(name, a, b, point_a, point_b);
  elements_.push_back({name, row, std::move(law), 0.0});
  prepared_ = false;
  return static_cast<int>(elements_.size()) - 1;
}

Row System::line_row(const std::string& name, int a, int b, const Vec3& point_a, const Vec3& point_b) const {
  FURROW_ASSERT(a >= kGround && a < body_count() && b >= kGround && b < body_count(), name, a, b, body_count());
  FURROW_ASSERT(a != b, name, a);
  FURROW_ASSERT((point_b - point_a).norm() > 0.0, name);
  Row row;
  row.kind = RowKind::distance;
  row.a = a;
  row.b = b;
  row.point_a = pose(a).R->transpose() * (point_a - *pose(a).position);
  row.point_b = pose(b).R->transpose() * (point_b - *pose(b).position);
  return row;
}

void System::set_state(int index, const BodyState& state) {
  FURROW_ASSERT(in_range(index, bodies_.size()), index, bodies_.size());
  FURROW_ASSERT(state.orientation.norm() > 0.0, bodies_[index].name);
  Body& body = bodies_[index];
  body.state = state;
  body.state.orientation.normalize();
  body.refresh();
  body.angular_momentum = body.R * (body.inertia * (body.R.transpose() * state.angular_velocity));
}

void System::set_load(int index, const Vec3& force, const Vec3& moment) {
  FURROW_ASSERT(in_range(index, bodies_.size()), index, bodies_.size());
  bodies_[index].force = force;
  bodies_[index].moment = moment;
}

Pose System::pose(int body) const {
  FURROW_ASSERT(body >= kGround && body < body_count(), body, body_count());
  if (body == kGround) return {&kGroundPosition, &kGroundAxes};
  return {&bodies_[body].state.position, &bodies_[body].R};
}

Motion System::target(int row, double time) const {
  FURROW_ASSERT(in_range(row, constraint_rows_.size()), row, constraint_rows_.size());
  const double reference = constraint_rows_[row].reference;
  const int motor = row_motor_[row];
  if (motor < 0) return {reference, 0.0};
  const Motion motion = motors_[motor].motion(time);
  return {reference + motion.value, motion.rate};
}

Motion System::coordinate(int index) const {
  FURROW_ASSERT(in_range(index, joints_.size()), index, joints_.size());
  const Row row = free_coordinate(joints_[index]);
  const Pose A = pose(row.a), B = pose(row.b);
  return {row_value(row, A, B), row_rate(row, row_jacobian(row, A, B))};
}

double System::max_violation() const {
  double largest = 0.0;
  for (std::size_t i = 0; i < constraint_rows_.size(); ++i) {
    const Row& row = constraint_rows_[i];
    const double value = row_value(row, pose(row.a), pose(row.b));
    largest = std::max(largest, std::abs(row_difference(row, value, target(static_cast<int>(i), time()).value)));
  }
  return largest;
}

double System::kinetic_energy() const {
  double energy = 0.0;
  for (const Body& body : bodies_)
    energy += 0.5 * body.mass * body.state.velocity.squaredNorm() +
              0.5 * body.state.angular_velocity.dot(body.angular_momentum);
  if (!rates_.empty()) energy += rates_.kinetic_energy();
  return energy;
}

double System::gravity_energy() const {
  double energy = 0.0;
  for (const Body& body : bodies_) energy -= body.mass * gravity_.dot(body.state.position);
  return energy;
}

Vec3 System::momentum() const {
  Vec3 sum = Vec3::Zero();
  for (const Body& body : bodies_) sum += body.mass * body.state.velocity;
  return sum;
}

Vec3 System::angular_momentum(const Vec3& about) const {
  Vec3 sum = Vec3::Zero();
  for (const Body& body : bodies_)
    sum += body.angular_momentum + body.mass * (body.state.position - about).cross(body.state.velocity);
  if (!rates_.empty()) sum += rates_.angular_momentum(bodies_);
  return sum;
}

void System::save(Archive& archive) const {
  save_value(archive, "bodies", bodies_);
  save_value(archive, "reactions", reactions_);
  archive.put("motor_forces", last_forces(motors_));
  archive.put("element_forces", last_forces(elements_));
  archive.put("start_time", start_time_);
  archive.put("step", step_);
  archive.put("count", count_);
  archive.put("redundant", static_cast<std::int64_t>(redundant_count_));
  save_drives(archive);
}

void System::restore(const Archive& archive) {
  ColumnReader<Body> bodies(archive, "bodies", bodies_.size());
  for (Body& body : bodies_) {
    bodies.take(body);
    body.refresh();
  }
  ColumnReader<Reaction> reactions(archive, "reactions", reactions_.size());
  for (Reaction& reaction : reactions_) reactions.take(reaction);
  take_last_forces(archive.get<double>("motor_forces", motors_.size()), motors_);
  take_last_forces(archive.get<double>("element_forces", elements_.size()), elements_);
  start_time_ = saved_finite(archive, "start_time");
  step_ = saved_finite(archive, "step");
  count_ = archive.get_int("count");
  if (step_ < 0.0 || count_ < 0 || count_ > kMostSteps)
    throw Error(ExitCode::io, "saved state of the multibody system holds step " + std::to_string(count_) + " of " +
                                  std::to_string(step_) + " s: it is damaged");
  prepare();
  restore_drives(archive);
  update_jacobians();
  if (const Outcome outcome = factorize(false); !outcome.ok) throw physics_error(outcome, "restored multibody system");
  find_redundancy();
  redundant_count_ = static_cast<int>(archive.get_int("redundant"));
}

std::string System::row_name(int row) const {
  FURROW_ASSERT(in_range(row, first_rate() + rate_count()), row, constraint_rows_.size(), elements_.size());
  if (row >= first_rate()) return rates_.row(row - first_rate()).name;
  if (row >= static_cast<int>(constraint_rows_.size())) return elements_[row - constraint_rows_.size()].name;
  if (row_motor_[row] >= 0) return motors_[row_motor_[row]].name;
  for (const Joint& joint : joints_)
    if (row >= joint.first_row && row < joint.first_row + joint.row_count) return joint.name;
  return "?";
}

}  // namespace furrow::vehicle
