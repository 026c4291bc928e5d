#include <algorithm>
#include <cmath>
#include <string>

#include "tests/engines/plain/defects.h"

namespace carom::plain {

namespace {

/// The plain engine: right in its faithful profile, and in each other one wrong in the way that it is
/// named for.
class PlainEngine final : public Engine {
 public:
  EngineInfo info() const override {
    EngineInfo info;
    info.name = "plain";
    info.about = "A plain event-driven engine, and broken variants of it that the gates must catch";
    info.version = "1";
    info.precision = "float64";
    info.profiles = {{"faithful", "Nothing is broken."}};
    for (const Defect& defect : defects()) {
      info.profiles.push_back({std::string(defect.name), std::string(defect.what)});
    }
    for (const Feature feature :
         {Feature::simultaneous, Feature::generalized_reflections, Feature::barrier}) {
      info.cannot[feature] = "it is too plain for that";
    }
    return info;
  }

  std::string refuses(const Scenario& scene, std::string_view /*profile*/) const override {
    // It looks at every pair at every impact.
    constexpr std::size_t kMostBalls = 100;
    const Effects& effects = scene.effects;
    if (scene.balls.size() > kMostBalls) return "more than 100 balls";
    const bool meets = scene.balls.size() > 1 || !scene.walls.empty() || !scene.slabs.empty();
    if ((effects.drag || effects.magnus) && meets) return "drag or the Magnus force with impacts";
    if (effects.gravity && scene.wall_contact.restitution < 1.0 && meets) return "a ball that comes to rest";
    if (effects.gravity && immovable(scene)) return "gravity with an immovable ball";
    if (may_collapse(scene)) return "balls that may collapse";
    if (overlap(scene)) return "balls that overlap when the scene begins";
    return {};
  }

  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view profile) const override {
    for (const Defect& defect : defects()) {
      if (defect.name == profile) return defect.make(scene);
    }
    return std::make_unique<Plain>(scene);
  }

 private:
  static bool immovable(const Scenario& scene) {
    return std::any_of(scene.balls.begin(), scene.balls.end(),
                       [](const Ball& ball) { return std::isinf(ball.mass); });
  }

  /// About ln(4/(1 − e))/(1 − e) balls in a line can collapse, three at e = 7 − 4√3; a wall is a mirror.
  static bool may_collapse(const Scenario& scene) {
    const double loss = 1.0 - std::min(scene.ball_contact.restitution, scene.wall_contact.restitution);
    const std::size_t bodies = scene.balls.size() * (scene.walls.empty() ? 1 : 2);
    if (!scene.effects.collisions || loss == 0.0 || scene.balls.size() < 2 || bodies < 3) return false;
    return scene.ball_contact.restitution < 1.0 && static_cast<double>(bodies) >= std::log(4.0 / loss) / loss;
  }

  static bool overlap(const Scenario& scene) {
    for (std::size_t a = 0; a < scene.balls.size(); ++a) {
      for (std::size_t b = a + 1; b < scene.balls.size(); ++b) {
        const double distance_m = (scene.balls[a].position - scene.balls[b].position).norm();
        if (distance_m < scene.balls[a].radius + scene.balls[b].radius) return scene.effects.collisions;
      }
    }
    return false;
  }
};

}  // namespace

}  // namespace carom::plain

CAROM_ENGINE_MODULE(carom::plain::PlainEngine)
