#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include "engine/engine.h"
#include "scenario/cast.h"
#include "trajectory/interference.h"

namespace carom {

/// The engine does not take the scene as an event has left it.
class NotTaken : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// One engine's run of a scene with events. Engines know nothing of events: the run is cut at their times
/// (parts_of_interval()), and at each the states are taken from the simulation, the event changes the balls
/// (Cast), and a simulation of the changed scene is made and goes on. So an event means the same in every
/// engine, and a run is the same whether its events were in the file or came while a person watched.
///
/// A new simulation is what a scene that begins so would get: an engine that chooses for the scene chooses
/// anew, and what it remembered of contacts is gone. It is seeded anew too: who passes a quantum barrier is
/// drawn by (seed, stage), or every stage would repeat the draws of the first.
///
/// A scene without events is a run of one stage, which costs it nothing. The scene and the engine outlive
/// this.
class StagedRun {
 public:
  using Create = std::function<std::unique_ptr<Simulation>(const Scenario& stage)>;

  /// @param create  makes a simulation of a stage. @throws NotTaken
  StagedRun(const Scenario& scenario, Create create);

  /// Moves on to the next frame. @return steps taken. @throws NotTaken
  std::int64_t to_next_frame();

  /// Writes the state of every ball that is there, by number.
  void snapshot(std::span<BallState> balls) const;

  Tally tally() const;  ///< over all stages

  /// Those of all stages; a setting that changed names its values with the times from which they held.
  Settings settings() const;

  double uncertainty_m() const { return uncertainty_m_ + (simulation_ ? simulation_->uncertainty_m() : 0.0); }
  const std::vector<Interference>& interferences() const { return interferences_; }

 private:
  void happen(std::size_t events);
  void end_stage();
  void begin_stage();

  const Scenario& scenario_;
  Create create_;
  std::optional<Cast> cast_;                ///< none without events
  std::unique_ptr<Scenario> stage_;         ///< the scene that the simulation was made of
  std::vector<std::size_t> numbers_;        ///< of the stage's balls
  std::unique_ptr<Simulation> simulation_;  ///< none while no ball is there, or all are lost
  std::uint64_t stages_ = 0;
  double stage_from_s_ = 0.0;
  bool lost_ = false;  ///< a state was not finite when an event came
  std::int64_t frame_ = 0;
  std::size_t events_done_ = 0;
  Tally before_ = {.walls_known = true, .energy = {.known = true}};  ///< of the stages that have ended
  double uncertainty_m_ = 0.0;
  std::map<std::string, std::vector<std::pair<double, SettingValue>>> settings_before_;
  std::vector<Interference> interferences_;
};

}  // namespace carom
