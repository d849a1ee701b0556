// The static trim: axle loads against hand statics, the drawn height, modes against closed forms.
#include "vehicle/analysis/trim.hpp"

#include <algorithm>

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>
#include <numbers>
#include <set>

#include "protocol/core/constants.hpp"
#include "protocol/core/error.hpp"
#include "tests/vehicle/shipped.hpp"
#include "tests/verification/record.hpp"
#include "vehicle/analysis/kinematics.hpp"

using namespace furrow;
using namespace furrow::testing;
using vehicle::TireCurve, vehicle::Trim, vehicle::Vehicle;

namespace {

std::vector<TireCurve> linear_tires(int count, double radius, double stiffness) {
  const TireCurve tire{radius, [stiffness](double d) { return stiffness * std::max(0.0, d); }};
  return std::vector(count, tire);
}

const vehicle::TrimMode& mode(const Trim& trim, const std::string& name) {
  for (const vehicle::TrimMode& one : trim.modes)
    if (one.name == name) return one;
  ADD_FAILURE() << "there is no mode " << name;
  return trim.modes.front();
}

/// Centre of mass of a vehicle as it is now.
Vec3 center_of_mass(const Vehicle& car) {
  Vec3 sum = Vec3::Zero();
  for (int i = 0; i < car.system().body_count(); ++i)
    sum += car.system().body(i).mass * car.system().body(i).state.position;
  return sum / car.mass();
}

/// Of masses coupled by a stiffness, rising, rad²/s².
Eigen::VectorXd squared_frequencies(const Eigen::MatrixXd& stiffness, const Eigen::VectorXd& masses) {
  const Eigen::VectorXd scale = masses.cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale.asDiagonal() * stiffness * scale.asDiagonal();
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(scaled, Eigen::EigenvaluesOnly).eigenvalues();
}

double hertz(double omega_squared) { return std::sqrt(omega_squared) / (2.0 * std::numbers::pi); }

}  // namespace

TEST(Trim, hmmwv_stands_at_the_drawn_height_with_the_axle_loads_of_hand_statics) {
  for (const char* name : {"hmmwv.json", "hmmwv_tr.json"}) {
    Vehicle car(shipped(name));
    const Trim trim = vehicle::trim(car, linear_tires(4, 0.4673, 5e5));
    for (const vehicle::WheelTrim& wheel : trim.wheels)
      EXPECT_NEAR(wheel.travel, 0.0, 1e-3) << name << " " << wheel.name;
    // By hand, from the drawn points: Σ m x over what is not symmetric about an axle's origin, mm and kg.
    const double steering = 3.681 * (1244.98 + 129.0 * std::cos(18.5 * std::numbers::pi / 180.0)) +
                            1.605 * (1244.98 + 64.5 * std::cos(18.5 * std::numbers::pi / 180.0));
    const double front =
        2.0 * ((14.705 + 18.8 + 19.45) * (1688.965 - 40.0) + 5.813 * (1688.965 - 106.0) + 23.965 * 1688.965);
    const double rear =
        2.0 * ((14.705 + 18.8 + 19.45) * (-1688.965 + 36.0) + 5.813 * (-1688.965 + 124.0) - 23.965 * 1688.965);
    const double mass = 2422.739;
    const double x = (2086.52 * 56.0 + steering + front + rear) / mass;
    const double by_hand = mass * kStandardGravity * (x + 1652.965) / 3301.93;
    verification::verify(std::string(name) + " at rest", "load of the front axle, N", trim.axle_loads[0], by_hand, 2e-3,
                         "hand statics of the drawn points");
    // In the posture itself the sums are exact.
    EXPECT_NEAR(trim.axle_loads[0] + trim.axle_loads[1], car.mass() * kStandardGravity, 1e-6);
    const double xf = car.rim(0).position.x(), xr = car.rim(2).position.x();
    EXPECT_NEAR(trim.axle_loads[0], car.mass() * kStandardGravity * (center_of_mass(car).x() - xr) / (xf - xr), 0.5)
        << name;
    EXPECT_NEAR(trim.wheels[0].load, trim.wheels[1].load, 3.0) << name;  // the Pitman arm is on the left
    EXPECT_NEAR(trim.roll, 0.0, 1e-3);
    EXPECT_LT(std::abs(trim.pitch), 2e-3);
  }
}

