#include "tests/engines/lopsided.h"

CAROM_ENGINE_MODULE(carom::test::TestEngine<carom::test::LopsidedGas<carom::test::BallZeroIsHeavier>>)
