#include "scenario/cast.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <variant>

namespace carom {

namespace {

bool adds(const Action& action) {
  return std::holds_alternative<AddBall>(action);
}

}  // namespace

std::size_t numbered_balls(const Scenario& scene) {
  std::size_t count = scene.balls.size();
  for (const Event& event : scene.events) {
    count += static_cast<std::size_t>(std::count_if(event.actions.begin(), event.actions.end(), adds));
  }
  return count;
}

double frame_time_s(const Scenario& scene, std::int64_t frame) {
  return scene.duration_s * static_cast<double>(frame) / static_cast<double>(scene.frames);
}

double same_moment_s(const Scenario& scene) {
  return 4.0 * std::numeric_limits<double>::epsilon() * scene.duration_s;
}

std::int64_t first_frame_after(const Scenario& scene, const Event& event) {
  const auto shows = [&](std::int64_t frame) {
    return event.time <= frame_time_s(scene, frame) + same_moment_s(scene);
  };
  const double share = event.time / scene.duration_s * static_cast<double>(scene.frames);
  auto frame = std::clamp<std::int64_t>(std::llround(share), 0, scene.frames);
  while (frame > 0 && shows(frame - 1)) --frame;
  while (frame < scene.frames && !shows(frame)) ++frame;
  return frame;
}

Cast::Cast(const Scenario& scene)
    : scene_(&scene), balls_(scene.balls.begin(), scene.balls.end()), next_number_(scene.balls.size()) {
  balls_.resize(numbered_balls(scene));
}

const Event* Cast::next() const {
  return next_event_ < scene_->events.size() ? &scene_->events[next_event_] : nullptr;
}

std::vector<BallChange> Cast::take_next() {
  const Event& event = scene_->events[next_event_++];
  std::vector<BallChange> changes;
  if (!std::all_of(event.actions.begin(), event.actions.end(), adds)) {
    changes.push_back({event.ball, balls_[event.ball], {}});
  }
  for (const Action& action : event.actions) {
    if (adds(action)) changes.push_back({next_number_, {}, {}});
    act(event, action);
  }
  for (BallChange& change : changes) change.after = balls_[change.ball];
  return changes;
}

void Cast::act(const Event& event, const Action& action) {
  if (const auto* added = std::get_if<AddBall>(&action)) {
    balls_[next_number_++] = added->ball;
    return;
  }
  std::optional<Ball>& ball = balls_[event.ball];
  if (!ball) return;  // an action after `remove`
  if (const auto* mass = std::get_if<ScaleMass>(&action)) {
    ball->mass *= mass->factor;
  } else if (const auto* radius = std::get_if<ScaleRadius>(&action)) {
    ball->radius *= radius->factor;
    ball->spin /= radius->factor * radius->factor;  // (1)
  } else if (const auto* velocity = std::get_if<SetVelocity>(&action)) {
    ball->velocity = velocity->velocity;
  } else if (const auto* place = std::get_if<SetPosition>(&action)) {
    ball->position = place->position;
  } else {
    ball.reset();
  }
}

void Cast::to_frame(std::int64_t frame, const std::function<void(const BallChange&)>& told) {
  while (next() != nullptr && first_frame_after(*scene_, *next()) <= frame) {
    const std::vector<BallChange> changes = take_next();
    if (told) std::for_each(changes.begin(), changes.end(), told);
  }
}

bool ever(const Scenario& scene, const std::function<bool(const Ball&)>& holds) {
  if (std::any_of(scene.balls.begin(), scene.balls.end(), holds)) return true;
  if (scene.events.empty()) return false;
  Cast cast(scene);
  while (cast.next() != nullptr) {
    for (const BallChange& change : cast.take_next()) {
      if (change.after && holds(*change.after)) return true;
    }
  }
  return false;
}

}  // namespace carom
