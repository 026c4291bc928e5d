#include "comparison/statistics/statistics.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "comparison/compare.h"
#include "comparison/statistics/cooling.h"
#include "comparison/statistics/distributions.h"
#include "core/random.h"
#include "tests/support/numbers.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

using testing::HasSubstr;

/// A gas of one radius; `more` are tables before the box, `second` a second group of balls.
ScenarioPtr gas_scene(int dimension, int count, double duration_s, const std::string& more = "",
                      const std::string& second = "") {
  const std::string low = dimension == 2 ? "[0, 0]" : "[0, 0, 0]";
  const std::string high = dimension == 2 ? "[30, 30]" : "[12, 12, 12]";
  return scene_of("title = \"gas\"\ndimension = " + std::to_string(dimension) +
                  "\nduration = " + std::to_string(duration_s) + "\nstep = 0.01\nframes = 100\n" + more +
                  "\n[box]\nmin = " + low + "\nmax = " + high +
                  "\n[[balls]]\nkind = \"gas\"\nseed = 5\nradius = 0.5\nspeed = 1.0\nmass = 1.0\ncount = " +
                  std::to_string(count) + "\n" + second);
}

/// The velocities of one moment: of Maxwell's law, with the scene's energy.
std::vector<BallState> equilibrium(const Scenario& scene, double energy_J, Random& random) {
  std::vector<BallState> states = states_of(scene);
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (int axis = 0; axis < scene.dimension; ++axis) {
      states[i].velocity[axis] = random.normal() / std::sqrt(scene.balls[i].mass);
    }
  }
  const double factor = std::sqrt(energy_J / kinetic_energy_of(scene, states));
  for (BallState& state : states) state.velocity *= factor;
  return states;
}

/// A run as theory expects it: every frame an independent moment of equilibrium, impacts and pushes at their
/// mean rates, times a factor, as counts and pushes of that many independent impacts.
struct MadeRun {
  double rate_factor = 1.0;
  double push_factor = 1.0;
  bool walls_known = true;
  std::function<void(std::vector<BallState>&)> spoil = [](std::vector<BallState>&) {};

  Trajectory of(const Gas& gas, std::uint64_t seed) const {
    const Scenario& scene = *gas.scene;
    Trajectory trajectory(scene);
    Random random(seed);
    double collisions = 0.0;
    double push_Ns = 0.0;
    for (std::size_t k = 0; k < trajectory.frames(); ++k) {
      std::vector<BallState> states = equilibrium(scene, gas.energy_J, random);
      spoil(states);
      std::copy(states.begin(), states.end(), trajectory.frame(k).begin());
      trajectory.tally(k).wall_impacts = static_cast<std::int64_t>(1000 * k);
      trajectory.tally(k).impacts = static_cast<std::int64_t>(collisions) + trajectory.tally(k).wall_impacts;
      trajectory.tally(k).wall_push_Ns = push_Ns;
      trajectory.tally(k).walls_known = walls_known;
      const double interval_s = trajectory.time(1);
      const double mean = gas.collisions_per_s * interval_s;
      collisions += rate_factor * mean + std::sqrt(mean) * random.normal();
      if (gas.boxed)
        push_Ns += push_factor * gas.boxed->wall_force_N * interval_s * (1.0 + 0.03 * random.normal());
    }
    return trajectory;
  }
};

RunStatistics statistics_of(const ScenarioPtr& scene, const MadeRun& run, std::uint64_t seed = 1) {
  const std::optional<Gas> gas = gas_of(*scene);
  return measure_statistics(*gas, run.of(*gas, seed));
}

double deviations(const RunStatistics& statistics, StatisticKind kind) {
  for (const Statistic& each : statistics.all) {
    if (each.kind == kind) return each.deviations;
  }
  ADD_FAILURE() << name_of(kind) << " was not asked";
  return 0.0;
}

// --- laws

TEST(Kolmogorov, Distance_IsThatOfAGrid_WhenTheSampleIsOne) {
  std::vector<double> grid;
  grid.reserve(50);
  for (int i = 0; i < 50; ++i) grid.push_back((i + 0.5) / 50.0);
  const auto uniform = [](double x) { return x; };
  EXPECT_NEAR(kolmogorov_distance(grid, uniform), 0.01, 1e-15);
  for (double& x : grid) x = 0.1 + 0.9 * x;  // nothing below a tenth
  EXPECT_NEAR(kolmogorov_distance(grid, uniform), 0.109, 1e-15);
}

