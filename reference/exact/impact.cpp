#include "reference/exact/impact.h"

namespace carom::exact {

namespace {

/// (3) of one body.
Real slip_per_impulse(const Matter& matter) {
  return matter.inverse_mass + matter.radius_m * matter.radius_m * matter.inverse_inertia;
}

/// (4)
Vector friction_impulse(const Vector& slip_mps, const Real& per_impulse, const Real& normal_Ns,
                        const Contact& contact) {
  const Real speed = length(slip_mps);
  const Real sticking = (1 + Real(contact.tangential_restitution)) / per_impulse;
  const Real sliding = contact.friction * normal_Ns;
  if (sticking * speed <= sliding) return slip_mps * -sticking;
  return slip_mps * Real(-sliding / speed);
}

}  // namespace

Real approach_mps(const Body& a, const Body& b, const Vector& normal) {
  return dot(a.velocity_mps - b.velocity_mps, normal);
}

Vector collide(Body& a, const Matter& matter_a, Body& b, const Matter& matter_b, const Vector& normal,
               const Contact& contact) {
  const Real normal_Ns = (1 + Real(contact.restitution)) * approach_mps(a, b, normal) /
                         (matter_a.inverse_mass + matter_b.inverse_mass);
  Vector impulse = normal * normal_Ns;
  if (contact.friction > 0.0) {
    const Vector turning = a.spin_radps * matter_a.radius_m + b.spin_radps * matter_b.radius_m;
    Vector slip = b.velocity_mps - a.velocity_mps - cross(turning, normal);
    slip -= normal * dot(slip, normal);
    const Vector along =
        friction_impulse(slip, slip_per_impulse(matter_a) + slip_per_impulse(matter_b), normal_Ns, contact);
    const Vector turn = cross(normal, along);
    a.spin_radps -= turn * Real(matter_a.radius_m * matter_a.inverse_inertia);
    b.spin_radps -= turn * Real(matter_b.radius_m * matter_b.inverse_inertia);
    impulse += along;
  }
  a.velocity_mps -= impulse * matter_a.inverse_mass;
  b.velocity_mps += impulse * matter_b.inverse_mass;
  return impulse;
}

}  // namespace carom::exact
