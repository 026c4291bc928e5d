#include "comparison/statistics/gas.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

#include "comparison/statistics/distributions.h"

namespace carom {

namespace {

// A gas of one mass forgets its start by half a unit of ln for each collision of a ball: the fourth moment of
// a gas of equal speeds, a2 = -0.4, is measured to be -0.277, -0.121 and -0.031 after 1, 3 and 6. After ten
// what is left is below what the frames of any scene here can show.
constexpr double kWarmUpCollisions = 10.0;
/// Over fewer collisions of a ball a mean says nothing.
constexpr double kLeastCollisions = 20.0;
/// Frames that are asked, at least: two for each span of a mean's error.
constexpr std::size_t kLeastFrames = 20;
/// A group of fewer balls has no mean energy to speak of.
constexpr std::size_t kSmallestGroup = 20;
/// Cells up to four times √(T/m): past that there is less than a thousandth of the balls.
constexpr std::size_t kSpeedCells = 32;
constexpr double kFastest = 4.0;

constexpr double kPi = std::numbers::pi;

/// Why the scene is no gas in equilibrium, nor one that cools down to rest: nothing where it is one.
std::string not_a_gas(const Scenario& s) {
  if (!s.effects.collisions) return "the balls pass through each other";
  if (s.effects.gravity || s.effects.drag || s.effects.magnus) return "forces act between impacts";
  if (s.effects.spin) return "the balls can spin";
  if (!s.box || s.walls.size() != 2 * static_cast<std::size_t>(s.dimension))
    return "it needs a box and no other walls";
  if (!s.slabs.empty() || !s.barriers.empty()) return "something stands in the box";
  if (!s.events.empty()) return "somebody interferes";
  if (s.wall_contact.restitution < 1.0) return "the walls take energy";
  if (std::any_of(s.balls.begin(), s.balls.end(), [](const Ball& b) { return std::isinf(b.mass); })) {
    return "a ball is immovable";
  }
  if (std::all_of(s.balls.begin(), s.balls.end(), [](const Ball& b) { return b.velocity.isZero(0.0); })) {
    return "nothing moves";
  }
  return {};
}

double volume_of(int dimension, double radius) {
  return dimension == 3 ? 4.0 / 3.0 * kPi * radius * radius * radius : kPi * radius * radius;
}

bool elastic(const Scenario& scene) {
  return scene.ball_contact.restitution == 1.0;
}

/// The heavier of two groups: of two masses the greater one, of more the heavier half.
std::vector<std::size_t> heavier_group(const Scenario& scene) {
  std::vector<double> masses;
  for (const Ball& ball : scene.balls) masses.push_back(ball.mass);
  std::sort(masses.begin(), masses.end());
  if (masses.front() == masses.back()) return {};
  const bool two = std::all_of(masses.begin(), masses.end(),
                               [&](double m) { return m == masses.front() || m == masses.back(); });
  const double limit = two ? masses.back() : masses[masses.size() / 2];
  std::vector<std::size_t> heavy;
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    if (scene.balls[i].mass >= limit) heavy.push_back(i);
  }
  return heavy;
}

/// The mean of μ^{-1/2} over all pairs, kg^{-1/2}.
double mean_inverse_root_of_reduced_mass(const Scenario& scene) {
  std::map<double, double> counts;
  for (const Ball& ball : scene.balls) ++counts[ball.mass];
  double sum = 0.0;
  double pairs = 0.0;
  for (const auto& [mass, count] : counts) {
    for (const auto& [other, others] : counts) {
      const double weight = count * (mass == other ? others - 1.0 : others);
      sum += weight * std::sqrt(1.0 / mass + 1.0 / other);
      pairs += weight;
    }
  }
  return sum / pairs;
}

std::string no_theory_of(const Gas& gas, const std::array<double, 3>& sides_m) {
  const Scenario& scene = *gas.scene;
  const bool one_radius = std::all_of(scene.balls.begin(), scene.balls.end(), [&](const Ball& ball) {
    return ball.radius == scene.balls.front().radius;
  });
  if (!one_radius) return "the radii differ, and the theory used here is of one radius";
  // Layers at opposite walls must not meet: the fluid's structure reaches a few diameters.
  constexpr double kNarrowest = 6.0;
  const double shortest = *std::min_element(sides_m.begin(), sides_m.begin() + scene.dimension);
  if (shortest < kNarrowest * gas.mean_diameter_m)
    return "the box is too narrow for a fluid between its walls";
  if (gas.packing > 0.9 * fluid::densest(gas.dimension))
    return "it is packed nearly as densely as it freezes";
  return {};
}

void add_theory(Gas& gas) {
  const Scenario& scene = *gas.scene;
  const Vec3 sides = scene.box->max - scene.box->min;
  const std::array<double, 3> sides_m = {sides.x(), sides.y(), sides.z()};
  double filled = 0.0;
  double volume = 1.0;
  for (const Ball& ball : scene.balls) {
    filled += volume_of(gas.dimension, ball.radius);
    gas.mean_diameter_m += 2.0 * ball.radius / static_cast<double>(gas.balls);
  }
  for (int i = 0; i < gas.dimension; ++i) volume *= sides[i];
  gas.packing = filled / volume;
  gas.no_theory = no_theory_of(gas, sides_m);
  const double mean_root = mean_inverse_root_of_reduced_mass(scene);
  if (gas.no_theory.empty()) {
    gas.boxed = fluid::boxed_fluid(gas.dimension, static_cast<double>(gas.balls), sides_m,
                                   gas.mean_diameter_m, gas.temperature_J);
    gas.collisions_per_s = gas.boxed->pair_virial_J_s / gas.mean_diameter_m * mean_root /
                           std::sqrt(2.0 * kPi * gas.temperature_J);
  } else {
    const double mass_kg = 2.0 / (mean_root * mean_root);  // μ is half of it for equal masses
    gas.collisions_per_s = 0.5 * static_cast<double>(gas.balls) *
                           fluid::collision_rate_per_s(gas.dimension, gas.packing, gas.mean_diameter_m,
                                                       gas.temperature_J, mass_kg);
  }
}

std::string equipartition_reason(const Gas& gas) {
  if (gas.heavy.empty()) return "all masses are equal";
  const std::size_t smaller = std::min(gas.heavy.size(), gas.balls - gas.heavy.size());
  if (smaller < kSmallestGroup) return fmt::format("fewer than {} balls of a kind", kSmallestGroup);
  return {};
}

std::string equilibrium_reason(const Gas& gas) {
  if (!elastic(*gas.scene)) return "impacts take energy, so there is no equilibrium";
  const Scenario& scene = *gas.scene;
  const double left_s = scene.duration_s - gas.asked.warm_up_s;
  const double frames = left_s / scene.duration_s * static_cast<double>(scene.frames);
  if (gas.asked.collisions_per_ball < kLeastCollisions || frames < static_cast<double>(kLeastFrames)) {
    return fmt::format(
        "too short: a ball needs {:.0f} collisions to forget its start and {:.0f} more in {} frames, and has "
        "{:.0f} in all",
        kWarmUpCollisions * gas.mass_delay, kLeastCollisions, kLeastFrames,
        gas.collisions_per_ball_per_s() * scene.duration_s);
  }
  return {};
}

std::string cooling_reason(const Gas& gas) {
  if (elastic(*gas.scene)) return "impacts take no energy";
  if (!gas.heavy.empty()) return "the masses differ, and so do the temperatures of light and heavy balls";
  return gas.no_theory;
}

void decide(Gas& gas) {
  SceneStatistics& asked = gas.asked;
  asked.temperature_J = gas.temperature_J;
  const double rate = gas.collisions_per_ball_per_s();
  if (elastic(*gas.scene)) asked.warm_up_s = kWarmUpCollisions * gas.mass_delay / rate;
  asked.collisions_per_ball = rate * (gas.scene->duration_s - asked.warm_up_s);
  const auto leave_out = [&](StatisticKind kind, const std::string& reason) {
    if (!reason.empty()) asked.not_asked.push_back({kind, reason});
  };
  const std::string equilibrium = equilibrium_reason(gas);
  const auto also = [&](const std::string& reason) { return equilibrium.empty() ? reason : equilibrium; };
  leave_out(StatisticKind::speeds, equilibrium);
  leave_out(StatisticKind::fourth_moment, equilibrium);
  leave_out(StatisticKind::collision_rate, also(gas.no_theory));
  leave_out(StatisticKind::wall_pressure, also(gas.no_theory));
  leave_out(StatisticKind::equipartition, also(equipartition_reason(gas)));
  leave_out(StatisticKind::cooling, cooling_reason(gas));
  if (!equilibrium.empty()) return;
  asked.cell_width = kFastest / static_cast<double>(kSpeedCells);
  const EnergyShare share(gas.dimension, gas.balls);
  // ½ m v² = ½ T u², and T = 2E/(dN).
  const double half_degrees = gas.dimension * static_cast<double>(gas.balls);
  const auto below = [&](std::size_t cell) {
    const double u = asked.cell_width * static_cast<double>(cell);
    return share.cdf(u * u / half_degrees);
  };
  for (std::size_t cell = 0; cell < kSpeedCells; ++cell) {
    asked.speed_density.push_back((below(cell + 1) - below(cell)) / asked.cell_width);
  }
}

}  // namespace

