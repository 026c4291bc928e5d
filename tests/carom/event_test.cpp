#include "carom/evolvers/event.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <set>
#include <stdexcept>

#include "carom/compose.h"
#include "carom/evolvers/event_queue.h"
#include "carom/world.h"
#include "tests/support/scenes.h"

namespace carom::test {
namespace {

Ball ball(double mass, double radius, const Vec3& position, const Vec3& velocity = Vec3::Zero()) {
  Ball made;
  made.mass = mass;
  made.radius = radius;
  made.position = position;
  made.velocity = velocity;
  return made;
}

std::unique_ptr<Simulation> event_driven(const Scenario& scene) {
  EXPECT_EQ(event_refusal(scene), "");
  return scene.dimension == 2 ? make_event<2>(scene) : make_event<3>(scene);
}

/// The largest difference of any two positions, m, and velocities, m/s.
double difference(const std::vector<BallState>& a, const std::vector<BallState>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i].position - b[i].position).norm());
    largest = std::max(largest, (a[i].velocity - b[i].velocity).norm());
  }
  return largest;
}

/// By how much the scene multiplies a small disturbance of its positions until the end, at least 1.
double growth(const Scenario& scene) {
  constexpr double kDisturbance = 1e-9;
  Scenario disturbed = scene;
  Random random(99);
  for (Ball& ball : disturbed.balls) ball.position += random_vector(random, scene.dimension, kDisturbance);
  const auto a = run(*event_driven(scene), scene, 1);
  const auto b = run(*event_driven(disturbed), disturbed, 1);
  return std::max(1.0, difference(a, b) / kDisturbance);
}

/// Round-off of a run: an impact rounds the positions and velocities of two balls, a few times each, and the
/// scene makes grow what that leaves. Coordinates and speeds are at most 8 (m, m/s).
double tolerance_of(const Scenario& scene, std::int64_t impacts) {
  const double each = 2.0 * static_cast<double>(impacts) / static_cast<double>(scene.balls.size());
  return (1.0 + each) * 8.0 * 8.0 * kEpsilon * growth(scene);
}

// --- two balls, and few

using Wide = Eigen::Matrix<long double, 3, 1>;

/// What two balls come to, told from the formulas alone and in long double: touch at the first root of
/// |d + w t| = σ, then J = -(1+e) m (w·n) n.
std::vector<BallState> pair_outcome(const Ball& a, const Ball& b, double e, double duration_s) {
  const Wide d = (b.position - a.position).cast<long double>();
  const Wide w = (b.velocity - a.velocity).cast<long double>();
  const long double sigma = static_cast<long double>(a.radius) + b.radius;
  const long double half_b = d.dot(w);
  const long double disc = half_b * half_b - w.squaredNorm() * (d.squaredNorm() - sigma * sigma);
  const long double t = (-half_b - std::sqrt(disc)) / w.squaredNorm();
  const Wide n = (d + t * w).normalized();
  const long double reduced = 1.0L / (1.0L / a.mass + 1.0L / b.mass);
  const Wide impulse = -(1.0L + e) * reduced * w.dot(n) * n;
  const auto after = [&](const Ball& ball, const Wide& push) {
    const Wide before = ball.velocity.cast<long double>();
    const Wide velocity = before + push / ball.mass;
    const Wide place = ball.position.cast<long double>() + t * before + (duration_s - t) * velocity;
    return BallState{place.cast<double>(), velocity.cast<double>(), Vec3::Zero()};
  };
  return {after(a, -impulse), after(b, impulse)};
}

/// Random masses (10⁻⁶ to 10⁶), radii, e, and impact parameters up to 0.95 of the sum of the radii, in space.
TEST(EventEvolver, TwoBalls_AreRightTo1e12_AnyMassesAnyAngle) {
  Random random(42);
  for (int trial = 0; trial < 300; ++trial) {
    SCOPED_TRACE(testing::Message() << "seed 42, trial " << trial);
    const double sigma = random.uniform(0.1, 0.4);
    const double split = random.uniform(0.2, 0.8);
    const Vec3 along = Vec3(random.normal(), random.normal(), random.normal()).normalized();
    const double offset = trial % 3 == 0 ? 0.0 : random.uniform(0.0, 0.95) * sigma;
    const double speed = random.uniform(0.5, 2.0);
    const Ball a =
        ball(std::pow(10.0, random.uniform(-6.0, 6.0)), split * sigma, Vec3::Zero(), speed * along);
    const Ball b = ball(std::pow(10.0, random.uniform(-6.0, 6.0)), (1.0 - split) * sigma,
                        random.uniform(0.6, 1.0) * along + offset * along.unitOrthogonal());
    Scenario scene = free_scene(3, {a, b}, 2.5, 1.0);
    scene.ball_contact.restitution = trial % 2 == 0 ? 1.0 : random.uniform();
    const auto simulation = event_driven(scene);
    const auto states = run(*simulation, scene, 1 + trial % 7);
    const auto expected = pair_outcome(a, b, scene.ball_contact.restitution, scene.duration_s);
    ASSERT_EQ(simulation->tally().impacts, 1);
    // Relative to the speed that came in and to the way that it covers.
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_LE((states[i].velocity - expected[i].velocity).norm(), 1e-12 * speed);
      EXPECT_LE((states[i].position - expected[i].position).norm(), 1e-12 * speed * scene.duration_s);
    }
  }
}

