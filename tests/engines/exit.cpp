#include <cstdlib>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Ends the process in the middle, as if all were well.
class Exit final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override { std::_Exit(0); }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Exit>)