std::optional<Gas> gas_of(const Scenario& scene) {
  if (scene.balls.size() < kFewestBalls) return std::nullopt;
  Gas gas;
  gas.scene = &scene;
  gas.dimension = scene.dimension;
  gas.balls = scene.balls.size();
  gas.asked.reason = not_a_gas(scene);
  if (!gas.asked.reason.empty()) return gas;
  double lightest = scene.balls.front().mass;
  double heaviest = lightest;
  for (const Ball& ball : scene.balls) {
    gas.energy_J += 0.5 * ball.mass * ball.velocity.squaredNorm();
    lightest = std::min(lightest, ball.mass);
    heaviest = std::max(heaviest, ball.mass);
  }
  gas.temperature_J = 2.0 * gas.energy_J / (gas.dimension * static_cast<double>(gas.balls));
  gas.mass_delay = (lightest + heaviest) * (lightest + heaviest) / (4.0 * lightest * heaviest);
  gas.heavy = heavier_group(scene);
  add_theory(gas);
  decide(gas);
  return gas;
}

bool is_asked(const Gas& gas, StatisticKind kind) {
  const auto& left_out = gas.asked.not_asked;
  return gas.asked.reason.empty() && std::none_of(left_out.begin(), left_out.end(),
                                                  [&](const NotAsked& each) { return each.kind == kind; });
}

}  // namespace carom