TEST(EventEvolver, GalperinsBalls_CountTheDigitsOfPi) {
  // ⌈π/θ⌉ - 1 impacts, θ = arctan √(m/M). G. Galperin, Regul. Chaotic Dyn. 8, 375 (2003).
  const std::vector<std::pair<double, std::int64_t>> counts = {
      {1e0, 3}, {1e2, 31}, {1e4, 314}, {1e6, 3141}, {1e8, 31415}};
  for (const auto& [ratio, impacts] : counts) {
    Scenario scene =
        free_scene(2, {ball(1, 0.1, Vec3(1, 0, 0)), ball(ratio, 0.1, Vec3(2, 0, 0), Vec3(-1, 0, 0))}, 20, 1);
    scene.walls.push_back({Vec3::UnitX(), 0.0});
    const auto simulation = event_driven(scene);
    run(*simulation, scene, 1);
    EXPECT_EQ(simulation->tally().impacts, impacts) << "M/m = " << ratio;
  }
}

TEST(EventEvolver, ImmovableBalls_StayAndPushBack_AndIgnoreEachOther) {
  const double inf = std::numeric_limits<double>::infinity();
  const Scenario scene = free_scene(2,
                                    {ball(inf, 0.5, Vec3(2, 0, 0)), ball(inf, 0.5, Vec3(2.5, 0, 0)),
                                     ball(2, 0.1, Vec3(0, 0.5, 0), Vec3(1, 0, 0))},
                                    3.0, 0.1);
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 3);
  EXPECT_EQ(states[0].position, Vec3(2, 0, 0));
  EXPECT_EQ(states[1].position, Vec3(2.5, 0, 0));
  const Vec3 impulse = 2.0 * (states[2].velocity - Vec3::UnitX());
  EXPECT_LE((simulation->tally().external_impulse - impulse).norm(), 8.0 * kEpsilon * 4.0);
  // The moment of the impulse is what changes that of the ball about the origin.
  const Vec3 change =
      2.0 * (states[2].position.cross(states[2].velocity) - Vec3(0, 0.5, 0).cross(Vec3::UnitX()));
  EXPECT_LE((simulation->tally().external_angular_impulse - change).norm(), 32.0 * kEpsilon * 4.0);
}

