#include "tests/engines/plain/defects.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace carom::plain {

namespace {

// Each is the plain engine with one step done wrong, and nothing else.

// --- the impact law

struct RestitutionOff : Plain {
  using Plain::Plain;
  Contact surface(const Touch& touch) const override {
    Contact contact = Plain::surface(touch);
    contact.restitution *= 0.999;
    return contact;
  }
};

struct VelocityThreshold : Plain {
  using Plain::Plain;
  Contact surface(const Touch& touch) const override {
    Contact contact = Plain::surface(touch);
    if (std::abs(slip(touch).dot(touch.normal)) < 1.0) contact.restitution = 0.0;
    return contact;
  }
};

struct WallRestitutionForBalls : Plain {
  using Plain::Plain;
  Contact surface(const Touch& /*touch*/) const override { return scene().wall_contact; }
};

struct FrictionSign : Plain {
  using Plain::Plain;
  Vec3 impulse(const Touch& touch) const override {
    const Vec3 right = Plain::impulse(touch);
    const Vec3 normal = right.dot(touch.normal) * touch.normal;
    return normal - (right - normal);
  }
};

struct NoFrictionCone : Plain {
  using Plain::Plain;
  Contact surface(const Touch& touch) const override {
    Contact contact = Plain::surface(touch);
    if (contact.friction > 0.0) contact.friction = 1e9;
    return contact;
  }
};

struct TangentialRestitutionIgnored : Plain {
  using Plain::Plain;
  Contact surface(const Touch& touch) const override {
    Contact contact = Plain::surface(touch);
    contact.tangential_restitution = 0.0;
    return contact;
  }
};

struct SpinOfSecondIgnored : Plain {
  using Plain::Plain;
  Vec3 slip(const Touch& touch) const override {
    if (!touch.b) return Plain::slip(touch);
    const Body& b = bodies_[*touch.b];
    return Plain::slip(touch) + (b.ball->radius * b.w).cross(touch.normal);
  }
};

struct DiskInertia : Plain {
  using Plain::Plain;
  double inertia(const Body& /*body*/) const override { return 0.5; }
};

struct NoTorque : Plain {
  using Plain::Plain;
  void push(Body& body, const Touch& touch, const Vec3& out, const Vec3& impulse_Ns) const override {
    const Vec3 spin = body.w;
    Plain::push(body, touch, out, impulse_Ns);
    body.w = spin;
  }
  using Plain::push;
};

struct MassRatioClamped : Plain {
  using Plain::Plain;
  double mass(const Body& body, const Touch& touch) const override {
    if (!touch.b) return body.ball->mass;
    const double heavier = std::max(bodies_[touch.a].ball->mass, bodies_[*touch.b].ball->mass);
    return std::max(body.ball->mass, 1e-4 * heavier);
  }
};

struct ImmovableIsHeavy : Plain {
  using Plain::Plain;
  double mass(const Body& body, const Touch& /*touch*/) const override {
    return std::isinf(body.ball->mass) ? 1e6 : body.ball->mass;
  }
};

// --- who gets the impulse

struct MomentumLeak : Plain {
  using Plain::Plain;
  void push(const Touch& touch, const Vec3& impulse_Ns) override {
    const bool leaks = touch.b && tally_.impacts % 1000 == 999;
    Plain::push(touch, impulse_Ns);
    if (leaks) bodies_[*touch.b].v -= 1e-3 * impulse_Ns / bodies_[*touch.b].ball->mass;
  }
  using Plain::push;
};

struct PairOrder : Plain {
  using Plain::Plain;
  /// The second ball's impulse is worked out when the first has its new velocity already.
  void push(const Touch& touch, const Vec3& impulse_Ns) override {
    if (!touch.b) return Plain::push(touch, impulse_Ns);
    push(bodies_[touch.a], touch, touch.normal, -impulse_Ns);
    push(bodies_[*touch.b], touch, -touch.normal, impulse(touch));
  }
  using Plain::push;
};

struct LabelsSwapped : Plain {
  using Plain::Plain;
  void collide(const Touch& touch) override {
    Plain::collide(touch);
    if (!touch.b) return;
    std::swap(bodies_[touch.a].x, bodies_[*touch.b].x);
    std::swap(bodies_[touch.a].v, bodies_[*touch.b].v);
  }
};

struct WallImpulseSign : Plain {
  using Plain::Plain;
  void book(const Vec3& impulse_Ns, const Vec3& at) override { Plain::book(-impulse_Ns, at); }
};

struct AngularImpulseNotBooked : Plain {
  using Plain::Plain;
  void book(const Vec3& impulse_Ns, const Vec3& /*at*/) override { tally_.external_impulse += impulse_Ns; }
};

// --- finding what meets

struct ForgottenWall : Plain {
  using Plain::Plain;
  bool sees_wall(std::size_t wall) const override { return wall != 1; }
};

struct CellBorder : Plain {
  using Plain::Plain;
  /// Balls are held against those of their own cell of 1 m, and never against those of the next.
  bool sees(const Body& a, const Body& b) const override {
    return (a.x.array().floor() == b.x.array().floor()).all();
  }
};

struct CollisionMargin : Plain {
  using Plain::Plain;
  double radius(const Body& body) const override { return 0.999 * body.ball->radius; }
};

struct TieForgotten : Plain {
  using Plain::Plain;
  /// Of the impacts of one moment only the first is carried out: the others find their balls overlapping a
  /// little, and those that overlap are taken for done.
  bool sees(const Body& a, const Body& b) const override {
    constexpr double kTouching = 1e-12;
    if (tied_ && (b.x - a.x).norm() < (radius(a) + radius(b)) * (1.0 + kTouching)) return false;
    return Plain::sees(a, b);
  }
  void collide(const Touch& touch) override {
    Plain::collide(touch);
    tied_ = true;
  }