TEST(Trim, struts_know_their_stops_and_the_vehicle_stays_where_it_was_put) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  spec.driveline = {};  // an idling engine would shake it
  Vehicle car(spec);
  const Trim trim = vehicle::trim(car, linear_tires(4, 0.4673, 5e5), 0.3);
  for (const vehicle::WheelTrim& wheel : trim.wheels) {
    ASSERT_TRUE(wheel.spring && wheel.shock) << wheel.name;
    EXPECT_NEAR(wheel.spring->length - 0.15, wheel.spring->to_shortest, 1e-12);
    EXPECT_GT(wheel.spring->to_longest, 0.02);
    EXPECT_GT(wheel.shock->to_shortest, 0.01);
    EXPECT_GT(wheel.spring->force, 5e3);
    EXPECT_NEAR(wheel.load, 5e5 * wheel.deflection, 1e-3);
  }
  EXPECT_NEAR(trim.wheels[0].height, car.rim(0).position.z() - 0.3, 1e-12);
  // It stays at rest: accelerations of the whole vehicle are zero with the trim's wheel loads.
  for (int k = 0; k < 4; ++k) {
    const Vec3 axle = car.rim(k).orientation * Vec3::UnitY();
    const Vec3 arm = (car.rim(k).position.z() - 0.3) / (1.0 - axle.z() * axle.z()) * (axle.z() * axle - Vec3::UnitZ());
    const Vec3 force(0, 0, trim.wheels[k].load);
    car.set_wrench(k, {force, arm.cross(force)});
  }
  vehicle::VehicleInputs inputs;
  inputs.brake = 1.0;
  car.set_inputs(inputs);
  const Vec3 before = car.origin();
  for (int i = 0; i < 100; ++i) ASSERT_TRUE(car.step(1e-3).ok);
  EXPECT_LT((car.origin() - before).norm(), 1e-7);
}

// The pull along a slope acts at the centre of mass and the holding forces at the tires' contacts: this moves load down
// the slope.
TEST(Trim, on_a_slope_axles_and_sides_carry_what_hand_statics_say) {
  vehicle::VehicleSpec spec = shipped("hmmwv.json");
  spec.driveline = {};
  for (const double heading : {0.0, 0.5 * std::numbers::pi}) {
    Vehicle car(spec);
    const double slope = 0.3;  // rad, up along x where the heading is 0
    const Vec3 gravity = kStandardGravity * Vec3(-std::sin(slope) * std::cos(heading),
                                                 std::sin(slope) * std::sin(heading), -std::cos(slope));
    const Trim trim = vehicle::trim(car, linear_tires(4, 0.4673, 5e5), 0.0, gravity);
    const Vec3 weight = car.mass() * gravity, centre = center_of_mass(car);
    Vec3 moment = centre.cross(weight);  // about the origin of the plane
    double load = 0.0;
    for (int k = 0; k < 4; ++k) {
      const Vec3 axle = car.rim(k).orientation * Vec3::UnitY();
      const Vec3 touches = car.rim(k).position +
                           car.rim(k).position.z() / (1.0 - axle.z() * axle.z()) * (axle.z() * axle - Vec3::UnitZ());
      moment += touches.cross(Vec3(0.0, 0.0, trim.wheels[k].load));
      load += trim.wheels[k].load;
    }
    EXPECT_NEAR(load, -weight.z(), 1e-6);
    EXPECT_NEAR(moment.x(), 0.0, 1e-5 * load) << heading;
    EXPECT_NEAR(moment.y(), 0.0, 1e-5 * load) << heading;
    EXPECT_GT(heading == 0.0 ? trim.axle_loads[1] - trim.axle_loads[0] : trim.wheels[0].load - trim.wheels[1].load,
              0.05 * load);
  }
}

