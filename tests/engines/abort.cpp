#include <cstdio>
#include <cstdlib>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Ends like an assertion in a library: a line on stderr, then abort().
class Abort final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override {
    std::fputs("solver.c:42: step: Assertion `mass > 0' failed.\n", stderr);
    std::abort();
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Abort>)
