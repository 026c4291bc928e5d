#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "reference/exact/setting.h"

namespace carom::exact {

/// Somebody whom a ball may meet, not before this moment.
struct Prospect {
  double earliest_s = 0.0;
  std::uint32_t partner = 0;
  bool wall = false;
};

/// The same motion in double precision, good for one thing: to tell cheaply whom a ball surely does not meet
/// before some moment. What it says is a lower bound whatever the roundings, so that it decides how much the
/// arithmetic of many digits has to do, and never what comes out.
///
/// Its error. A place is x + v t + ½ g t², t seconds after the ball's last impact, relative to the middle of
/// the scene. With X, V, G bounds on its terms' factors over the scene's duration T, the three are off by
/// less than ε X, 4 ε V T (v and t are differences of rounded numbers) and 4 ε G T², and their sum by as much
/// again; the distance of two balls is then off by less than
///
///   δ = 32 ε (X + V T + G T²)                                                            (1)
///
/// and so is where a velocity that is off by ε V takes them. A ball's radius is taken larger by δ. Beyond
/// that the smaller root of |d|² + 2 b t + |v|² t² = R² is computed with less than 20 ε |d|² of backward
/// error, as v t <= d where it is the smaller one; |d|² is taken smaller by 10⁻¹⁰ of itself, a million times
/// that. The time is at last taken smaller by 10⁻⁹ of itself, and by 4 ε T for what an absolute time is off
/// by.
class Shadow {
 public:
  Shadow(const Scenario& scene, const Setting& setting, double end_s);

  /// Takes over a ball's motion after an impact.
  void set(std::size_t ball, const Body& body);

  /// Moves all balls to a moment.
  void advance(double now_s);

  /// Moves one ball to the moment at which the others are.
  void catch_up(std::size_t ball);

  /// Whom a ball may meet before the end, from now on, in no order.
  void prospects(std::size_t ball, std::vector<Prospect>& found) const;

  /// Whom a ball may be as near as `gap_m`, now.
  void near(std::size_t ball, double gap_m, std::vector<Prospect>& found) const;

  /// The largest speed that a ball had so far or could fall to, m/s.
  double top_speed_mps() const { return top_speed_mps_; }

 private:
  struct Ball {
    bool movable = true;
    double radius_m = 0.0;
    double since_s = 0.0;
    Vec3 start_m = Vec3::Zero();  ///< at since_s, from the middle
    Vec3 start_mps = Vec3::Zero();
  };

  double error_m() const;
  double before(double wait_s) const;
  double pair_earliest_s(std::size_t a, std::size_t b, double error) const;
  double wall_earliest_s(std::size_t ball, const Wall& wall) const;
  double wall_gap_m(std::size_t ball, const Wall& wall) const;

  Vec3 middle_m_ = Vec3::Zero();
  Vec3 gravity_mps2_ = Vec3::Zero();
  bool gravity_;
  std::vector<Wall> walls_;  ///< seen from the middle
  std::vector<Ball> balls_;
  std::vector<Vec3> now_m_;  ///< places now
  std::vector<Vec3> now_mps_;
  bool meet_;
  double now_s_ = 0.0;
  double end_s_;
  double largest_m_ = 0.0;
  double top_speed_mps_ = 0.0;
};

}  // namespace carom::exact
