#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

// Which balls a scene has at which moment. Events change that, and nothing else does: mass, radius and
// presence are the same in every engine's run of the scene.
//
// A ball keeps its number for good. The balls of the file have the first numbers; each ball that an event
// adds takes the next one, in the order in which the events happen; the number of a ball that has gone is not
// given again.

/// All balls that are there at some time: the highest number, and one.
std::size_t numbered_balls(const Scenario& scene);

/// When a frame is recorded, s. Frame 0 is the start.
double frame_time_s(const Scenario& scene, std::int64_t frame);

/// Two moments of a scene that are nearer to each other than this are one, s: 4 ε of the duration. A frame's
/// time and an event's are decimals that were rounded, multiplied and divided; each of that errs by ½ ε.
double same_moment_s(const Scenario& scene);

/// The first frame that shows what an event has done. A frame at the moment of an event shows the balls after
/// it.
std::int64_t first_frame_after(const Scenario& scene, const Event& event);

/// What an event did to one ball; nothing before: it came, nothing after: it went.
struct BallChange {
  std::size_t ball = 0;  ///< its number
  std::optional<Ball> before;
  std::optional<Ball> after;
};

/// The balls of a scene by number, from the start through one event after the other. The scene outlives it.
///
/// What the actions of an event do, in this order:
/// - scale_mass: the matter that is added moves and turns as the ball does. Velocity and spin stay, momentum
///   and energy change with the mass; I = κ m r² follows, κ (Ball::inertia) stays.
/// - scale_radius: the ball swells by forces inside it, which neither push nor turn it. Velocity, mass and
///   the angular momentum I ω stay, so that with r' = s r
///     ω' = ω / s²,                                                                                     (1)
///   and the energy of rotation falls to 1/s² of what it was.
/// - set_velocity, set_position: the ball is given this; nothing else of it changes.
/// - remove, add_ball.
class Cast {
 public:
  explicit Cast(const Scenario& scene);

  std::size_t size() const { return balls_.size(); }  ///< numbered_balls()

  /// A ball by number; nothing where it has not come yet or has gone. Its place and motion are those that the
  /// file or the last event gave it, or that were written here.
  std::optional<Ball>& operator[](std::size_t ball) { return balls_[ball]; }
  const std::optional<Ball>& operator[](std::size_t ball) const { return balls_[ball]; }

  /// The event that is next; none after the last.
  const Event* next() const;

  /// Carries out the next event. @pre next(), and the ball that it is about is there
  /// @return what it changed, balls in the order in which it changed them
  std::vector<BallChange> take_next();

  /// Carries out every event that this frame shows, and tells what changes.
  void to_frame(std::int64_t frame, const std::function<void(const BallChange&)>& told = {});

 private:
  void act(const Event& event, const Action& action);

  const Scenario* scene_;
  std::vector<std::optional<Ball>> balls_;
  std::size_t next_event_ = 0;
  std::size_t next_number_ = 0;  ///< of a ball that is added
};

/// Whether this holds for some ball at some time, as the file and the events have it.
bool ever(const Scenario& scene, const std::function<bool(const Ball&)>& holds);

}  // namespace carom