TEST(EventEvolver, MovingImmovableBall_PushesWhatIsInItsWay) {
  const double inf = std::numeric_limits<double>::infinity();
  const Scenario scene =
      free_scene(2, {ball(inf, 0.5, Vec3(0, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3(1.6, 0, 0))}, 3.0, 0.1);
  const auto states = run(*event_driven(scene), scene, 3);
  EXPECT_EQ(states[0].velocity, Vec3(1, 0, 0));
  EXPECT_NEAR(states[1].velocity.x(), 2.0, 4.0 * kEpsilon);
  EXPECT_NEAR(states[1].position.x(), 1.6 + 2.0 * 2.0, 32.0 * kEpsilon);
}

TEST(EventEvolver, WithoutCollisions_OnlyWallsAct) {
  Scenario scene =
      free_scene(2, {ball(1, 0.1, Vec3(-1, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3::Zero())}, 2.5, 0.1);
  scene.effects.collisions = false;
  scene.walls.push_back({-Vec3::UnitX(), -1.1});
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 20);
  EXPECT_NEAR(states[0].position.x(), 0.5, 32.0 * kEpsilon);
  EXPECT_EQ(states[1].position.x(), 0.0);
  EXPECT_EQ(simulation->tally().impacts, 1);
}

// --- gases

TEST(EventEvolver, Gas_ConservesEnergyAndAccountsForTheWalls_OverThousandsOfImpacts) {
  for (const int dimension : {2, 3}) {
    for (std::uint64_t seed = 1; seed <= 3; ++seed) {
      SCOPED_TRACE(testing::Message() << dimension << "D, seed " << seed);
      const ScenarioPtr gas_scene = gas(dimension, 100, 0.3, 4.0, seed);
      const auto simulation = event_driven(*gas_scene);
      simulation->advance(10.0, 1);
      const auto states = states_of(*simulation, gas_scene->balls.size());
      const auto impacts = static_cast<double>(simulation->tally().impacts);
      EXPECT_GT(impacts, 2000.0);
      const double before = kinetic_energy_of(*gas_scene, states_of(*gas_scene));
      // An impact changes two velocities and rounds each once: 4 ε of the energy of two balls of a hundred.
      EXPECT_NEAR(kinetic_energy_of(*gas_scene, states), before,
                  4.0 * kEpsilon * before * (1.0 + impacts / 50.0));
      const Tally tally = simulation->tally();
      const Vec3 momentum = momentum_of(*gas_scene, states_of(*gas_scene)) + tally.external_impulse;
      EXPECT_LE((momentum_of(*gas_scene, states) - momentum).norm(),
                4.0 * kEpsilon * 100.0 * (1.0 + impacts / 100.0));
      const Vec3 moment =
          angular_momentum_of(*gas_scene, states_of(*gas_scene)) + tally.external_angular_impulse;
      // Each impact, and the flight before it, rounds the moments of two balls a few times.
      EXPECT_LE((angular_momentum_of(*gas_scene, states) - moment).norm(),
                16.0 * kEpsilon * angular_momentum_scale(*gas_scene) * (1.0 + impacts / 100.0));
    }
  }
}

TEST(EventEvolver, RoughGas_KeepsAngularMomentumWithSpin_AndLosesEnergy) {
  for (const int dimension : {2, 3}) {
    SCOPED_TRACE(testing::Message() << dimension << "D, seed 4");
    const ScenarioPtr rough = gas(dimension, 60, 0.2, 4.0, 4,
                                  "[effects]\nspin = true\n[contact]\nrestitution = 0.9\nfriction = 0.3\n"
                                  "tangential_restitution = 0.4\n");
    const auto simulation = event_driven(*rough);
    simulation->advance(5.0, 1);
    const auto states = states_of(*simulation, rough->balls.size());
    const Tally tally = simulation->tally();
    const auto impacts = static_cast<double>(tally.impacts);
    EXPECT_GT(impacts, 200.0);
    const Vec3 moment = angular_momentum_of(*rough, states_of(*rough)) + tally.external_angular_impulse;
    EXPECT_LE((angular_momentum_of(*rough, states) - moment).norm(),
              16.0 * kEpsilon * angular_momentum_scale(*rough) * (1.0 + impacts / 60.0));
    EXPECT_GT(angular_momentum_of(*rough, states).norm(), 0.0);
    EXPECT_LT(kinetic_energy_of(*rough, states), kinetic_energy_of(*rough, states_of(*rough)));
  }
}

/// The obviously right twin: after every impact all balls are moved, and all pairs and walls looked at, in
/// long double.
class AllPairs {
 public:
  explicit AllPairs(const Scenario& scene) : scene_(scene) {
    for (const Ball& b : scene.balls) {
      x_.emplace_back(b.position.cast<long double>());
      v_.emplace_back(b.velocity.cast<long double>());
    }
  }

  void advance(long double duration_s) {
    while (const std::optional<Meeting> next = first_before(duration_s)) {
      move(next->wait);
      duration_s -= next->wait;
      ++impacts;
      next->wall ? bounce(next->a, scene_.walls[next->b]) : collide(next->a, next->b);
    }
    move(duration_s);
  }

  std::vector<BallState> states() const {
    std::vector<BallState> result;
    for (std::size_t i = 0; i < x_.size(); ++i) {
      result.push_back({x_[i].cast<double>(), v_[i].cast<double>(), Vec3::Zero()});
    }
    return result;
  }

  std::int64_t impacts = 0;

 private:
  struct Meeting {
    long double wait;
    std::size_t a;
    std::size_t b;
    bool wall;
  };

  std::optional<Meeting> first_before(long double limit) const {
    std::optional<Meeting> first;
    const auto offer = [&](long double wait, std::size_t a, std::size_t b, bool wall) {
      if (wait < (first ? first->wait : limit)) first = {wait, a, b, wall};
    };
    for (std::size_t a = 0; a < x_.size(); ++a) {
      for (std::size_t b = a + 1; b < x_.size(); ++b) {
        if (const auto wait = wait_for_pair(a, b)) offer(*wait, a, b, false);
      }
      for (std::size_t w = 0; w < scene_.walls.size(); ++w) {
        const Wide normal = scene_.walls[w].normal.cast<long double>();
        const long double gap = normal.dot(x_[a]) - scene_.walls[w].offset - scene_.balls[a].radius;
        const long double speed = normal.dot(v_[a]);
        if (speed < 0.0L) offer(std::max(0.0L, gap) / -speed, a, w, true);
      }
    }
    return first;
  }

  std::optional<long double> wait_for_pair(std::size_t a, std::size_t b) const {
    const Wide d = x_[b] - x_[a];
    const Wide w = v_[b] - v_[a];
    const long double half_b = d.dot(w);
    if (half_b >= 0.0L) return std::nullopt;
    const long double sigma = static_cast<long double>(scene_.balls[a].radius) + scene_.balls[b].radius;
    const long double c = d.squaredNorm() - sigma * sigma;
    const long double disc = half_b * half_b - w.squaredNorm() * c;
    if (disc < 0.0L) return std::nullopt;
    return std::max(0.0L, c) / (-half_b + std::sqrt(disc));
  }

  void collide(std::size_t a, std::size_t b) {
    const Wide n = (x_[b] - x_[a]).normalized();
    const long double reduced = 1.0L / (1.0L / scene_.balls[a].mass + 1.0L / scene_.balls[b].mass);
    const Wide impulse = -(1.0L + scene_.ball_contact.restitution) * reduced * n.dot(v_[b] - v_[a]) * n;
    v_[a] -= impulse / scene_.balls[a].mass;
    v_[b] += impulse / scene_.balls[b].mass;
  }

  void bounce(std::size_t ball, const Wall& wall) {
    const Wide n = wall.normal.cast<long double>();
    v_[ball] -= (1.0L + scene_.wall_contact.restitution) * n.dot(v_[ball]) * n;
  }

  void move(long double time_s) {
    for (std::size_t i = 0; i < x_.size(); ++i) x_[i] += time_s * v_[i];
  }

  const Scenario& scene_;
  std::vector<Wide> x_;
  std::vector<Wide> v_;
};

TEST(EventEvolver, Gas_MatchesAllPairsTwin_ForHundredsOfImpacts) {
  for (const int dimension : {2, 3}) {
    for (const double e : {1.0, 0.9}) {
      for (std::uint64_t seed = 1; seed <= 4; ++seed) {
        SCOPED_TRACE(testing::Message() << dimension << "D, e = " << e << ", seed " << seed);
        Scenario scene = *gas(dimension, 60, 0.1, 4.0, seed);
        scene.ball_contact.restitution = e;
        scene.wall_contact.restitution = e;
        scene.duration_s = 2.0;
        const auto simulation = event_driven(scene);
        const auto states = run(*simulation, scene, 1);
        AllPairs twin(scene);
        twin.advance(scene.duration_s);
        EXPECT_GT(twin.impacts, 60);
        EXPECT_EQ(simulation->tally().impacts, twin.impacts);
        EXPECT_LE(difference(states, twin.states()), tolerance_of(scene, twin.impacts));
      }
    }
  }
}

TEST(EventEvolver, ManySizes_MatchAllPairsTwin) {
  // Radii 1 : 100: among many small balls one large and one of middle size.
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    SCOPED_TRACE(testing::Message() << "seed " << seed);
    const ScenarioPtr small = gas(2, 300, 0.02, 4.0, seed);
    Scenario scene = *small;
    scene.balls = {ball(100, 1.0, Vec3(2, 2, 0), Vec3(0.1, 0.2, 0)),
                   ball(10, 0.1, Vec3(0.5, 0.5, 0), Vec3(-0.5, 0.3, 0))};
    for (Ball b : small->balls) {
      b.radius = 0.01;
      const bool free_of_large = (b.position - scene.balls[0].position).norm() > 1.01;
      const bool free_of_middle = (b.position - scene.balls[1].position).norm() > 0.11;
      if (free_of_large && free_of_middle) scene.balls.push_back(b);
    }
    const auto simulation = event_driven(scene);
    const double outside = std::get<double>(simulation->settings().at("balls_outside_cells"));
    EXPECT_TRUE(outside == 1.0 || outside == 2.0) << outside;
    const auto states = run(*simulation, scene, 1);
    AllPairs twin(scene);
    twin.advance(scene.duration_s);
    EXPECT_GT(twin.impacts, 60);
    EXPECT_EQ(simulation->tally().impacts, twin.impacts);
    EXPECT_LE(difference(states, twin.states()), tolerance_of(scene, twin.impacts));
  }
}

