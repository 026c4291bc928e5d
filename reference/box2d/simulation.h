#pragma once

#include <box2d/box2d.h>
#include <fmt/format.h>

#include <cmath>
#include <iterator>
#include <vector>

#include "reference/box2d/listener.h"
#include "reference/box2d/setup.h"
#include "reference/common/fluid.h"

namespace carom::box2d {

/// One scene as a b2World. Lengths inside are in Box2D's units, `scale` of them to a metre; times and masses
/// are the scene's.
class Box2dSimulation final : public Simulation {
 public:
  Box2dSimulation(const Scenario& scene, const Setup& setup)
      : scene_(scene),
        setup_(setup),
        listener_(scene, setup.length_scale),
        world_(vec2(scene.effects.gravity.value_or(Vec3::Zero()))) {
    world_.SetContactListener(&listener_);
    world_.SetAllowSleeping(setup.sleeping);
    world_.SetWarmStarting(setup.warm_starting);
    world_.SetContinuousPhysics(!setup.continuous_when_fast);
    const reference::Reach reach = reference::reach_of(scene);
    for (const Wall& wall : scene.walls) add_wall(wall, reach);
    for (const Ball& ball : scene.balls) add_ball(ball);
  }

  void advance(double step_s, std::int64_t steps) override {
    set_damping(step_s);
    for (std::int64_t k = 0; k < steps; ++k) {
      if (reference::needs_fluid_force(scene_.effects)) apply_fluid_forces(step_s);
      if (setup_.continuous_when_fast) choose_continuous(step_s);
      if (listener_.energy().wants_places()) snapshot(listener_.energy().before());
      listener_.account().begin_step(step_s);
      world_.Step(static_cast<float>(step_s), setup_.velocity_iterations, setup_.position_iterations);
      listener_.account().end_step();
      listener_.energy().close_step([this](std::size_t ball) { return state_of(ball); }, step_s);
    }
  }

  void snapshot(std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = state_of(i);
  }

  Tally tally() const override {
    Tally tally = listener_.account().tally();
    tally.energy = listener_.energy().account();
    return tally;
  }

  Settings settings() const override;

 private:
  // Thicker than a ball can enter in a step from either side, so its centre is never nearer to another face.
  static constexpr float kWallThickness = 4.0f * b2_maxTranslation;
  static constexpr std::uint16_t kBall = 0x1;
  static constexpr std::uint16_t kWall = 0x2;

  b2Vec2 vec2(const Vec3& v) const {
    return {static_cast<float>(v.x() * setup_.length_scale), static_cast<float>(v.y() * setup_.length_scale)};
  }
  Vec3 vec3(const b2Vec2& v) const { return Vec3(v.x, v.y, 0.0) / setup_.length_scale; }
  /// In Box2D's units, as a fixture wants it.
  float restitution_threshold() const {
    return static_cast<float>(setup_.velocity_threshold_mps * setup_.length_scale);
  }
  BallState state_of(std::size_t i) const {
    return {vec3(bodies_[i]->GetWorldCenter()), vec3(bodies_[i]->GetLinearVelocity()), spin_of(i)};
  }
  Vec3 spin_of(std::size_t i) const { return {0.0, 0.0, bodies_[i]->GetAngularVelocity()}; }

  void add_ball(const Ball& ball);
  void add_wall(const Wall& wall, const reference::Reach& reach);
  void add_wall_shape(b2Body& body, const b2Vec2& normal, float half_length);
  void set_damping(double step_s);
  void apply_fluid_forces(double step_s);
  void choose_continuous(double step_s);

