#pragma once

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <string>
#include <vector>

#include "tests/reference/support.h"

namespace carom::reference_test {

// What the table of switches of every reference adapter has to do. Each function returns what is wrong, in
// words; nothing where all is well.

/// A ball that falls and rebounds, rolls and hits another: something for every setting to act on.
inline Scenario scene_for_switches() {
  Scenario scene = scene_of(2, 0.01, 200);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.effects.spin = true;
  scene.ball_contact = scene.wall_contact = {0.7, 0.2, 0.0};
  add_box(scene, 4.0);
  scene.balls.push_back(ball(1.0, 0.1, {1.0, 0.5, 0.0}, {2.0, 0.0, 0.0}));
  scene.balls.push_back(ball(2.0, 0.2, {2.0, 0.2, 0.0}));
  return scene;
}

inline std::vector<std::string> switch_names(const Engine& engine) {
  std::vector<std::string> names;
  for (const Switch& each : engine.info().switches) names.push_back(each.name);
  return names;
}

inline std::vector<BallState> states_after(Simulation& simulation, const Scenario& scene) {
  simulation.advance(scene.step_s, scene.frames);
  std::vector<BallState> balls(scene.balls.size());
  simulation.snapshot(balls);
  return balls;
}

inline bool same_bits(const std::vector<BallState>& a, const std::vector<BallState>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const BallState& x, const BallState& y) {
    return x.position == y.position && x.velocity == y.velocity && x.spin == y.spin;
  });
}

/// With every setting switched, a profile must be the other one: in its settings and bit for bit.
inline std::vector<std::string> all_switched_is_not_the_other(const Engine& engine) {
  const Scenario scene = scene_for_switches();
  const std::vector<std::string> names = switch_names(engine);
  std::vector<std::string> wrong;
  if (names.empty()) wrong.emplace_back("there is nothing to switch");
  for (const auto& [from, to] : {std::pair{"default", "faithful"}, {"faithful", "default"}}) {
    const auto switched = engine.create_switched(scene, from, names);
    const auto other = engine.create(scene, to);
    if (switched->settings() != other->settings()) wrong.push_back(fmt::format("settings from {}", from));
    if (!same_bits(states_after(*switched, scene), states_after(*other, scene))) {
      wrong.push_back(fmt::format("states from {}", from));
    }
  }
  return wrong;
}

/// One setting switched takes its own value from the other profile and leaves those of all others alone.
inline std::vector<std::string> one_switched_moves_others(const Engine& engine) {
  const Scenario scene = scene_for_switches();
  const std::vector<std::string> names = switch_names(engine);
  const Settings from = engine.create(scene, "default")->settings();
  const Settings to = engine.create(scene, "faithful")->settings();
  std::vector<std::string> wrong;
  for (const std::string& name : names) {
    const Settings now = engine.create_switched(scene, "default", std::vector{name})->settings();
    if (from.at(name) == to.at(name)) wrong.push_back(name + " is the same in both profiles");
    if (now.at(name) != to.at(name)) wrong.push_back(name + " does not switch");
    for (const std::string& other : names) {
      if (other != name && now.at(other) != from.at(other))
        wrong.push_back(std::string(name).append(" switches ").append(other));
    }
  }
  return wrong;
}

}  // namespace carom::reference_test
