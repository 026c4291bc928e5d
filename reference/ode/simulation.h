#pragma once

#include <fmt/format.h>
#include <ode/ode.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <deque>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <vector>

#include "reference/common/account.h"
#include "reference/common/energy.h"
#include "reference/common/fluid.h"
#include "reference/ode/setup.h"

namespace carom::ode {

/// ODE is C: what it hands out is a pointer that is given back by a function of its own.
template <auto destroy>
struct DestroyedBy {
  template <class Object>
  void operator()(Object* object) const {
    destroy(object);
  }
};
using World = std::unique_ptr<dxWorld, DestroyedBy<&dWorldDestroy>>;      // with its bodies
using GeomSpace = std::unique_ptr<dxSpace, DestroyedBy<&dSpaceDestroy>>;  // with its geometries
using Joints = std::unique_ptr<dxJointGroup, DestroyedBy<&dJointGroupDestroy>>;

/// One scene as an ODE world, in the scene's own units.
class OdeSimulation final : public Simulation {
 public:
  OdeSimulation(const Scenario& scene, const Setup& setup);

  void advance(double step_s, std::int64_t steps) override;
  void snapshot(std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = state_of(i);
  }
  Tally tally() const override {
    Tally tally = account_.tally();
    tally.energy = energy_.account();
    return tally;
  }
  Settings settings() const override;

 private:
  /// A contact of the step at hand. ODE writes into `forces` when it solves the step.
  struct Touch {
    std::uint32_t a = 0;  // a movable ball
    std::uint32_t b = 0;
    Vec3 normal = Vec3::Zero();  // into a
    Vec3 point = Vec3::Zero();
    std::optional<reference::SolvedContact::Body> body_a;
    std::optional<reference::SolvedContact::Body> body_b;
    dJointFeedback forces = {};
  };

  // Categories of geometries. Immovable things never meet each other.
  static constexpr unsigned long kMovable = 1;
  static constexpr unsigned long kImmovable = 2;
  static constexpr unsigned long kWall = 4;

  static Vec3 vec3(const dReal* v) { return {v[0], v[1], v[2]}; }
  /// Of a geometry: the balls count from 0, the walls go on after them.
  static std::uint32_t number_of(dGeomID geometry) {
    return *static_cast<const std::uint32_t*>(dGeomGetData(geometry));
  }
  BallState state_of(std::size_t ball) const;
  bool is_movable(std::uint32_t number) const {
    return !account_.is_wall(number) && std::isfinite(scene_.balls[number].mass);
  }
  double inverse_mass(std::uint32_t number) const {
    return is_movable(number) ? 1.0 / scene_.balls[number].mass : 0.0;
  }

  void configure_world();
  void add_ball(const Ball& ball);
  void add_wall(const Wall& wall);
  void set_mass(dBodyID body, const Ball& ball);
  void apply_forces(double step_s);
  void meet(dGeomID first, dGeomID second);
  void touch(const dContactGeom& contact, std::uint32_t a, std::uint32_t b);
  void set_friction(dContact& contact, const Touch& touch, double friction) const;
  Vec3 surface_velocity(const std::optional<reference::SolvedContact::Body>& body,
                        std::uint32_t number) const;
  std::optional<reference::SolvedContact::Body> body_at(std::uint32_t number, const Vec3& point) const;
  void account_for(const Touch& touch, double step_s);

