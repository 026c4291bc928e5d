#include "comparison/coefficients.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "tests/support/numbers.h"

namespace carom::test {
namespace {

/// What the movers of a probe do, as a function of time.
using StatesAt = std::function<std::vector<BallState>(double)>;

Run run_of(const CoefficientProbe& probe, const StatesAt& states_at) {
  Run run;
  run.trajectory = Trajectory(probe.scene);
  for (std::size_t k = 0; k < run.trajectory.frames(); ++k) {
    const std::vector<BallState> states = states_at(run.trajectory.time(k));
    std::copy(states.begin(), states.end(), run.trajectory.frame(k).begin());
  }
  return run;
}

/// The exact motion of a probe with this restitution and, where it slides, this friction (three-parameter
/// law): the impact changes the normal velocity by -(1 + e) v, shared between two equal balls, and the
/// tangential one by μ times that.
StatesAt exact(const CoefficientProbe& probe, double restitution, double friction) {
  return [=](double t) {
    const double v = probe.speed_mps;
    const double change = (1.0 + restitution) * v * (probe.wall ? 1.0 : 0.5);
    std::vector<BallState> states;
    double impact_s = 0.0;
    for (const Ball& ball : probe.scene.balls) {
      const bool flies = ball.velocity.x() > 0.0;
      // The other surface is at x = 0 in every lane.
      if (flies) impact_s = (-ball.position.x() - ball.radius) / v;
      BallState state = {ball.position + t * ball.velocity, ball.velocity, ball.spin};
      if (t > impact_s) {
        const Vec3 dv = change * Vec3(flies ? -1.0 : 1.0, (flies ? 1.0 : -1.0) * friction, 0.0);
        state.velocity += dv;
        state.position += (t - impact_s) * dv;
      }
      states.push_back(state);
    }
    return states;
  };
}

TEST(Coefficients, Probes_CoverFourPowersOfTen_InBothSurfaces) {
  const std::vector<CoefficientProbe> probes = coefficient_probes();
  EXPECT_EQ(probes.size(), 6U * 13U);
  for (const bool wall : {false, true}) {
    double slowest = 1e9;
    double fastest = 0.0;
    for (const CoefficientProbe& probe : probes) {
      if (probe.wall != wall) continue;
      slowest = std::min(slowest, probe.speed_mps);
      fastest = std::max(fastest, probe.speed_mps);
      EXPECT_LT(probe.speed_mps * probe.scene.step_s, 0.1 * probe.scene.balls[0].radius);
    }
    EXPECT_NEAR(slowest, 0.01, 4 * kEpsilon);
    EXPECT_NEAR(fastest, 100.0, 400 * kEpsilon);
  }
}

// Friction delivers what was asked for only where the surfaces slide until the impact is over.
TEST(Coefficients, FrictionProbes_SlideThroughout) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    if (probe.coefficient != Coefficient::friction) continue;
    const Ball& ball = probe.scene.balls[0];
    const double slip_mps = ball.radius * ball.spin.z() * (probe.wall ? 1.0 : 2.0);
    const double restitution = probe.scene.ball_contact.restitution;
    // (7/2) μ (1 + e) v for solid spheres, ball on ball and ball on wall alike.
    EXPECT_GT(slip_mps, 3.5 * probe.nominal * (1.0 + restitution) * probe.speed_mps);
  }
}

TEST(Coefficients, Delivered_IsThatOfTheImpactLaw) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    const bool friction = probe.coefficient == Coefficient::friction;
    const auto run = run_of(probe, exact(probe, friction ? 0.5 : 0.37, friction ? 0.21 : 0.0));
    // Velocities of two balls are added and divided: a few roundings.
    EXPECT_NEAR(delivered(probe, run).value().value, friction ? 0.21 : 0.37, 8 * kEpsilon);
  }
}

