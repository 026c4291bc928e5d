#include "comparison/examine_textbook.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "carom/textbook/program.h"
#include "comparison/random_vector.h"

namespace carom {

namespace {

using textbook::Program;
using textbook::ProgramBall;

Ball ball_at(const Vec3& position, const Vec3& velocity, double mass = 1.0, double radius = 0.1) {
  Ball ball;
  ball.mass = mass;
  ball.radius = radius;
  ball.position = position;
  ball.velocity = velocity;
  return ball;
}

Scenario scene_with(std::vector<Ball> balls) {
  Scenario scene;
  scene.balls = std::move(balls);
  return scene;
}

Program run(const Scenario& scene, double update_s, int updates) {
  Program program(scene);
  program.set_update(update_s);
  for (int k = 0; k < updates; ++k) program.update();
  return program;
}

Vec3 place_of(const ProgramBall& ball) {
  return ball.x.cast<double>();
}

Vec3 velocity_of(const Program& program, std::size_t ball) {
  return program.balls()[ball].v.cast<double>() / program.update_s();
}

double random_mass(Random& random) {
  return std::pow(10.0, random.uniform(-1.0, 1.0));
}

// --- the impulse

/// One random pair that overlaps by a tenth, of about 1 kg, 1 m and 1 m/s.
void add_pair(Random& random, ImpulseAccuracy& accuracy) {
  constexpr double kUpdate = 1.0 / 64.0;
  const Vec3 n = random_vector(random).normalized();  // from a to b, when they meet
  const Ball a = ball_at(Vec3::Zero(), random_vector(random), random_mass(random), random.uniform(0.2, 1.0));
  Ball b = ball_at(Vec3::Zero(), random_vector(random), random_mass(random), random.uniform(0.2, 1.0));
  b.position = 0.9 * (a.radius + b.radius) * n + kUpdate * (a.velocity - b.velocity);
  const double v_n = n.dot(b.velocity - a.velocity);
  if (v_n >= 0.0) return;
  const double impulse_Ns = -2.0 * v_n / (1.0 / a.mass + 1.0 / b.mass);
  const Program program = run(scene_with({a, b}), kUpdate, 1);
  const Vec3 a_after = velocity_of(program, 0);
  const Vec3 b_after = velocity_of(program, 1);
  const double speeds = a.velocity.norm() + b.velocity.norm();
  const double error = std::max((a_after - (a.velocity - impulse_Ns / a.mass * n)).norm(),
                                (b_after - (b.velocity + impulse_Ns / b.mass * n)).norm());
  const Vec3 momentum = a.mass * (a_after - a.velocity) + b.mass * (b_after - b.velocity);
  const double squares = a.mass * a.velocity.squaredNorm() + b.mass * b.velocity.squaredNorm();
  const double gained = a.mass * a_after.squaredNorm() + b.mass * b_after.squaredNorm() - squares;
  ++accuracy.pairs;
  accuracy.velocity = std::max(accuracy.velocity, error / speeds);
  accuracy.momentum = std::max(accuracy.momentum,
                               momentum.norm() / (a.mass * a.velocity.norm() + b.mass * b.velocity.norm()));
  accuracy.energy = std::max(accuracy.energy, std::abs(gained) / squares);
}

ImpulseAccuracy measure_impulse() {
  constexpr int kPairs = 20'000;
  Random random(1);
  ImpulseAccuracy accuracy;
  for (int k = 0; k < kPairs; ++k) add_pair(random, accuracy);
  return accuracy;
}

// --- moving apart

constexpr double kRadiusSum = 0.2;  // m, of two balls of 0.1 m

/// Where two balls at rest end, of which the second, of this mass, lies at x = d.
std::pair<double, double> moved_apart(double d, double second_mass) {
  const Program program =
      run(scene_with({ball_at(Vec3::Zero(), Vec3::Zero()), ball_at({d, 0, 0}, Vec3::Zero(), second_mass)}),
          1.0, 1);
  return {place_of(program.balls()[0]).x(), place_of(program.balls()[1]).x()};
}

ShiftMeasured measure_shift(double share) {
  constexpr double kHeavy = 100.0;
  const double overlap = share * kRadiusSum;
  const double d = kRadiusSum - overlap;
  const auto [first, second] = moved_apart(d, kHeavy);
  ShiftMeasured measured;
  measured.overlap = share;
  measured.first = std::abs(first) / overlap;
  measured.second = std::abs(second - d) / overlap;
  measured.gap = (second - first) / kRadiusSum - 1.0;
  measured.centre_of_mass = (first + kHeavy * (second - d)) / (1.0 + kHeavy) / overlap;
  return measured;
}

/// The same two balls, the left or the right one first.
double measure_swapped(double share) {
  const double overlap = share * kRadiusSum;
  const double d = kRadiusSum - overlap;
  const auto [left, right] = moved_apart(d, 1.0);
  const Program other =
      run(scene_with({ball_at({d, 0, 0}, Vec3::Zero()), ball_at(Vec3::Zero(), Vec3::Zero())}), 1.0, 1);
  return std::max(std::abs(place_of(other.balls()[0]).x() - right),
                  std::abs(place_of(other.balls()[1]).x() - left)) /
         overlap;
}

// --- under gravity

DropMeasured measure_drop(int rate_hz) {
  constexpr double kGravity = 9.81;
  constexpr double kSeconds = 10.0;
  Scenario scene = scene_with({ball_at({0, 0.5, 0}, Vec3::Zero()), ball_at({0, 2.0, 0}, Vec3::Zero())});
  scene.effects.gravity = Vec3(0.0, -kGravity, 0.0);
  scene.walls.push_back({Vec3::UnitY(), 0.0});
  const Program program = run(scene, 1.0 / rate_hz, static_cast<int>(kSeconds * rate_hz));
  double before_J = 0.0;
  double after_J = 0.0;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    // The potential energy is zero where a ball would lie on the floor.
    before_J += ball.mass * kGravity * (ball.position.y() - ball.radius);
    after_J += ball.mass * (kGravity * (place_of(program.balls()[i]).y() - ball.radius) +
                            0.5 * velocity_of(program, i).squaredNorm());
  }
  const EnergyAccount& account = program.tally().energy;
  DropMeasured measured;
  measured.rate_hz = rate_hz;
  measured.energy = (after_J - before_J) / before_J;
  measured.correction = account.correction_J / before_J;
  measured.flight =
      measured.energy - measured.correction - (account.ball_impacts_J + account.wall_impacts_J) / before_J;
  return measured;
}

// --- one centre

int not_finite(const Program& program) {
  return static_cast<int>(
      std::count_if(program.balls().begin(), program.balls().end(),
                    [](const ProgramBall& ball) { return !ball.x.allFinite() || !ball.v.allFinite(); }));
}

CoincidentMeasured measure_coincident() {
  const Vec3 place(0.5, 0.5, 0.0);
  const Vec3 target(2.5, 0.5, 0.0);
  const Scenario scene = scene_with(
      {ball_at(place, Vec3::UnitX()), ball_at(place, Vec3::UnitX()), ball_at(target, Vec3::Zero())});
  const Program all = run(scene, 1.0 / 64.0, 4 * 64);
  CoincidentMeasured measured;
  measured.not_finite_after_one = not_finite(run(scene, 1.0 / 64.0, 1));
  measured.not_finite_after_all = not_finite(all);
  measured.third_untouched = place_of(all.balls()[2]) == target;
  return measured;
}

// --- the law with squared speeds

SquaredLaw measure_squares(double e) {
  const double m1 = 1.0;
  const double m2 = 3.0;
  const double v1 = 2.0;
  const double v2 = -1.0;
  const double impulse_Ns = -(1.0 + e) * (v2 - v1) / (1.0 / m1 + 1.0 / m2);
  const double w1 = v1 - impulse_Ns / m1;
  const double w2 = v2 + impulse_Ns / m2;
  return {e, m1 * v1 + m2 * v2, m1 * w1 + m2 * w2, m1 * v1 * v1 + m2 * v2 * v2, m1 * w1 * w1 + m2 * w2 * w2};
}

// --- frame rates

/// A ball at v flies head-on at one at rest and of its size, and covers v · update at a time. It gets an
/// impulse where an update ends while they overlap and approach. They overlap over a length of 2R, but
/// approach over the first R of it alone: past the other's centre n has turned round. So it passes with the
/// probability 1 − R/(v · update), where that is above 0 (the place of the first update is anywhere). The
/// impact comes late by what it is past the touch, over v.
RateMeasured measure_rate(int rate_hz) {
  constexpr double kPerUpdate = 0.02;  // m
  constexpr double kSpeed = 20.0;      // m/s
  constexpr int kPhases = 2000;
  const double update_s = 1.0 / rate_hz;
  RateMeasured measured;
  measured.rate_hz = rate_hz;
  const Scenario slow = scene_with({ball_at(Vec3::Zero(), {kPerUpdate * rate_hz, 0, 0})});
  measured.speed_mps = place_of(run(slow, update_s, rate_hz).balls()[0]).x();
  const double stride = kSpeed * update_s;
  int passed = 0;
  double late_s = 0.0;
  for (int k = 0; k < kPhases; ++k) {
    const double start = -1.0 - stride * (k + 0.5) / kPhases;
    Program program(
        scene_with({ball_at({start, 0, 0}, {kSpeed, 0, 0}), ball_at(Vec3::Zero(), Vec3::Zero())}));
    program.set_update(update_s);
    double moved_s = 0.0;
    while (program.tally().impacts == 0 && place_of(program.balls()[0]).x() < 1.0) {
      program.update();
      moved_s += update_s;
    }
    passed += program.tally().impacts == 0 ? 1 : 0;
    if (program.tally().impacts > 0) late_s += moved_s - (-kRadiusSum - start) / kSpeed;
  }
  measured.unseen = static_cast<double>(passed) / kPhases;
  measured.unseen_by_formula = std::max(0.0, 1.0 - kRadiusSum / stride);
  measured.late_s = late_s / std::max(1, kPhases - passed);
  return measured;
}

SpinMeasured measure_spin() {
  constexpr int kRate = 64;
  constexpr double kRadius = 0.1;
  const double path = 2.0 * std::numbers::pi * kRadius;
  const Program program =
      run(scene_with({ball_at(Vec3::Zero(), {path, 0, 0}, 1.0, kRadius)}), 1.0 / kRate, kRate);
  return {static_cast<double>(program.balls()[0].angle_x), place_of(program.balls()[0]).x() / kRadius};
}

}  // namespace

TextbookFindings examine_textbook() {
  TextbookFindings findings;
  findings.impulse = measure_impulse();
  for (const double share : {0.01, 0.1, 0.5, 0.9}) findings.shifts.push_back(measure_shift(share));
  findings.swapped = measure_swapped(0.5);
  for (const int rate_hz : {30, 60, 120, 240, 960}) findings.drops.push_back(measure_drop(rate_hz));
  findings.coincident = measure_coincident();
  for (const double e : {1.0, 0.5, 0.0}) findings.squares.push_back(measure_squares(e));
  for (const int rate_hz : {30, 60, 144, 240}) findings.rates.push_back(measure_rate(rate_hz));
  findings.spin = measure_spin();
  return findings;
}

}  // namespace carom
