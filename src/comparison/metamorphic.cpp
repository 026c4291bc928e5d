#include "comparison/metamorphic.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/random.h"
#include "scenario/cast.h"

namespace carom {

namespace {

Ball seen_ball(const Frame& frame, Ball ball, double time_s) {
  const BallState state = frame.seen({ball.position, ball.velocity, ball.spin}, time_s);
  ball.position = state.position;
  ball.velocity = state.velocity;
  ball.spin = state.spin;
  ball.mass *= frame.mass;
  ball.radius *= frame.length;
  return ball;
}

/// Whether every axis becomes an axis.
bool permutes_axes(const Eigen::Matrix3d& map) {
  return std::all_of(map.data(), map.data() + map.size(),
                     [](double entry) { return entry == 0.0 || std::abs(entry) == 1.0; });
}

Box seen_box(const Frame& frame, const Box& box) {
  const Vec3 a = frame.length * (frame.map * box.min);
  const Vec3 b = frame.length * (frame.map * box.max);
  return {a.cwiseMin(b), a.cwiseMax(b)};
}

/// What walls, slabs and barriers share: R n · x' >= L offset says the same as n · x >= offset.
template <class Plane>
Plane seen_plane(const Frame& frame, Plane plane) {
  plane.normal = frame.map * plane.normal;
  plane.offset *= frame.length;
  return plane;
}

void see_solids(const Frame& frame, Scenario& scene) {
  for (Wall& wall : scene.walls) wall = seen_plane(frame, wall);
  if (scene.box && permutes_axes(frame.map)) {
    // The box's walls are the first, in the order of the axes.
    scene.box = seen_box(frame, *scene.box);
    for (int axis = 0; axis < scene.dimension; ++axis) {
      const auto at = 2 * static_cast<std::size_t>(axis);
      scene.walls[at] = {Vec3::Unit(axis), scene.box->min[axis]};
      scene.walls[at + 1] = {-Vec3::Unit(axis), -scene.box->max[axis]};
    }
  } else {
    scene.box.reset();
  }
  for (Slab& slab : scene.slabs) {
    slab = seen_plane(frame, slab);
    slab.thickness *= frame.length;
  }
  // J is kg m²/s², J s is kg m²/s.
  const double action = frame.mass * frame.length * frame.length / frame.time;
  for (Barrier& barrier : scene.barriers) {
    barrier = seen_plane(frame, barrier);
    barrier.thickness *= frame.length;
    barrier.height *= action / frame.time;
    barrier.hbar *= action;
  }
}

/// g in m/s²; c in kg/s (linear) or kg/m (quadratic); s in kg. The Magnus force s ω × v is a polar vector, as
/// it must be, for det(R)² = 1.
void see_effects(const Frame& frame, Effects& effects) {
  if (effects.gravity) {
    effects.gravity = frame.length / (frame.time * frame.time) * (frame.map * *effects.gravity);
  }
  if (effects.drag) {
    const bool linear = effects.drag->kind == Drag::Kind::linear;
    effects.drag->coefficient *= frame.mass / (linear ? frame.time : frame.length);
  }
  if (effects.magnus) *effects.magnus *= frame.mass;
}

void see_action(const Frame& frame, double time_s, Action& action) {
  if (auto* set = std::get_if<SetVelocity>(&action)) {
    set->velocity = frame.seen({Vec3::Zero(), set->velocity, Vec3::Zero()}, time_s).velocity;
  } else if (auto* moved = std::get_if<SetPosition>(&action)) {
    moved->position = frame.seen({moved->position, Vec3::Zero(), Vec3::Zero()}, time_s).position;
  } else if (auto* added = std::get_if<AddBall>(&action)) {
    added->ball = seen_ball(frame, added->ball, time_s);
  }
}

Frame turned_by(double angle_rad, const Vec3& axis) {
  Frame frame;
  frame.map = Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
  return frame;
}

Frame quarter_turn() {
  Frame frame;
  frame.map << 0, -1, 0, 1, 0, 0, 0, 0, 1;  // the cosine of ½π is not 0 in a double
  return frame;
}

Frame mirrored() {
  Frame frame;
  frame.map(0, 0) = -1.0;
  return frame;
}

Frame boosted(const Scenario& scene) {
  Frame frame;
  const double speed_mps = fastest_mps(scene);
  const Vec3 direction = scene.dimension == 2 ? Vec3(0.6, -0.8, 0.0) : Vec3(Vec3(2, -3, 6) / 7);
  // Balls that are all at rest are seen to move all the same.
  frame.boost = (speed_mps > 0.0 ? speed_mps : 1.0) * direction;
  return frame;
}

Frame rescaled(double length, double time, double mass) {
  Frame frame;
  frame.length = length;
  frame.time = time;
  frame.mass = mass;
  return frame;
}

Frame frame_for(const Scenario& scene, Symmetry symmetry) {
  switch (symmetry) {
    case Symmetry::mirror:
      return mirrored();
    case Symmetry::rotate_90:
      return quarter_turn();
    case Symmetry::rotate_1_rad:
      return turned_by(1.0, scene.dimension == 2 ? Vec3(Vec3::UnitZ()) : Vec3(Vec3(2, -3, 6) / 7));
    case Symmetry::boost:
      return boosted(scene);
    case Symmetry::rescale_2:
      return rescaled(8.0, 0.25, 16.0);
    case Symmetry::rescale_1_7:
      return rescaled(1.7, 1.3, 2.3);
    case Symmetry::relabel:
    case Symmetry::reverse:
      break;
  }
  return {};
}

std::vector<std::size_t> own_places(std::size_t count) {
  std::vector<std::size_t> places(count);
  std::iota(places.begin(), places.end(), std::size_t{0});
  return places;
}

/// One cycle through all, so that none stays. Source: S. Sattolo, "An algorithm to generate a random cyclic
/// permutation", Inf. Process. Lett. 22:6 (1986).
/// Balls that events add keep their numbers, which the order of the events gives them.
std::vector<std::size_t> other_places(const Scenario& scene) {
  std::vector<std::size_t> places = own_places(numbered_balls(scene));
  Random random(1);
  for (std::size_t i = scene.balls.size() - 1; i > 0; --i) {
    std::swap(places[i], places[static_cast<std::size_t>(random.uniform() * static_cast<double>(i))]);
  }
  return places;
}

Scenario relabelled(Scenario scene, const std::vector<std::size_t>& place) {
  const std::vector<Ball> balls = scene.balls;
  for (std::size_t i = 0; i < balls.size(); ++i) scene.balls[place[i]] = balls[i];
  for (Event& event : scene.events) event.ball = place[event.ball];
  return scene;
}

BallState turned_back(const BallState& state) {
  return {state.position, -state.velocity, -state.spin};
}

Scenario reversed(Scenario scene, std::span<const BallState> final_states) {
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const BallState start = turned_back(final_states[i]);
    scene.balls[i].position = start.position;
    scene.balls[i].velocity = start.velocity;
    scene.balls[i].spin = start.spin;
  }
  return scene;
}

std::string no_boost(const Scenario& scene) {
  if (!scene.walls.empty()) return "walls stand still";
  if (!scene.slabs.empty() || !scene.barriers.empty()) return "slabs and barriers stand still";
  if (scene.effects.drag) return "drag is relative to the air, which stands still";
  if (scene.effects.magnus) return "the Magnus force is relative to the air, which stands still";
  return {};
}

std::string no_relabelling(const Scenario& scene) {
  if (scene.balls.size() < 2) return "a single ball";
  if (!scene.barriers.empty()) return "who passes a barrier is drawn by the ball's number";
  return {};
}

std::string no_reversal(const Scenario& scene) {
  const bool balls_meet = scene.effects.collisions && scene.balls.size() > 1;
  const auto any = [&](auto loses) {
    return (balls_meet && loses(scene.ball_contact)) || (!scene.walls.empty() && loses(scene.wall_contact));
  };
  if (any([](const Contact& contact) { return contact.restitution < 1.0; })) return "impacts lose energy";
  if (any([](const Contact& contact) { return contact.friction > 0.0; })) return "friction loses energy";
  if (scene.effects.drag) return "drag loses energy";
  if (!scene.barriers.empty()) return "a barrier draws who passes";
  if (!scene.events.empty()) return "its events have their times";
  return {};
}

}  // namespace