TEST(Kolmogorov, Probability_IsThatOfItsTables) {
  // Critical values of √n D for large n, rounded to three digits: 1.224 for 10 %, 1.358 for 5 %, 1.628 for 1
  // %.
  const double root = 1000.0;
  const auto p_of = [&](double lambda) {
    return kolmogorov_p(lambda / (root + 0.12 + 0.11 / root), static_cast<std::size_t>(root * root));
  };
  EXPECT_NEAR(p_of(1.224), 0.10, 2e-4);
  EXPECT_NEAR(p_of(1.358), 0.05, 1e-4);
  EXPECT_NEAR(p_of(1.628), 0.01, 5e-5);
  EXPECT_EQ(p_of(0.1), 1.0);
  EXPECT_NEAR(sigmas_of(0.0013498980316301), 3.0, 1e-9);
  EXPECT_EQ(sigmas_of(0.7), 0.0);
  EXPECT_GT(sigmas_of(0.0), 30.0);
}

TEST(EnergyShare, IsTheLawOfPointsOnASphere_ForFewBalls) {
  Random random(3);
  for (const int d : {2, 3}) {
    const std::size_t n = 5;
    const EnergyShare law(d, n);
    std::vector<double> firsts;
    std::vector<double> moments;
    std::vector<double> groups;
    for (int sample = 0; sample < 4000; ++sample) {
      std::vector<double> shares;
      double sum = 0.0;
      for (std::size_t i = 0; i < n; ++i) {
        double square = 0.0;
        for (int axis = 0; axis < d; ++axis) square += std::pow(random.normal(), 2);
        shares.push_back(square);
        sum += square;
      }
      double squares = 0.0;
      for (double& share : shares) {
        share /= sum;
        squares += share * share;
      }
      firsts.push_back(shares[0]);
      moments.push_back(static_cast<double>(n) * d / (d + 2.0) * squares - 1.0);
      groups.push_back(shares[0] + shares[1]);
    }
    std::sort(firsts.begin(), firsts.end());
    const double distance = kolmogorov_distance(firsts, [&](double x) { return law.cdf(x); });
    EXPECT_GT(kolmogorov_p(distance, firsts.size()), 0.001) << d;
    const auto mean_and_deviation = [](const std::vector<double>& values) {
      double mean = 0.0;
      double square = 0.0;
      for (const double v : values) mean += v / static_cast<double>(values.size());
      for (const double v : values) square += (v - mean) * (v - mean) / static_cast<double>(values.size());
      return std::pair(mean, std::sqrt(square));
    };
    // A mean of 4000 is off by its standard deviation over 63; a standard deviation by about 2 % of itself.
    const auto [a2, a2_deviation] = mean_and_deviation(moments);
    EXPECT_NEAR(a2, law.fourth_moment_mean(), 4.0 * law.fourth_moment_deviation() / 63.0) << d;
    EXPECT_NEAR(a2_deviation, law.fourth_moment_deviation(), 0.08 * law.fourth_moment_deviation()) << d;
    EXPECT_NEAR(mean_and_deviation(groups).second, law.group_deviation(2), 0.08 * law.group_deviation(2))
        << d;
  }
}

TEST(TimeMean, Error_IsThatOfTheSpans) {
  std::vector<double> series;
  series.reserve(103);
  for (int i = 0; i < 103; ++i)
    series.push_back(i < 3 ? 1e6 : (i - 3) / 10);  // ten spans 0 … 9, a rest in front
  const TimeMean mean = time_mean(series);
  EXPECT_DOUBLE_EQ(mean.mean, 4.5);
  EXPECT_DOUBLE_EQ(mean.error, std::sqrt(82.5 / 90.0));
}

// --- equilibrium

