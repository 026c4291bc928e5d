#pragma once

#include <chipmunk/chipmunk.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <vector>

#include "reference/chipmunk/setup.h"
#include "reference/common/account.h"
#include "reference/common/energy.h"
#include "reference/common/fluid.h"
#include "reference/common/scene_scale.h"

namespace carom::chipmunk {

/// Chipmunk is C: what it hands out is freed by a function of its own.
template <auto free>
struct FreedBy {
  template <class Object>
  void operator()(Object* object) const {
    free(object);
  }
};
using Space = std::unique_ptr<cpSpace, FreedBy<&cpSpaceFree>>;
using Body = std::unique_ptr<cpBody, FreedBy<&cpBodyFree>>;
using Shape = std::unique_ptr<cpShape, FreedBy<&cpShapeFree>>;

/// One scene as a cpSpace, in the scene's own units.
class ChipmunkSimulation final : public Simulation {
 public:
  ChipmunkSimulation(const Scenario& scene, const Setup& setup);

  void advance(double step_s, std::int64_t steps) override;
  void snapshot(std::span<BallState> balls) const override;
  Tally tally() const override {
    Tally tally = account_.tally();
    tally.energy = energy_.account();
    return tally;
  }
  Settings settings() const override;

 private:
  // Collision categories.
  static constexpr cpBitmask kBall = 0x1;
  static constexpr cpBitmask kWall = 0x2;

  static cpVect vect(const Vec3& v) { return cpv(v.x(), v.y()); }
  static Vec3 vec3(const cpVect& v) { return {v.x, v.y, 0.0}; }
  /// Of a shape: the balls count from 0, the walls go on after them.
  static std::uint32_t number_of(const cpShape* shape) {
    return *static_cast<const std::uint32_t*>(cpShapeGetUserData(shape));
  }
  BallState state_of(std::size_t ball) const {
    const cpBody* body = bodies_[ball].get();
    return {vec3(cpBodyGetPosition(body)), vec3(cpBodyGetVelocity(body)), {0, 0, spin_of(body)}};
  }
  double spin_of(const cpBody* body) const {
    return scene_.effects.spin ? cpBodyGetAngularVelocity(body) : 0.0;
  }
  bool is_movable(std::uint32_t number) const {
    return !account_.is_wall(number) && std::isfinite(scene_.balls[number].mass);
  }
  double inverse_mass(std::uint32_t number) const {
    return is_movable(number) ? 1.0 / scene_.balls[number].mass : 0.0;
  }

  void configure_space();
  void add_ball(const Ball& ball);
  void add_wall(const Wall& wall, const reference::Reach& reach);
  void add_shape(cpShape* shape, std::size_t number, cpBitmask category, cpBitmask meets);
  void apply_forces(double step_s);
  void use_pair_coefficients(cpArbiter* arbiter) const;
  void remember_what_is_not_applied(cpArbiter* arbiter);
  void account_for(cpArbiter* arbiter);
  std::optional<reference::SolvedContact::Body> body_at(std::uint32_t number, const cpVect& point) const;

