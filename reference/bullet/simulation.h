#pragma once

#include <btBulletDynamicsCommon.h>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

#include "reference/bullet/bounded_plane.h"
#include "reference/bullet/setup.h"
#include "reference/bullet/surfaces.h"
#include "reference/common/account.h"
#include "reference/common/energy.h"
#include "reference/common/fluid.h"

namespace carom::bullet {

/// One scene as a Bullet world. Lengths inside are in Bullet's units, `length_scale` of them to a metre;
/// times and masses are the scene's. A plane scene is confined by the bodies' linear and angular factors.
class BulletSimulation final : public Simulation {
 public:
  BulletSimulation(const Scenario& scene, const Setup& setup);
  ~BulletSimulation() override;

  void advance(double step_s, std::int64_t steps) override;
  void snapshot(std::span<BallState> balls) const override;
  Tally tally() const override {
    Tally tally = account_.tally();
    tally.energy = energy_.account();
    return tally;
  }
  Settings settings() const override;

 private:
  // The mass of an immovable ball that moves, kg: so large that its inverse vanishes beside any other, and
  // not so large that the inverse underflows in single precision.
  static constexpr double kHugeMass_kg = 1e30;

  // Collision groups. Immovable things never meet each other.
  enum Group : int { kMovable = 1, kImmovable = 2, kWall = 4 };

  static btVector3 vector(const Vec3& v) {
    return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
  }
  btVector3 units(const Vec3& v) const { return vector(v * setup_.length_scale); }
  btTransform at(const Vec3& position) const {
    btTransform place;
    place.setIdentity();
    place.setOrigin(units(position));
    return place;
  }
  Vec3 metres(const btVector3& v) const { return Vec3(v.x(), v.y(), v.z()) / setup_.length_scale; }
  Vec3 spin_of(const btRigidBody& body) const {
    const btVector3& spin = body.getAngularVelocity();
    return {spin.x(), spin.y(), spin.z()};
  }
  BallState state_of(std::size_t ball) const {
    const btRigidBody& body = *bodies_[ball];
    return {metres(body.getCenterOfMassPosition()), metres(body.getLinearVelocity()), spin_of(body)};
  }
  bool is_ball(const btCollisionObject& object) const {
    return object.getUserIndex() < static_cast<int>(scene_.balls.size());
  }
  bool is_movable(const btCollisionObject& object) const {
    return is_ball(object) &&
           std::isfinite(scene_.balls[static_cast<std::size_t>(object.getUserIndex())].mass);
  }
  double inverse_mass(const btCollisionObject& object) const {
    return is_movable(object) ? 1.0 / scene_.balls[static_cast<std::size_t>(object.getUserIndex())].mass
                              : 0.0;
  }

  std::optional<reference::SolvedContact::Body> body_at(const btCollisionObject& object,
                                                        const btVector3& point);

  void configure_solver();
  void add_ball(const Ball& ball);
  void add_wall(const Wall& wall, const reference::Reach& reach);
  btRigidBody& add_body(double mass, std::unique_ptr<btCollisionShape> shape, const btTransform& place,
                        const btVector3& inertia, int group, int mask);
  void move_freely(btRigidBody& body, const Ball& ball);
  void apply_fluid_forces(double step_s);
  void forget_contact_points();
  void account_for_step();
  void account_for(const btPersistentManifold& manifold);