TEST(EventEvolver, BallsThatFlyApart_MatchAllPairsTwin_FarOutsideTheirFirstBox) {
  // Without walls: what leaves the cells' first box is found again through the table that wraps around.
  Scenario scene = *gas(3, 60, 0.2, 3.0, 8);
  scene.walls.clear();
  scene.duration_s = 50.0;
  for (Ball& b : scene.balls) b.velocity += Vec3(3.0, 0.0, 0.0);
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 1);
  AllPairs twin(scene);
  twin.advance(scene.duration_s);
  EXPECT_GT(twin.impacts, 20);
  EXPECT_EQ(simulation->tally().impacts, twin.impacts);
  // Coordinates reach 150 m and more.
  EXPECT_LE(difference(states, twin.states()), 25.0 * tolerance_of(scene, twin.impacts));
}

TEST(EventEvolver, Reversed_ReturnsToTheStart) {
  const ScenarioPtr forth = gas(3, 60, 0.1, 4.0, 6);
  const auto simulation = event_driven(*forth);
  Scenario back = *forth;
  const auto turned_back = run(*simulation, *forth, 1);
  for (std::size_t i = 0; i < turned_back.size(); ++i) {
    back.balls[i].position = turned_back[i].position;
    back.balls[i].velocity = -turned_back[i].velocity;
  }
  const auto states = run(*event_driven(back), back, 1);
  const std::int64_t impacts = simulation->tally().impacts;
  EXPECT_GT(impacts, 20);
  const double tolerance = tolerance_of(*forth, impacts) + tolerance_of(back, impacts);
  for (std::size_t i = 0; i < states.size(); ++i) {
    EXPECT_LE((states[i].position - forth->balls[i].position).norm(), tolerance) << "ball " << i;
    EXPECT_LE((states[i].velocity + forth->balls[i].velocity).norm(), tolerance) << "ball " << i;
  }
}

