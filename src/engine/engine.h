#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "core/vec.h"
#include "scenario/features.h"
#include "scenario/scenario.h"

namespace carom {

// The one interface that every engine meets, the hand-written one included. A scene goes in, snapshots come
// out. Quantities are SI in the scene's frame whatever units and axes the engine uses inside.

/// The state of one ball at one moment.
struct BallState {
  Vec3 position;  ///< m
  Vec3 velocity;  ///< m/s
  Vec3 spin;      ///< rad/s
};

/// What changed the energy of the movable balls since t = 0, J; above 0 gained, below lost. A push's work is
///   W = J·(g + g')/2,                                                                                   (1)
/// J the impulse on one of two bodies, g and g' its velocity relative to the other at the point of contact
/// before and after: the change of their kinetic energies by an impulse. Walls, and immovable balls whether
/// they move or not, count as at rest. It is booked by the part of the push that does it. What these leave of
/// a run's change of energy happened in flight: by gravity and drag, by how they are integrated, and by what
/// an engine does to velocities without a push.
struct EnergyAccount {
  double ball_impacts_J = 0.0;  ///< the normal impulses between movable balls
  double wall_impacts_J = 0.0;  ///< the normal impulses of walls and immovable balls
  double friction_J = 0.0;      ///< the tangential impulses of all of them
  double correction_J = 0.0;    ///< what moved balls out of overlaps, by the potential energy it gave them
  bool known = false;           ///< whether the engine keeps this account
};

/// Running totals since t = 0, in the order of the simulation's own events.
///
/// Walls and immovable balls push on the movable ones, so momentum is conserved only once their push is
/// accounted for: an engine adds up the impulses that it exchanged with them.
struct Tally {
  std::int64_t impacts = 0;                      ///< ball on ball and ball on wall, approaching ones only
  std::int64_t wall_impacts = 0;                 ///< those of them on walls and slabs, one ball at a time
  double wall_push_Ns = 0.0;                     ///< N s, Σ J·n of what walls and slabs pushed at impacts
  bool walls_known = false;                      ///< whether the engine keeps these two
  Vec3 external_impulse = Vec3::Zero();          ///< N s, from walls and immovable balls onto movable balls
  Vec3 external_angular_impulse = Vec3::Zero();  ///< N m s, Σ x_contact × J about the origin
  bool external_known = true;                    ///< false where the engine cannot tell these impulses
  EnergyAccount energy = {};
};

using SettingValue = std::variant<bool, double, std::string>;
/// Every setting an engine ran with, by name (units in the name: `velocity_threshold_mps`).
using Settings = std::map<std::string, SettingValue>;

/// One scene set up in one engine.
class Simulation {
 public:
  Simulation() = default;
  Simulation(const Simulation&) = delete;
  Simulation& operator=(const Simulation&) = delete;
  virtual ~Simulation() = default;

  /// Moves the world on by `steps` equal steps of `step_s` seconds. An engine without a step of its own jumps
  /// to the end. @pre step_s > 0, steps > 0.
  virtual void advance(double step_s, std::int64_t steps) = 0;

  /// Writes the state of every ball, in the scene's order. @pre balls.size() == scenario.balls.size().
  virtual void snapshot(std::span<BallState> balls) const = 0;

  virtual Tally tally() const = 0;

  /// Every setting in force, those of the profile as well as what was derived from the scene.
  virtual Settings settings() const = 0;

  /// A bound on the error of every position, metres, where the engine knows one (a closed form does).
  virtual double uncertainty_m() const { return 0.0; }
};

/// A setting in which an engine's profiles differ, and which can be taken from either of them alone.
struct Switch {
  std::string name;     ///< as in Simulation::settings(), where its value stands
  std::string meaning;  ///< what it does, a few words
};

/// A way of setting an engine up. "faithful" comes first: every threshold, damping, sleep and margin set for
/// fidelity. "default" is what a newcomer gets.
struct Profile {
  std::string name;
  std::string about;  ///< one sentence
};

/// What an engine is and can do, before any scene.
struct EngineInfo {
  std::string name;       ///< as in `--engine`
  std::string about;      ///< one sentence
  std::string version;    ///< of the engine
  std::string precision;  ///< "float32" or "float64"
  std::vector<Profile> profiles;
  std::map<Feature, std::string> cannot;  ///< features it lacks, each with the reason; all others it has
  std::vector<std::string> limits;        ///< what it does only so well, and why, a sentence each
  std::vector<Switch> switches = {};      ///< every setting in which its two profiles differ
};

/// All of it is in this header: a module of another project (src/CaromConfig.cmake.in) links to nothing of
/// Carom.
class Engine {
 public:
  Engine() = default;
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;
  virtual ~Engine() = default;

  virtual EngineInfo info() const = 0;

  /// Why this scene is beyond this engine although every feature it needs is there; empty where it is not.
  virtual std::string refuses(const Scenario& scenario, std::string_view profile) const {
    (void)scenario;
    (void)profile;
    return {};
  }

  /// Sets the scene up. @pre unsupported_reason() is empty, and the profile is one of info().profiles.
  /// The scenario outlives the simulation.
  virtual std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view profile) const = 0;

  /// The same, with the settings of these names as the engine's other profile has them.
  /// @pre each name is that of one of info().switches; the engine has two profiles.
  virtual std::unique_ptr<Simulation> create_switched(const Scenario& scenario, std::string_view profile,
                                                      std::span<const std::string> switched) const {
    if (!switched.empty()) {
      throw std::logic_error(info().name + " has no setting " + switched.front() + " to switch");
    }
    return create(scenario, profile);
  }
};

/// Why the engine cannot run the scene: the first missing feature, or what the engine itself refuses; empty
/// where it can.
std::string unsupported_reason(const Engine& engine, const Scenario& scenario, std::string_view profile);

/// The symbol by which a loadable engine module hands out its engine (see modules.h). Its number goes up with
/// every change of this interface, so that a module of an older build is refused and does not crash.
#define CAROM_ENGINE_SYMBOL carom_engine_4
using EngineFactory = Engine* (*)();

}  // namespace carom

/// Defines the entry point of a loadable engine module.
#define CAROM_ENGINE_MODULE(EngineType)                                                     \
  extern "C" __attribute__((visibility("default"))) ::carom::Engine* CAROM_ENGINE_SYMBOL(); \
  extern "C" ::carom::Engine* CAROM_ENGINE_SYMBOL() {                                       \
    static EngineType engine;                                                               \
    return &engine;                                                                         \
  }