  const Scenario& scene_;
  Setup setup_;
  reference::Account account_;
  reference::EnergyBook energy_;
  std::vector<std::uint32_t> numbers_;  // 0, 1, …, which the shapes point to
  std::vector<Body> bodies_;            // of the balls, in the scene's order
  std::vector<Shape> shapes_;
  Space space_{cpSpaceNew()};  // refers to bodies and shapes, and so is freed before them
  std::unordered_map<cpArbiter*, Vec3> not_applied_;  // N s on b, of pairs that met again in this step
};

inline ChipmunkSimulation::ChipmunkSimulation(const Scenario& scene, const Setup& setup)
    : scene_(scene),
      setup_(setup),
      account_(scene, std::numeric_limits<cpFloat>::epsilon()),
      energy_(scene, reference::EnergyBook::Moves::first),
      numbers_(scene.balls.size() + scene.walls.size()) {
  std::iota(numbers_.begin(), numbers_.end(), 0U);
  configure_space();
  for (const Ball& ball : scene.balls) add_ball(ball);
  const reference::Reach reach = reference::reach_of(scene);
  for (const Wall& wall : scene.walls) add_wall(wall, reach);
}

inline void ChipmunkSimulation::configure_space() {
  cpSpaceSetGravity(space_.get(), vect(scene_.effects.gravity.value_or(Vec3::Zero())));
  cpSpaceSetIterations(space_.get(), setup_.iterations);
  cpSpaceSetCollisionBias(space_.get(), setup_.collision_bias);
  cpSpaceSetCollisionSlop(space_.get(), setup_.collision_slop_m);
  cpSpaceSetCollisionPersistence(space_.get(), static_cast<cpTimestamp>(setup_.collision_persistence_steps));
  cpCollisionHandler* handler = cpSpaceAddDefaultCollisionHandler(space_.get());
  handler->userData = this;
  // Called in each step once a pair's mixed coefficients have been set, so ours replace them.
  handler->preSolveFunc = [](cpArbiter* arbiter, cpSpace*, cpDataPointer self) -> cpBool {
    auto* const simulation = static_cast<ChipmunkSimulation*>(self);
    simulation->use_pair_coefficients(arbiter);
    simulation->remember_what_is_not_applied(arbiter);
    return cpTrue;
  };
  handler->postSolveFunc = [](cpArbiter* arbiter, cpSpace*, cpDataPointer self) {
    static_cast<ChipmunkSimulation*>(self)->account_for(arbiter);
  };
}

inline void ChipmunkSimulation::add_ball(const Ball& ball) {
  const double disk = cpMomentForCircle(ball.mass, 0.0, ball.radius, cpvzero);
  const double moment = setup_.scene_inertia ? ball.inertia * ball.mass * ball.radius * ball.radius : disk;
  cpBody* body = std::isfinite(ball.mass)    ? cpBodyNew(ball.mass, scene_.effects.spin ? moment : INFINITY)
                 : ball.velocity.isZero(0.0) ? cpBodyNewStatic()
                                             : cpBodyNewKinematic();
  const std::size_t number = bodies_.size();
  bodies_.emplace_back(body);
  cpBodySetPosition(body, vect(ball.position));
  cpBodySetVelocity(body, vect(ball.velocity));
  if (scene_.effects.spin) cpBodySetAngularVelocity(body, ball.spin.z());
  if (std::isfinite(ball.mass) && scene_.effects.spin) energy_.set_inverse_inertia(number, 1.0 / moment);
  cpSpaceAddBody(space_.get(), body);
  add_shape(cpCircleShapeNew(body, ball.radius, cpvzero), number, kBall,
            scene_.effects.collisions ? kBall | kWall : kWall);
}

inline void ChipmunkSimulation::add_wall(const Wall& wall, const reference::Reach& reach) {
  // Thicker than a ball can enter in two steps, so that its centre never passes the middle of the segment.
  double thickness_m = 0.0;
  if (setup_.thick_walls) {
    const double travel_m = reference::expected_top_speed_mps(scene_) * reference::first_step_s(scene_);
    for (const Ball& ball : scene_.balls) thickness_m = std::max(thickness_m, ball.radius);
    thickness_m = 2.0 * (thickness_m + travel_m);
  }
  const Vec3& n = wall.normal;
  const Vec3 middle = reach.centre - (n.dot(reach.centre) - wall.offset + thickness_m) * n;
  const Vec3 along = (reach.radius_m + thickness_m) * Vec3(n.y(), -n.x(), 0.0);
  add_shape(cpSegmentShapeNew(cpSpaceGetStaticBody(space_.get()), vect(middle - along), vect(middle + along),
                              thickness_m),
            scene_.balls.size() + static_cast<std::size_t>(&wall - scene_.walls.data()), kWall, kBall);
}

inline void ChipmunkSimulation::add_shape(cpShape* shape, std::size_t number, cpBitmask category,
                                          cpBitmask meets) {
  cpShapeSetUserData(shape, &numbers_[number]);
  cpShapeSetFilter(shape, cpShapeFilterNew(CP_NO_GROUP, category, meets));
  shapes_.emplace_back(cpSpaceAddShape(space_.get(), shape));
}

inline void ChipmunkSimulation::advance(double step_s, std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) {
    if (scene_.effects.drag || scene_.effects.magnus) apply_forces(step_s);
    if (energy_.wants_places()) snapshot(energy_.before());
    account_.begin_step(step_s);
    cpSpaceStep(space_.get(), step_s);
    account_.end_step();
    energy_.close_step([this](std::size_t ball) { return state_of(ball); }, step_s);
  }
}

