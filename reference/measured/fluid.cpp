#include "reference/measured/fluid.h"

#include <cmath>
#include <numbers>
#include <vector>

#include "scenario/generate.h"

namespace carom::measured {

namespace {

using std::numbers::pi;

/// Blocks of time that are counted apart, after the one that is left out.
constexpr std::int64_t kBlocks = 20;
constexpr double kCollisionsPerBlock = 5.0;  ///< of each sphere

double packing(double density) {
  return pi / 6.0 * density;
}

double carnahan_starling(double eta) {
  return (1.0 + eta + eta * eta - eta * eta * eta) / std::pow(1.0 - eta, 3);
}

/// Of scaled-particle theory.
double particle_theory(double eta) {
  return (1.0 + eta + eta * eta) / std::pow(1.0 - eta, 3);
}

/// γ, equation (2).
double wall_tension(double eta) {
  return -4.5 / pi * eta * eta * (1.0 + eta) / std::pow(1.0 - eta, 3);
}

/// ∂(μ/T)/∂ln n of Carnahan and Starling, times (1 - η)⁴.
double stiffness(double eta) {
  const double e2 = eta * eta;
  return 1.0 + 4.0 * eta + 4.0 * e2 - 4.0 * e2 * eta + e2 * e2;
}

/// Γ, equation (3).
double wall_excess(double eta) {
  return 4.5 / pi * (2.0 + 4.0 * eta) * eta * eta / stiffness(eta);
}

/// ε, equation (4).
double edge_excess(double eta) {
  return 3.375 * std::pow(eta, 3) / stiffness(eta);
}

/// What edges add to the pressure on the walls, equation (6), by T.
double edge_pressure(double eta, double side) {
  return 4.5 * std::pow(eta / (1.0 - eta), 3) / (side * side);
}

/// L of equation (1). Its right-hand side grows with L, and is bracketed and halved.
double centres_side(const Fluid& fluid) {
  const auto held = [&](double side) {
    return fluid.density * std::pow(side, 3) + wall_excess(packing(fluid.density)) * 6.0 * side * side +
           edge_excess(packing(fluid.density)) * 12.0 * side;
  };
  double low = 0.0;
  double high = 2.0 * std::cbrt(static_cast<double>(fluid.count) / fluid.density);
  for (int halving = 0; halving < 60; ++halving) {
    const double middle = 0.5 * (low + high);
    (held(middle) < static_cast<double>(fluid.count) ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

struct Mean {
  double value = 0.0;
  double standard_error = 0.0;
};

Mean mean_of(const std::vector<double>& values) {
  const auto count = static_cast<double>(values.size());
  Mean mean;
  for (const double value : values) mean.value += value / count;
  double squares = 0.0;
  for (const double value : values) squares += (value - mean.value) * (value - mean.value);
  mean.standard_error = std::sqrt(squares / (count - 1.0) / count);
  return mean;
}

}  // namespace

Scenario fluid_scene(const Fluid& fluid) {
  Scenario scene;
  scene.dimension = 3;
  const double side = centres_side(fluid) + 1.0;
  scene.box = Box{Vec3::Zero(), Vec3::Constant(side)};
  for (int axis = 0; axis < 3; ++axis) {
    scene.walls.push_back({Vec3::Unit(axis), 0.0});
    scene.walls.push_back({-Vec3::Unit(axis), -side});
  }
  Generator generator;
  generator.count = fluid.count;
  generator.seed = 1;
  generator.radius = std::pair(0.5, 0.5);
  generator.mass = 1.0;
  generator.speed = std::sqrt(3.0);  // ½ m v² = 3/2 T
  scene.balls = generate(generator, scene);
  const double collision_s = std::sqrt(pi) / (6.0 * (carnahan_starling(packing(fluid.density)) - 1.0));
  scene.frames = kBlocks + 1;
  scene.duration_s = static_cast<double>(scene.frames) * kCollisionsPerBlock * collision_s;
  scene.step_s = 0.1 * collision_s;
  return scene;
}

Measurement compressibility(const Fluid& fluid, const Runner& run) {
  const Scenario scene = fluid_scene(fluid);
  const Record record = run(scene);
  const double block_s = scene.duration_s / static_cast<double>(scene.frames);
  std::vector<double> rates;
  for (std::size_t block = 2; block < record.impacts.size(); ++block) {
    rates.push_back(static_cast<double>(record.impacts[block] - record.impacts[block - 1]) / block_s);
  }
  const Mean rate = mean_of(rates);
  double temperature = 0.0;
  const auto count = static_cast<double>(fluid.count);
  for (const BallState& state : record.states) temperature += state.velocity.squaredNorm() / (3.0 * count);

  const double eta = packing(fluid.density);
  const double side = centres_side(fluid);
  const double volume = std::pow(side, 3);
  const double area = 6.0 * side * side;
  const double weight = 3.0 * volume + area / std::numbers::sqrt2;  // equation (5)
  const double exchange = std::sqrt(pi * temperature);
  const double on_walls = (3.0 * count * temperature + exchange * rate.value) / weight;
  const double by_walls = 4.0 * wall_tension(eta) / side;
  const double by_edges = -edge_pressure(eta, side);
  const double z = (on_walls / temperature + by_walls + by_edges) / fluid.density;

  // The pressure belongs to the density that is there: δZ/Z = (1 + d ln Z/d ln n) δn/n.
  constexpr double kStep = 1e-6;
  const double steepness =
      1.0 + std::log(carnahan_starling(eta * (1.0 + kStep)) / carnahan_starling(eta)) / kStep;
  const double of_walls = z * steepness * wall_excess(eta) * area / count - by_walls / fluid.density;
  const double of_edges = z * steepness * edge_excess(eta) * 12.0 * side / count - by_edges / fluid.density;
  const double off = std::abs(particle_theory(eta) / carnahan_starling(eta) - 1.0);
  const double chance = 2.0 * exchange * rate.standard_error / weight / (fluid.density * temperature);
  return {z, chance + off * of_walls + of_edges};
}

Measurement mean_free_time(const Measurement& compressibility) {
  const double t0 = std::sqrt(pi) / (6.0 * (compressibility.value - 1.0));
  return {t0, t0 * compressibility.uncertainty / (compressibility.value - 1.0)};
}

}  // namespace carom::measured
