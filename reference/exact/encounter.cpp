#include "reference/exact/encounter.h"

namespace carom::exact {

Encounter::Encounter(const Setting& setting, const Scenario& scene, const Touch& touch, Body& ball,
                     Body& partner)
    : a_(touch.wall ? &still_ : &ball),
      b_(touch.wall ? &ball : &partner),
      matter_a_(touch.wall ? &setting.wall_matter : &setting.matter[touch.ball]),
      matter_b_(&setting.matter[touch.wall ? touch.ball : touch.partner]),
      contact_(touch.wall ? &scene.wall_contact : &scene.ball_contact),
      setting_(&setting) {
  if (touch.wall) {
    normal_ = setting.walls[touch.partner].normal;
  } else {
    const Vector d = partner.position_m - ball.position_m;
    normal_ = d * Real(1 / length(d));
  }
}

/// Along n, from a to b, b moves away from a at g_b·n - g_a·n. Two balls at a distance R that pass each other
/// at v_t along the surface also part at v_t²/R, as the normal turns.
Real Encounter::pressing_mps2() const {
  if (!setting_->gravity || matter_a_->movable() == matter_b_->movable()) return 0;
  const Real away = dot(setting_->gravity_mps2, normal_) * (matter_b_->movable() ? 1 : -1);
  if (a_ == &still_) return -away;
  Vector v = b_->velocity_mps - a_->velocity_mps;
  v -= normal_ * dot(v, normal_);
  return -away - dot(v, v) / (matter_a_->radius_m + matter_b_->radius_m);
}

}  // namespace carom::exact