  const Scenario& scene_;
  Setup setup_;
  reference::Account account_;
  reference::EnergyBook energy_;
  double step_s_ = 0.0;  // of the step at hand
  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broadphase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broadphase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;  // the balls in the scene's order, then the walls
};

inline BulletSimulation::BulletSimulation(const Scenario& scene, const Setup& setup)
    : scene_(scene), setup_(setup), account_(scene, kEpsilon), energy_(scene) {
  use_pair_coefficients();
  configure_solver();
  world_.setGravity(units(scene.effects.gravity.value_or(Vec3::Zero())));
  for (const Ball& ball : scene.balls) add_ball(ball);
  const reference::Reach reach = reference::reach_of(scene);
  for (const Wall& wall : scene.walls) add_wall(wall, reach);
}

inline BulletSimulation::~BulletSimulation() {
  for (const auto& body : bodies_) world_.removeRigidBody(body.get());
}

inline void BulletSimulation::configure_solver() {
  btContactSolverInfo& info = world_.getSolverInfo();
  info.m_restitutionVelocityThreshold =
      static_cast<btScalar>(setup_.velocity_threshold_mps * setup_.length_scale);
  info.m_numIterations = setup_.iterations;
  info.m_erp2 = static_cast<btScalar>(setup_.erp2);
  info.m_splitImpulse = setup_.split_impulse ? 1 : 0;
  info.m_warmstartingFactor = static_cast<btScalar>(setup_.warm_starting_factor);
}

inline btRigidBody& BulletSimulation::add_body(double mass, std::unique_ptr<btCollisionShape> shape,
                                               const btTransform& place, const btVector3& inertia, int group,
                                               int mask) {
  btRigidBody::btRigidBodyConstructionInfo info(static_cast<btScalar>(mass), nullptr, shape.get(), inertia);
  info.m_startWorldTransform = place;
  auto body = std::make_unique<btRigidBody>(info);
  body->setUserPointer(const_cast<Scenario*>(&scene_));
  body->setUserIndex(static_cast<int>(bodies_.size()));
  body->setContactProcessingThreshold(
      static_cast<btScalar>(setup_.contact_processing_threshold_m * setup_.length_scale));
  if (!setup_.sleeping) body->setActivationState(DISABLE_DEACTIVATION);
  if (!setup_.gyroscopic) body->setFlags(0);
  world_.addRigidBody(body.get(), group, mask);
  shapes_.push_back(std::move(shape));
  bodies_.push_back(std::move(body));
  return *bodies_.back();
}

inline void BulletSimulation::add_ball(const Ball& ball) {
  const bool immovable = std::isinf(ball.mass);
  const bool fixed = immovable && ball.velocity.isZero(0.0);
  const double radius = ball.radius * setup_.length_scale;
  const double mass = fixed ? 0.0 : immovable ? kHugeMass_kg : ball.mass;
  const auto moment = static_cast<btScalar>(ball.inertia * mass * radius * radius);
  const int others = scene_.effects.collisions ? (immovable ? kMovable : kMovable | kImmovable) : 0;
  btRigidBody& body = add_body(mass, std::make_unique<btSphereShape>(static_cast<btScalar>(radius)),
                               at(ball.position), btVector3(moment, moment, moment),
                               immovable ? kImmovable : kMovable, immovable ? others : others | kWall);
  if (fixed) return;
  move_freely(body, ball);
  if (!immovable && scene_.effects.spin) {
    energy_.set_inverse_inertia(static_cast<std::size_t>(body.getUserIndex()),
                                1.0 / (ball.inertia * ball.mass * ball.radius * ball.radius));
  }
}

inline void BulletSimulation::move_freely(btRigidBody& body, const Ball& ball) {
  const btVector3 in_space(1, 1, 1);
  const btVector3 in_plane(1, 1, 0);
  const btVector3 about_z(0, 0, 1);
  const bool plane = scene_.dimension == 2;
  body.setLinearFactor(plane ? in_plane : in_space);
  body.setAngularFactor(!scene_.effects.spin ? btVector3(0, 0, 0) : plane ? about_z : in_space);
  body.setLinearVelocity(units(ball.velocity));
  if (scene_.effects.spin) body.setAngularVelocity(vector(ball.spin));
  // (1 - d)^h = e^{-c h/m} for every step h.
  const double damping = -std::expm1(-reference::linear_drag_rate(scene_.effects, ball));
  body.setDamping(static_cast<btScalar>(damping), 0);
  body.setCcdMotionThreshold(body.getCollisionShape()->getMargin() *
                             static_cast<btScalar>(setup_.ccd_motion_threshold_radii));
  body.setCcdSweptSphereRadius(body.getCollisionShape()->getMargin() *
                               static_cast<btScalar>(setup_.ccd_swept_radius_radii));
  if (std::isinf(ball.mass)) {
    body.setGravity({0, 0, 0});
    body.setLinearFactor({0, 0, 0});
    body.setAngularFactor(0);
  }
}

inline void BulletSimulation::add_wall(const Wall& wall, const reference::Reach& reach) {
  const auto offset = static_cast<btScalar>(wall.offset * setup_.length_scale);
  std::unique_ptr<btCollisionShape> shape;
  if (setup_.bounded_planes) {
    shape = std::make_unique<BoundedPlane>(vector(wall.normal), offset, units(reach.centre),
                                           static_cast<btScalar>(reach.radius_m * setup_.length_scale));
  } else {
    shape = std::make_unique<btStaticPlaneShape>(vector(wall.normal), offset);
  }
  add_body(0.0, std::move(shape), at(Vec3::Zero()), btVector3(0, 0, 0), kWall, kMovable);
}

inline void BulletSimulation::advance(double step_s, std::int64_t steps) {
  for (std::int64_t k = 0; k < steps; ++k) {
    if (reference::needs_fluid_force(scene_.effects)) apply_fluid_forces(step_s);
    if (setup_.fresh_points) forget_contact_points();
    if (energy_.wants_places()) snapshot(energy_.before());
    account_.begin_step(step_s);
    step_s_ = step_s;
    world_.stepSimulation(static_cast<btScalar>(step_s), 0);
    account_for_step();
    energy_.close_step([this](std::size_t ball) { return state_of(ball); }, step_s);
  }
}

inline void BulletSimulation::snapshot(std::span<BallState> balls) const {
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = state_of(i);
}

inline void BulletSimulation::apply_fluid_forces(double step_s) {
  for (std::size_t i = 0; i < scene_.balls.size(); ++i) {
    if (!is_movable(*bodies_[i])) continue;
    const Vec3 force_N =
        reference::fluid_force(scene_.effects, scene_.balls[i], metres(bodies_[i]->getLinearVelocity()),
                               spin_of(*bodies_[i]), step_s);
    bodies_[i]->applyCentralForce(units(force_N));
  }
}

// A ball touches at one point. Bullet keeps up to four per pair from earlier steps, and a remembered point is
// no longer under the ball's centre, so that its normal impulse would turn the ball.
inline void BulletSimulation::forget_contact_points() {
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    dispatcher_.getManifoldByIndexInternal(i)->clearManifold();
  }
}

