#include "comparison/coefficients.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace carom {

namespace {

constexpr double kRadius_m = 0.1;
constexpr double kStepRadii = 0.05;
// Steps until the surfaces touch, in each lane. Before its last step of approach the first is 0.8 steps away,
// 0.04 r, farther than any engine's contact acts (Bullet's begins at 0.02 √3 r on a plane).
constexpr std::array kGapSteps = {5.8, 5.5, 5.2};
constexpr double kLane_m = 1.0;  // ten radii from lane to lane
// Arrival takes up to 5.8 steps; at e = ½ the ball needs as many halves to come free again. The rest is for
// engines that take several steps over an impact.
constexpr std::int64_t kSteps = 40;
// The speed of the surface by spin, in speeds of approach. Sliding on a wall needs more than (7/2) μ (1 + e)
// = 1.6 (physics of the three-parameter law, homogeneous sphere); two balls that spin alike slide twice as
// fast.
constexpr double kSlipSpeeds = 4.0;
// Powers of ten of the speed and points in each.
constexpr int kLowestPower = -2;
constexpr int kHighestPower = 2;
constexpr int kPerPower = 3;
// Surfaces nearer than this are together. A wall's skin holds a ball off by up to 0.1 r, and where every ball
// starts it is far from it.
constexpr double kTogetherRadii = 0.15;
// A ball that is slower than this share of its speed has been stopped.
constexpr double kStopped = 1e-3;

Ball ball_at(double x_m, std::size_t lane, double speed_mps, double spin_radps) {
  Ball ball;
  ball.radius = kRadius_m;
  ball.position = {x_m, kLane_m * static_cast<double>(lane), 0.0};
  ball.velocity = {speed_mps, 0.0, 0.0};
  ball.spin = {0.0, 0.0, spin_radps};
  return ball;
}

/// The ball flies along x, to the right; what it hits is at x = 0.
Scenario scene_of(Coefficient coefficient, bool wall, double nominal, double speed_mps) {
  const bool friction = coefficient == Coefficient::friction;
  Scenario scene;
  scene.id = "coefficients";
  scene.dimension = 2;
  scene.step_s = kStepRadii * kRadius_m / speed_mps;
  scene.duration_s = scene.step_s * static_cast<double>(kSteps);
  scene.frames = kSteps;
  scene.effects.spin = friction;
  scene.ball_contact = friction ? Contact{0.5, nominal, 0.0} : Contact{nominal, 0.0, 0.0};
  scene.wall_contact = scene.ball_contact;
  const double spin_radps = friction ? kSlipSpeeds * speed_mps / kRadius_m / (wall ? 1.0 : 2.0) : 0.0;
  for (std::size_t lane = 0; lane < kGapSteps.size(); ++lane) {
    const double gap_m = kGapSteps[lane] * kStepRadii * kRadius_m;
    scene.balls.push_back(ball_at(-gap_m - kRadius_m, lane, speed_mps, spin_radps));
    if (!wall) scene.balls.push_back(ball_at(kRadius_m, lane, 0.0, spin_radps));
  }
  if (wall) scene.walls.push_back({-Vec3::UnitX(), 0.0});
  return scene;
}

/// Where the surfaces are, and how they move: what is hit less what hits.
struct Approach {
  double gap_m = 0.0;
  double opening_mps = 0.0;
};

Approach approach_of(std::span<const BallState> balls) {
  if (balls.size() == 1) return {-balls[0].position.x() - kRadius_m, -balls[0].velocity.x()};
  const Vec3 apart = balls[1].position - balls[0].position;
  return {apart.norm() - 2.0 * kRadius_m, balls[1].velocity.x() - balls[0].velocity.x()};
}

/// (1) or (2); nothing where the normal velocity did not change.
std::optional<double> value_of(const CoefficientProbe& probe, std::span<const BallState> balls) {
  if (probe.coefficient == Coefficient::restitution) {
    return approach_of(balls).opening_mps / probe.speed_mps;
  }
  // What was hit was at rest, so its velocity is the impulse over its mass; a wall gives it to the ball.
  const Vec3 change =
      probe.wall ? Vec3(balls[0].velocity - Vec3(probe.speed_mps, 0.0, 0.0)) : balls[1].velocity;
  if (change.x() == 0.0) return std::nullopt;
  return std::abs(change.y() / change.x());
}

/// The balls of a lane in a frame.
std::span<const BallState> lane_of(const CoefficientProbe& probe, const Trajectory& trajectory,
                                   std::size_t frame, std::size_t lane) {
  const std::size_t balls = probe.wall ? 1 : 2;
  return trajectory.frame(frame).subspan(lane * balls, balls);
}

std::optional<double> delivered_in(const CoefficientProbe& probe, const Trajectory& trajectory,
                                   std::size_t lane) {
  const double still_mps = kStopped * probe.speed_mps;
  // The first frame in which the ball does not approach any more: later it may be put to sleep.
  std::size_t arrest = 0;
  for (std::size_t frame = 1; frame < trajectory.frames(); ++frame) {
    const auto balls = lane_of(probe, trajectory, frame, lane);
    const Approach approach = approach_of(balls);
    if (approach.opening_mps > still_mps && approach.gap_m > 0.0) return value_of(probe, balls);
    if (arrest == 0 && approach.opening_mps >= -still_mps) arrest = frame;
  }
  const Approach last = approach_of(lane_of(probe, trajectory, trajectory.frames() - 1, lane));
  const bool together = std::abs(last.gap_m) < kTogetherRadii * kRadius_m;
  if (arrest == 0 || !together || std::abs(last.opening_mps) > still_mps) return std::nullopt;
  if (probe.coefficient == Coefficient::restitution) return 0.0;
  return value_of(probe, lane_of(probe, trajectory, arrest, lane));
}

bool same_kind(const CoefficientProbe& probe, const CoefficientPanel& panel) {
  return probe.coefficient == panel.coefficient && probe.wall == panel.wall && probe.nominal == panel.nominal;
}

}  // namespace

