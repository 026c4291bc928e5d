#include "trajectory/staged_run.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>

#include "trajectory/intervals.h"

namespace carom {

namespace {

using History = std::map<std::string, std::vector<std::pair<double, SettingValue>>>;

Tally sum(const Tally& a, const Tally& b) {
  Tally sum;
  sum.impacts = a.impacts + b.impacts;
  sum.wall_impacts = a.wall_impacts + b.wall_impacts;
  sum.wall_push_Ns = a.wall_push_Ns + b.wall_push_Ns;
  sum.walls_known = a.walls_known && b.walls_known;
  sum.external_impulse = a.external_impulse + b.external_impulse;
  sum.external_angular_impulse = a.external_angular_impulse + b.external_angular_impulse;
  sum.external_known = a.external_known && b.external_known;
  sum.energy.ball_impacts_J = a.energy.ball_impacts_J + b.energy.ball_impacts_J;
  sum.energy.wall_impacts_J = a.energy.wall_impacts_J + b.energy.wall_impacts_J;
  sum.energy.friction_J = a.energy.friction_J + b.energy.friction_J;
  sum.energy.correction_J = a.energy.correction_J + b.energy.correction_J;
  sum.energy.known = a.energy.known && b.energy.known;
  return sum;
}

/// Adds the settings that hold from a time on, where they differ from those before.
void add_settings(const Settings& settings, double from_s, History& history) {
  for (const auto& [name, value] : settings) {
    auto& values = history[name];
    if (values.empty() || values.back().second != value) values.emplace_back(from_s, value);
  }
}

std::string text_of(const SettingValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* flag = std::get_if<bool>(&value)) return *flag ? "true" : "false";
  return fmt::format("{}", std::get<double>(value));
}

/// The stream of seeds that belongs to a seed. Source of the increment: S. Vigna's SplitMix64.
std::uint64_t seed_of_stage(std::uint64_t seed, std::uint64_t stage) {
  return seed + stage * 0x9E3779B97F4A7C15U;
}

BallState unwritten() {
  const Vec3 nothing = Vec3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {nothing, nothing, nothing};
}

}  // namespace

StagedRun::StagedRun(const Scenario& scenario, Create create)
    : scenario_(scenario), create_(std::move(create)) {
  if (scenario_.events.empty()) {
    simulation_ = create_(scenario_);
    return;
  }
  cast_.emplace(scenario_);
  for (const Part& part : parts_of_interval(scenario_, 0, 0)) happen(part.events);
  begin_stage();
}

std::int64_t StagedRun::to_next_frame() {
  ++frame_;
  std::int64_t steps = 0;
  for (const Part& part : parts_of_interval(scenario_, frame_, events_done_)) {
    if (part.steps > 0 && simulation_) simulation_->advance(part.step_s, part.steps);
    steps += part.steps;
    if (part.events == 0) continue;
    end_stage();
    happen(part.events);
    begin_stage();
  }
  return steps;
}

void StagedRun::snapshot(std::span<BallState> balls) const {
  // What an engine forgets to write must not pass for a ball at rest.
  std::fill(balls.begin(), balls.end(), unwritten());
  if (!simulation_) return;
  if (!cast_) return simulation_->snapshot(balls);
  std::vector<BallState> states(numbers_.size(), unwritten());
  simulation_->snapshot(states);
  for (std::size_t i = 0; i < states.size(); ++i) balls[numbers_[i]] = states[i];
}

Tally StagedRun::tally() const {
  if (stages_ <= 1 && simulation_) return simulation_->tally();
  return simulation_ ? sum(before_, simulation_->tally()) : before_;
}

Settings StagedRun::settings() const {
  History history = settings_before_;
  if (simulation_) add_settings(simulation_->settings(), stage_from_s_, history);
  Settings settings;
  for (const auto& [name, values] : history) {
    if (values.size() == 1) {
      settings[name] = values.front().second;
      continue;
    }
    std::string text = text_of(values.front().second);
    for (std::size_t i = 1; i < values.size(); ++i) {
      text += fmt::format(", from t = {} s on {}", values[i].first, text_of(values[i].second));
    }
    settings[name] = text;
  }
  return settings;
}

void StagedRun::end_stage() {
  if (!simulation_) return;
  std::vector<BallState> states(numbers_.size(), unwritten());
  simulation_->snapshot(states);
  for (std::size_t i = 0; i < states.size(); ++i) {
    const BallState& state = states[i];
    if (!state.position.allFinite() || !state.velocity.allFinite() || !state.spin.allFinite()) lost_ = true;
    Ball& ball = *(*cast_)[numbers_[i]];
    ball.position = state.position;
    ball.velocity = state.velocity;
    ball.spin = state.spin;
  }
  before_ = stages_ <= 1 ? simulation_->tally() : sum(before_, simulation_->tally());
  uncertainty_m_ += simulation_->uncertainty_m();
  add_settings(simulation_->settings(), stage_from_s_, settings_before_);
  simulation_.reset();
}

void StagedRun::happen(std::size_t events) {
  for (std::size_t i = 0; i < events; ++i, ++events_done_) {
    stage_from_s_ = cast_->next()->time;
    Interference& each = interferences_.emplace_back();
    each.time_s = stage_from_s_;
    each.changes = cast_->take_next();
  }
  // Overlaps are told as they are once everything of this moment has happened.
  for (std::size_t i = interferences_.size() - events; i < interferences_.size(); ++i) {
    for (const BallChange& change : interferences_[i].changes) {
      interferences_[i].overlap_radii =
          std::max(interferences_[i].overlap_radii, overlap_radii(scenario_, *cast_, change.ball));
    }
  }
}

void StagedRun::begin_stage() {
  if (lost_) return;
  auto stage = std::make_unique<Scenario>(scenario_);
  stage->events.clear();
  stage->balls.clear();
  numbers_.clear();
  for (std::size_t i = 0; i < cast_->size(); ++i) {
    if (!(*cast_)[i]) continue;
    stage->balls.push_back(*(*cast_)[i]);
    numbers_.push_back(i);
  }
  for (Barrier& barrier : stage->barriers) barrier.seed = seed_of_stage(barrier.seed, stages_);
  ++stages_;
  stage_ = std::move(stage);
  if (numbers_.empty()) return;
  try {
    simulation_ = create_(*stage_);
  } catch (const NotTaken& reason) {
    if (interferences_.empty()) throw;
    throw NotTaken(fmt::format("from t = {} s on: {}", stage_from_s_, reason.what()));
  }
}

}  // namespace carom
