#include <chrono>
#include <thread>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Never comes back.
class Hang final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override {
    while (true) std::this_thread::sleep_for(std::chrono::seconds(1));
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Hang>)