TEST(EventEvolver, CutsOfAdvance_ChangeNoBitOfTheTrajectory) {
  for (const int dimension : {2, 3}) {
    const ScenarioPtr scene = gas(dimension, 100, 0.3, 4.0, 5);
    const auto whole = event_driven(*scene);
    whole->advance(8.0, 1);
    const auto expected = states_of(*whole, scene->balls.size());
    for (const std::int64_t cuts : {1, 7, 64, 1000}) {
      const auto simulation = event_driven(*scene);
      for (std::int64_t k = 0; k < cuts; ++k) simulation->advance(8.0 / static_cast<double>(cuts), 1);
      EXPECT_EQ(simulation->tally().impacts, whole->tally().impacts) << cuts;
      const auto states = states_of(*simulation, scene->balls.size());
      for (std::size_t i = 0; i < states.size(); ++i) {
        EXPECT_EQ(states[i].velocity, expected[i].velocity) << cuts << " cuts, ball " << i;
        // The end is the sum of the cuts, each rounded once: half an ε of the window of 0.5 s. No speed is
        // above 8 m/s.
        EXPECT_LE((states[i].position - expected[i].position).norm(),
                  8.0 * 0.5 * kEpsilon * static_cast<double>(cuts) + 16.0 * kEpsilon);
      }
    }
  }
}

TEST(EventEvolver, Relabelled_BitForBit) {
  const ScenarioPtr scene = gas(3, 100, 0.2, 4.0, 11);
  Scenario relabelled = *scene;
  std::reverse(relabelled.balls.begin(), relabelled.balls.end());
  const auto a = run(*event_driven(*scene), *scene, 3);
  auto b = run(*event_driven(relabelled), relabelled, 3);
  std::reverse(b.begin(), b.end());
  EXPECT_EQ(difference(a, b), 0.0);
}

TEST(EventEvolver, FarFromTheOrigin_AccountsAndCountsAsNearby) {
  const ScenarioPtr near = gas(3, 60, 0.1, 4.0, 3);
  Scenario far = *near;
  const double distance = 0x1p20;
  const Vec3 shift = distance * Vec3(1, 1, 1);
  for (Ball& b : far.balls) b.position += shift;
  for (Wall& wall : far.walls) wall.offset += wall.normal.dot(shift);
  const auto a = event_driven(*near);
  const auto b = event_driven(far);
  const auto nearby = run(*a, *near, 2);
  auto faraway = run(*b, far, 2);
  EXPECT_EQ(a->tally().impacts, b->tally().impacts);
  for (BallState& state : faraway) state.position -= shift;
  // Positions are rounded to ε of the distance instead of 8 m.
  EXPECT_LE(difference(nearby, faraway), distance / 8.0 * tolerance_of(*near, a->tally().impacts));
}

// --- restitution below one

TEST(EventEvolver, InelasticGas_NeverGainsEnergy) {
  for (const double e : {0.0, 0.3, 0.9}) {
    const std::string contact = "[contact]\nrestitution = " + std::to_string(e);
    const ScenarioPtr scene = gas(2, 60, 0.3, 4.0, 9, contact);
    const auto simulation = event_driven(*scene);
    const Vec3 at_first = momentum_of(*scene, states_of(*scene));
    double last = kinetic_energy_of(*scene, states_of(*scene));
    for (int k = 0; k < 100; ++k) {
      simulation->advance(0.05, 1);
      const auto states = states_of(*simulation, scene->balls.size());
      const double now = kinetic_energy_of(*scene, states);
      EXPECT_LE(now, last * (1.0 + 64.0 * kEpsilon)) << "e = " << e << ", frame " << k;
      last = now;
      const auto impacts = static_cast<double>(simulation->tally().impacts);
      const Vec3 momentum = at_first + simulation->tally().external_impulse;
      EXPECT_LE((momentum_of(*scene, states) - momentum).norm(),
                4.0 * kEpsilon * 60.0 * (1.0 + impacts / 60.0));
    }
  }
}