// A chassis on four wheels in fixed bearings is one rigid body on four springs k at x = a, −b and y = ±s, whose centre
// of mass lies h above the wheels' centres and H above the ground:
//   heave and pitch  M = diag(m, J_y), K = [2(k + k), −2k(a − b); ., 2k(a² + b²) − W h]
//   roll 4 k s² − W H, since a leaning wheel moves down on its edge
TEST(Trim, modes_of_a_rigid_vehicle_on_four_springs_match_the_closed_form) {
  nlohmann::json text = shipped_text("rover.json");
  text.erase("driveline");
  text["axles"].erase(2);
  const double k = 2e4, a = 0.22, b = 0.30, s = 0.16, R = 0.058;
  for (nlohmann::json& axle : text["axles"]) {
    axle["suspension"] = {{"type", "fixed"}, {"spindle", axle["suspension"]["spindle"]}};
    axle["origin"] = {axle["name"] == "front" ? a : -b, 0.0, 0.0};
  }
  text["chassis"]["center_of_mass"] = {-0.5 * (b - a), 0.0, 0.10};
  Vehicle car(vehicle::read_vehicle(text, "car.json"));
  const Trim trim = vehicle::trim(car, linear_tires(4, R, k));
  const double m = car.mass(), W = m * kStandardGravity;
  const Vec3 centre = center_of_mass(car);
  Mat3 J = Mat3::Zero();
  for (int i = 0; i < car.system().body_count(); ++i) {
    const vehicle::Body& body = car.system().body(i);
    const Vec3 r = body.state.position - centre;
    J += body.R * body.inertia * body.R.transpose() +
         body.mass * (r.squaredNorm() * Mat3::Identity() - r * r.transpose());
  }
  // The chassis' centre of mass is held in x and y, so the whole vehicle's moves sideways as it turns.
  const double arm = centre.z() - car.system().body(car.chassis()).state.position.z();
  J += m * arm * arm * Mat3::Identity();
  const double xf = car.rim(0).position.x() - centre.x(), xr = car.rim(2).position.x() - centre.x();
  const double h = centre.z() - car.rim(0).position.z();
  Eigen::Matrix2d K, M;
  K << 4.0 * k, -2.0 * k * (xf + xr), -2.0 * k * (xf + xr), 2.0 * k * (xf * xf + xr * xr) - W * h;
  M << m, 0.0, 0.0, J(1, 1);
  const Eigen::VectorXd squares = squared_frequencies(K, M.diagonal());
  EXPECT_NEAR(trim.pitch, 0.0, 1e-3);
  std::vector<double> found{mode(trim, "heave").frequency, mode(trim, "pitch").frequency};
  std::sort(found.begin(), found.end());
  for (const int k : {0, 1})
    verification::verify("rigid vehicle on four springs, vibrations", k == 0 ? "heave, Hz" : "pitch, Hz", found[k],
                         hertz(squares[k]), 1e-5, "closed form");
  EXPECT_NEAR(trim.wheels[0].load, W * -xr / (xf - xr) / 2.0, 1e-6 * W);
  EXPECT_NEAR(mode(trim, "roll").frequency, hertz((4.0 * k * s * s - W * centre.z()) / J(0, 0)),
              2e-3 * mode(trim, "roll").frequency);
}

