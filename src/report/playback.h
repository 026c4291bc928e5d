#pragma once

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "scenario/scenario.h"
#include "trajectory/trajectory.h"
#include "trajectory/truth.h"

namespace carom {

/// How much of a comparison goes into its playback. What is left out is said in it.
struct PlaybackLimits {
  static constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

  std::size_t balls = kNone;  ///< the first ones stay
  std::size_t states =
      kNone;  ///< of one run, balls times frames; frames are thinned evenly, the last one stays
  std::size_t bytes = kNone;    ///< of all runs together; the first run stays, whatever it takes
  std::size_t impacts = 20000;  ///< listed of one run; the first ones stay
  int position_bits = 14;       ///< positions on a grid of 2^-bits of the smallest radius
  int speed_bits = 20;          ///< velocities on one of 2^-bits of the largest speed, spins likewise
};

/// The runs of a scene as the viewer (reports/web/viewer) plays them: one line of JSON without `<`, `>` and
/// `&`, so that it may stand in a page. The runs come in the order given, the truth first where there is one.
///
/// - `format`: "carom-playback-2"
/// - `scene`: id, title, dimension, duration and step (s), gravity, box, walls, slabs, barriers, spin,
///   collisions, and events (time, ball, and the factors or states of its actions)
/// - `balls`: count (of all), shown, first (those of them that are there at the start), and of each that is
///   shown mass (kg), radius (m), inertia, when it is first there: packed doubles
/// - `changes` by events: frame (of the run), ball, there (or gone), and its mass and radius from then on
/// - `frames`: intervals (of the run), every: those kept are 0, every, 2 every, … and the last; count of
///   those kept
/// - `rounding`: position_m, speed_mps, spin_radps: the grid on which these stand; each is off by half of it
///   at most
/// - `runs`: label, status, reason, precision; of one that ended well either `same_as` (the label of a run
///   with the same states, to the bit), or positions, velocities and spins (where balls can spin), energy (J,
///   packed doubles: translation, rotation, potential of every frame, one after the other), counted (the
///   impacts that the engine counted until each frame), impacts (times in units of duration · 2⁻³⁰; ball;
///   other), more_impacts: whether there are more. Where balls can meet, brute_force_tests and tree_tests
///   (pair_tests.h) of each frame; where there are events, added (J, packed doubles: what they brought until
///   each frame). The truth is labelled "truth" and may end earlier; `known` is its number of frames. Where
///   there is none its reason says why.
/// - `left_out`: labels of the runs that the limit of bytes leaves out
///
/// Integers and doubles are packed as in pack.h; balls follow each other, axes stand outside of balls.
/// Velocities and spins are whole multiples of their grid, as first differences over the frames. Positions
/// are what the flight from the frame before misses them by, in whole multiples n of R = rounding.position_m:
/// in the first frame x = n R, then, each axis c by itself,
///
///   x' = x + clamp(h/2 (v + v') + a, ±2²⁹ R) + n R                                                       (1)
///
/// with h the time between two frames that are kept and v, v' the velocities in them as they are unpacked.
/// Under a constant acceleration that is the flight itself, and n is 0. An impact at a time t of the interval
/// jumps v by Δ = v' - v, and (1) misses by (h/2 - t) Δ, a vector along Δ. So the axis l with the largest |Δ|
/// (of equal ones the first) goes first, with a = 0; where |n_l R| <= h/2 |Δ_l| + R and Δ_l is finite and not
/// 0, the others follow with a_c = n_l R (Δ_c / Δ_l); else with a = 0. Like a second difference of the
/// positions n takes two frames to tell, but from velocities that are known better: no rounding is left in
/// it. The grids are powers of two: positions at most 2⁻¹⁴ of the smallest radius (unless the limits say
/// otherwise), velocities at most 2⁻²⁰ of the largest speed, spins likewise (coarser only where a number
/// would not fit into 31 bits).
struct PlaybackText {
  std::string json;
  std::vector<std::string> left_out;  ///< labels of the runs that the limit of bytes leaves out
};
PlaybackText write_playback(const Scenario& scenario, const std::vector<const Run*>& runs,
                            const Truth* truth = nullptr, const PlaybackLimits& limits = {});

/// The same, where it is known to fit.
inline std::string playback_json(const Scenario& scenario, const std::vector<const Run*>& runs,
                                 const Truth* truth = nullptr, const PlaybackLimits& limits = {}) {
  return write_playback(scenario, runs, truth, limits).json;
}

}  // namespace carom