TEST(Statistics, AreAsExpected_InEquilibrium_AndTheirProbabilitiesAreEvenlySpread) {
  const ScenarioPtr scene = gas_scene(3, 60, 300.0);
  const std::optional<Gas> gas = gas_of(*scene);
  const MadeRun good;
  std::vector<double> p;
  double fourth_moments = 0.0;
  constexpr int kSamples = 200;
  for (int seed = 1; seed <= kSamples; ++seed) {
    const RunStatistics statistics =
        measure_statistics(*gas, good.of(*gas, static_cast<std::uint64_t>(seed)));
    ASSERT_EQ(statistics.all.size(), 4U);
    for (const Statistic& each : statistics.all) {
      EXPECT_TRUE(each.as_expected()) << name_of(each.kind) << " " << each.deviations << ", seed " << seed;
    }
    const double detail = std::stod(statistics.all[0].detail.substr(4));
    p.push_back(detail);
    fourth_moments += std::pow(deviations(statistics, StatisticKind::fourth_moment), 2);
  }
  std::sort(p.begin(), p.end());
  const double distance = kolmogorov_distance(p, [](double x) { return x; });
  EXPECT_GT(kolmogorov_p(distance, p.size()), 0.001) << "distance " << distance;
  // The frames are all independent here, and more of them than moments are counted.
  EXPECT_LE(fourth_moments / kSamples, 1.0 + 4.0 * std::sqrt(2.0 / kSamples));
}

TEST(Statistics, FindWrongSpeeds) {
  const ScenarioPtr scene = gas_scene(3, 200, 200.0);
  const double rms = std::sqrt(2.0 * gas_of(*scene)->energy_J / 200.0);
  MadeRun equal;
  equal.spoil = [rms](std::vector<BallState>& states) {
    for (BallState& state : states) state.velocity = rms * state.velocity.normalized();
  };
  MadeRun two_temperatures;  // a third of the balls at twice the mean, the others at half of it
  two_temperatures.spoil = [](std::vector<BallState>& states) {
    for (std::size_t i = 0; i < states.size(); ++i) states[i].velocity *= std::sqrt(i % 3 == 0 ? 2.0 : 0.5);
  };
  MadeRun lossy;  // one that lost a fifth of the energy
  lossy.spoil = [](std::vector<BallState>& states) {
    for (BallState& state : states) state.velocity *= std::sqrt(0.8);
  };
  for (const MadeRun& run : {equal, two_temperatures, lossy}) {
    EXPECT_GT(deviations(statistics_of(scene, run), StatisticKind::speeds), 4.0);
  }
  EXPECT_GT(deviations(statistics_of(scene, equal), StatisticKind::fourth_moment), 20.0);
}

TEST(Statistics, FindAWrongCollisionRate_AndAWrongPressure) {
  for (const int d : {2, 3}) {
    const ScenarioPtr scene = gas_scene(d, 300, 200.0);
    MadeRun run;
    run.rate_factor = 1.3;
    RunStatistics statistics = statistics_of(scene, run);
    EXPECT_GT(deviations(statistics, StatisticKind::collision_rate), 4.0) << d;
    EXPECT_LE(deviations(statistics, StatisticKind::wall_pressure), 4.0) << d;
    run = MadeRun{};
    run.push_factor = 0.8;
    statistics = statistics_of(scene, run);
    EXPECT_LE(deviations(statistics, StatisticKind::collision_rate), 4.0) << d;
    EXPECT_GT(deviations(statistics, StatisticKind::wall_pressure), 4.0) << d;
  }
}

TEST(Statistics, DoNotAskRates_OfAnEngineThatDoesNotTellWalls) {
  MadeRun run;
  run.walls_known = false;
  const RunStatistics statistics = statistics_of(gas_scene(2, 100, 200.0), run);
  EXPECT_EQ(statistics.all.size(), 2U);
  ASSERT_EQ(statistics.not_asked.size(), 2U);
  EXPECT_EQ(statistics.not_asked[0].kind, StatisticKind::collision_rate);
}

