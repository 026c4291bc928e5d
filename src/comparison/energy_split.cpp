#include "comparison/energy_split.h"

#include "comparison/conserved.h"

namespace carom {

std::optional<EnergySplit> split_energy(const Scenario& scene, const Run& run) {
  if (run.status != RunStatus::ok || !scene.events.empty()) return std::nullopt;
  const std::size_t last = run.trajectory.frames() - 1;
  const EnergyAccount& account = run.trajectory.tally(last).energy;
  if (!account.known) return std::nullopt;
  const Reference reference(scene);
  const double change_J =
      reference.of(run.trajectory.frame(last)).energy_J - reference.of(run.trajectory.frame(0)).energy_J;
  EnergySplit split{0.0, account.ball_impacts_J, account.wall_impacts_J, account.friction_J,
                    account.correction_J};
  split.flight_J =
      change_J - (split.ball_impacts_J + split.wall_impacts_J + split.friction_J + split.correction_J);
  return split;
}

}  // namespace carom
