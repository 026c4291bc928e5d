#include "reference/converged/impact.h"

#include <cmath>

namespace carom::converged {

namespace {

Vector tangential_impulse(const Contact& contact, const Vector& n, const Real& normal_Ns, const Side& a,
                          const Side& b) {
  if (contact.friction == 0.0) return Vector::Zero();
  const Vector slip = (b.v - b.spin.cross(n) * b.radius_m) - (a.v + a.spin.cross(n) * a.radius_m);
  const Vector along = slip - n * slip.dot(n);
  const Real yield = a.per_mass + a.per_turning + b.per_mass + b.per_turning;
  Vector sticking = along * (-(1 + Real(contact.tangential_restitution)) / yield);
  const Real most_Ns = Real(contact.friction) * normal_Ns;
  if (sticking.norm() <= most_Ns) return sticking;
  return along * (-most_Ns / along.norm());
}

/// Δω = arm × J / I with the arm to the contact, of length r.
void turn(Side& side, const Vector& n, const Vector& impulse_on_b) {
  // -r n × J for b and r n × (-J) for a: the same.
  if (side.per_turning != 0) side.spin -= n.cross(impulse_on_b) * (side.per_turning / side.radius_m);
}

}  // namespace

Side Side::of(const Ball& ball, const Vector& v, const Vector& spin) {
  Side side;
  side.radius_m = ball.radius;
  side.v = v;
  side.spin = spin;
  if (std::isinf(ball.mass)) return side;
  side.per_mass = 1 / Real(ball.mass);
  side.per_turning = side.per_mass / ball.inertia;
  return side;
}

Vector strike(const Contact& contact, const Vector& n, Side& a, Side& b) {
  const Real normal_Ns = -(1 + Real(contact.restitution)) * (b.v - a.v).dot(n) / (a.per_mass + b.per_mass);
  Vector impulse = n * normal_Ns + tangential_impulse(contact, n, normal_Ns, a, b);
  a.v -= impulse * a.per_mass;
  b.v += impulse * b.per_mass;
  if (contact.friction != 0.0) {
    turn(a, n, impulse);
    turn(b, n, impulse);
  }
  return impulse;
}

}  // namespace carom::converged