 private:
  bool tied_ = false;
};

struct EndOfStep : Plain {
  using Plain::Plain;
  /// An impact is carried out when the step ends in which it happens, wherever the balls are by then.
  std::optional<Touch> next_touch() const override {
    std::optional<Touch> touch = Plain::next_touch();
    if (touch) touch->wait_s = std::ceil((time_s_ + touch->wait_s) / step_s_) * step_s_ - time_s_;
    return touch;
  }
};

// --- time and motion

struct FirstOrderGravity : Plain {
  using Plain::Plain;
  /// Semi-implicit Euler: with steps s it adds ½ g s t to the fall.
  void fly(double time_s) override {
    Plain::fly(time_s);
    for (Body& body : bodies_) body.x += 0.5 * step_s_ * time_s * gravity();
  }
};

struct GravityAtBounce : Plain {
  using Plain::Plain;
  /// The velocity is turned round with a step's gravity in it.
  void collide(const Touch& touch) override {
    bodies_[touch.a].v += step_s_ * gravity();
    Plain::collide(touch);
  }
};

struct PositionCorrection : Plain {
  using Plain::Plain;
  /// A ball that has bounced is moved out of the wall by a millionth of its radius, and keeps its velocity.
  void collide(const Touch& touch) override {
    Plain::collide(touch);
    if (!touch.b) bodies_[touch.a].x -= 1e-6 * bodies_[touch.a].ball->radius * touch.normal;
  }
};

struct TimeLost : Plain {
  using Plain::Plain;
  /// Every impact costs a microsecond in which nothing moves.
  void collide(const Touch& touch) override {
    Plain::collide(touch);
    time_s_ += 1e-6;
  }
};

struct SpeedLimit : Plain {
  using Plain::Plain;
  /// No ball goes further than 2 m in a step.
  void fly(double time_s) override {
    for (Body& body : bodies_) {
      const double speed_mps = body.v.norm();
      if (speed_mps * step_s_ > 2.0) body.v *= 2.0 / (speed_mps * step_s_);
    }
    Plain::fly(time_s);
  }
};

struct Sleeping : Plain {
  using Plain::Plain;
  void fly(double time_s) override {
    for (Body& body : bodies_) {
      if (body.v.norm() < 0.05) body.v.setZero();
    }
    Plain::fly(time_s);
  }
};

struct Damping : Plain {
  using Plain::Plain;
  void fly(double time_s) override {
    Plain::fly(time_s);
    for (Body& body : bodies_) body.v *= 1.0 - 0.05 * time_s;
  }
};

struct SinglePrecision : Plain {
  using Plain::Plain;
  void fly(double time_s) override {
    Plain::fly(time_s);
    for (Body& body : bodies_) {
      body.x = body.x.cast<float>().cast<double>();
      body.v = body.v.cast<float>().cast<double>();
    }
  }
};

struct DragSign : Plain {
  using Plain::Plain;
  Vec3 acceleration(const Body& body) const override { return 2.0 * gravity() - Plain::acceleration(body); }
};

struct MagnusSign : Plain {
  using Plain::Plain;
  Vec3 acceleration(const Body& body) const override {
    Body turned = body;
    turned.w = -body.w;
    return Plain::acceleration(turned);
  }
};

template <class Simulation>
std::unique_ptr<carom::Simulation> make(const Scenario& scene) {
  return std::make_unique<Simulation>(scene);
}

}  // namespace

