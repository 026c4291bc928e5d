#include "carom/broad_phase/uniform_grid.h"
#include "tests/benchmarks/bare.h"

namespace carom::benchmark {

std::unique_ptr<BroadPhase<3>> make_grid() {
  return std::make_unique<BroadPhaseOf<3, UniformGrid<3>>>();
}

}  // namespace carom::benchmark