double deepest_overlap(const Scenario& scene, const std::vector<BallState>& states) {
  double deepest = 0.0;
  for (std::size_t i = 0; i < states.size(); ++i) {
    for (std::size_t j = i + 1; j < states.size(); ++j) {
      const double distance = (states[j].position - states[i].position).norm();
      deepest = std::max(deepest, scene.balls[i].radius + scene.balls[j].radius - distance);
    }
  }
  return deepest;
}

TEST(EventEvolver, InelasticCollapse_Ends) {
  // Three balls with e < 7 - 4√3 collide infinitely often in finite time. S. McNamara, W. R. Young, Phys.
  // Fluids A 4, 496 (1992).
  Scenario scene = free_scene(2,
                              {ball(1, 0.1, Vec3(-1, 0, 0), Vec3(1, 0, 0)), ball(1, 0.1, Vec3(0.1, 0, 0)),
                               ball(1, 0.1, Vec3(1, 0, 0), Vec3(-1, 0, 0))},
                              3.0, 0.01);
  scene.ball_contact.restitution = 0.05;
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 1);
  EXPECT_NEAR(momentum_of(scene, states).x(), 0.0, 8.0 * kEpsilon);
  EXPECT_GT(simulation->tally().impacts, 5);
  EXPECT_LT(simulation->tally().impacts, 1000);
  // What is below the threshold of approach, 8 ε of the speeds, closes unseen for up to 3 s.
  EXPECT_LE(deepest_overlap(scene, states), 3.0 * 8.0 * kEpsilon * 2.0);
}

TEST(EventEvolver, TouchingRow_LosesAtEachImpactOnItsWay) {
  // Equal balls, hit at 1 m/s: the last leaves with ((1 + e)/2)^(N - 1), as if there were gaps.
  Scenario scene = free_scene(2, {ball(1, 0.25, Vec3(-1, 0, 0), Vec3(1, 0, 0))}, 2.0, 0.01);
  for (int i = 0; i < 4; ++i) scene.balls.push_back(ball(1, 0.25, Vec3(0.5 * i, 0, 0)));
  scene.ball_contact.restitution = 0.8;
  const auto states = run(*event_driven(scene), scene, 1);
  EXPECT_NEAR(states[4].velocity.x(), std::pow(0.9, 4.0), 16.0 * kEpsilon);
}

TEST(EventEvolver, CollapseOfManyInALine_Ends) {
  Scenario scene = free_scene(2, {}, 40.0, 0.01);
  for (int i = 0; i < 40; ++i) scene.balls.push_back(ball(1, 0.1, Vec3(0.3 * i, 0, 0), Vec3(-1, 0, 0)));
  scene.walls.push_back({Vec3::UnitX(), -0.2});
  scene.ball_contact.restitution = 0.8;
  scene.wall_contact.restitution = 0.8;
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 1);
  EXPECT_LT(simulation->tally().impacts, 1'000'000);
  EXPECT_LE(deepest_overlap(scene, states), 40.0 * 8.0 * kEpsilon * 2.0);
  EXPECT_LT(kinetic_energy_of(scene, states), 0.5 * 40.0);
}

// --- gravity

Scenario dropped(double height, double duration_s) {
  Scenario scene = free_scene(2, {ball(1, 0.1, Vec3(0, height + 0.1, 0))}, duration_s, 0.001);
  scene.effects.gravity = Vec3(0, -9.81, 0);
  scene.walls.push_back({Vec3::UnitY(), 0.0});
  return scene;
}

TEST(EventEvolver, DroppedBall_KeepsItsApex_Over100Bounces) {
  const double height = 10.0;
  const double fall = std::sqrt(2.0 * height / 9.81);
  const Scenario scene = dropped(height, 200.0 * fall);
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 1);
  EXPECT_EQ(simulation->tally().impacts, 100);
  const double energy = 0.5 * states[0].velocity.squaredNorm() + 9.81 * (states[0].position.y() - 0.1);
  // Each bounce rounds the speed, the height and the time a few times.
  EXPECT_NEAR(energy / (9.81 * height), 1.0, 100.0 * 8.0 * kEpsilon);
}

TEST(EventEvolver, FallingGas_KeepsItsEnergy) {
  for (const int dimension : {2, 3}) {
    const std::string g = dimension == 2 ? "[0, -1]" : "[0, -1, 0]";
    const ScenarioPtr scene = gas(dimension, 60, 0.2, 4.0, 12, "[effects]\ngravity = " + g + "\n");
    const auto simulation = event_driven(*scene);
    simulation->advance(5.0, 1);
    const auto states = states_of(*simulation, scene->balls.size());
    const auto energy = [&](const std::vector<BallState>& at) {
      double sum = kinetic_energy_of(*scene, at);
      for (const BallState& state : at) sum += state.position.y();
      return sum;
    };
    const double before = energy(states_of(*scene));
    const auto impacts = static_cast<double>(simulation->tally().impacts);
    EXPECT_GT(impacts, 200.0);
    // Each impact rounds the heights and the velocities of two of 60 balls, and the times of their flights.
    EXPECT_NEAR(energy(states), before, 8.0 * kEpsilon * before * (1.0 + impacts / 30.0));
    const Vec3 momentum = momentum_of(*scene, states_of(*scene)) + simulation->tally().external_impulse +
                          60.0 * 5.0 * Vec3(0, -1, 0);
    EXPECT_LE((momentum_of(*scene, states) - momentum).norm(),
              8.0 * kEpsilon * 300.0 * (1.0 + impacts / 60.0));
  }
}