std::vector<CoefficientProbe> coefficient_probes() {
  std::vector<CoefficientProbe> probes;
  const auto add = [&probes](Coefficient coefficient, double nominal, bool wall) {
    for (int k = kLowestPower * kPerPower; k <= kHighestPower * kPerPower; ++k) {
      const double speed_mps = std::pow(10.0, static_cast<double>(k) / kPerPower);
      probes.push_back(
          {coefficient, wall, nominal, speed_mps, scene_of(coefficient, wall, nominal, speed_mps)});
    }
  };
  for (const bool wall : {false, true}) {
    for (const double e : {1.0, 0.5}) add(Coefficient::restitution, e, wall);
  }
  for (const bool wall : {false, true}) add(Coefficient::friction, 0.3, wall);
  return probes;
}

std::optional<Delivered> delivered(const CoefficientProbe& probe, const Run& run) {
  if (run.status != RunStatus::ok) return std::nullopt;
  std::optional<Delivered> all;
  for (std::size_t lane = 0; lane < kGapSteps.size(); ++lane) {
    const std::optional<double> value = delivered_in(probe, run.trajectory, lane);
    if (!value) return std::nullopt;
    if (!all) all = Delivered{*value, *value, *value};
    all->lowest = std::min(all->lowest, *value);
    all->highest = std::max(all->highest, *value);
  }
  return all;
}

std::vector<CoefficientPanel> empty_panels(const std::vector<CoefficientProbe>& probes,
                                           const std::vector<std::string>& labels) {
  std::vector<CoefficientPanel> panels;
  for (const CoefficientProbe& probe : probes) {
    if (panels.empty() || !same_kind(probe, panels.back())) {
      panels.push_back({probe.coefficient, probe.wall, probe.nominal, {}, {}});
      for (const std::string& label : labels) panels.back().curves.push_back({label, {}});
    }
    panels.back().speeds_mps.push_back(probe.speed_mps);
  }
  return panels;
}

void add_delivered(const CoefficientProbe& probe, const std::vector<Run>& runs,
                   std::vector<CoefficientPanel>& panels) {
  const auto panel = std::find_if(panels.begin(), panels.end(),
                                  [&](const CoefficientPanel& each) { return same_kind(probe, each); });
  for (std::size_t i = 0; i < runs.size(); ++i) {
    panel->curves[i].values.push_back(delivered(probe, runs[i]));
  }
}

CurveFinding finding_of(const CoefficientPanel& panel, const CoefficientCurve& curve) {
  CurveFinding finding;
  finding.lowest = finding.highest = panel.nominal;
  bool lost_so_far = true;
  for (std::size_t i = 0; i < curve.values.size(); ++i) {
    const std::optional<Delivered>& got = curve.values[i];
    if (!got) continue;
    finding.arrived = true;
    lost_so_far = lost_so_far && got->value < 0.5 * panel.nominal;
    if (lost_so_far) {
      finding.lost_up_to_mps = panel.speeds_mps[i];
      continue;
    }
    finding.largest_error = std::max(finding.largest_error, std::abs(got->value - panel.nominal));
    finding.lowest = std::min(finding.lowest, got->lowest);
    finding.highest = std::max(finding.highest, got->highest);
  }
  return finding;
}

}  // namespace carom
