#include "trajectory/interference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

namespace carom {

namespace {

using Json = nlohmann::json;

Json pack(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

Vec3 vector_from(const Json& json) {
  return Vec3(json.at(0).get<double>(), json.at(1).get<double>(), json.at(2).get<double>());
}

/// JSON has no infinity: an immovable ball's mass is null.
Json pack(const std::optional<Ball>& ball) {
  if (!ball) return nullptr;
  return {std::isinf(ball->mass) ? Json(nullptr) : Json(ball->mass),
          ball->radius,
          pack(ball->position),
          pack(ball->velocity),
          pack(ball->spin),
          ball->inertia};
}

std::optional<Ball> ball_from(const Json& json) {
  if (json.is_null()) return std::nullopt;
  Ball ball;
  ball.mass = json.at(0).is_null() ? std::numeric_limits<double>::infinity() : json.at(0).get<double>();
  ball.radius = json.at(1);
  ball.position = vector_from(json.at(2));
  ball.velocity = vector_from(json.at(3));
  ball.spin = vector_from(json.at(4));
  ball.inertia = json.at(5);
  return ball;
}

}  // namespace

double overlap_radii(const Scenario& scene, const Cast& cast, std::size_t ball) {
  if (!cast[ball]) return 0.0;
  const Ball& self = *cast[ball];
  double deepest = 0.0;
  if (std::isfinite(self.mass)) {
    for (const Wall& wall : scene.walls) {
      const double gap = wall.normal.dot(self.position) - wall.offset - self.radius;
      deepest = std::max(deepest, -gap / self.radius);
    }
  }
  for (std::size_t i = 0; scene.effects.collisions && i < cast.size(); ++i) {
    if (i == ball || !cast[i] || !(std::isfinite(self.mass) || std::isfinite(cast[i]->mass))) continue;
    const double gap = (cast[i]->position - self.position).norm() - self.radius - cast[i]->radius;
    deepest = std::max(deepest, -gap / std::min(self.radius, cast[i]->radius));
  }
  return deepest;
}

std::string packed(const std::vector<Interference>& interferences) {
  Json json = Json::array();
  for (const Interference& each : interferences) {
    Json changes = Json::array();
    for (const BallChange& change : each.changes) {
      changes.push_back({change.ball, pack(change.before), pack(change.after)});
    }
    json.push_back({each.time_s, each.overlap_radii, std::move(changes)});
  }
  return json.dump();
}

std::vector<Interference> unpacked_interferences(const std::string& text) {
  std::vector<Interference> interferences;
  for (const Json& row : Json::parse(text)) {
    Interference& each = interferences.emplace_back();
    each.time_s = row.at(0);
    each.overlap_radii = row.at(1);
    for (const Json& change : row.at(2)) {
      each.changes.push_back({change.at(0), ball_from(change.at(1)), ball_from(change.at(2))});
    }
  }
  return interferences;
}

}  // namespace carom