  const Scenario& scene_;
  Setup setup_;
  ContactListener listener_;
  b2World world_;
  std::vector<b2Body*> bodies_;  // of the balls, in the scene's order; owned by world_
  double damped_for_s_ = 0.0;    // the step that the bodies' damping was computed for
};

inline void Box2dSimulation::add_ball(const Ball& ball) {
  const bool immovable = std::isinf(ball.mass);
  b2BodyDef def;
  def.type = !immovable ? b2_dynamicBody : ball.velocity.isZero(0.0) ? b2_staticBody : b2_kinematicBody;
  def.position = vec2(ball.position);
  def.linearVelocity = vec2(ball.velocity);
  def.angularVelocity = scene_.effects.spin ? static_cast<float>(ball.spin.z()) : 0.0f;
  def.fixedRotation = !scene_.effects.spin;
  def.userData.pointer = bodies_.size();
  b2Body* body = world_.CreateBody(&def);

  b2CircleShape circle;
  circle.m_radius = static_cast<float>(ball.radius * setup_.length_scale);
  b2FixtureDef fixture;
  fixture.shape = &circle;
  fixture.restitutionThreshold = restitution_threshold();
  fixture.filter.categoryBits = kBall;
  fixture.filter.maskBits = scene_.effects.collisions ? kBall | kWall : kWall;
  const double area = b2_pi * static_cast<double>(circle.m_radius) * circle.m_radius;
  if (!immovable) fixture.density = static_cast<float>(ball.mass / area);
  body->CreateFixture(&fixture);
  if (!immovable && setup_.scene_inertia) {
    b2MassData data = {static_cast<float>(ball.mass), b2Vec2_zero, 0.0f};
    data.I = static_cast<float>(ball.inertia * ball.mass * circle.m_radius * circle.m_radius);
    body->SetMassData(&data);
  }
  // Box2D has the inertia about the centre, and none where a body does not rotate.
  const double inertia = body->GetInertia() / (setup_.length_scale * setup_.length_scale);
  listener_.energy().set_inverse_inertia(bodies_.size(), inertia > 0.0 ? 1.0 / inertia : 0.0);
  bodies_.push_back(body);
}

inline void Box2dSimulation::add_wall(const Wall& wall, const reference::Reach& reach) {
  const Vec3& n = wall.normal;
  const Vec3 foot = reach.centre - (n.dot(reach.centre) - wall.offset) * n;
  // Box2D's own axis nearest to the normal: turning by no more than what is left keeps upright walls exact.
  const bool along_x = std::abs(n.x()) > std::abs(n.y());
  const Vec3 axis = along_x ? Vec3(std::copysign(1.0, n.x()), 0, 0) : Vec3(0, std::copysign(1.0, n.y()), 0);

  b2BodyDef def;
  def.position = vec2(foot);
  def.angle = static_cast<float>(std::atan2(axis.cross(n).z(), axis.dot(n)));
  def.userData.pointer = scene_.balls.size() + static_cast<std::size_t>(&wall - scene_.walls.data());
  const float half_length = static_cast<float>(reach.radius_m * setup_.length_scale) + kWallThickness;
  add_wall_shape(*world_.CreateBody(&def), {static_cast<float>(axis.x()), static_cast<float>(axis.y())},
                 half_length);
}

inline void Box2dSimulation::add_wall_shape(b2Body& body, const b2Vec2& normal, float half_length) {
  b2FixtureDef fixture;
  fixture.restitutionThreshold = restitution_threshold();
  fixture.filter.categoryBits = kWall;
  const b2Vec2 along = half_length * b2Cross(normal, 1.0f);
  b2EdgeShape edge;
  edge.SetTwoSided(-along, along);
  fixture.shape = &edge;
  b2PolygonShape solid;
  if (setup_.solid_walls) {
    // Polygons have a skin of b2_polygonRadius: the face stands back by it, so the skin is on the plane.
    const b2Vec2 face = -b2_polygonRadius * normal;
    const b2Vec2 back = face - kWallThickness * normal;
    const b2Vec2 corners[] = {face - along, face + along, back + along, back - along};
    solid.Set(corners, static_cast<int32>(std::size(corners)));
    fixture.shape = &solid;
  }
  body.CreateFixture(&fixture);
}

inline void Box2dSimulation::set_damping(double step_s) {
  if (step_s == damped_for_s_) return;
  damped_for_s_ = step_s;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double rate_Hz = reference::linear_drag_rate(scene_.effects, scene_.balls[i]);
    // Box2D damps by 1/(1 + h λ) in a step of h; λ = (e^{c h/m} - 1)/h makes that e^{-c h/m}.
    bodies_[i]->SetLinearDamping(static_cast<float>(std::expm1(rate_Hz * step_s) / step_s));
  }
}

inline void Box2dSimulation::apply_fluid_forces(double step_s) {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i]->GetType() != b2_dynamicBody) continue;
    const Vec3 force_N = reference::fluid_force(scene_.effects, scene_.balls[i],
                                                vec3(bodies_[i]->GetLinearVelocity()), spin_of(i), step_s);
    bodies_[i]->ApplyForceToCenter(vec2(force_N), false);
  }
}

inline void Box2dSimulation::choose_continuous(double step_s) {
  bool any_fast = false;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    const double travel_m = vec3(bodies_[i]->GetLinearVelocity()).norm() * step_s;
    const bool fast = travel_m > kFastRadiiPerStep * scene_.balls[i].radius;
    bodies_[i]->SetBullet(fast);
    any_fast = any_fast || fast;
  }
  world_.SetContinuousPhysics(any_fast);
}

inline Settings Box2dSimulation::settings() const {
  const double unit_m = 1.0 / setup_.length_scale;
  const bool when_fast = setup_.continuous_when_fast;
  return {
      {"length_scale", setup_.length_scale},
      {"velocity_threshold_mps", setup_.velocity_threshold_mps},
      {"velocity_iterations", static_cast<double>(setup_.velocity_iterations)},
      {"position_iterations", static_cast<double>(setup_.position_iterations)},
      {"sleeping", setup_.sleeping},
      {"warm_starting", setup_.warm_starting},
      {"continuous", when_fast ? fmt::format("where v·step > {} r", kFastRadiiPerStep) : "against walls"},
      {"walls", setup_.solid_walls ? "solid polygons, skin on the plane" : "edges, skin outside the plane"},
      {"inertia", setup_.scene_inertia ? "of the scene" : "disk, 1/2 m r²"},
      {"mixing", "coefficients of the pair, set on each contact"},
      {"damping", "linear, 1/(1 + h λ) with λ = (exp(c h/m) - 1)/h"},
      {"linear_slop_m", b2_linearSlop * unit_m},
      {"polygon_radius_m", b2_polygonRadius * unit_m},
      {"aabb_extension_m", b2_aabbExtension * unit_m},
      {"max_travel_m_per_step", b2_maxTranslation * unit_m},
      {"max_turn_rad_per_step", double{b2_maxRotation}},
  };
}

}  // namespace carom::box2d