TEST(Statistics, FindHeavyBallsThatAreTooHot) {
  const std::string heavy =
      "[[balls]]\nkind = \"gas\"\nseed = 6\nradius = 0.5\nspeed = 0.5\nmass = 4.0\ncount = 100\n";
  const ScenarioPtr scene = gas_scene(2, 150, 400.0, "", heavy);
  EXPECT_LE(deviations(statistics_of(scene, MadeRun{}), StatisticKind::equipartition), 4.0);
  MadeRun hot;
  hot.spoil = [](std::vector<BallState>& states) {
    for (std::size_t i = 150; i < states.size(); ++i) states[i].velocity *= std::sqrt(1.2);
  };
  const RunStatistics statistics = statistics_of(scene, hot);
  EXPECT_GT(deviations(statistics, StatisticKind::equipartition), 4.0);
  EXPECT_NEAR(statistics.all.back().value, 1.2, 0.03);
}

TEST(Gas, CollisionRate_IsEnskogs_ForAWideBox_AndAnyMasses) {
  // For masses m and M the rate of a pair goes with μ^{-1/2}: all masses times 4 make half the rate at the
  // same temperature, and twice the energy √2 of it.
  const ScenarioPtr scene = gas_scene(3, 100, 200.0);
  const std::optional<Gas> gas = gas_of(*scene);
  const double enskog = fluid::collision_rate_per_s(3, gas->packing, 1.0, gas->temperature_J, 1.0);
  // The walls of a box of twelve diameters press the gas together by up to (12/11)³ - 1.
  EXPECT_GT(gas->collisions_per_ball_per_s(), enskog);
  EXPECT_LT(gas->collisions_per_ball_per_s(), 1.35 * enskog);
  Scenario heavy = *scene;
  for (Ball& ball : heavy.balls) ball.mass *= 4.0;
  for (Ball& ball : heavy.balls) ball.velocity *= 0.5;
  EXPECT_NEAR(gas_of(heavy)->collisions_per_s, 0.5 * gas->collisions_per_s, 1e-12 * gas->collisions_per_s);
}

// --- cooling

/// A gas that cools as theory expects with this restitution, whatever the scene says.
Trajectory cooling_run(const Gas& gas, double restitution) {
  Trajectory trajectory(*gas.scene);
  const double rate = cooling_rate_per_s(gas.dimension, restitution, gas.collisions_per_ball_per_s());
  Random random(9);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    const double factor = 1.0 + rate * trajectory.time(k);
    const auto states = equilibrium(*gas.scene, gas.energy_J / (factor * factor), random);
    std::copy(states.begin(), states.end(), trajectory.frame(k).begin());
  }
  return trajectory;
}

TEST(Cooling, SonineCoefficient_IsItsPublishedFormula) {
  EXPECT_EQ(sonine_coefficient(3, 1.0), 0.0);
  EXPECT_NEAR(sonine_coefficient(3, std::numbers::sqrt2 / 2.0), 0.0, 1e-15);  // it changes sign there
  EXPECT_NEAR(sonine_coefficient(3, 0.9), 1.6 * (1.0 - 1.62) / (81.0 - 15.3 + 2.43), 1e-15);
}

TEST(Cooling, HaffsLaw_IsTheMeasuredOne_OfTenThousandBalls) {
  // e = 0.9, nσ³ = 0.1, T0 = m = σ = 1: measured T = 0.6274, 0.3954, 0.1582 at t = 10.15, 22.96, 59.44, some
  // promille of it noise, and 1 % more than Haff's law in the end, when the balls gather.
  const double gamma = fluid::collision_rate_per_s(3, kPi / 60.0, 1.0, 1.0, 1.0);
  const double rate = cooling_rate_per_s(3, 0.9, gamma);
  const double measured[][3] = {{10.15, 0.6274, 0.005}, {22.96, 0.3954, 0.005}, {59.44, 0.1582, 0.015}};
  for (const auto& [t, value, tolerance] : measured) {
    EXPECT_NEAR(std::pow(1.0 + rate * t, -2), value, tolerance * value) << t;
  }
}

TEST(Statistics, FindAGasThatCoolsAtAnotherRate) {
  const ScenarioPtr scene =
      gas_scene(3, 500, 60.0, "[contact]\nrestitution = 0.9\n[contact.wall]\nrestitution = 1.0\n");
  const std::optional<Gas> gas = gas_of(*scene);
  RunStatistics statistics = measure_statistics(*gas, cooling_run(*gas, 0.9));
  ASSERT_EQ(statistics.all.size(), 1U);  // there is no equilibrium
  EXPECT_EQ(statistics.all[0].kind, StatisticKind::cooling);
  EXPECT_LE(statistics.all[0].deviations, 0.01);
  for (const double wrong : {0.8, 0.95, 1.0}) {
    statistics = measure_statistics(*gas, cooling_run(*gas, wrong));
    EXPECT_GT(statistics.all[0].deviations, 4.0) << wrong;
  }
}

