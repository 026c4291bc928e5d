#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "engine/truth_source.h"
#include "reference/exact/cluster.h"
#include "reference/exact/encounter.h"
#include "reference/exact/meeting.h"
#include "reference/exact/setting.h"
#include "reference/exact/shadow.h"

namespace carom::exact {

/// What all runs of one solution may compute together, in steps of about 10 ns. Work is counted and not
/// timed, so that a solution goes equally far on every machine.
struct Budget {
  std::int64_t left = 0;
};

/// Why a run cannot go on.
struct Stop {
  double time_s = 0.0;
  std::string reason;
  bool budget = false;  ///< for want of budget; else for what happens in the scene
};

/// One run of a scene in arithmetic of so many digits, event by event: every ball flies its exact parabola
/// until the soonest of all impacts, which is carried out; then it and all others that had counted on these
/// balls look for their next ones (B. J. Alder, T. E. Wainwright, J. Chem. Phys. 31, 459 (1959), with a
/// single soonest impact for each ball as in B. D. Lubachevsky, J. Comput. Phys. 94, 255 (1991)).
///
/// A moment at which two impacts come together is found before any of them is carried out: when one is due,
/// every other contact of its balls that is not open by more than the scene's own rounding. What follows from
/// them is judged by cluster.h; where it is not unique the run stops.
class Run {
 public:
  /// @param digits  in force while the run is made
  /// @param end_s   nobody asks about later
  Run(const Scenario& scene, const Digits& digits, double end_s, Budget& budget);

  /// A twin of such a run: positions are changed at the start by `change_m` times numbers in [-1, 1], and
  /// velocities by as much over the duration. Immovable balls stay as they are, and so does an axis along
  /// which all balls are level and still and no rounding can change that (balls on a line in the plane): no
  /// engine leaves it, however unstable the motion across it is.
  void perturb(const Real& change_m);

  /// The largest change that perturb() made to a position or, over the duration, a velocity, m.
  const Real& perturbation_m() const { return perturbation_m_; }

  /// From the last moment on all balls fly and spin the other way: without loss they come back.
  /// @pre follow() got there
  void turn_round();

  /// Goes on to a moment and past the impacts at it. Returns whether it got there.
  bool follow(const Moment& moment);

  /// A ball at the last moment. @pre follow() got there
  Body state(std::size_t ball) const;

  Tally tally() const;

  int digits() const { return digits_; }
  const std::optional<Stop>& stop() const { return stop_; }
  const std::vector<TrueImpact>& impacts() const { return impacts_; }
  const std::vector<Tie>& ties() const { return ties_; }
  double top_speed_mps() const { return shadow_.top_speed_mps(); }
  const Setting& setting() const { return setting_; }

 private:
  /// The soonest impact of a ball, as far as is known.
  struct Due {
    std::optional<Real> time_s;
    double rounded_s = 0.0;  ///< infinite where there is none
    std::uint32_t partner = 0;
    bool wall = false;
  };

  void look_ahead();
  std::optional<std::size_t> soonest() const;
  void predict(std::size_t ball);
  std::optional<Real> meeting_s(std::size_t ball, const Prospect& prospect) const;
  void perform(std::size_t ball);
  void carry_out(const Touch& touch);
  void predict_anew(const Touch& touch);
  Cluster cluster_of(const Touch& touch);
  void add_touches(std::uint32_t ball, const Real& gap_m, Cluster& cluster);
  Real gap_m(const Touch& touch, const Body& ball) const;
  bool piles_up(const Cluster& cluster) const;
  bool goes_on(const Touch& touch);
  void account(const Touch& touch, const Encounter& encounter, const Vector& impulse);
  void tell_tie_apart(const Touch& touch, const Real& approach);
  void tell_tie(std::vector<std::uint32_t> balls, bool shares_ball);
  void stop_at(const Real& time_s, std::string reason, bool budget = false);
  double rounding_m() const;

  const Scenario& scene_;
  int digits_;
  Setting setting_;
  Slack slack_;
  Real instant_s_;  ///< what counts as no time
  Real end_s_;
  Shadow shadow_;
  Budget& budget_;
  Real perturbation_m_;
  std::vector<Body> bodies_;
  std::vector<Due> due_;
  bool started_ = false;
  Real now_s_;
  Real moment_s_;
  Vector external_impulse_;
  Vector external_angular_impulse_;
  std::vector<TrueImpact> impacts_;
  std::vector<Tie> ties_;
  std::optional<Stop> stop_;
  std::vector<Prospect> prospects_;  ///< room for predict()
};

}  // namespace carom::exact
