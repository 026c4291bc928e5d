#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"
#include "engine/tuning.h"
#include "trajectory/cpu_time.h"
#include "trajectory/record.h"

namespace carom::test {

/// Flies on straight lines, and is off along x by C hᵖ t: an engine of which the order is known.
class KnownOrderSimulation final : public Simulation {
 public:
  KnownOrderSimulation(const Scenario& scene, double order, double factor)
      : scene_(scene), order_(order), factor_(factor) {}

  void advance(double step_s, std::int64_t steps) override {
    const double span_s = step_s * static_cast<double>(steps);
    time_s_ += span_s;
    off_m_ += factor_ * std::pow(step_s, order_) * span_s;
  }
  void snapshot(std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const Ball& ball = scene_.balls[i];
      balls[i] = {ball.position + time_s_ * ball.velocity + off_m_ * Vec3::UnitX(), ball.velocity, ball.spin};
    }
  }
  Tally tally() const override { return {}; }
  Settings settings() const override { return {}; }

 private:
  const Scenario& scene_;
  double order_;
  double factor_;
  double time_s_ = 0.0;
  double off_m_ = 0.0;
};

/// An engine of known order, whose one setting multiplies its error; and what else a study must live with.
class KnownOrder final : public Engine, public Tunable {
 public:
  explicit KnownOrder(double order) : order_(order) {}

  EngineInfo info() const override {
    return {"known", "of known order", "1", "float64", {{"faithful", "the only one"}}, {}, {}, {}};
  }
  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view /*profile*/) const override {
    return std::make_unique<KnownOrderSimulation>(scene, order_, 1.0);
  }

  bool takes_steps(const Scenario& /*scene*/) const override { return true; }
  ClaimedOrder claimed_order(const Scenario& /*scene*/) const override { return static_cast<int>(order_); }
  std::vector<Tuning> tunings(const Scenario& /*scene*/, std::string_view /*profile*/) const override {
    return {{"factor", "multiplies the error", {3.0}, true},
            {"colour", "nothing", {std::string("red")}, false}};
  }
  std::unique_ptr<Simulation> create_tuned(const Scenario& scene, std::string_view /*profile*/,
                                           const Tuned& tuned) const override {
    const double factor = tuned.name == "factor" ? std::get<double>(tuned.value) : 1.0;
    return std::make_unique<KnownOrderSimulation>(scene, order_, factor);
  }

 private:
  double order_;
};

/// As long in every step as in another, kStepCost_s, and right.
class SlowSimulation final : public Simulation {
 public:
  static constexpr double kStepCost_s = 5e-5;

  explicit SlowSimulation(const Scenario& scene) : flight_(scene, 0.0, 0.0) {}

  void advance(double step_s, std::int64_t steps) override {
    const double until_s = cpu_now() + kStepCost_s * static_cast<double>(steps);
    while (cpu_now() < until_s) {
    }
    flight_.advance(step_s, steps);
  }
  void snapshot(std::span<BallState> balls) const override { flight_.snapshot(balls); }
  Tally tally() const override { return {}; }
  Settings settings() const override { return {}; }

 private:
  KnownOrderSimulation flight_;
};

class Slow final : public Engine {
 public:
  EngineInfo info() const override {
    return {"slow", "takes its time", "1", "float64", {{"faithful", "the only one"}}, {}, {}, {}};
  }
  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view /*profile*/) const override {
    return std::make_unique<SlowSimulation>(scene);
  }
};

/// Ends by an exception in whatever scene.
class Throws final : public Engine {
 public:
  EngineInfo info() const override {
    return {"throws", "ends by an exception", "1", "float64", {{"faithful", "the only one"}}, {}, {}, {}};
  }
  std::unique_ptr<Simulation> create(const Scenario& /*scene*/, std::string_view /*profile*/) const override {
    throw std::runtime_error("no world today");
  }
};

template <class EngineType, class... Arguments>
EngineChoice choice_of(const std::string& name, Arguments... arguments) {
  const auto engine = std::make_shared<EngineType>(arguments...);
  return {{name, [engine]() -> const Engine& { return *engine; }}, "faithful"};
}

}  // namespace carom::test
