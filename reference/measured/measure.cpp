#include "reference/measured/measure.h"

#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <tuple>
#include <vector>

#include "reference/measured/fluid.h"
#include "reference/measured/relaxation.h"

namespace carom::measured {

namespace {

/// Where the two touch, and how they move there: the normal is y, and the partner is below.
struct Touch {
  double normal_mps = 0.0;      ///< of the ball relative to its partner, positive apart
  double slip_mps = 0.0;        ///< g_t, of the ball's surface over the partner's, along x
  double tangential_mps = 0.0;  ///< of the ball's centre, along x
  double spin_radps = 0.0;
};

/// v + ω × a at the ball's lowest point, a = -r y, is v_x + ω r; at the partner's highest, v_x - ω R.
Touch touch_of(std::span<const BallState> states, const Scenario& scene) {
  const BallState& ball = states[0];
  Touch touch{ball.velocity.y(), ball.velocity.x() + ball.spin.z() * scene.balls[0].radius, ball.velocity.x(),
              ball.spin.z()};
  if (states.size() > 1) {
    touch.normal_mps -= states[1].velocity.y();
    touch.slip_mps -= states[1].velocity.x() - states[1].spin.z() * scene.balls[1].radius;
  }
  return touch;
}

double quantity_of(Quantity quantity, const Impact& impact, const Touch& before, const Touch& after) {
  // Of the slip an impulse J_t makes Δg_t = J_t (1/m)(1 + 1/κ), 7/2 J_t/m for solid spheres; Δv_n = J_n/m.
  constexpr double kTangential = 2.0 / 7.0;
  switch (quantity) {
    case Quantity::restitution:
      return -after.normal_mps / before.normal_mps;
    case Quantity::tangential_ratio:
      return after.tangential_mps / before.tangential_mps;
    case Quantity::tangential:
      return after.tangential_mps;
    case Quantity::spin:
      return after.spin_radps;
    case Quantity::beta:
      return -after.slip_mps / before.slip_mps;
    case Quantity::scaled_slip:
      return after.slip_mps / (impact.friction * after.normal_mps);
    case Quantity::scaled_spin:
      return impact.radius_m * after.spin_radps / (impact.friction * std::abs(before.normal_mps));
    case Quantity::friction:
      return kTangential * std::abs(after.slip_mps - before.slip_mps) /
             std::abs(after.normal_mps - before.normal_mps);
    case Quantity::compressibility:
    case Quantity::mean_free_time:
    case Quantity::fourth_cumulant:
      break;
  }
  throw std::logic_error("measured: a fluid's quantity of an impact");
}

Measurement measure_impact(Quantity quantity, const Impact& impact, const Runner& run) {
  const Scenario scene = impact_scene(impact);
  std::optional<Touch> before;
  Touch after;
  run(scene, [&](std::span<const BallState> states, const Tally&) {
    after = touch_of(states, scene);
    if (!before) before = after;
  });
  return {quantity_of(quantity, impact, before.value(), after), 0.0};
}

}  // namespace

Scenario impact_scene(const Impact& impact) {
  Scenario scene;
  scene.dimension = 2;
  scene.effects.spin = true;
  scene.ball_contact = {impact.restitution, impact.friction, impact.tangential_restitution};
  scene.wall_contact = scene.ball_contact;
  // It comes from two radii away, along its path.
  const double time_s = 2.0 * impact.radius_m / impact.normal_mps;
  scene.duration_s = 2.0 * time_s;
  scene.step_s = scene.duration_s / 100.0;
  Ball ball;
  ball.radius = impact.radius_m;
  ball.velocity = Vec3(impact.tangential_mps, -impact.normal_mps, 0.0);
  ball.position = Vec3(0.0, impact.radius_m, 0.0) - time_s * ball.velocity;
  ball.spin = Vec3(0.0, 0.0, impact.spin_radps);
  scene.balls = {ball};
  if (impact.partner == Partner::wall) {
    scene.walls = {{Vec3::UnitY(), 0.0}};
    return scene;
  }
  Ball partner = ball;
  partner.velocity = Vec3::Zero();
  partner.spin = Vec3::Zero();
  if (impact.partner == Partner::heavy) {
    partner.radius *= 5.0;
    partner.mass *= 1000.0 * 125.0;
  }
  partner.position = Vec3(0.0, -partner.radius, 0.0);
  if (impact.partner == Partner::mirrored) {
    partner.velocity = -ball.velocity;
    partner.spin = -ball.spin;
    partner.position -= time_s * partner.velocity;
  }
  scene.balls.push_back(partner);
  return scene;
}

struct Laboratory::Fluids {
  using Key = std::tuple<double, std::size_t, std::int64_t>;
  std::map<Key, Measurement> compressibilities;
  std::map<Key, std::vector<RelaxationPoint>> relaxations;
};

Laboratory::Laboratory(Runner run) : run_(std::move(run)), fluids_(std::make_unique<Fluids>()) {}

Laboratory::~Laboratory() = default;

Measurement Laboratory::measure(const Value& value) {
  if (const auto* impact = std::get_if<Impact>(&value.experiment)) {
    return measure_impact(value.quantity, *impact, run_);
  }
  const Fluid& fluid = std::get<Fluid>(value.experiment);
  const Fluids::Key key{fluid.density, fluid.count, fluid.blocks};
  if (value.quantity == Quantity::fourth_cumulant) {
    auto& points = fluids_->relaxations[key];
    if (points.empty()) points = relaxation(fluid, run_);
    return cumulant_after(points, fluid.collisions);
  }
  auto known = fluids_->compressibilities.find(key);
  if (known == fluids_->compressibilities.end()) {
    known = fluids_->compressibilities.emplace(key, measure_fluid(fluid, run_).compressibility).first;
  }
  return value.quantity == Quantity::compressibility ? known->second : mean_free_time(known->second);
}

Measurement measure(const Value& value, const Runner& run) {
  return Laboratory(run).measure(value);
}

bool meets(const Value& value, const Measurement& measurement) {
  return value.published &&
         std::abs(measurement.value - *value.published) <= value.uncertainty + measurement.uncertainty;
}

Runner runner_of(const Engine& engine, std::string profile) {
  return [&engine, profile = std::move(profile)](const Scenario& scene, const Watch& watch) {
    const std::string reason = unsupported_reason(engine, scene, profile);
    if (!reason.empty()) throw std::runtime_error(engine.info().name + ": " + reason);
    const auto simulation = engine.create(scene, profile);
    const double interval_s = scene.duration_s / static_cast<double>(scene.frames);
    const auto steps = static_cast<std::int64_t>(std::ceil(interval_s / scene.step_s * (1.0 - 1e-12)));
    std::vector<BallState> states(scene.balls.size());
    for (std::int64_t frame = 0; frame <= scene.frames; ++frame) {
      if (frame > 0) simulation->advance(interval_s / static_cast<double>(steps), steps);
      simulation->snapshot(states);
      watch(states, simulation->tally());
    }
  };
}

Runner runner_of(const TruthSource& source) {
  return [&source](const Scenario& scene, const Watch& watch) {
    const std::string reason = source.refuses(scene);
    if (!reason.empty()) throw std::runtime_error(std::string(source.kind()) + ": " + reason);
    std::vector<Moment> moments;
    for (std::int64_t frame = 0; frame <= scene.frames; ++frame) {
      moments.push_back({scene.duration_s / static_cast<double>(scene.frames), frame});
    }
    std::size_t seen = 0;
    const Solution solution =
        source.solve(scene, moments, [&](std::size_t, std::span<const BallState> states, const Tally& tally) {
          watch(states, tally);
          ++seen;
        });
    if (seen != moments.size()) {
      throw std::runtime_error(std::string(source.kind()) + ": not known to the end: " + solution.limit);
    }
  };
}

}  // namespace carom::measured