// --- what is asked

std::string reason_of(const std::string& more, const std::string& balls) {
  const ScenarioPtr scene =
      scene_of("title = \"t\"\ndimension = 2\nduration = 200.0\nstep = 0.01\nframes = 200\n" + more +
               "[[balls]]\nkind = \"gas\"\ncount = 60\nseed = 5\nradius = 0.5\nspeed = 1.0\n"
               "mass = 1.0\n" +
               balls);
  const std::optional<Gas> gas = gas_of(*scene);
  return gas ? gas->asked.reason : "too few";
}

TEST(Gas, IsNotAsked_WhereSomethingElseActs) {
  const std::string box = "[box]\nmin = [0, 0]\nmax = [30, 30]\n";
  EXPECT_EQ(reason_of(box, ""), "");
  EXPECT_THAT(reason_of("[effects]\ngravity = [0, -9.81]\n" + box, ""), HasSubstr("forces"));
  EXPECT_THAT(reason_of("[effects]\nspin = true\n" + box, ""), HasSubstr("spin"));
  EXPECT_THAT(reason_of("[effects]\ncollisions = false\n" + box, ""), HasSubstr("pass through"));
  EXPECT_THAT(reason_of("[contact.wall]\nrestitution = 0.5\n" + box, ""), HasSubstr("walls take energy"));
  EXPECT_THAT(reason_of("[[wall]]\nnormal = [1, 1]\noffset = 1.0\n" + box, ""), HasSubstr("other walls"));
  EXPECT_FALSE(gas_of(*gas_scene(2, 49, 200.0)));
}

TEST(Gas, SaysWhyAStatisticDoesNotApply) {
  const auto reason = [](const ScenarioPtr& scene, StatisticKind kind) -> std::string {
    const SceneStatistics asked = gas_of(*scene)->asked;
    for (const NotAsked& each : asked.not_asked) {
      if (each.kind == kind) return each.reason;
    }
    return {};
  };
  EXPECT_THAT(reason(gas_scene(2, 100, 5.0), StatisticKind::speeds), HasSubstr("too short"));
  EXPECT_THAT(reason(gas_scene(2, 100, 200.0), StatisticKind::equipartition), HasSubstr("masses are equal"));
  EXPECT_THAT(reason(gas_scene(2, 100, 200.0), StatisticKind::cooling), HasSubstr("no energy"));
  EXPECT_EQ(reason(gas_scene(2, 100, 200.0), StatisticKind::collision_rate), "");
  const std::string small =
      "[[balls]]\nkind = \"gas\"\nseed = 6\nradius = 0.3\nspeed = 1.0\nmass = 1.0\ncount = 50\n";
  EXPECT_THAT(reason(gas_scene(2, 100, 200.0, "", small), StatisticKind::wall_pressure),
              HasSubstr("radii differ"));
}

TEST(Statistics, AreAMetric_ThatAGateCanLimit) {
  const ScenarioPtr scene = gas_scene(2, 100, 200.0, "[gate]\nstatistics = 4.0\n");
  const std::optional<Gas> gas = gas_of(*scene);
  const auto compared = [&](const MadeRun& made) {
    carom::Run run;
    run.engine = "engine";
    run.profile = "faithful";
    run.trajectory = made.of(*gas, 2);
    return compare(scene, {}, {run}, {"engine"});
  };
  EXPECT_EQ(compared({}).runs[0].verdict, Verdict::pass);
  MadeRun wrong;
  wrong.push_factor = 0.5;
  const SceneComparison result = compared(wrong);
  EXPECT_EQ(result.runs[0].verdict, Verdict::fail);
  EXPECT_EQ(result.runs[0].metrics[Metric::statistics],
            deviations(*result.runs[0].statistics, StatisticKind::wall_pressure));
}

}  // namespace
}  // namespace carom::test
