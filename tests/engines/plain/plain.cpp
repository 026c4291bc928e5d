#include "tests/engines/plain/plain.h"

#include <cmath>
#include <stdexcept>

namespace carom::plain {

namespace {

bool movable(const Body& body) {
  return std::isfinite(body.ball->mass);
}

double inverse(double mass) {
  return std::isfinite(mass) ? 1.0 / mass : 0.0;
}

}  // namespace

Plain::Plain(const Scenario& scene) : scene_(&scene) {
  for (const Ball& ball : scene.balls) bodies_.push_back({&ball, ball.position, ball.velocity, ball.spin});
}

void Plain::advance(double step_s, std::int64_t steps) {
  step_s_ = step_s;
  if (smooth()) {
    for (std::int64_t i = 0; i < steps; ++i) integrate(step_s);
    return;
  }
  // More impacts than this between two frames are a collapse, which this engine has no answer to.
  constexpr int kMostImpacts = 100'000;
  const double end_s = time_s_ + step_s * static_cast<double>(steps);
  for (int impacts = 0;; ++impacts) {
    if (impacts > kMostImpacts) throw std::runtime_error("the impacts do not end");
    const std::optional<Touch> touch = next_touch();
    if (!touch || time_s_ + touch->wait_s > end_s) break;
    fly(touch->wait_s);
    time_s_ += touch->wait_s;
    collide(*touch);
  }
  fly(end_s - time_s_);
  time_s_ = end_s;
}

void Plain::snapshot(std::span<BallState> balls) const {
  for (std::size_t i = 0; i < balls.size(); ++i) balls[i] = {bodies_[i].x, bodies_[i].v, bodies_[i].w};
}

// --- motion

Vec3 Plain::acceleration(const Body& body) const {
  Vec3 force = body.ball->mass * gravity();
  if (scene_->effects.drag) {
    const Drag& drag = *scene_->effects.drag;
    const double speed_mps = drag.kind == Drag::Kind::quadratic ? body.v.norm() : 1.0;
    force -= drag.coefficient * speed_mps * body.v;
  }
  if (scene_->effects.magnus) force += *scene_->effects.magnus * body.w.cross(body.v);
  return force / body.ball->mass;
}

void Plain::fly(double time_s) {
  for (Body& body : bodies_) {
    if (!movable(body)) {
      body.x += time_s * body.v;
      continue;
    }
    body.x += time_s * body.v + 0.5 * time_s * time_s * gravity();
    body.v += time_s * gravity();
  }
}

/// The classical Runge–Kutta method for x' = v, v' = a(v).
void Plain::integrate(double step_s) {
  for (Body& body : bodies_) {
    const auto at = [&](const Vec3& velocity) {
      Body moved = body;
      moved.v = velocity;
      return acceleration(moved);
    };
    const Vec3 v1 = body.v;
    const Vec3 a1 = at(v1);
    const Vec3 v2 = body.v + 0.5 * step_s * a1;
    const Vec3 a2 = at(v2);
    const Vec3 v3 = body.v + 0.5 * step_s * a2;
    const Vec3 a3 = at(v3);
    const Vec3 v4 = body.v + step_s * a3;
    const Vec3 a4 = at(v4);
    body.x += step_s / 6.0 * (v1 + 2.0 * v2 + 2.0 * v3 + v4);
    body.v += step_s / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4);
  }
}

// --- finding what meets

/// |d + u t| = R: t = (|d|² − R²)/(−d·u + √(|u|² R² − |d × u|²)), without cancellation for d·u < 0.
std::optional<double> Plain::wait(const Body& a, const Body& b) const {
  const Vec3 d = b.x - a.x;
  const Vec3 u = b.v - a.v;
  const double reach_m = radius(a) + radius(b);
  const double closing = -d.dot(u);
  if (closing <= 0.0) return std::nullopt;
  const double discriminant = u.squaredNorm() * reach_m * reach_m - d.cross(u).squaredNorm();
  const double gap = d.squaredNorm() - reach_m * reach_m;
  if (gap <= 0.0) return 0.0;
  if (discriminant < 0.0) return std::nullopt;
  return gap / (closing + std::sqrt(discriminant));
}

/// gap + v t + ½ a t² = 0 on the way in.
std::optional<double> Plain::wait(const Body& body, const Vec3& normal, double offset) const {
  const double gap = normal.dot(body.x) - offset - radius(body);
  const double v = normal.dot(body.v);
  const double a = normal.dot(gravity());
  if (gap <= 0.0 && v < 0.0) return 0.0;
  if (a == 0.0) return v < 0.0 ? std::optional(gap / -v) : std::nullopt;
  const double discriminant = v * v - 2.0 * a * gap;
  if (discriminant < 0.0 || (a > 0.0 && v >= 0.0)) return std::nullopt;
  const double root = std::sqrt(discriminant);
  return v < 0.0 ? 2.0 * gap / (root - v) : (v + root) / -a;
}