inline void BulletSimulation::account_for_step() {
  for (int i = 0; i < dispatcher_.getNumManifolds(); ++i) {
    account_for(*dispatcher_.getManifoldByIndexInternal(i));
  }
  account_.end_step();
}

inline void BulletSimulation::account_for(const btPersistentManifold& manifold) {
  const btCollisionObject& a = *manifold.getBody0();
  const btCollisionObject& b = *manifold.getBody1();
  const bool awake = (is_movable(a) && a.isActive()) || (is_movable(b) && b.isActive());
  if (!awake) return;  // the solver skipped the pair, its impulses are those of an earlier step
  double normal_impulse = 0.0;
  for (int k = 0; k < manifold.getNumContacts(); ++k) {
    const btManifoldPoint& point = manifold.getContactPoint(k);
    // The solver skips points further apart than this and leaves their old impulse in place.
    if (point.getDistance() > manifold.getContactProcessingThreshold()) continue;
    normal_impulse += point.getAppliedImpulse();
    const btVector3 push_on_a = point.getAppliedImpulse() * point.m_normalWorldOnB;
    const btVector3 drag_on_a = point.m_appliedImpulseLateral1 * point.m_lateralFrictionDir1 +
                                point.m_appliedImpulseLateral2 * point.m_lateralFrictionDir2;
    energy_.add({body_at(a, point.getPositionWorldOnA()), body_at(b, point.getPositionWorldOnB()),
                 -metres(push_on_a), -metres(drag_on_a)});
    if (is_movable(a) && is_movable(b)) continue;
    const btVector3 on_a = push_on_a + drag_on_a;
    const bool ball_is_a = is_movable(a);
    account_.external({metres(ball_is_a ? on_a : -on_a),
                       metres(ball_is_a ? point.getPositionWorldOnA() : point.getPositionWorldOnB())});
  }
  const double speed = normal_impulse * (inverse_mass(a) + inverse_mass(b)) / setup_.length_scale;
  const auto number_a = static_cast<std::uint32_t>(a.getUserIndex());
  const auto number_b = static_cast<std::uint32_t>(b.getUserIndex());
  account_.contact(number_a, number_b, speed);
  if (account_.is_wall(std::max(number_a, number_b))) account_.wall(normal_impulse / setup_.length_scale);
}

// Where the point was at the beginning of the step, when the contact was found: the arm is that from the
// centre then.
inline std::optional<reference::SolvedContact::Body> BulletSimulation::body_at(
    const btCollisionObject& object, const btVector3& point) {
  if (!is_movable(object)) return std::nullopt;
  const auto ball = static_cast<std::size_t>(object.getUserIndex());
  const BallState state = state_of(ball);
  return reference::SolvedContact::Body{ball, metres(point) - (state.position - step_s_ * state.velocity)};
}

inline Settings BulletSimulation::settings() const {
  const double unit_m = 1.0 / setup_.length_scale;
  const bool continuous = setup_.ccd_motion_threshold_radii > 0.0;
  return {
      {"length_scale", setup_.length_scale},
      {"velocity_threshold_mps", setup_.velocity_threshold_mps},
      {"velocity_iterations", static_cast<double>(setup_.iterations)},
      {"erp2", setup_.erp2},
      {"split_impulse", setup_.split_impulse},
      {"split_impulse_threshold_m", world_.getSolverInfo().m_splitImpulsePenetrationThreshold * unit_m},
      {"linear_slop_m", world_.getSolverInfo().m_linearSlop * unit_m},
      {"contact_processing_threshold_m", setup_.contact_processing_threshold_m},
      {"contact_points", setup_.fresh_points ? "of this step" : "remembered"},
      {"warm_starting_factor", setup_.warm_starting_factor},
      {"sleeping", setup_.sleeping},
      {"gyroscopic", setup_.gyroscopic},
      {"continuous",
       continuous ? fmt::format("where v·step > {} r", setup_.ccd_motion_threshold_radii) : "off"},
      {"ccd_motion_threshold_radii", setup_.ccd_motion_threshold_radii},
      {"ccd_swept_sphere_radii", setup_.ccd_swept_radius_radii},
      {"walls", setup_.bounded_planes ? "planes, with bounding boxes" : "planes"},
      {"inertia", "of the scene"},
      {"mixing", "coefficients of the pair, through the global callbacks"},
      {"damping", "linear, (1 - d)^h with d = 1 - exp(-c/m)"},
      {"max_turn_rad_per_step", kMaxTurn_rad},
  };
}

}  // namespace carom::bullet