TEST(Coefficients, Range_IsThatOfAllLanes) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    if (probe.coefficient != Coefficient::restitution) continue;
    const StatesAt dull = exact(probe, 0.4, 0.0);
    const StatesAt lively = exact(probe, 0.9, 0.0);
    const std::size_t first = probe.wall ? 1 : 2;
    const auto mixed = run_of(probe, [&](double t) {
      std::vector<BallState> states = lively(t);
      const std::vector<BallState> others = dull(t);
      std::copy(others.begin(), others.begin() + static_cast<std::ptrdiff_t>(first), states.begin());
      return states;
    });
    const Delivered got = delivered(probe, mixed).value();
    EXPECT_NEAR(got.value, 0.4, 8 * kEpsilon);
    EXPECT_EQ(got.value, got.lowest);
    EXPECT_NEAR(got.highest, 0.9, 8 * kEpsilon);
  }
}

TEST(Coefficients, BounceThatIsLost_DeliversZero) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    if (probe.coefficient != Coefficient::restitution) continue;
    EXPECT_EQ(delivered(probe, run_of(probe, exact(probe, 0.0, 0.0))).value().highest, 0.0);
  }
}

TEST(Coefficients, BallThatNeverArrives_DeliversNothing) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    const auto asleep = [&probe](double) {
      std::vector<BallState> states;
      for (const Ball& ball : probe.scene.balls)
        states.push_back({ball.position, Vec3::Zero(), Vec3::Zero()});
      return states;
    };
    EXPECT_FALSE(delivered(probe, run_of(probe, asleep)));
    auto crashed = run_of(probe, exact(probe, 1.0, 0.0));
    crashed.status = RunStatus::crashed;
    EXPECT_FALSE(delivered(probe, crashed));
  }
}

/// One that flies through whatever is in its way.
TEST(Coefficients, BallThatPassesThrough_DeliversNothing) {
  for (const CoefficientProbe& probe : coefficient_probes()) {
    const auto through = [&probe](double t) {
      std::vector<BallState> states;
      for (const Ball& ball : probe.scene.balls)
        states.push_back({ball.position + t * ball.velocity, ball.velocity, ball.spin});
      return states;
    };
    EXPECT_FALSE(delivered(probe, run_of(probe, through))) << probe.wall;
  }
}

TEST(Coefficients, Panels_HaveACurveForEachEngine_AndAValueForEachSpeed) {
  const std::vector<CoefficientProbe> probes = coefficient_probes();
  std::vector<CoefficientPanel> panels = empty_panels(probes, {"right", "lossy"});
  for (const CoefficientProbe& probe : probes) {
    const double e = probe.coefficient == Coefficient::friction ? 0.5 : probe.nominal;
    const double lost = probe.speed_mps <= 1.0 ? 0.0 : e;
    add_delivered(probe, {run_of(probe, exact(probe, e, 0.3)), run_of(probe, exact(probe, lost, 0.3))},
                  panels);
  }
  ASSERT_EQ(panels.size(), 6U);
  for (const CoefficientPanel& panel : panels) {
    ASSERT_EQ(panel.curves.size(), 2U);
    for (const CoefficientCurve& curve : panel.curves)
      EXPECT_EQ(curve.values.size(), panel.speeds_mps.size());
    EXPECT_TRUE(std::is_sorted(panel.speeds_mps.begin(), panel.speeds_mps.end()));
    if (panel.coefficient != Coefficient::restitution) continue;
    const CurveFinding right = finding_of(panel, panel.curves[0]);
    EXPECT_TRUE(right.arrived);
    EXPECT_FALSE(right.lost_up_to_mps);
    EXPECT_NEAR(right.largest_error, 0.0, 8 * kEpsilon);
    const CurveFinding lossy = finding_of(panel, panel.curves[1]);
    EXPECT_DOUBLE_EQ(lossy.lost_up_to_mps.value(), 1.0);
    EXPECT_NEAR(lossy.largest_error, 0.0, 8 * kEpsilon);
  }
}

}  // namespace
}  // namespace carom::test
