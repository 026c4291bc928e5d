#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "engine/engine.h"
#include "reference/closed_form/twofold.h"

namespace carom::closed_form {

/// The motion of every ball of a scene in closed form.
class Motion {
 public:
  Motion() = default;
  Motion(const Motion&) = delete;
  Motion& operator=(const Motion&) = delete;
  virtual ~Motion() = default;

  virtual std::string_view family() const = 0;

  /// Positions and velocities at a moment; at the moment of an impact, those after it. The spins come in as
  /// they were at the start, and stay so in families where nothing changes them. @pre 0 <= time_s, and no
  /// later than the scene's duration but for its rounding.
  virtual void evaluate(const Twofold& time_s, std::span<BallState> balls) const = 0;

  /// What happened up to and including a moment.
  virtual Tally tally(const Twofold& time_s) const = 0;

  /// A bound on the error of every position up to the scene's duration.
  virtual double uncertainty_m() const = 0;
};

/// What a family makes of a scene: its motion; or why the scene is beyond it; or neither, where the scene is
/// not of the family's kind.
struct Attempt {
  std::unique_ptr<Motion> motion;
  std::string reason;
};

/// Every axis by itself: uniform or uniformly accelerated, between walls across it.
Attempt try_separable(const Scenario& scenario);
/// Flight through a resisting medium that meets nothing.
Attempt try_drag(const Scenario& scenario);
/// Any number of balls on one line, with walls across it.
Attempt try_line(const Scenario& scenario);
/// Flight under the Magnus force that meets nothing.
Attempt try_magnus(const Scenario& scenario);
/// Balls by themselves, each with one wall that it bounces on, slides on and rolls on with friction.
Attempt try_rough_wall(const Scenario& scenario);
/// Two balls that meet once, smooth or rough.
Attempt try_pair(const Scenario& scenario);

}  // namespace carom::closed_form
