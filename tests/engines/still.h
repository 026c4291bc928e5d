#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <vector>

#include "engine/engine.h"

namespace carom::test {

/// A simulation in which nothing ever moves: what the broken engines of the tests are made from.
class StillSimulation : public Simulation {
 public:
  explicit StillSimulation(const Scenario& scene) {
    for (const Ball& ball : scene.balls) states_.push_back({ball.position, ball.velocity, ball.spin});
  }

  void advance(double /*step_s*/, std::int64_t /*steps*/) override {}
  void snapshot(std::span<BallState> balls) const override {
    std::copy_n(states_.begin(), balls.size(), balls.begin());
  }
  Tally tally() const override { return {}; }
  Settings settings() const override { return {}; }

 protected:
  std::vector<BallState> states_;
};

/// An engine that makes one kind of simulation of whatever it is given.
template <class SimulationType>
class TestEngine final : public Engine {
 public:
  EngineInfo info() const override {
    EngineInfo info;
    info.name = "test";
    info.about = "An engine that is broken on purpose";
    info.version = "1";
    info.precision = "float64";
    info.profiles = {{"faithful", "Broken."}};
    return info;
  }

  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view /*profile*/) const override {
    return std::make_unique<SimulationType>(scene);
  }
};

}  // namespace carom::test
