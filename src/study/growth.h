#pragma once

#include <cstdint>
#include <vector>

#include "scenario/scenario.h"
#include "study/measure.h"
#include "study/study.h"

namespace carom {

/// Timed runs of each number of balls in each engine, at most.
inline constexpr int kGrowthRepeats = 3;

/// The numbers of balls that the growth of the cost is measured at: powers of ten from 10 to 10⁵.
std::vector<std::int64_t> growth_balls();

/// A gas of so many equal elastic balls of radius 1 m and rms speed 1 m/s in a box of this packing. It lasts
/// kGrowthSteps steps of a tenth of a second, in which a ball moves a tenth of its radius.
ScenarioPtr gas_to_grow(int dimension, double packing, std::int64_t balls);

/// A kind of gas.
struct GasKind {
  int dimension = 2;
  double packing = 0.1;
};

/// Whether it was measured with this kind of gas.
inline bool is_of(const StudyGrowth& growth, const GasKind& kind) {
  return growth.dimension == kind.dimension && growth.packing == kind.packing;
}

/// The kinds of gas among the scenes of a study, each dimension once, with the packing of the first.
std::vector<GasKind> gas_kinds(const std::vector<ScenarioPtr>& scenes);

/// Measures the time of every engine at each number of balls, few balls first; one that is foreseen to take
/// longer than the limit is not run, nor what comes when the budget of the kind is used up. What `into` tells
/// already is not measured again.
void measure_growth(const GasKind& kind, const std::vector<EngineChoice>& engines, const StudyLimits& limits,
                    const StudyWatch& watch, std::vector<StudyGrowth>& into);

}  // namespace carom