void Plain::take(std::optional<Touch>& first, const std::optional<double>& wait_s, Touch touch) {
  if (!wait_s || (first && *wait_s >= first->wait_s)) return;
  touch.wait_s = *wait_s;
  first = touch;
}

void Plain::add_walls(std::optional<Touch>& first, std::size_t a) const {
  const Body& body = bodies_[a];
  if (!movable(body)) return;
  for (std::size_t k = 0; k < scene_->walls.size(); ++k) {
    const Wall& wall = scene_->walls[k];
    if (sees_wall(k)) take(first, wait(body, wall.normal, wall.offset), {a, std::nullopt, -wall.normal, 0.0});
  }
  for (const Slab& slab : scene_->slabs) {
    const Vec3 out = slab.normal.dot(body.x) > slab.offset ? slab.normal : Vec3(-slab.normal);
    const double face = out.dot(slab.normal) * slab.offset + 0.5 * slab.thickness;
    take(first, wait(body, out, face), {a, std::nullopt, -out, 0.0});
  }
}

std::optional<Touch> Plain::next_touch() const {
  std::optional<Touch> first;
  for (std::size_t a = 0; a < bodies_.size(); ++a) {
    add_walls(first, a);
    if (!scene_->effects.collisions) continue;
    for (std::size_t b = a + 1; b < bodies_.size(); ++b) {
      if (!movable(bodies_[a]) && !movable(bodies_[b])) continue;
      if (sees(bodies_[a], bodies_[b])) take(first, wait(bodies_[a], bodies_[b]), {a, b, Vec3::Zero(), 0.0});
    }
  }
  return first;
}

// --- what happens then

void Plain::collide(const Touch& touch) {
  Touch now = touch;
  if (touch.b) now.normal = (bodies_[*touch.b].x - bodies_[touch.a].x).normalized();
  push(now, impulse(now));
  ++tally_.impacts;
}

Contact Plain::surface(const Touch& touch) const {
  return touch.b ? scene_->ball_contact : scene_->wall_contact;
}

/// g = v_b − v_a − (r_a ω_a + r_b ω_b) × n; a wall neither moves nor turns.
Vec3 Plain::slip(const Touch& touch) const {
  const Body& a = bodies_[touch.a];
  Vec3 velocity = -a.v;
  Vec3 turning = a.ball->radius * a.w;
  if (touch.b) {
    velocity += bodies_[*touch.b].v;
    turning += bodies_[*touch.b].ball->radius * bodies_[*touch.b].w;
  }
  return velocity - turning.cross(touch.normal);
}

Vec3 Plain::impulse(const Touch& touch) const {
  const Contact contact = surface(touch);
  const Body& a = bodies_[touch.a];
  const Body* b = touch.b ? &bodies_[*touch.b] : nullptr;
  double normal_share = inverse(mass(a, touch));
  double tangential_share = normal_share * (1.0 + 1.0 / inertia(a));
  if (b != nullptr) {
    normal_share += inverse(mass(*b, touch));
    tangential_share += inverse(mass(*b, touch)) * (1.0 + 1.0 / inertia(*b));
  }
  const Vec3 g = slip(touch);
  const double g_n = g.dot(touch.normal);
  const double normal_Ns = -(1.0 + contact.restitution) * g_n / normal_share;
  Vec3 total = normal_Ns * touch.normal;
  const Vec3 g_t = g - g_n * touch.normal;
  if (contact.friction > 0.0 && g_t.norm() > 0.0) {
    const double sticking_Ns = (1.0 + contact.tangential_restitution) * g_t.norm() / tangential_share;
    total -= std::min(sticking_Ns, contact.friction * normal_Ns) * g_t.normalized();
  }
  return total;
}

void Plain::push(const Touch& touch, const Vec3& impulse_Ns) {
  Body& a = bodies_[touch.a];
  const Vec3 at = a.x + a.ball->radius * touch.normal;
  push(a, touch, touch.normal, -impulse_Ns);
  if (touch.b) push(bodies_[*touch.b], touch, -touch.normal, impulse_Ns);
  if (!touch.b || !movable(bodies_[*touch.b])) book(-impulse_Ns, at);
  if (touch.b && !movable(a)) book(impulse_Ns, at);
}

void Plain::push(Body& body, const Touch& touch, const Vec3& out, const Vec3& impulse_Ns) const {
  if (!movable(body)) return;
  const double m = mass(body, touch);
  body.v += impulse_Ns / m;
  if (!scene_->effects.spin) return;
  const double r = body.ball->radius;
  body.w += r * out.cross(impulse_Ns) / (inertia(body) * m * r * r);
}

void Plain::book(const Vec3& impulse_Ns, const Vec3& at) {
  tally_.external_impulse += impulse_Ns;
  tally_.external_angular_impulse += at.cross(impulse_Ns);
}

}  // namespace carom::plain
