#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Forgets to write the state of the last ball.
class Silent final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void snapshot(std::span<BallState> balls) const override {
    StillSimulation::snapshot(balls.first(balls.size() - 1));
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Silent>)
