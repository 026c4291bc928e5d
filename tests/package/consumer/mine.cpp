#include <engine/engine.h>

#include <cmath>
#include <memory>
#include <vector>

namespace {

/// Two balls without spin: they fly straight, hit each other at most once, and fly on.
class TwoBalls final : public carom::Simulation {
 public:
  explicit TwoBalls(const carom::Scenario& scene) : scene_(scene) {
    for (const carom::Ball& ball : scene.balls) balls_.push_back({ball.position, ball.velocity, ball.spin});
  }

  void advance(double step_s, std::int64_t steps) override {
    const double time_s = step_s * static_cast<double>(steps);
    const double wait_s = until_impact();
    if (wait_s > time_s) return fly(time_s);
    fly(wait_s);
    collide();
    fly(time_s - wait_s);
  }

  void snapshot(std::span<carom::BallState> balls) const override {
    std::copy(balls_.begin(), balls_.end(), balls.begin());
  }
  carom::Tally tally() const override { return {}; }
  carom::Settings settings() const override { return {}; }

 private:
  void fly(double time_s) {
    for (carom::BallState& ball : balls_) ball.position += time_s * ball.velocity;
  }

  double until_impact() const {
    const carom::Vec3 d = balls_[1].position - balls_[0].position;
    const carom::Vec3 u = balls_[1].velocity - balls_[0].velocity;
    const double reach = scene_.balls[0].radius + scene_.balls[1].radius;
    const double discriminant = u.squaredNorm() * reach * reach - d.cross(u).squaredNorm();
    if (d.dot(u) >= 0.0 || discriminant < 0.0) return INFINITY;
    return std::fmax((d.squaredNorm() - reach * reach) / (std::sqrt(discriminant) - d.dot(u)), 0.0);
  }

  void collide() {
    const double a = scene_.balls[0].mass;
    const double b = scene_.balls[1].mass;
    const carom::Vec3 n = (balls_[1].position - balls_[0].position).normalized();
    const double closing = n.dot(balls_[0].velocity - balls_[1].velocity);
    const double impulse = (1.0 + scene_.ball_contact.restitution) * closing * a * b / (a + b);
    balls_[0].velocity -= impulse / a * n;
#ifndef FORGET_THE_SECOND_BALL
    balls_[1].velocity += impulse / b * n;
#endif
  }

  const carom::Scenario& scene_;
  std::vector<carom::BallState> balls_;
};

class Mine final : public carom::Engine {
 public:
  carom::EngineInfo info() const override {
    carom::EngineInfo info;
    info.name = "mine";
    info.about = "Two balls";
    info.version = "1";
    info.precision = "float64";
    info.profiles = {{"faithful", "The only one."}};
    for (const carom::Feature feature :
         {carom::Feature::walls, carom::Feature::gravity, carom::Feature::spin}) {
      info.cannot[feature] = "two balls in empty space are all there is";
    }
    return info;
  }

  std::string refuses(const carom::Scenario& scene, std::string_view /*profile*/) const override {
    return scene.balls.size() == 2 ? "" : "it knows two balls";
  }

  std::unique_ptr<carom::Simulation> create(const carom::Scenario& scene,
                                            std::string_view /*profile*/) const override {
    return std::make_unique<TwoBalls>(scene);
  }
};

}  // namespace

CAROM_ENGINE_MODULE(Mine)
