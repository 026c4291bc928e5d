#include "report/page/plots.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "comparison/conserved.h"
#include "report/page/plot.h"
#include "report/page/wording.h"

namespace carom::page {

namespace {

// What an engine that explodes may reach in a plot; beyond it, axes would overflow.
constexpr double kLargest = 1e299;
// A truth whose energy changes by no more than this conserves it; the rest is rounding.
constexpr double kConserves = 1e-9;

bool anything_finite(const std::vector<double>& values) {
  return std::any_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}

/// The plot of one of the series, with the lines in which something is known.
Plot plot_of(const SceneComparison& scene, std::vector<double> RunSeries::*series) {
  Plot plot;
  for (const RunComparison& run : scene.runs) {
    if (run.run.status != RunStatus::ok) continue;
    if (plot.times_s.empty()) {
      for (std::size_t k = 0; k < run.run.trajectory.frames(); ++k) {
        plot.times_s.push_back(run.run.trajectory.time(k));
      }
    }
    Line line = {run.run.label(), run.series.*series};
    line.values.resize(plot.times_s.size(), std::numeric_limits<double>::quiet_NaN());
    for (double& value : line.values) {
      if (std::isfinite(value)) value = std::clamp(value, -kLargest, kLargest);
    }
    if (anything_finite(line.values)) plot.lines.push_back(std::move(line));
  }
  return plot;
}

void add_gate_rule(const SceneComparison& scene, Metric metric, Plot& plot) {
  const auto gate = scene.scene->gate.under_test.find(metric);
  if (gate == scene.scene->gate.under_test.end() || gate->second <= 0.0) return;
  plot.rules.push_back({gate->second, "gate " + given(gate->second), "gate"});
}

/// The energy of the truth, (E - E_0) / E_scale, where it is not conserved; NaN beyond the truth's horizon.
std::vector<double> expected_energy(const SceneComparison& scene) {
  if (!scene.truth.known() || scene.truth.trajectory.frames() == 0) return {};
  const Reference reference(*scene.scene);
  const Trajectory& truth = scene.truth.trajectory;
  std::vector<double> energies;
  const Cast cast(*scene.scene);  // the truth ends before the first event
  for (std::size_t k = 0; k < truth.frames(); ++k) {
    const bool known = truth.time(k) <= scene.truth.horizon_s.value_or(scene.scene->duration_s);
    const double energy_J = reference.of(truth.frame(k), cast).energy_J - reference.start.energy_J;
    energies.push_back(known ? energy_J / reference.energy_scale_J
                             : std::numeric_limits<double>::quiet_NaN());
  }
  return Line{"truth", energies}.peak() > kConserves ? energies : std::vector<double>();
}

void add_energy_plot(Node parent, const SceneComparison& scene, const Legend& legend) {
  Plot plot = plot_of(scene, &RunSeries::energy);
  if (plot.lines.empty()) return;
  plot.title = "Energy, change since the start.";
  plot.quantity = "share of the initial energy; above 0 gained, below lost";
  plot.expected = expected_energy(scene);
  // The gate limits the distance from what is expected, which can be drawn only where that is zero.
  if (plot.expected.empty()) add_gate_rule(scene, Metric::energy, plot);
  add_plot(parent, plot, signed_axis(plot), legend);
}

void add_momentum_plot(Node parent, const SceneComparison& scene, const Legend& legend) {
  Plot plot = plot_of(scene, &RunSeries::momentum);
  if (plot.lines.empty()) return;
  plot.title = "Momentum, deviation from what is expected.";
  plot.quantity = "share of Σ m|v| at the start";
  add_gate_rule(scene, Metric::momentum, plot);
  add_plot(parent, plot, log_axis(plot), legend);
}

void add_position_plot(Node parent, const SceneComparison& scene, const Legend& legend) {
  Plot plot = plot_of(scene, &RunSeries::position);
  if (plot.lines.empty()) return;
  plot.title = "Position, error of the worst ball.";
  plot.quantity = "distance from the truth, m";
  add_gate_rule(scene, Metric::position, plot);
  if (scene.position_tolerance_m > 0.0)
    plot.rules.push_back({scene.position_tolerance_m, "diverged", "parted"});
  if (scene.truth.uncertainty_m > 0.0)
    plot.rules.push_back({scene.truth.uncertainty_m, "uncertainty of the truth", ""});
  if (scene.truth.horizon_s && *scene.truth.horizon_s < scene.scene->duration_s) {
    plot.horizon = Mark{*scene.truth.horizon_s, "horizon"};
  }
  add_plot(parent, plot, log_axis(plot), legend);
}

}  // namespace

void add_plots(Node parent, const SceneComparison& scene, const Legend& legend) {
  Node row = add(parent, "div", {{"class", "plots"}});
  add_position_plot(row, scene, legend);
  add_energy_plot(row, scene, legend);
  add_momentum_plot(row, scene, legend);
  if (!row.first_child()) parent.remove_child(row);
}

}  // namespace carom::page
