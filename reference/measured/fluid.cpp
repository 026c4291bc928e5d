#include "reference/measured/fluid.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <span>
#include <stdexcept>
#include <vector>

#include "scenario/generate.h"

namespace carom::measured {

namespace {

using std::numbers::pi;

/// Blocks of time that are left out while the start is forgotten.
constexpr std::int64_t kForgetting = 5;
constexpr std::int64_t kFramesPerBlock = 10;

/// The window begins this far from where centres are stopped, and opens over twice the diameter.
constexpr double kMargin = 3.0;
constexpr double kRamp = 2.0;

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

/// d(n Z)/dn of Carnahan and Starling: the square of the isothermal speed of sound.
double pressure_slope(double eta) {
  return stiffness(eta) / std::pow(1.0 - eta, 4);
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

/// How much of a sphere the window takes along one axis, at this distance from where centres are stopped.
double ramp(double depth, double margin) {
  const double opened = std::clamp((depth - margin) / kRamp, 0.0, 1.0);
  const double sine = std::sin(0.5 * pi * opened);
  return sine * sine;
}

/// The density in the window, L the side that centres have.
double density_inside(std::span<const BallState> states, double side, double margin) {
  double taken = 0.0;
  for (const BallState& state : states) {
    double weight = 1.0;
    for (int axis = 0; axis < 3; ++axis) {
      const double place = state.position[axis] - 0.5;
      weight *= ramp(std::min(place, side - place), margin);
    }
    taken += weight;
  }
  return taken / std::pow(side - 2.0 * margin - kRamp, 3);
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

/// The mean of blocks of time, whose standard error is the larger of that of the blocks and of that of pairs
/// of them: were neighbours alike, pairs would differ more.
Mean mean_of_blocks(const std::vector<double>& blocks) {
  Mean mean = mean_of(blocks);
  std::vector<double> pairs;
  for (std::size_t i = 1; i < blocks.size(); i += 2) pairs.push_back(0.5 * (blocks[i - 1] + blocks[i]));
  mean.standard_error = std::max(mean.standard_error, mean_of(pairs).standard_error);
  return mean;
}

/// What was seen of the fluid in each block of time.
struct Blocks {
  std::vector<double> rates;      ///< impacts of two spheres, 1/s
  std::vector<double> densities;  ///< in the window
  std::vector<double> narrower;   ///< in a window that begins σ further from the walls
  double temperature = 0.0;
};

double temperature_of(std::span<const BallState> states) {
  double squares = 0.0;
  for (const BallState& state : states) squares += state.velocity.squaredNorm();
  return squares / (3.0 * static_cast<double>(states.size()));
}

Blocks watched(const Fluid& fluid, const Runner& run) {
  const Scenario scene = fluid_scene(fluid);
  const double side = centres_side(fluid);
  const auto frames = static_cast<double>(kFramesPerBlock);
  const double block_s = scene.duration_s / static_cast<double>(scene.frames) * frames;
  Blocks blocks;
  std::int64_t frame = 0;
  std::int64_t before = 0;
  double density = 0.0;
  double narrower = 0.0;
  run(scene, [&](std::span<const BallState> states, const Tally& tally) {
    const std::int64_t block = frame / kFramesPerBlock - kForgetting;
    const bool begins = frame++ % kFramesPerBlock == 0;
    if (block < 0) return;
    if (begins) {
      const std::int64_t impacts = impacts_of_pairs(tally);
      if (block > 0) {
        blocks.rates.push_back(static_cast<double>(impacts - before) / block_s);
        blocks.densities.push_back(density / frames);
        blocks.narrower.push_back(narrower / frames);
      }
      before = impacts;
      density = 0.0;
      narrower = 0.0;
      blocks.temperature = temperature_of(states);
    }
    density += density_inside(states, side, kMargin);
    narrower += density_inside(states, side, kMargin + 1.0);
  });
  return blocks;
}

/// How far scaled-particle theory is off, as a share, seen by its pressure.
double theory_error(double eta) {
  return std::abs(particle_theory(eta) / carnahan_starling(eta) - 1.0);
}

/// The density far from walls as the box was made for, by equation (1).
Measurement density_by_theory(const Fluid& fluid) {
  const double eta = packing(fluid.density);
  const double side = centres_side(fluid);
  const double by_walls = theory_error(eta) * wall_excess(eta) * 6.0 / side;
  return {fluid.density, by_walls + edge_excess(eta) * 12.0 / (side * side)};
}

/// The density far from walls as it is counted in the window.
Measurement density_by_counting(const Blocks& blocks) {
  const Mean density = mean_of_blocks(blocks.densities);
  const double shifted = std::abs(mean_of(blocks.narrower).value - density.value);
  return {density.value, 2.0 * density.standard_error + shifted};
}

}  // namespace

Scenario fluid_box(const Fluid& fluid) {
  Scenario scene;
  scene.dimension = 3;
  const double side = centres_side(fluid) + 1.0;
  scene.box = Box{Vec3::Zero(), Vec3::Constant(side)};
  for (int axis = 0; axis < 3; ++axis) {
    scene.walls.push_back({Vec3::Unit(axis), 0.0});
    scene.walls.push_back({-Vec3::Unit(axis), -side});
  }
  return scene;
}

double collision_time(double density) {
  return std::sqrt(pi) / (6.0 * (carnahan_starling(packing(density)) - 1.0));
}

Scenario fluid_scene(const Fluid& fluid) {
  Scenario scene = fluid_box(fluid);
  Generator generator;
  generator.kind = Generator::Kind::lattice;
  generator.count = fluid.count;
  generator.seed = 1;
  generator.radius = std::pair(0.5, 0.5);
  generator.mass = 1.0;
  generator.speed = std::sqrt(3.0);  // ½ m v² = 3/2 T
  scene.balls = generate(generator, scene);
  const std::int64_t blocks = kForgetting + fluid.blocks;
  const double block_s = centres_side(fluid) / std::sqrt(pressure_slope(packing(fluid.density)));
  scene.frames = blocks * kFramesPerBlock;
  scene.duration_s = static_cast<double>(blocks) * block_s;
  scene.step_s = 0.1 * collision_time(fluid.density);
  return scene;
}

FluidMeasurement measure_fluid(const Fluid& fluid, const Runner& run) {
  const Blocks blocks = watched(fluid, run);
  FluidMeasurement result;
  result.density_by_theory = density_by_theory(fluid);
  result.density_by_counting = density_by_counting(blocks);
  const Measurement density = result.density_by_theory.uncertainty < result.density_by_counting.uncertainty
                                  ? result.density_by_theory
                                  : result.density_by_counting;

  const Mean rate = mean_of_blocks(blocks.rates);
  const double eta = packing(density.value);
  const double side = centres_side(fluid);
  const double volume = std::pow(side, 3);
  const auto count = static_cast<double>(fluid.count);
  const double exchange = std::sqrt(pi / blocks.temperature);
  const double on_walls = (count + exchange * rate.value / 3.0) / volume;  // equation (5), by T
  const double by_walls = 4.0 * wall_tension(eta) / side;
  const double by_edges = -edge_pressure(eta, side);
  const double z = (on_walls + by_walls + by_edges) / density.value;

  const double moved = carnahan_starling(packing(fluid.density)) / carnahan_starling(eta);
  const double steepness = pressure_slope(eta) / carnahan_starling(eta);  // d ln(n Z)/d ln n
  const double of_rate = 2.0 * exchange * rate.standard_error / (3.0 * volume * density.value);
  const double of_density = steepness * z * density.uncertainty / density.value;
  const double of_walls = (theory_error(eta) * std::abs(by_walls) + std::abs(by_edges)) / density.value;
  result.compressibility = {z * moved, of_rate + of_density + of_walls + z / count};
  return result;
}

std::int64_t impacts_of_pairs(const Tally& tally) {
  if (!tally.walls_known) throw std::runtime_error("measured: impacts on walls are not told apart");
  return tally.impacts - tally.wall_impacts;
}

Measurement mean_free_time(const Measurement& compressibility) {
  const double t0 = std::sqrt(pi) / (6.0 * (compressibility.value - 1.0));
  return {t0, t0 * compressibility.uncertainty / (compressibility.value - 1.0)};
}

}  // namespace carom::measured
