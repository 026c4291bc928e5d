#pragma once

#include <box2d/box2d.h>

#include <algorithm>
#include <optional>
#include <unordered_map>

#include "reference/common/account.h"
#include "reference/common/energy.h"

namespace carom::box2d {

/// A number of the body that Box2D carries for us: balls count up from 0, walls down from the top.
inline std::uint32_t body_number(b2Body* body) {
  return static_cast<std::uint32_t>(body->GetUserData().pointer);
}

/// Gives every contact the scene's coefficients, whatever Box2D's mixing rule makes of the fixtures' own, and
/// writes down what the contacts did.
class ContactListener final : public b2ContactListener {
 public:
  ContactListener(const Scenario& scene, double length_scale)
      : scene_(scene), scale_(length_scale), account_(scene, b2_epsilon), energy_(scene) {}

  void BeginContact(b2Contact* contact) override {
    const bool wall =
        is_wall(contact->GetFixtureA()->GetBody()) || is_wall(contact->GetFixtureB()->GetBody());
    const Contact& surface = wall ? scene_.wall_contact : scene_.ball_contact;
    contact->SetRestitution(static_cast<float>(surface.restitution));
    contact->SetFriction(static_cast<float>(surface.friction));
  }

  void EndContact(b2Contact* contact) override { touches_.erase(contact); }

  // Normal and point as the solver is about to use them: by PostSolve the bodies have moved on.
  void PreSolve(b2Contact* contact, const b2Manifold* /*before*/) override {
    b2WorldManifold manifold;
    contact->GetWorldManifold(&manifold);
    const b2Vec2& point = manifold.points[0];
    touches_[contact] = {manifold.normal, point, point - contact->GetFixtureA()->GetBody()->GetWorldCenter(),
                         point - contact->GetFixtureB()->GetBody()->GetWorldCenter()};
  }

  void PostSolve(b2Contact* contact, const b2ContactImpulse* impulse) override {
    b2Body* a = contact->GetFixtureA()->GetBody();
    b2Body* b = contact->GetFixtureB()->GetBody();
    const double speed = impulse->normalImpulses[0] * (inverse_mass(*a) + inverse_mass(*b));
    account_.contact(body_number(a), body_number(b), speed / scale_);
    energy_.add(solved(contact, *impulse));
    if (!is_external(contact)) return;
    account_.external(push_on_ball(contact, *impulse));
    if (account_.is_wall(std::max(body_number(a), body_number(b)))) {
      account_.wall(impulse->normalImpulses[0] / scale_);
    }
  }

  reference::Account& account() { return account_; }
  const reference::Account& account() const { return account_; }
  reference::EnergyBook& energy() { return energy_; }
  const reference::EnergyBook& energy() const { return energy_; }

 private:
  struct Touch {
    b2Vec2 normal;  // from body A to body B
    b2Vec2 point;
    b2Vec2 arm_a;  // from the centre of body A to the point
    b2Vec2 arm_b;
  };

  static double inverse_mass(const b2Body& body) {
    return body.GetType() == b2_dynamicBody ? 1.0 / body.GetMass() : 0.0;
  }
  static bool is_external(b2Contact* contact) {
    return contact->GetFixtureA()->GetBody()->GetType() != b2_dynamicBody ||
           contact->GetFixtureB()->GetBody()->GetType() != b2_dynamicBody;
  }
  bool is_wall(b2Body* body) const { return body_number(body) >= scene_.balls.size(); }

  reference::Push push_on_ball(b2Contact* contact, const b2ContactImpulse& impulse) const {
    const Touch& touch = touches_.at(contact);
    const b2Vec2 tangent = b2Cross(touch.normal, 1.0f);
    const bool ball_is_b = contact->GetFixtureB()->GetBody()->GetType() == b2_dynamicBody;
    const Vec3 normal(touch.normal.x, touch.normal.y, 0.0);
    const Vec3 along(tangent.x, tangent.y, 0.0);
    const double sign = (ball_is_b ? 1.0 : -1.0) / scale_;
    return {sign * (impulse.normalImpulses[0] * normal + impulse.tangentImpulses[0] * along),
            Vec3(touch.point.x, touch.point.y, 0.0) / scale_};
  }

  /// The contact as it was solved. Box2D's impulses act on B along a normal from A to B.
  reference::SolvedContact solved(b2Contact* contact, const b2ContactImpulse& impulse) const {
    const Touch& touch = touches_.at(contact);
    const b2Vec2 tangent = b2Cross(touch.normal, 1.0f);
    reference::SolvedContact solved;
    solved.a = body_at(contact->GetFixtureA()->GetBody(), touch.arm_a);
    solved.b = body_at(contact->GetFixtureB()->GetBody(), touch.arm_b);
    solved.push = impulse.normalImpulses[0] / scale_ * Vec3(touch.normal.x, touch.normal.y, 0.0);
    solved.drag = impulse.tangentImpulses[0] / scale_ * Vec3(tangent.x, tangent.y, 0.0);
    return solved;
  }

  std::optional<reference::SolvedContact::Body> body_at(b2Body* body, const b2Vec2& arm) const {
    if (body->GetType() != b2_dynamicBody) return std::nullopt;
    return reference::SolvedContact::Body{body_number(body), Vec3(arm.x, arm.y, 0.0) / scale_};
  }

  const Scenario& scene_;
  double scale_;
  reference::Account account_;
  reference::EnergyBook energy_;
  std::unordered_map<b2Contact*, Touch> touches_;  // of contacts that touch now
};

}  // namespace carom::box2d
