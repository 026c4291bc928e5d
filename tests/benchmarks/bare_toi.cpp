#include "carom/evolvers/toi.h"
#include "tests/benchmarks/bare.h"

int main(int /*argc*/, char** argv) {
  return carom::benchmark::run_bare<carom::ToiEvolver>("toi", argv);
}
