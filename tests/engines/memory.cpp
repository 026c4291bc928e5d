#include <vector>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Takes memory without end.
class Memory final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override {
    for (std::size_t bytes = std::size_t{1} << 20U;; bytes *= 2) {
      hoard_.emplace_back(bytes, 'x');
    }
  }

 private:
  std::vector<std::vector<char>> hoard_;
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Memory>)