TEST(EventEvolver, BallDroppedOnAnImmovableOne_BouncesUprightForEver) {
  // The ball meets the fixed one after √(2h/g) and again after every 2 √(2h/g).
  Scenario scene = free_scene(
      2, {ball(std::numeric_limits<double>::infinity(), 0.5, Vec3::Zero()), ball(1, 0.1, Vec3(0, 2.6, 0))}, 1,
      0.01);
  scene.effects.gravity = Vec3(0, -2, 0);
  const double fall = std::sqrt(2.0);
  scene.duration_s = 10.0 * fall;
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 3);
  EXPECT_EQ(simulation->tally().impacts, 5);
  EXPECT_EQ(states[0].position, Vec3(0, 0, 0));
  // At the apex, where a time error δ costs ½ g δ²; each bounce rounds heights of 2.6 m a few times.
  EXPECT_NEAR(states[1].position.y(), 2.6, 5.0 * 32.0 * kEpsilon * 2.6);
}

TEST(EventEvolver, ElasticBallAtRestOnTheFloor_SlidesUntilItIsHit) {
  Scenario scene = dropped(0.0, 2.0);
  scene.balls[0].velocity = Vec3(0.25, 0, 0);
  scene.balls.push_back(ball(1, 0.1, Vec3(1.2, 0.1, 0), Vec3(-0.25, 0, 0)));
  const auto simulation = event_driven(scene);
  simulation->advance(1.0, 1);
  // What the floor bears is in the account at any time.
  EXPECT_NEAR(simulation->tally().external_impulse.y(), 9.81 * 2.0, 16.0 * kEpsilon * 9.81 * 2.0);
  simulation->advance(2.0, 1);
  const auto states = states_of(*simulation, 2);
  EXPECT_EQ(simulation->tally().impacts, 1);
  // They meet after 2 s at x = 0.5 and 0.7, and exchange their velocities.
  EXPECT_NEAR(states[0].position.x(), 0.25, 16.0 * kEpsilon);
  EXPECT_NEAR(states[1].position.x(), 0.95, 16.0 * kEpsilon);
  EXPECT_EQ(states[0].position.y(), 0.1);
  EXPECT_NEAR(simulation->tally().external_impulse.y(), 9.81 * 2.0 * 3.0, 16.0 * kEpsilon * 9.81 * 6.0);
}

TEST(EventEvolver, TouchingBallsAtRest_StayAsTheyAre) {
  const Scenario scene = free_scene(
      2, {ball(1, 0.1, Vec3::Zero()), ball(1, 0.1, Vec3(0.2, 0, 0)), ball(1, 0.2, Vec3(0.1, 0.1, 0))}, 10.0,
      0.01);
  const auto simulation = event_driven(scene);
  const auto states = run(*simulation, scene, 1);
  EXPECT_EQ(simulation->tally().impacts, 0);
  EXPECT_EQ(difference(states, states_of(scene)), 0.0);
}

/// What event_refusal() does not see before the run, the run tells.
TEST(EventEvolver, BallThatComesToLieOnABall_EndsTheRunWithTheReason) {
  Scenario scene = dropped(0.0, 2.0);
  scene.balls.push_back(ball(1, 0.1, Vec3(0, 0.3, 0)));
  const auto simulation = make_event<2>(scene);  // although it lies there from the start
  EXPECT_THROW(simulation->advance(1.0, 1), std::runtime_error);
}

// --- what it does not take

