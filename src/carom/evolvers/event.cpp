#include "carom/evolvers/event.h"

#include <algorithm>
#include <cmath>

#include "carom/evolvers/event_start.h"

namespace carom {

namespace {

bool has_immovable(const Scenario& scene) {
  return std::any_of(scene.balls.begin(), scene.balls.end(),
                     [](const Ball& ball) { return std::isinf(ball.mass); });
}

/// Whether gravity presses balls on something that takes their energy.
bool balls_come_to_rest(const Scenario& scene) {
  if (!scene.effects.gravity || scene.effects.gravity->isZero(0.0)) return false;
  const bool on_walls = !scene.walls.empty();
  if (on_walls && scene.wall_contact.restitution < 1.0) return true;
  const bool on_anything = on_walls || has_immovable(scene);
  return scene.effects.collisions && on_anything && scene.ball_contact.restitution < 1.0;
}

}  // namespace

std::string event_refusal(const Scenario& scene) {
  if (scene.effects.drag)
    return "it jumps along exact flights, and those under drag have no closed form for impacts";
  if (scene.effects.magnus) return "it jumps along exact flights, and takes no Magnus force";
  if (!scene.slabs.empty()) return "its walls have one side: it takes no slabs";
  if (!scene.barriers.empty()) return "its walls have one side: it takes no quantum barriers";
  if (scene.multi_contact != MultiContact::sequential) {
    return "it carries out one impact after the other: it takes no law for several contacts at once";
  }
  if (balls_come_to_rest(scene)) {
    return "under gravity and with restitution below 1 balls come to rest after infinitely many impacts, "
           "which it cannot jump over";
  }
  return lies_at_start(scene);
}

}  // namespace carom
