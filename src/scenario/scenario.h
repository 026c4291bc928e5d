#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "scenario/metric.h"
#include "scenario/symmetry.h"

namespace carom {

// A scene as data: what a scenario file says, validated, in SI units. Nothing here knows an engine.

/// Drag on a ball: linear F = -c v (c in kg/s), quadratic F = -c |v| v (c in kg/m).
struct Drag {
  enum class Kind { linear, quadratic };
  Kind kind = Kind::linear;
  double coefficient = 0.0;
};

/// What acts on the balls between impacts. What is not named does not exist in the simulation.
struct Effects {
  std::optional<Vec3> gravity;   ///< m/s²
  std::optional<Drag> drag;      ///
  bool spin = false;             ///< balls can rotate
  std::optional<double> magnus;  ///< kg: F = s ω × v
  bool collisions = true;        ///< false: balls pass through each other, only walls act
};

/// Coefficients of the three-parameter impact law between two surfaces.
struct Contact {
  double restitution = 1.0;             ///< e in [0, 1]
  double friction = 0.0;                ///< Coulomb μ >= 0
  double tangential_restitution = 0.0;  ///< β0 in [-1, 1], used where the contact sticks
};

/// What touching balls do when impacts come at several of their contacts at once: no law of nature says.
enum class MultiContact {
  sequential,               ///< pair by pair until all separate
  simultaneous,             ///< all contacts push at once
  generalized_reflections,  ///< contacts that approach push at once, and so on along the balls
};

/// A fixed plane: a ball of radius r stays where normal·x - offset >= r. The normal is a unit vector.
struct Wall {
  Vec3 normal = Vec3::UnitY();
  double offset = 0.0;  ///< m
};

/// An axis-aligned container. Its walls stand in Scenario::walls; z is 0 in dimension 2.
struct Box {
  Vec3 min = Vec3::Zero();
  Vec3 max = Vec3::Zero();
};

/// A solid sheet with faces at offset ± thickness/2 along the unit normal.
struct Slab {
  Vec3 normal = Vec3::UnitX();
  double offset = 0.0;     ///< m
  double thickness = 0.0;  ///< m
};

/// A rectangular quantum barrier around offset along the unit normal; a ball's energy is ½ m v_n².
struct Barrier {
  Vec3 normal = Vec3::UnitX();
  double offset = 0.0;     ///< m
  double thickness = 0.0;  ///< m
  double height = 0.0;     ///< J
  double hbar = 1.0;       ///< J s
  std::uint64_t seed = 0;  ///< of the draws that decide who passes
};

struct Ball {
  double mass = 1.0;    ///< kg; infinity for an immovable ball
  double radius = 1.0;  ///< m
  Vec3 position = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  Vec3 spin = Vec3::Zero();  ///< rad/s
  double inertia = 0.4;      ///< I/(m r²)
};

/// What a person did at a moment.
struct ScaleMass {
  double factor = 1.0;
};
struct ScaleRadius {
  double factor = 1.0;
};
struct SetVelocity {
  Vec3 velocity = Vec3::Zero();
};
struct SetPosition {
  Vec3 position = Vec3::Zero();
};
struct AddBall {
  Ball ball;
};
struct RemoveBall {};
using Action = std::variant<ScaleMass, ScaleRadius, SetVelocity, SetPosition, AddBall, RemoveBall>;

struct Event {
  double time = 0.0;     ///< s, in [0, duration]
  std::size_t ball = 0;  ///< index into the balls; unused by AddBall
  std::vector<Action> actions;
};

/// Where the truth of a scene comes from. `automatic` picks the first that applies.
enum class TruthKind { automatic, closed_form, exact, converged, none };

/// Upper limits on metrics; a metric that is absent is not gated.
using Limits = std::map<Metric, double>;

/// What must hold: for the engine under test, and for engines that have a table of their own.
struct Gate {
  Limits under_test;
  std::map<std::string, Limits, std::less<>> per_engine;
};

/// A validated scene, made by parse_scene() or load_scene() (parse.h) and shared as `const` from then on.
struct Scenario {
  std::string id;      ///< "<group>/<name>"
  std::string file;    ///< where it was read
  std::string sha256;  ///< of the file's bytes
  std::string title;
  std::string about;  ///< Markdown

  int dimension = 2;        ///< 2 or 3
  double duration_s = 1.0;  ///< > 0
  double step_s = 0.004;    ///< > 0, the longest step a stepping engine may take
  std::int64_t frames = 1;  ///< recorded frames after the initial one

  Effects effects;
  Contact ball_contact;
  Contact wall_contact;
  MultiContact multi_contact = MultiContact::sequential;
  std::optional<Box> box;
  std::vector<Wall> walls;  ///< those of the box first (min x, max x, min y, …), then the file's own
  std::vector<Slab> slabs;
  std::vector<Barrier> barriers;
  std::vector<Ball> balls;  ///< those written one by one first, then the generated ones
  std::vector<Event> events;

  TruthKind truth = TruthKind::automatic;
  Gate gate;
  std::vector<Symmetry> symmetries;  ///< held against twins of the scene, in this order

  std::vector<std::string> notes;  ///< what the reader of the file should know (a radius that was scaled)
};

using ScenarioPtr = std::shared_ptr<const Scenario>;

}  // namespace carom