// Half-car: body (heave, pitch) on wheel rates k_w with unsprung masses on tires k_t. The arms' masses are shared by
// their ends here, and links do not add to the rates, so that a few per cent remain.
TEST(Trim, ride_frequencies_of_the_hmmwv_match_a_model_of_two_axles_with_its_wheel_rates) {
  const vehicle::VehicleSpec spec = shipped("hmmwv_tr.json");
  Vehicle car(spec);
  const double kt = 5e5;
  const Trim trim = vehicle::trim(car, linear_tires(4, 0.4673, kt));
  const std::vector<double> radii(4, 0.4573);
  vehicle::KinematicsOptions options;
  options.points = 1;
  const auto rows = vehicle::kinematics(spec, radii, options);
  double rates[2] = {};
  for (const vehicle::KinematicsRow& row : rows) {
    if (row.wheel == "front left" && row.motion == "parallel") rates[0] = 2.0 * row.wheel_rate;
    if (row.wheel == "rear left" && row.motion == "parallel") rates[1] = 2.0 * row.wheel_rate;
  }
  const double arms = 2.0 * 0.5 * (5.813 + 23.965), unsprung = 2.0 * (14.705 + 18.8 + 19.45) + arms;
  const double sprung = car.mass() - 2.0 * unsprung;
  const double J = 2955.66 + 2.0 * arms * 1.69 * 1.69;  // inner ends of the arms
  const double a = 1.65 - 0.05, b = 1.65 + 0.05;
  Eigen::Matrix4d K = Eigen::Matrix4d::Zero();
  const Eigen::Vector4d M(sprung, J, unsprung, unsprung);
  for (int axle = 0; axle < 2; ++axle) {
    Eigen::Vector4d g(1.0, axle == 0 ? -a : b, 0.0, 0.0);  // body above the axle less the axle
    g[2 + axle] = -1.0;
    K += rates[axle] * g * g.transpose();
    K(2 + axle, 2 + axle) += 2.0 * kt;
  }
  const Eigen::VectorXd squares = squared_frequencies(K, M);
  std::vector<double> body{mode(trim, "heave").frequency, mode(trim, "pitch").frequency};
  std::sort(body.begin(), body.end());
  const auto verify = [](const char* what, double value, double reference) {
    verification::verify("hmmwv_tr.json, vibrations", what, value, reference, 0.05, "half-car on its wheel rates");
  };
  verify("lower of heave and pitch, Hz", body[0], hertz(squares[0]));
  verify("upper of heave and pitch, Hz", body[1], hertz(squares[1]));
  verify("hop of the front axle, Hz", mode(trim, "hop front").frequency, hertz(squares[2]));
  EXPECT_GT(mode(trim, "heave").damping, 0.1);
}

TEST(Trim, every_shipped_vehicle_stands_near_its_drawn_position) {
  for (const auto& [name, radius, stiffness] :
       {std::tuple{"hmmwv.json", 0.4673, 5e5}, std::tuple{"buggy.json", 0.3045, 2e5},
        std::tuple{"rover.json", 0.058, 1e6}}) {
    Vehicle car(shipped(name));
    const Trim trim = vehicle::trim(car, linear_tires(car.wheel_count(), radius, stiffness));
    for (const vehicle::WheelTrim& wheel : trim.wheels) {
      EXPECT_NEAR(wheel.travel, 0.0, 0.01) << name << " " << wheel.name;
      EXPECT_GT(wheel.load, 0.0) << name << " " << wheel.name;
    }
    std::set<std::string> names;
    for (const vehicle::TrimMode& one : trim.modes) {
      EXPECT_GT(one.frequency, 0.3) << name << " " << one.name;
      EXPECT_TRUE(names.insert(one.name).second) << name << " " << one.name;
    }
  }
  // Each wheel of the rover has the load of a laboratory's single wheel.
  Vehicle rover(shipped("rover.json"));
  for (const vehicle::WheelTrim& wheel : vehicle::trim(rover, linear_tires(6, 0.058, 1e6)).wheels)
    EXPECT_NEAR(wheel.load, 24.5, 0.1 * 24.5) << wheel.name;
}

TEST(Trim, a_vehicle_that_nothing_carries_is_an_error) {
  Vehicle car(shipped("buggy.json"));
  EXPECT_THROW(vehicle::trim(car, linear_tires(4, 0.3, 0.0)), Error);
}
