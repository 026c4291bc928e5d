#include "carom/evolvers/list.h"

#include "carom/evolvers/event.h"

namespace carom {

std::unique_ptr<Simulation> make_toi_2d(const Scenario& scene, Parts<2> parts);
std::unique_ptr<Simulation> make_toi_3d(const Scenario& scene, Parts<3> parts);
std::unique_ptr<Simulation> make_step_2d(const Scenario& scene, Parts<2> parts);
std::unique_ptr<Simulation> make_step_3d(const Scenario& scene, Parts<3> parts);

namespace {

std::unique_ptr<Simulation> make_event_2d(const Scenario& scene, Parts<2> /*parts*/) {
  return make_event<2>(scene);
}

std::unique_ptr<Simulation> make_event_3d(const Scenario& scene, Parts<3> /*parts*/) {
  return make_event<3>(scene);
}

/// Elastic balls without gravity never come to rest, so that nothing is left to what `event` cannot do; and
/// it rounds places once an impact, not once a step.
bool nothing_rests(const Scenario& scene) {
  return !scene.effects.gravity && scene.ball_contact.restitution == 1.0 &&
         scene.wall_contact.restitution == 1.0 && event_refusal(scene).empty();
}

bool always(const Scenario& /*scene*/) {
  return true;
}

/// It finds impacts where they are, and is exact where flight is a parabola; drag and the Magnus force make
/// of flight what a step follows to the second order.
std::optional<int> toi_order(const Scenario& scene) {
  return scene.effects.drag || scene.effects.magnus ? std::optional(2) : std::nullopt;
}

/// It moves on and looks for impacts afterwards.
std::optional<int> step_order(const Scenario& /*scene*/) {
  return 1;
}

std::string takes_everything(const Scenario& /*scene*/) {
  return {};
}

}  // namespace

const std::vector<Evolver>& all_evolvers() {
  static const std::vector<Evolver> evolvers = {
      {"event", "no steps: jumps from impact to impact on exact flights", false, event_refusal, nothing_rests,
       make_event_2d, make_event_3d, false},
      {"toi", "fixed steps, every impact at its time within the step", true, takes_everything, always,
       make_toi_2d, make_toi_3d, true, toi_order},
      {"step", "fixed steps, what overlaps when one ends is in contact and is moved apart", true,
       takes_everything, always, make_step_2d, make_step_3d, true, step_order},
  };
  return evolvers;
}

}  // namespace carom
