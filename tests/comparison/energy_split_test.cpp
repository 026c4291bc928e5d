#include "comparison/energy_split.h"

#include <gtest/gtest.h>

namespace carom {
namespace {

/// One ball of 2 kg that had 1 m/s and has 3 m/s in the end: 8 J gained.
struct Accelerated {
  Scenario scene;
  Run run;

  Accelerated() {
    Ball ball;
    ball.mass = 2.0;
    ball.velocity = Vec3(1, 0, 0);
    scene.balls = {ball};
    run.trajectory = Trajectory(scene);
    run.trajectory.frame(0)[0] = {Vec3::Zero(), Vec3(1, 0, 0), Vec3::Zero()};
    run.trajectory.frame(1)[0] = {Vec3::Zero(), Vec3(0, 3, 0), Vec3::Zero()};
    for (std::size_t k = 0; k < 2; ++k) run.trajectory.tally(k) = {};
    EnergyAccount& energy = run.trajectory.tally(1).energy;
    energy = {1.0, -2.0, -0.5, 0.25, true};
  }
};

TEST(EnergySplit, Flight_IsWhatTheAccountLeaves) {
  const Accelerated made;
  const EnergySplit split = split_energy(made.scene, made.run).value();
  EXPECT_EQ(split.ball_impacts_J, 1.0);
  EXPECT_EQ(split.wall_impacts_J, -2.0);
  EXPECT_EQ(split.friction_J, -0.5);
  EXPECT_EQ(split.correction_J, 0.25);
  EXPECT_DOUBLE_EQ(split.flight_J, 8.0 - (1.0 - 2.0 - 0.5 + 0.25));
}

TEST(EnergySplit, IsNothing_WhereTheEngineCannotTell) {
  Accelerated made;
  made.run.trajectory.tally(1).energy.known = false;
  EXPECT_FALSE(split_energy(made.scene, made.run));
}

TEST(EnergySplit, IsNothing_WhereARunFails) {
  Accelerated failed;
  failed.run.status = RunStatus::crashed;
  EXPECT_FALSE(split_energy(failed.scene, failed.run));
}

}  // namespace
}  // namespace carom
