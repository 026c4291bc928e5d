#include "comparison/energy_split.h"

#include "comparison/conserved.h"
#include "comparison/metrics/brought.h"

namespace carom {

std::optional<EnergySplit> split_energy(const Scenario& scene, const Run& run) {
  if (run.status != RunStatus::ok) return std::nullopt;
  const std::size_t last = run.trajectory.frames() - 1;
  const EnergyAccount& account = run.trajectory.tally(last).energy;
  if (!account.known) return std::nullopt;
  const Reference reference(scene);
  Cast cast(scene);
  const double start_J =
      scene.events.empty() ? reference.of(run.trajectory.frame(0), cast).energy_J : reference.start.energy_J;
  cast.to_frame(scene.frames);
  const double change_J = reference.of(run.trajectory.frame(last), cast).energy_J - start_J;
  EnergySplit split{0.0, account.ball_impacts_J, account.wall_impacts_J, account.friction_J,
                    account.correction_J};
  for (const Interference& each : run.interferences) {
    split.events_J += brought_by(reference, each).energy_J;
  }
  split.flight_J = change_J - (split.ball_impacts_J + split.wall_impacts_J + split.friction_J +
                               split.correction_J + split.events_J);
  return split;
}

}  // namespace carom
