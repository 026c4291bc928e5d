#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Throws what is no std::exception.
class Throw final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override { throw 42; }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Throw>)
