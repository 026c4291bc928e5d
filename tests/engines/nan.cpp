#include <limits>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Gives a ball that is nowhere.
class Nan final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override {
    states_.back().position.x() = std::numeric_limits<double>::quiet_NaN();
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Nan>)
