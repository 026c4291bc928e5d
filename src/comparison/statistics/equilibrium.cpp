#include "comparison/statistics/equilibrium.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "comparison/statistics/distributions.h"

namespace carom {

namespace {

/// Of each frame every eighth ball is asked, and in the next frame others: what the fixed sum of all energies
/// takes from the scatter of a sample, which would make p too large, is then an eighth of what it takes from
/// all balls together, and a ball is asked again only eight frames later.
constexpr std::size_t kAskedOneIn = 8;
/// Collisions of a ball between two frames that are asked, at least; so a ball has 16 until it is asked
/// again.
constexpr double kCollisionsBetween = 2.0;
/// Collisions of a ball after which a mean over all balls is an independent one, by the decay that sets the
/// warm-up: what is left of the first is below 2 %.
constexpr double kIndependentAfter = 8.0;

/// Waves of sound and slow drifts of energy make a mean scatter more than independent events would, in the
/// gases here by less than twice. One that scatters four times as much comes from no equilibrium.
constexpr double kMostScatter = 4.0;

/// The scatter that a mean is allowed, from what was seen of it and what independent events would have: spans
/// that happen to agree are not believed more than those, nor one that explodes its own scatter.
double believed(double seen, double independent) {
  return std::clamp(seen, independent, kMostScatter * independent);
}

class Equilibrium {
 public:
  Equilibrium(const Gas& gas, const Trajectory& trajectory)
      : gas_(gas), trajectory_(trajectory), law_(gas.dimension, gas.balls) {
    while (first_ + 1 < trajectory.frames() && trajectory.time(first_) < gas.asked.warm_up_s) ++first_;
    const double between_s = trajectory.time(1) - trajectory.time(0);
    const double collisions = gas.collisions_per_ball_per_s() * between_s;
    stride_ = static_cast<std::size_t>(std::max(1.0, std::ceil(kCollisionsBetween / collisions)));
    independent_ = std::max(1.0, gas.asked.collisions_per_ball / (kIndependentAfter * gas.mass_delay));
  }

  Statistic speeds() const {
    std::vector<double> shares;
    std::size_t asked = 0;
    for (std::size_t k = first_; k < trajectory_.frames(); k += stride_, ++asked) {
      for (std::size_t i = asked % kAskedOneIn; i < gas_.balls; i += kAskedOneIn)
        shares.push_back(share(k, i));
    }
    std::sort(shares.begin(), shares.end());
    const double distance = kolmogorov_distance(shares, [this](double x) { return law_.cdf(x); });
    const double p = kolmogorov_p(distance, shares.size());
    // The mean and the standard deviation of Kolmogorov's law.
    const double mean = std::sqrt(std::numbers::pi / 2.0) * std::numbers::ln2;
    const double deviation = std::sqrt(std::numbers::pi * std::numbers::pi / 12.0 - mean * mean);
    const double root = std::sqrt(static_cast<double>(shares.size()));
    return {StatisticKind::speeds, distance,     mean / root,
            deviation / root,      sigmas_of(p), fmt::format("p = {:.2g}, n = {}", p, shares.size())};
  }

  Statistic fourth_moment() const {
    double sum = 0.0;
    double frames = 0.0;
    for (std::size_t k = first_; k < trajectory_.frames(); ++k, ++frames) {
      double squares = 0.0;
      for (std::size_t i = 0; i < gas_.balls; ++i) squares += share(k, i) * share(k, i);
      sum += static_cast<double>(gas_.balls) * gas_.dimension / (gas_.dimension + 2.0) * squares - 1.0;
    }
    const double allowance = law_.fourth_moment_deviation() / std::sqrt(std::min(independent_, frames));
    return made(StatisticKind::fourth_moment, sum / frames, law_.fourth_moment_mean(), allowance);
  }

  Statistic collision_rate() const {
    const auto collisions = [](const Tally& tally) {
      return static_cast<double>(tally.impacts - tally.wall_impacts);
    };
    const TimeMean rate = rate_of(collisions);
    const double counted = std::max(1.0, collisions(last()) - collisions(trajectory_.tally(first_)));
    const double per_ball = 2.0 / static_cast<double>(gas_.balls);
    const double expected = gas_.collisions_per_s * per_ball;
    // Independent collisions would scatter like this.
    const double chance = believed(per_ball * rate.error, expected / std::sqrt(counted));
    return made(StatisticKind::collision_rate, per_ball * rate.mean, expected,
                std::hypot(chance, gas_.boxed->virial_error * expected),
                fmt::format("theory ±{:.1f} %, chance ±{:.1f} %", 100.0 * gas_.boxed->virial_error,
                            100.0 * chance / expected));
  }

