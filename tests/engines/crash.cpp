#include <csignal>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Writes where nothing is.
class Crash final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override { std::raise(SIGSEGV); }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Crash>)