inline void ChipmunkSimulation::snapshot(std::span<BallState> balls) const {
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = state_of(i);
}

inline void ChipmunkSimulation::apply_forces(double step_s) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (std::isinf(scene_.balls[i].mass)) continue;
    const BallState state = state_of(i);
    const Vec3 force_N =
        reference::linear_drag_force(scene_.effects, scene_.balls[i], state.velocity, step_s) +
        reference::fluid_force(scene_.effects, scene_.balls[i], state.velocity, state.spin, step_s);
    cpBodySetForce(bodies_[i].get(), vect(force_N));
  }
}

inline void ChipmunkSimulation::use_pair_coefficients(cpArbiter* arbiter) const {
  CP_ARBITER_GET_SHAPES(arbiter, a, b);
  const bool wall = account_.is_wall(std::max(number_of(a), number_of(b)));
  const Contact& surface = wall ? scene_.wall_contact : scene_.ball_contact;
  cpArbiterSetRestitution(arbiter, surface.restitution);
  cpArbiterSetFriction(arbiter, surface.friction);
}

// A pair that parted and meets again while it is remembered starts from the sum of its old impulses, which
// Chipmunk counts but does not apply.
inline void ChipmunkSimulation::remember_what_is_not_applied(cpArbiter* arbiter) {
  if (!cpArbiterIsFirstContact(arbiter)) return;
  const Vec3 on_b = -vec3(cpArbiterTotalImpulse(arbiter));
  if (!on_b.isZero(0.0)) not_applied_.emplace(arbiter, on_b);
}

// After the solver, and bodies have not moved since it was given the contact.
inline void ChipmunkSimulation::account_for(cpArbiter* arbiter) {
  CP_ARBITER_GET_SHAPES(arbiter, a, b);
  const std::uint32_t number_a = number_of(a);
  const std::uint32_t number_b = number_of(b);
  const cpVect point_a = cpArbiterGetPointA(arbiter, 0);
  const cpVect point_b = cpArbiterGetPointB(arbiter, 0);
  const Vec3 normal = vec3(cpArbiterGetNormal(arbiter));  // from a to b
  Vec3 on_b = -vec3(cpArbiterTotalImpulse(arbiter));
  if (const auto old = not_applied_.find(arbiter); old != not_applied_.end()) {
    on_b -= old->second;
    not_applied_.erase(old);
  }
  const double push_Ns = on_b.dot(normal);
  const Vec3 push = push_Ns * normal;
  energy_.add({body_at(number_a, point_a), body_at(number_b, point_b), push, on_b - push});
  account_.contact(number_a, number_b, push_Ns * (inverse_mass(number_a) + inverse_mass(number_b)));
  if (is_movable(number_a) && is_movable(number_b)) return;
  const bool ball_is_a = is_movable(number_a);
  account_.external({ball_is_a ? -on_b : on_b, vec3(ball_is_a ? point_a : point_b)});
  if (account_.is_wall(std::max(number_a, number_b))) account_.wall(push_Ns);
}

inline std::optional<reference::SolvedContact::Body> ChipmunkSimulation::body_at(std::uint32_t number,
                                                                                 const cpVect& point) const {
  if (!is_movable(number)) return std::nullopt;
  return reference::SolvedContact::Body{number,
                                        vec3(cpvsub(point, cpBodyGetPosition(bodies_[number].get())))};
}

inline Settings ChipmunkSimulation::settings() const {
  return {
      {"iterations", static_cast<double>(setup_.iterations)},
      {"collision_bias", setup_.collision_bias},
      {"collision_slop_m", setup_.collision_slop_m},
      {"collision_persistence_steps", static_cast<double>(setup_.collision_persistence_steps)},
      {"walls", setup_.thick_walls ? "thick segments, surface on the plane" : "segments without thickness"},
      {"inertia", setup_.scene_inertia ? "of the scene" : "disk, 1/2 m r²"},
      {"velocity_threshold_mps", 0.0},
      {"sleeping", std::isfinite(cpSpaceGetSleepTimeThreshold(space_.get()))},
      {"continuous", "none"},
      {"mixing", "coefficients of the pair, set on each contact"},
      {"damping", "linear, as a force: m v (exp(-c h/m) - 1)/h"},
      {"broad_phase", "bounding-volume tree"},
  };
}

}  // namespace carom::chipmunk
