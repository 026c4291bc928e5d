#include <new>
#include <vector>

#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// Takes more and more memory; where nothing stops it, it ends itself before the machine does.
class Memory final : public StillSimulation {
 public:
  using StillSimulation::StillSimulation;
  void advance(double /*step_s*/, std::int64_t /*steps*/) override {
    constexpr std::size_t kEnough = std::size_t{1} << 30U;
    for (std::size_t bytes = std::size_t{1} << 20U; bytes <= kEnough; bytes *= 2) {
      hoard_.emplace_back(bytes, 'x');
    }
    throw std::bad_alloc();
  }

 private:
  std::vector<std::vector<char>> hoard_;
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::Memory>)
