#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"
#include "scenario/scenario.h"

namespace carom {

/// A moment as an engine means it that takes so many equal steps: step_s × steps, which as a product is exact
/// and as a double in general is not.
struct Moment {
  double step_s = 0.0;
  std::int64_t steps = 0;
};

/// An impact of the true motion: of two balls, or of a ball and a wall of the scene.
struct TrueImpact {
  double time_s = 0.0;
  std::uint32_t ball = 0;
  std::uint32_t partner = 0;  ///< another ball, or an index into Scenario::walls
  bool wall = false;
};

/// Impacts at one moment, as far as the scene's numbers tell, which are decimals rounded to doubles. What
/// follows depends on their order at most where they share a ball.
struct Tie {
  double time_s = 0.0;
  std::vector<std::uint32_t> balls;  ///< of all of them, sorted
  bool shares_ball = false;
};

/// What a truth source knows of a motion beside its states.
struct Solution {
  double uncertainty_m = 0.0;           ///< a bound on the error of every position handed out
  std::optional<double> known_until_s;  ///< nothing: the whole duration
  std::string limit;                    ///< why it is not known for longer
  int digits = 0;                 ///< decimal digits of the arithmetic; 0 where their number is not its means
  std::int64_t impact_count = 0;  ///< while it is known
  std::vector<TrueImpact> impacts;  ///< the first kMostImpactsTold of them, in order of time
  std::vector<Tie> ties;            ///< the first kMostTiesTold
  /// For each moment asked for: how much larger than at the start a small change of the initial positions and
  /// velocities has become, |δx(t)|_max / |δ|, with δ of a random direction and |δ| the largest change of any
  /// position (m) or, over the duration, velocity (m/s × duration). An axis along which all balls are level
  /// and still, so that no rounding moves them along it, is left out of δ. Shorter where the change is not
  /// followed any further, and empty where it was not found out.
  std::vector<double> amplification;

  static constexpr std::size_t kMostImpactsTold = 100'000;
  static constexpr std::size_t kMostTiesTold = 100;
};

/// A way to know how a scene truly goes, independent of every engine that it judges: a closed form,
/// arithmetic of certified precision, a converged integration.
class TruthSource {
 public:
  /// Takes the states of all balls at the k-th moment asked for, with what walls pushed until then.
  using Taker = std::function<void(std::size_t k, std::span<const BallState> balls, const Tally& tally)>;

  TruthSource() = default;
  TruthSource(const TruthSource&) = delete;
  TruthSource& operator=(const TruthSource&) = delete;
  virtual ~TruthSource() = default;

  /// "closed-form", "exact" or "converged".
  virtual std::string_view kind() const = 0;

  /// Why the scene is beyond this source ("no closed form: …"); empty where it is not.
  virtual std::string refuses(const Scenario& scenario) const = 0;

  /// Solves the scene and hands out its states at the moments asked for, up to the last that is known; at the
  /// moment of an impact, those after it. How far it gets depends on the scene alone, not on a clock.
  /// @param moments  ascending, from 0; they may pass the scene's duration a little
  /// @pre refuses() is empty. @throws std::exception where something goes wrong, with the reason.
  virtual Solution solve(const Scenario& scenario, std::span<const Moment> moments,
                         const Taker& take) const = 0;
};

}  // namespace carom
