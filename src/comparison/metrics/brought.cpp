#include "comparison/metrics/brought.h"

#include <cmath>

namespace carom {

namespace {

Conserved sum(const Conserved& a, const Conserved& b, double sign) {
  return {a.energy_J + sign * b.energy_J, a.momentum_Ns + sign * b.momentum_Ns,
          a.angular_momentum_Nms + sign * b.angular_momentum_Nms};
}

bool shown(const Scenario& scene, std::size_t event, std::size_t frame) {
  return first_frame_after(scene, scene.events[event]) <= static_cast<std::int64_t>(frame);
}

}  // namespace

Conserved brought_by(const Reference& reference, const Interference& interference) {
  Conserved brought;
  for (const BallChange& change : interference.changes) {
    if (change.after) brought = sum(brought, reference.of(*change.after, change.ball), 1.0);
    if (change.before) brought = sum(brought, reference.of(*change.before, change.ball), -1.0);
  }
  return brought;
}

std::vector<Conserved> brought_by_events(const Reference& reference, const Run& run) {
  std::vector<Conserved> brought;
  brought.reserve(run.trajectory.frames());
  Conserved now;
  std::size_t next = 0;
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    for (; next < run.interferences.size() && shown(*reference.scenario, next, k); ++next) {
      now = sum(now, brought_by(reference, run.interferences[next]), 1.0);
    }
    brought.push_back(now);
  }
  return brought;
}

GravityOverTime::GravityOverTime(const Reference& reference, const Run& run)
    : reference_(reference),
      run_(run),
      gravity_(reference.scenario->effects.gravity.value_or(Vec3::Zero())),
      mass_kg_(reference.mass_kg),
      momentum_Ns_(reference.start.momentum_Ns) {}

GivenByGravity GravityOverTime::after(double since_s) const {
  return {before_.impulse_Ns + mass_kg_ * since_s * gravity_,
          before_.angular_impulse_Nms +
              (since_s * mass_moment_kgm_ + (0.5 * since_s * since_s) * momentum_Ns_).cross(gravity_)};
}

void GravityOverTime::pass(double time_s, const Interference& interference) {
  const double since_s = time_s - from_s_;
  before_ = after(since_s);
  mass_moment_kgm_ += since_s * momentum_Ns_ + (0.5 * since_s * since_s * mass_kg_) * gravity_;
  momentum_Ns_ += mass_kg_ * since_s * gravity_;
  from_s_ = time_s;
  const auto count = [&](const std::optional<Ball>& ball, double sign) {
    if (!ball || std::isinf(ball->mass)) return;
    mass_kg_ += sign * ball->mass;
    momentum_Ns_ += sign * ball->mass * ball->velocity;
    mass_moment_kgm_ += sign * ball->mass * (ball->position - reference_.origin);
  };
  for (const BallChange& change : interference.changes) {
    count(change.after, 1.0);
    count(change.before, -1.0);
  }
}

GivenByGravity GravityOverTime::at_frame(std::size_t frame) {
  for (; next_ < run_.interferences.size() && shown(*reference_.scenario, next_, frame); ++next_) {
    pass(run_.interferences[next_].time_s, run_.interferences[next_]);
  }
  return after(run_.trajectory.time(frame) - from_s_);
}

}  // namespace carom
