#pragma once

#include <compare>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "engine/truth_source.h"
#include "reference/converged/contact.h"
#include "reference/converged/impact.h"

namespace carom::converged {

struct State {
  Vector x;     ///< m
  Vector v;     ///< m/s
  Vector spin;  ///< rad/s
};

/// The states that a scene starts with.
std::vector<State> start_of(const Scenario& scenario);

/// What is large in a scene; neither is 0.
Scale scale_of(const Scenario& scenario);

/// One integration of a scene, from event to event: a ball's polynomial ends and the next begins, two balls
/// meet, a ball meets a wall. Every ball goes by steps of its own.
class Run {
 public:
  /// @param end_s  no moment later than this is asked for
  /// @param most_work  multiplications after which it gives up: counted and not timed, so that how far a
  /// scene
  ///                   is known is the same on every machine
  Run(const Scenario& scenario, std::vector<State> start, const Accuracy& accuracy, const Real& end_s,
      std::int64_t most_work);

  /// Follows the motion up to a moment, impacts at the moment included. False where it is not known for so
  /// long: known_until_s() and limit() say how long, and why.
  bool follow(const Real& time_s);

  /// @pre follow(time_s) was true, and no later moment was asked for
  State at(std::size_t ball, const Real& time_s) const;
  Vector place_at(std::size_t ball, const Real& time_s) const { return pieces_[ball].place_at(time_s); }

  const Real& known_until_s() const { return known_until_s_; }
  const std::string& limit() const { return limit_; }

  Tally tally() const;
  const std::vector<TrueImpact>& impacts() const { return impacts_; }
  const std::vector<Tie>& ties() const { return ties_; }

 private:
  enum class Kind : std::uint8_t { next_piece, wall, pair };
  struct Event {
    Real time_s;
    Kind kind;
    std::uint32_t ball;
    std::uint32_t partner;  ///< a ball, or a wall
    Found found;
    // An event of a piece that is no more is void.
    std::uint64_t piece;
    std::uint64_t partner_piece;

    bool operator<(const Event& other) const;
  };

  void begin_piece(std::size_t ball, const Real& time_s, const Vector& x, const Vector& v);
  void predict(std::size_t ball, const Real& from_s);
  void predict_pair(std::size_t a, std::size_t b, const Real& from_s);
  bool is_void(const Event& event) const;
  void carry_out(const Event& event);
  void impact(const Event& event);
  void meet_wall(const Event& event);
  void meet_ball(const Event& event);
  void book(const Event& event, const Vector& external_Ns, const Vector& contact_m);
  /// Looks for impacts at the same moment. False where they share a ball with this one.
  bool alone(const Event& event);
  bool within_budget(const Real& time_s);
  void stop(const Real& time_s, std::string limit);
  bool movable(std::size_t ball) const;
  std::string described(const Event& event) const;

  const Scenario& scenario_;
  Accuracy accuracy_;
  Scale scale_;
  Real end_s_;
  std::int64_t most_work_;
  Real tie_s_;  ///< impacts within this are at one moment
  std::vector<Piece> pieces_;
  std::vector<std::uint64_t> piece_numbers_;
  std::vector<Vector> spins_;
  std::vector<Real> last_impact_s_;
  std::set<Event> events_;
  Real known_until_s_;
  std::string limit_;
  std::int64_t impact_count_ = 0;
  Vector external_Ns_ = Vector::Zero();
  Vector external_Nms_ = Vector::Zero();
  std::vector<TrueImpact> impacts_;
  std::vector<Tie> ties_;
  Real tied_until_s_ = -1;  ///< ties up to here are told
  std::int64_t work_ = 0;   ///< multiplications
};

}  // namespace carom::converged
