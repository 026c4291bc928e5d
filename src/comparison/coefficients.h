#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "trajectory/trajectory.h"

namespace carom {

// The coefficients that engines really deliver: the simplest impact there is, repeated over five powers of
// ten of speed. A threshold below which bounces are lost, or a mixing rule that makes another coefficient of
// the one that was asked for, shows as a curve that is not a horizontal line.

enum class Coefficient {
  restitution,  ///< e = -v_n'/v_n (1), the relative velocities along the normal after and before
  friction,  ///< μ = |J_t|/|J_n| (2), the impulses along the surface and along the normal, of a sliding hit
};

/// One experiment: a ball of mass 1 kg and radius 0.1 m meets head-on an equal ball at rest, or a wall, in
/// the plane and without gravity. For friction the balls spin so fast that the surfaces slide throughout: a
/// hit by spin has the same normal at whatever place a stepping engine finds it. The scene does it three
/// times, in lanes far from each other, at different phases of the step.
struct CoefficientProbe {
  Coefficient coefficient = Coefficient::restitution;
  bool wall = false;       ///< on a wall; else on a ball
  double nominal = 1.0;    ///< what the scene asks for
  double speed_mps = 1.0;  ///< of the approach
  Scenario scene;
};

/// Every experiment: ball on ball and ball on wall; e = 1 and ½, μ = 0.3 (with e = ½); at 13 speeds from 0.01
/// to 100 m/s. By coefficient, surface, nominal value and speed.
///
/// The step is 0.05 r/v. An engine that looks for overlaps at the end of steps finds one of 0.2, 0.5 and 0.8
/// steps in the three lanes; one that is exact, or blind to the depth, delivers the same in all of them.
std::vector<CoefficientProbe> coefficient_probes();

/// What was delivered: in the first lane, and over all of them.
struct Delivered {
  double value = 0.0;
  double lowest = 0.0;
  double highest = 0.0;
};

/// What this run of the probe delivered, read for each lane in the first frame in which the surfaces are
/// apart and recede; 0 for restitution where they stay together. Nothing where the run did not end well, or a
/// ball never arrived.
std::optional<Delivered> delivered(const CoefficientProbe& probe, const Run& run);

/// A coefficient over the speeds, in one engine.
struct CoefficientCurve {
  std::string label;
  std::vector<std::optional<Delivered>> values;  ///< one for each speed
};

/// One coefficient between the same surfaces with the same nominal value, in all engines.
struct CoefficientPanel {
  Coefficient coefficient = Coefficient::restitution;
  bool wall = false;
  double nominal = 1.0;
  std::vector<double> speeds_mps;
  std::vector<CoefficientCurve> curves;
};

/// The panels to be filled by add_delivered(): one for each kind of probe, with a curve for each label.
std::vector<CoefficientPanel> empty_panels(const std::vector<CoefficientProbe>& probes,
                                           const std::vector<std::string>& labels);

/// Puts what the runs of a probe delivered, one for each label, into its panel. @pre the panels are of its
/// kind
void add_delivered(const CoefficientProbe& probe, const std::vector<Run>& runs,
                   std::vector<CoefficientPanel>& panels);

/// What a curve says.
struct CurveFinding {
  /// The highest speed up to which less than half of the coefficient is delivered, at every slower speed too.
  std::optional<double> lost_up_to_mps;
  double largest_error = 0.0;  ///< |delivered - nominal| above that speed, in the first lane
  /// The lowest and highest that was delivered above that speed, in any lane.
  double lowest = 0.0;
  double highest = 0.0;
  bool arrived = false;  ///< whether anything was measured
};

CurveFinding finding_of(const CoefficientPanel& panel, const CoefficientCurve& curve);

}  // namespace carom