  const Scenario& scene_;
  Setup setup_;
  reference::Account account_;
  reference::EnergyBook energy_;
  World world_{dWorldCreate()};
  GeomSpace space_{dHashSpaceCreate(nullptr)};
  Joints joints_{dJointGroupCreate(0)};
  std::vector<std::uint32_t> numbers_;  // 0, 1, …, which the geometries point to
  std::vector<dBodyID>
      bodies_;                 // of the balls, in the scene's order; none where a ball stands still for ever
  std::deque<Touch> touches_;  // of the step at hand: ODE keeps pointers to them
  unsigned long seed_ = 0;     // of the solver's random order, which ODE keeps for the whole process
};

inline OdeSimulation::OdeSimulation(const Scenario& scene, const Setup& setup)
    : scene_(scene),
      setup_(setup),
      account_(scene, std::numeric_limits<dReal>::epsilon()),
      energy_(scene),
      numbers_(scene.balls.size() + scene.walls.size()) {
  std::iota(numbers_.begin(), numbers_.end(), 0U);
  configure_world();
  for (const Ball& ball : scene.balls) add_ball(ball);
  for (const Wall& wall : scene.walls) add_wall(wall);
}

inline void OdeSimulation::configure_world() {
  const Vec3 gravity_mps2 = scene_.effects.gravity.value_or(Vec3::Zero());
  dWorldSetGravity(world_.get(), gravity_mps2.x(), gravity_mps2.y(), gravity_mps2.z());
  dWorldSetERP(world_.get(), setup_.erp);
  dWorldSetCFM(world_.get(), setup_.cfm);
  dWorldSetQuickStepNumIterations(world_.get(), setup_.iterations);
  dWorldSetQuickStepW(world_.get(), setup_.over_relaxation);
  dHashSpaceSetLevels(space_.get(), setup_.cells.smallest, setup_.cells.largest);
}

inline void OdeSimulation::add_ball(const Ball& ball) {
  const std::size_t number = bodies_.size();
  const bool immovable = std::isinf(ball.mass);
  const bool fixed = immovable && ball.velocity.isZero(0.0);
  dGeomID sphere = dCreateSphere(space_.get(), ball.radius);
  dGeomSetData(sphere, &numbers_[number]);
  const unsigned long others = !scene_.effects.collisions ? 0 : immovable ? kMovable : kMovable | kImmovable;
  dGeomSetCategoryBits(sphere, immovable ? kImmovable : kMovable);
  dGeomSetCollideBits(sphere, immovable ? others : others | kWall);
  bodies_.push_back(fixed ? nullptr : dBodyCreate(world_.get()));
  dBodyID body = bodies_.back();
  if (!fixed) dGeomSetBody(sphere, body);
  dGeomSetPosition(sphere, ball.position.x(), ball.position.y(), ball.position.z());
  if (fixed) return;
  dBodySetLinearVel(body, ball.velocity.x(), ball.velocity.y(), ball.velocity.z());
  if (immovable) {
    dBodySetKinematic(body);
  } else {
    set_mass(body, ball);
  }
  if (scene_.effects.spin) {
    dBodySetAngularVel(body, ball.spin.x(), ball.spin.y(), ball.spin.z());
  } else {
    dBodySetMaxAngularSpeed(body, 0.0);
  }
}

inline void OdeSimulation::set_mass(dBodyID body, const Ball& ball) {
  const double moment = ball.inertia * ball.mass * ball.radius * ball.radius;
  dMass mass;
  dMassSetParameters(&mass, ball.mass, 0, 0, 0, moment, moment, moment, 0, 0, 0);
  dBodySetMass(body, &mass);
  dBodySetGyroscopicMode(body, setup_.gyroscopic ? 1 : 0);
  if (scene_.effects.spin) energy_.set_inverse_inertia(bodies_.size() - 1, 1.0 / moment);
}

inline void OdeSimulation::add_wall(const Wall& wall) {
  const Vec3& n = wall.normal;
  dGeomID plane = dCreatePlane(space_.get(), n.x(), n.y(), n.z(), wall.offset);
  const std::size_t number = scene_.balls.size() + static_cast<std::size_t>(&wall - scene_.walls.data());
  dGeomSetData(plane, &numbers_[number]);
  dGeomSetCategoryBits(plane, kWall);
  dGeomSetCollideBits(plane, kMovable);
}

inline BallState OdeSimulation::state_of(std::size_t ball) const {
  const dBodyID body = bodies_[ball];
  const Vec3 spin = scene_.effects.spin ? scene_.balls[ball].spin : Vec3::Zero();
  if (body == nullptr) return {scene_.balls[ball].position, Vec3::Zero(), spin};
  return {vec3(dBodyGetPosition(body)), vec3(dBodyGetLinearVel(body)), vec3(dBodyGetAngularVel(body))};
}

inline void OdeSimulation::advance(double step_s, std::int64_t steps) {
  dRandSetSeed(seed_);
  for (std::int64_t k = 0; k < steps; ++k) {
    if (scene_.effects.drag || scene_.effects.magnus) apply_forces(step_s);
    if (energy_.wants_places()) snapshot(energy_.before());
    account_.begin_step(step_s);
    dSpaceCollide(space_.get(), this, [](void* self, dGeomID first, dGeomID second) {
      static_cast<OdeSimulation*>(self)->meet(first, second);
    });
    dWorldQuickStep(world_.get(), step_s);
    for (const Touch& touch : touches_) account_for(touch, step_s);
    account_.end_step();
    energy_.close_step([this](std::size_t ball) { return state_of(ball); }, step_s);
    dJointGroupEmpty(joints_.get());
    touches_.clear();
  }
  seed_ = dRandGetSeed();
}

inline void OdeSimulation::apply_forces(double step_s) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (std::isinf(scene_.balls[i].mass)) continue;
    const BallState state = state_of(i);
    const Vec3 force_N =
        reference::linear_drag_force(scene_.effects, scene_.balls[i], state.velocity, step_s) +
        reference::fluid_force(scene_.effects, scene_.balls[i], state.velocity, state.spin, step_s);
    dBodyAddForce(bodies_[i], force_N.x(), force_N.y(), force_N.z());
  }
}