BallState Frame::seen(const BallState& state, double time_s) const {
  return {length * (map * state.position) + time_s * boost, (length * (map * state.velocity) + boost) / time,
          map.determinant() / time * (map * state.spin)};
}

BallState Frame::unseen(const BallState& state, double time_s) const {
  const Eigen::Matrix3d back = map.transpose();
  return {back * (state.position - time_s * boost) / length, back * (time * state.velocity - boost) / length,
          map.determinant() * time * (back * state.spin)};
}

Scenario Frame::operator()(const Scenario& scene) const {
  Scenario image = scene;
  image.duration_s *= time;
  image.step_s *= time;
  see_effects(*this, image.effects);
  see_solids(*this, image);
  for (Ball& ball : image.balls) ball = seen_ball(*this, ball, 0.0);
  for (Event& event : image.events) {
    for (Action& action : event.actions) see_action(*this, event.time, action);
    event.time *= time;
  }
  return image;
}

BallState Twin::back(std::span<const BallState> twin_states, std::size_t ball, double time_s) const {
  const BallState state = frame.unseen(twin_states[place[ball]], time_s);
  return backwards ? turned_back(state) : state;
}

std::string not_symmetric(const Scenario& scene, Symmetry symmetry) {
  switch (symmetry) {
    case Symmetry::boost:
      return no_boost(scene);
    case Symmetry::relabel:
      return no_relabelling(scene);
    case Symmetry::reverse:
      return no_reversal(scene);
    case Symmetry::mirror:
    case Symmetry::rotate_90:
    case Symmetry::rotate_1_rad:
    case Symmetry::rescale_2:
    case Symmetry::rescale_1_7:
      break;
  }
  return {};
}

Twin make_twin(const Scenario& scene, Symmetry symmetry, std::span<const BallState> final_states) {
  Twin twin;
  twin.frame = frame_for(scene, symmetry);
  twin.backwards = symmetry == Symmetry::reverse;
  twin.place = symmetry == Symmetry::relabel ? other_places(scene) : own_places(numbered_balls(scene));
  if (symmetry == Symmetry::relabel) {
    twin.scenario = relabelled(scene, twin.place);
  } else if (twin.backwards) {
    twin.scenario = reversed(scene, final_states);
  } else {
    twin.scenario = twin.frame(scene);
  }
  return twin;
}

Twin disturbed_twin(const Scenario& scene, double position_m, double velocity_mps) {
  Twin twin;
  twin.scenario = scene;
  twin.place = own_places(numbered_balls(scene));
  Random random(1);
  for (Ball& ball : twin.scenario.balls) {
    if (std::isinf(ball.mass)) continue;
    for (int axis = 0; axis < scene.dimension; ++axis) {
      ball.position[axis] += random.uniform(-position_m, position_m);
      ball.velocity[axis] += random.uniform(-velocity_mps, velocity_mps);
    }
  }
  return twin;
}

double fastest_mps(const Scenario& scene) {
  double speed_mps = 0.0;
  for (const Ball& ball : scene.balls) speed_mps = std::max(speed_mps, ball.velocity.norm());
  return speed_mps;
}

}  // namespace carom