  Statistic wall_pressure() const {
    const TimeMean force = rate_of([](const Tally& tally) { return tally.wall_push_Ns; });
    const double area = wall_area();
    const double expected = gas_.boxed->wall_force_N / area;
    const auto hits = static_cast<double>(last().wall_impacts - trajectory_.tally(first_).wall_impacts);
    // The pushes of balls that arrive at a wall scatter by 4/π - 1 of their mean's square.
    const double independent = expected * std::sqrt(4.0 / std::numbers::pi / std::max(1.0, hits));
    const double chance = believed(force.error / area, independent);
    return made(StatisticKind::wall_pressure, force.mean / area, expected,
                std::hypot(chance, gas_.boxed->force_error * expected),
                fmt::format("theory ±{:.1f} %, chance ±{:.1f} %", 100.0 * gas_.boxed->force_error,
                            100.0 * chance / expected));
  }

  Statistic equipartition() const {
    std::vector<double> shares;
    for (std::size_t k = first_; k < trajectory_.frames(); ++k) {
      double sum = 0.0;
      double all = 0.0;
      for (std::size_t i = 0; i < gas_.balls; ++i) all += share(k, i);
      for (const std::size_t i : gas_.heavy) sum += share(k, i);
      shares.push_back(sum / all);
    }
    const TimeMean mean = time_mean(shares);
    const double members = static_cast<double>(gas_.heavy.size()) / static_cast<double>(gas_.balls);
    const double independent = law_.group_deviation(gas_.heavy.size()) / std::sqrt(independent_);
    const double ratio = mean.mean / members / ((1.0 - mean.mean) / (1.0 - members));
    // d ln(s/(1-s)) = ds/(s(1-s)).
    const double allowance = believed(mean.error, independent) / (members * (1.0 - members));
    return made(StatisticKind::equipartition, ratio, 1.0, allowance,
                fmt::format("{} heavy, {} light", gas_.heavy.size(), gas_.balls - gas_.heavy.size()));
  }

  std::vector<double> speed_density() const {
    const SceneStatistics& asked = gas_.asked;
    std::vector<double> density(asked.speed_density.size(), 0.0);
    double count = 0.0;
    const double degrees = gas_.dimension * static_cast<double>(gas_.balls);
    for (std::size_t k = first_; k < trajectory_.frames(); k += stride_) {
      for (std::size_t i = 0; i < gas_.balls; ++i, ++count) {
        const double cell = std::floor(std::sqrt(share(k, i) * degrees) / asked.cell_width);
        if (cell < static_cast<double>(density.size())) ++density[static_cast<std::size_t>(cell)];
      }
    }
    for (double& each : density) each /= count * asked.cell_width;
    return density;
  }

 private:
  static Statistic made(StatisticKind kind, double value, double expected, double allowance,
                        const std::string& detail = {}) {
    return {kind, value, expected, allowance, std::abs(value - expected) / allowance, detail};
  }

  double share(std::size_t frame, std::size_t ball) const {
    return 0.5 * gas_.scene->balls[ball].mass * trajectory_.frame(frame)[ball].velocity.squaredNorm() /
           gas_.energy_J;
  }

  const Tally& last() const { return trajectory_.tally(trajectory_.frames() - 1); }

  template <class Quantity>
  TimeMean rate_of(const Quantity& quantity) const {
    std::vector<double> rates;
    for (std::size_t k = first_; k + 1 < trajectory_.frames(); ++k) {
      rates.push_back((quantity(trajectory_.tally(k + 1)) - quantity(trajectory_.tally(k))) /
                      (trajectory_.time(k + 1) - trajectory_.time(k)));
    }
    return time_mean(rates);
  }

  double wall_area() const {
    const Vec3 sides = gas_.scene->box->max - gas_.scene->box->min;
    double volume = 1.0;
    for (int i = 0; i < gas_.dimension; ++i) volume *= sides[i];
    double area = 0.0;
    for (int i = 0; i < gas_.dimension; ++i) area += 2.0 * volume / sides[i];
    return area;
  }

  const Gas& gas_;
  const Trajectory& trajectory_;
  EnergyShare law_;
  std::size_t first_ = 0;     // frame
  std::size_t stride_ = 1;    // frames between those that are asked
  double independent_ = 1.0;  // how many independent moments the run has
};

}  // namespace

void measure_equilibrium(const Gas& gas, const Trajectory& trajectory, RunStatistics& statistics) {
  if (!is_asked(gas, StatisticKind::speeds)) return;
  const Equilibrium run(gas, trajectory);
  statistics.speed_density = run.speed_density();
  statistics.all.push_back(run.speeds());
  statistics.all.push_back(run.fourth_moment());
  const bool counted = trajectory.tally(trajectory.frames() - 1).walls_known;
  const auto if_counted = [&](StatisticKind kind, Statistic (Equilibrium::*measure)() const) {
    if (!is_asked(gas, kind)) return;
    if (counted) {
      statistics.all.push_back((run.*measure)());
    } else {
      statistics.not_asked.push_back({kind, "the engine does not tell impacts on walls from others"});
    }
  };
  if_counted(StatisticKind::collision_rate, &Equilibrium::collision_rate);
  if_counted(StatisticKind::wall_pressure, &Equilibrium::wall_pressure);
  if (is_asked(gas, StatisticKind::equipartition)) statistics.all.push_back(run.equipartition());
}

}  // namespace carom