// The broad phase found two geometries near each other. A joint's first body has to be movable: ODE swaps its
// two bodies where the first is missing, and with them the sides of what it reports.
inline void OdeSimulation::meet(dGeomID first, dGeomID second) {
  if (!is_movable(number_of(first))) std::swap(first, second);
  dContactGeom contact;
  if (dCollide(first, second, 1, &contact, sizeof(contact)) == 0) return;
  touch(contact, number_of(first), number_of(second));
}

inline void OdeSimulation::touch(const dContactGeom& geometry, std::uint32_t a, std::uint32_t b) {
  const Vec3 point = vec3(geometry.pos);
  touches_.push_back({a, b, vec3(geometry.normal), point, body_at(a, point), body_at(b, point)});
  Touch& touch = touches_.back();
  const Contact& surface = account_.is_wall(b) ? scene_.wall_contact : scene_.ball_contact;
  dContact contact = {};
  contact.geom = geometry;
  contact.surface.mode = dContactBounce;
  contact.surface.bounce = surface.restitution;
  contact.surface.bounce_vel = setup_.velocity_threshold_mps;
  set_friction(contact, touch, surface.friction);
  const dJointID joint = dJointCreateContact(world_.get(), joints_.get(), &contact);
  dJointAttach(joint, bodies_[a], account_.is_wall(b) ? nullptr : bodies_[b]);
  dJointSetFeedback(joint, &touch.forces);
}

inline void OdeSimulation::set_friction(dContact& contact, const Touch& touch, double friction) const {
  contact.surface.mu = friction;
  if (setup_.friction == Friction::constant_force || friction == 0.0) return;
  contact.surface.mode |= dContactApprox1;
  // ODE bounds friction along two directions each on its own. With the first one along the slip the second
  // has nothing to do, and the bound is that of Coulomb's cone.
  const Vec3 velocity = surface_velocity(touch.body_a, touch.a) - surface_velocity(touch.body_b, touch.b);
  const Vec3 slip = velocity - velocity.dot(touch.normal) * touch.normal;
  const double slip_mps = slip.norm();
  if (slip_mps == 0.0) return;
  contact.surface.mode |= dContactFDir1;
  for (int axis = 0; axis < 3; ++axis) contact.fdir1[axis] = slip[axis] / slip_mps;
}

inline Vec3 OdeSimulation::surface_velocity(const std::optional<reference::SolvedContact::Body>& body,
                                            std::uint32_t number) const {
  if (account_.is_wall(number)) return Vec3::Zero();
  const BallState state = state_of(number);
  return body ? Vec3(state.velocity + state.spin.cross(body->arm)) : state.velocity;
}

inline std::optional<reference::SolvedContact::Body> OdeSimulation::body_at(std::uint32_t number,
                                                                            const Vec3& point) const {
  if (!is_movable(number)) return std::nullopt;
  return reference::SolvedContact::Body{number, point - state_of(number).position};
}

inline void OdeSimulation::account_for(const Touch& touch, double step_s) {
  const Vec3 on_a = step_s * vec3(touch.forces.f1);
  const double push_Ns = on_a.dot(touch.normal);
  const Vec3 push_on_a = push_Ns * touch.normal;
  energy_.add({touch.body_a, touch.body_b, -push_on_a, push_on_a - on_a});
  account_.contact(touch.a, touch.b, push_Ns * (inverse_mass(touch.a) + inverse_mass(touch.b)));
  if (is_movable(touch.b)) return;
  account_.external({on_a, touch.point});
  if (account_.is_wall(touch.b)) account_.wall(push_Ns);
}

inline Settings OdeSimulation::settings() const {
  const bool coulomb = setup_.friction == Friction::coulomb;
  return {
      {"velocity_threshold_mps", setup_.velocity_threshold_mps},
      {"iterations", static_cast<double>(setup_.iterations)},
      {"over_relaxation", setup_.over_relaxation},
      {"erp", setup_.erp},
      {"cfm", setup_.cfm},
      {"friction_law",
       coulomb ? "μ times the normal force, along the slip" : "μ newtons, along two fixed directions"},
      {"gyroscopic", setup_.gyroscopic},
      {"cell_levels", fmt::format("2^{} … 2^{} m", setup_.cells.smallest, setup_.cells.largest)},
      {"solver", "dWorldQuickStep"},
      {"sleeping", dWorldGetAutoDisableFlag(world_.get()) != 0},
      {"continuous", "none"},
      {"walls", "planes"},
      {"inertia", "of the scene"},
      {"mixing", "coefficients of the pair, set on each contact"},
      {"damping", "linear, as a force: m v (exp(-c h/m) - 1)/h"},
  };
}

}  // namespace carom::ode