const std::vector<Defect>& defects() {
  static const std::vector<Defect> all = {
      {"restitution-off", "e is a thousandth too small", make<RestitutionOff>},
      {"velocity-threshold", "an impact below 1 m/s is taken for rest", make<VelocityThreshold>},
      {"wall-restitution-for-balls", "balls hit each other with the walls' coefficients",
       make<WallRestitutionForBalls>},
      {"friction-sign", "friction pushes the way the surfaces slip", make<FrictionSign>},
      {"no-friction-cone", "every rough contact sticks, however hard it slips", make<NoFrictionCone>},
      {"tangential-restitution-ignored", "a contact that sticks gives nothing back",
       make<TangentialRestitutionIgnored>},
      {"spin-of-second-ignored", "the slip is that of the first ball's spin alone",
       make<SpinOfSecondIgnored>},
      {"disk-inertia", "every ball turns like a disk, I = ½ m r²", make<DiskInertia>},
      {"no-torque", "friction slows a ball down and does not turn it", make<NoTorque>},
      {"mass-ratio-clamped", "no ball counts as lighter than a ten-thousandth of the other",
       make<MassRatioClamped>},
      {"immovable-is-heavy", "an immovable ball is one of a million kilograms in the impulse",
       make<ImmovableIsHeavy>},
      {"momentum-leak", "at every thousandth impact the second ball gets a thousandth too little",
       make<MomentumLeak>},
      {"pair-order", "the second ball's impulse is computed from the first one's new velocity",
       make<PairOrder>},
      {"labels-swapped", "two balls that hit each other change places in the results", make<LabelsSwapped>},
      {"wall-impulse-sign", "what walls push is booked with the wrong sign", make<WallImpulseSign>},
      {"angular-impulse-not-booked", "what walls push is booked, but not about which point",
       make<AngularImpulseNotBooked>},
      {"forgotten-wall", "one wall of the box is not there", make<ForgottenWall>},
      {"cell-border", "balls in neighbouring cells of the grid are not held against each other",
       make<CellBorder>},
      {"collision-margin", "balls are a thousandth smaller where they collide", make<CollisionMargin>},
      {"tie-forgotten", "of the impacts of one moment only the first is carried out", make<TieForgotten>},
      {"end-of-step", "an impact is carried out when its step ends", make<EndOfStep>},
      {"first-order-gravity", "gravity is integrated with order 1 and not exactly", make<FirstOrderGravity>},
      {"gravity-at-bounce", "a step's gravity is added before the bounce", make<GravityAtBounce>},
      {"position-correction", "moving a ball out of the wall lifts it, and its energy with it",
       make<PositionCorrection>},
      {"time-lost", "a microsecond is lost at every impact", make<TimeLost>},
      {"speed-limit", "no ball goes further than 2 m in a step", make<SpeedLimit>},
      {"sleeping", "a ball slower than 5 cm/s is put to sleep", make<Sleeping>},
      {"damping", "velocities decay by 5 % a second", make<Damping>},
      {"single-precision", "states are kept in single precision", make<SinglePrecision>},
      {"drag-sign", "drag pushes forwards", make<DragSign>},
      {"magnus-sign", "the Magnus force is v × ω and not ω × v", make<MagnusSign>},
  };
  return all;
}

}  // namespace carom::plain