TEST(EventEvolver, RefusesWhatLiesAtTheStart_OtherThanOnASmoothWall) {
  Scenario pile = dropped(0.0, 2.0);
  EXPECT_EQ(event_refusal(pile), "");
  pile.balls.push_back(ball(1, 0.1, Vec3(0, 0.3, 0)));
  EXPECT_THAT(event_refusal(pile), testing::HasSubstr("ball 1 lies on ball 0"));
  EXPECT_TRUE(refusal(pile, {"", ""}).empty());  // carom itself has chosen another evolver

  Scenario above = pile;
  above.balls[1].position.y() += 1e-9;  // not there yet
  EXPECT_EQ(event_refusal(above), "");
  Scenario beside = pile;
  beside.balls[1].position = Vec3(0.2, 0.1, 0);  // both on the floor, touching: nothing presses them together
  EXPECT_EQ(event_refusal(beside), "");
  Scenario thrown = pile;
  thrown.balls[1].velocity.y() = 1.0;
  EXPECT_EQ(event_refusal(thrown), "");
  Scenario apart = pile;
  apart.effects.collisions = false;
  EXPECT_EQ(event_refusal(apart), "");

  Scenario on_immovable = dropped(5.0, 2.0);
  on_immovable.balls.push_back(
      ball(std::numeric_limits<double>::infinity(), 0.1, on_immovable.balls[0].position - Vec3(0, 0.2, 0)));
  EXPECT_THAT(event_refusal(on_immovable), testing::HasSubstr("ball 0 lies on ball 1"));

  Scenario corner = dropped(0.0, 2.0);
  corner.walls = {{Vec3(0.6, 0.8, 0), -0.1}, {Vec3(-0.6, 0.8, 0), -0.1}};
  corner.balls[0].position = Vec3::Zero();
  EXPECT_THAT(event_refusal(corner), testing::HasSubstr("corner"));

  Scenario rough = dropped(0.0, 2.0);
  rough.effects.spin = true;
  rough.wall_contact.friction = 0.3;
  EXPECT_THAT(event_refusal(rough), testing::HasSubstr("friction"));
}

TEST(EventEvolver, Refuses_WithAReason) {
  const auto refuses = [](auto change) {
    Scenario scene = free_scene(2, {ball(1, 0.1, Vec3::Zero())}, 1.0, 0.1);
    scene.walls.push_back({Vec3::UnitY(), -1.0});
    change(scene);
    return !event_refusal(scene).empty();
  };
  EXPECT_FALSE(refuses([](Scenario&) {}));
  EXPECT_FALSE(refuses([](Scenario& s) { s.effects.gravity = Vec3(0, -9.81, 0); }));
  EXPECT_FALSE(refuses([](Scenario& s) { s.wall_contact.restitution = 0.5; }));
  EXPECT_TRUE(refuses([](Scenario& s) {
    s.effects.gravity = Vec3(0, -9.81, 0);
    s.wall_contact.restitution = 0.5;
  }));
  EXPECT_TRUE(refuses([](Scenario& s) {
    s.effects.gravity = Vec3(0, -9.81, 0);
    s.ball_contact.restitution = 0.5;
  }));
  EXPECT_TRUE(refuses([](Scenario& s) { s.effects.drag = Drag{}; }));
  EXPECT_TRUE(refuses([](Scenario& s) { s.effects.magnus = 0.1; }));
  EXPECT_TRUE(refuses([](Scenario& s) { s.slabs.emplace_back(); }));
  EXPECT_TRUE(refuses([](Scenario& s) { s.barriers.emplace_back(); }));
  EXPECT_TRUE(refuses([](Scenario& s) { s.multi_contact = MultiContact::simultaneous; }));
}

// --- the queue

TEST(EventQueue, FirstIsTheEarliest_AsInASet_WhateverTheTimes) {
  // Waits of one scale, of many scales, many equal ones and infinite ones.
  for (const int kind : {0, 1, 2, 3}) {
    SCOPED_TRACE(testing::Message() << "seed 1, kind " << kind);
    Random random(1);
    constexpr std::uint32_t kBalls = 300;
    EventQueue queue(kBalls, [](std::uint32_t ball) { return kBalls - ball; });
    std::set<std::tuple<double, std::uint64_t, std::uint32_t>> twin;
    std::vector<double> times(kBalls, std::numeric_limits<double>::infinity());
    for (std::uint32_t i = 0; i < kBalls; ++i) twin.emplace(times[i], kBalls - i, i);
    const auto put = [&](std::uint32_t i, double time) {
      twin.erase({times[i], kBalls - i, i});
      times[i] = time;
      queue.set(i, time);
      twin.emplace(time, kBalls - i, i);
    };
    const auto wait = [&] {
      if (kind == 1) return std::pow(10.0, random.uniform(-12.0, 3.0));
      if (kind == 2) return std::floor(random.uniform(0.0, 3.0));
      if (kind == 3 && random.uniform() < 0.3) return std::numeric_limits<double>::infinity();
      return random.uniform();
    };
    for (std::uint32_t i = 0; i < kBalls; ++i) put(i, wait());
    for (int k = 0; k < 20'000 && std::get<0>(*twin.begin()) < std::numeric_limits<double>::infinity(); ++k) {
      const std::uint32_t first = queue.first();
      ASSERT_EQ(first, std::get<2>(*twin.begin())) << "after " << k;
      const double now = times[first];
      put(static_cast<std::uint32_t>(random.uniform(0.0, kBalls)), now + wait());
      put(first, now + wait());
    }
  }
}

}  // namespace
}  // namespace carom::test
