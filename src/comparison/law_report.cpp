#include "comparison/law_report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "carom/laws/law_formula.h"
#include "carom/laws/three_parameter.h"
#include "comparison/random_vector.h"

namespace carom {

namespace {

/// Roundings of ½ε that may add up in what is measured: a law's expression has some twenty operations, what
/// they give is carried through J/m and r J/I to velocities (at most five times the speeds: 2/κ for a solid
/// sphere), and squared for an energy.
constexpr double kRoundings = 256.0;
constexpr double kHalfEpsilon = 0.5 * std::numeric_limits<double>::epsilon();

/// A measure, and what rounding alone may make of it.
struct Measured {
  double value = 0.0;
  double allowance = kRoundings * kHalfEpsilon;
};

// --- pairs

PairBall random_ball(Random& random) {
  PairBall ball;
  ball.mass = std::pow(10.0, random.uniform(-2.0, 2.0));
  ball.radius = std::pow(10.0, random.uniform(-0.5, 0.5));
  ball.inertia = random.uniform(0.2, 0.7) * ball.mass * ball.radius * ball.radius;
  ball.velocity = random_vector(random);
  ball.spin = random_vector(random) / ball.radius;
  return ball;
}

double speeds_of(const PairMeeting& pair) {
  return pair.one.velocity.norm() + pair.two.velocity.norm() + pair.one.radius * pair.one.spin.norm() +
         pair.two.radius * pair.two.spin.norm();
}

double approach_of(const PairMeeting& pair) {
  return -pair.normal.dot(pair.two.velocity - pair.one.velocity);
}

PairMeeting random_pair(Random& random) {
  // Where they hardly approach, rounding of the other speeds would drown what is asked.
  constexpr double kAtLeast = 0.05;
  while (true) {
    PairMeeting pair{random_ball(random), random_ball(random), random_vector(random).normalized(), {}};
    pair.surface = {random.uniform(), random.uniform(), random.uniform(-1.0, 1.0)};
    if (approach_of(pair) < 0.0) pair.normal = -pair.normal;
    if (approach_of(pair) > kAtLeast * speeds_of(pair)) return pair;
  }
}

// --- what is conserved

Vec3 momentum(const PairMeeting& pair) {
  return pair.one.mass * pair.one.velocity + pair.two.mass * pair.two.velocity;
}

double momentum_scale(const PairMeeting& pair) {
  return pair.one.mass * pair.one.velocity.norm() + pair.two.mass * pair.two.velocity.norm();
}

double energy(const PairMeeting& pair) {
  const auto of = [](const PairBall& ball) {
    return 0.5 * ball.mass * ball.velocity.squaredNorm() + 0.5 * ball.inertia * ball.spin.squaredNorm();
  };
  return of(pair.one) + of(pair.two);
}

/// About a point that lies one metre along each axis from where they touch.
Vec3 angular_momentum(const PairMeeting& pair) {
  const Vec3 contact = Vec3::Ones();
  return (contact - pair.one.radius * pair.normal).cross(pair.one.mass * pair.one.velocity) +
         (contact + pair.two.radius * pair.normal).cross(pair.two.mass * pair.two.velocity) +
         pair.one.inertia * pair.one.spin + pair.two.inertia * pair.two.spin;
}

double angular_momentum_scale(const PairMeeting& pair) {
  const auto of = [](const PairBall& ball) {
    return (Vec3::Ones().norm() + ball.radius) * ball.mass * ball.velocity.norm() +
           ball.inertia * ball.spin.norm();
  };
  return of(pair.one) + of(pair.two);
}

// --- twins

/// How far the balls of two outcomes are apart in velocity, surface speed included, m/s.
double apart(const PairMeeting& a, const PairMeeting& b) {
  const auto of = [](const PairBall& p, const PairBall& q) {
    return std::max((p.velocity - q.velocity).norm(), p.radius * (p.spin - q.spin).norm());
  };
  return std::max(of(a.one, b.one), of(a.two, b.two));
}

PairMeeting exchanged(PairMeeting pair) {
  std::swap(pair.one, pair.two);
  pair.normal = -pair.normal;
  return pair;
}

PairMeeting boosted(PairMeeting pair, const Vec3& by) {
  pair.one.velocity += by;
  pair.two.velocity += by;
  return pair;
}

/// In a mirror with this unit normal. A spin is turned round where a velocity is not.
PairMeeting mirrored(PairMeeting pair, const Vec3& mirror) {
  const auto turn = [&](Vec3& v) { v -= 2.0 * mirror.dot(v) * mirror; };
  turn(pair.normal);
  for (PairBall* ball : {&pair.one, &pair.two}) {
    turn(ball->velocity);
    turn(ball->spin);
    ball->spin = -ball->spin;
  }
  return pair;
}

/// In units in which a kilogram, a metre and a second are these numbers. Powers of 2, so that nothing is
/// rounded.
PairMeeting rescaled(PairMeeting pair, double kg, double m, double s) {
  for (PairBall* ball : {&pair.one, &pair.two}) {
    ball->mass *= kg;
    ball->radius *= m;
    ball->inertia *= kg * m * m;
    ball->velocity *= m / s;
    ball->spin /= s;
  }
  return pair;
}

// --- the rules

/// One pair, and what the law makes of it.
class PairTrial {
 public:
  PairTrial(const PairMeeting& pair, const PairLaw& law)
      : pair_(pair), law_(law), impulses_(law(pair)), after_(carom::after(pair, impulses_)) {}

  bool is_finite() const { return impulses_.on_one.allFinite() && impulses_.on_two.allFinite(); }

  Measured measure(LawRule rule) const {
    switch (rule) {
      case LawRule::momentum:
        return change(momentum(after_), momentum(pair_), momentum_scale(after_), momentum_scale(pair_));
      case LawRule::energy_elastic:
        return energy_elastic();
      case LawRule::energy_never_won:
        return {std::max(energy(after_) / energy(pair_) - 1.0, 0.0)};
      case LawRule::rebound:
        return per_approach(std::abs(approach_of(after_) + pair_.surface.restitution * approach_of(pair_)));
      case LawRule::parting:
        return per_approach(std::max(approach_of(after_), 0.0));
      case LawRule::pushing:
        return pushing();
      case LawRule::angular_momentum:
        return change(angular_momentum(after_), angular_momentum(pair_), angular_momentum_scale(after_),
                      angular_momentum_scale(pair_));
      case LawRule::exchange:
        return twin(exchanged(outcome(exchanged(pair_))), speeds_of(pair_));
      case LawRule::boost:
        return boost();
      case LawRule::mirror:
        return mirror();
      case LawRule::units:
        return twin(rescaled(outcome(rescaled(pair_, 4.0, 2.0, 8.0)), 0.25, 0.5, 0.125), speeds_of(pair_));
    }
    return {};
  }

 private:
  PairMeeting outcome(const PairMeeting& pair) const { return carom::after(pair, law_(pair)); }

  /// In units of the speed of approach, against which all speeds are rounded.
  Measured per_approach(double speed) const {
    const double approach = approach_of(pair_);
    return {speed / approach, kRoundings * kHalfEpsilon * speeds_of(pair_) / approach};
  }

  /// What speeds are rounded by is a share of the approach; and a law whose impulse goes with that carries it
  /// into the speeds after, which may be far higher than those before.
  Measured twin(const PairMeeting& other, double speeds) const {
    const double steepness = 1.0 + speeds_of(after_) / approach_of(pair_);
    return {apart(after_, other) / speeds_of(pair_),
            kRoundings * kHalfEpsilon * speeds / speeds_of(pair_) * steepness};
  }

  /// The change of what is conserved, by its scale before, against which and the one after it is rounded.
  Measured change(const Vec3& after, const Vec3& before, double scale_after, double scale_before) const {
    return {(after - before).norm() / scale_before,
            kRoundings * kHalfEpsilon * std::max(1.0, scale_after / scale_before)};
  }

  Measured energy_elastic() const {
    PairMeeting elastic = pair_;
    elastic.surface = {1.0, 0.0, 0.0};
    return {std::abs(energy(outcome(elastic)) / energy(elastic) - 1.0)};
  }

  /// What pulls, in units of the impulse that just stops the approach.
  Measured pushing() const {
    const double stop_Ns = approach_of(pair_) / (1.0 / pair_.one.mass + 1.0 / pair_.two.mass);
    const double pull_Ns = std::max(pair_.normal.dot(impulses_.on_one), -pair_.normal.dot(impulses_.on_two));
    return per_approach(std::max(pull_Ns / stop_Ns, 0.0) * approach_of(pair_));
  }

  /// The train is three times as fast as the balls, along the diagonal.
  Measured boost() const {
    const Vec3 train = 3.0 * speeds_of(pair_) * Vec3::Ones().normalized();
    return twin(boosted(outcome(boosted(pair_, train)), -train), speeds_of(pair_) + 2.0 * train.norm());
  }

  Measured mirror() const {
    const Vec3 plane = Vec3(1.0, 2.0, 3.0).normalized();
    return twin(mirrored(outcome(mirrored(pair_, plane)), plane), speeds_of(pair_));
  }

  const PairMeeting& pair_;
  const PairLaw& law_;
  PairImpulses impulses_;
  PairMeeting after_;
};

/// The measures of one rule over all pairs.
struct Tallied {
  std::vector<double> values;
  std::int64_t broken = 0;
  double worst = -1.0;
  PairMeeting worst_pair;

  void add(const Measured& measured, const PairMeeting& pair) {
    // What is no number keeps no rule.
    const double value =
        std::isnan(measured.value) ? std::numeric_limits<double>::infinity() : measured.value;
    values.push_back(value);
    if (!(value <= measured.allowance)) ++broken;
    if (value > worst) {
      worst = value;
      worst_pair = pair;
    }
  }

  RuleResult result(LawRule rule) {
    if (values.empty()) return {rule, 0.0, 0.0, 0.0, {}};
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return {rule, worst, *middle, static_cast<double>(broken) / static_cast<double>(values.size()),
            worst_pair};
  }
};

/// The compiled law on a world of two balls.
PairImpulses right_impulses(const PairMeeting& pair) {
  std::vector<Ball> balls(2);
  const std::array<const PairBall*, 2> of = {&pair.one, &pair.two};
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls[i].mass = of[i]->mass;
    balls[i].radius = of[i]->radius;
    balls[i].inertia = of[i]->inertia / (of[i]->mass * of[i]->radius * of[i]->radius);
    balls[i].velocity = of[i]->velocity;
    balls[i].spin = of[i]->spin;
  }
  World<3> world(balls, true);
  const Vec3 impulse_Ns = ThreeParameter::between<3>(world, 0, 1, pair.normal, pair.surface);
  return {-impulse_Ns, impulse_Ns};
}

}  // namespace

const std::vector<LawRuleName>& law_rules() {
  static const std::vector<LawRuleName> rules = {
      {LawRule::momentum, "momentum", "momentum is kept", "change of Σ m v, of Σ m |v|"},
      {LawRule::energy_elastic, "energy_elastic", "energy is kept where e = 1, μ = 0",
       "change of the energy, of itself"},
      {LawRule::energy_never_won, "energy_never_won", "energy is never won", "gain of energy, of itself"},
      {LawRule::rebound, "rebound", "balls part with e times the approach", "error of e"},
      {LawRule::parting, "parting", "balls part after the impact", "approach that is left, of what it was"},
      {LawRule::pushing, "pushing", "balls push, and do not pull",
       "pull, in impulses that just stop the approach"},
      {LawRule::angular_momentum, "angular_momentum", "angular momentum is kept",
       "change of Σ x × m v + I ω, of Σ |x| m |v| + I |ω|"},
      {LawRule::exchange, "exchange", "which is ball 1 does not matter",
       "difference of velocities, of the speeds"},
      {LawRule::boost, "boost", "it is the same from a moving train",
       "difference of velocities, of the speeds"},
      {LawRule::mirror, "mirror", "it is the same in a mirror", "difference of velocities, of the speeds"},
      {LawRule::units, "units", "it is the same in other units", "difference of velocities, of the speeds"},
  };
  return rules;
}

LawReport examine_law(const LawFile& about, const PairLaw& law, std::int64_t pairs, std::uint64_t seed) {
  LawReport report;
  report.law = about;
  report.pairs = pairs;
  report.seed = seed;
  std::vector<Tallied> tallied(law_rules().size());
  Random random(seed);
  for (std::int64_t k = 0; k < pairs; ++k) {
    const PairMeeting pair = random_pair(random);
    const PairTrial trial(pair, law);
    if (!trial.is_finite()) {
      ++report.not_finite;
      continue;
    }
    for (std::size_t i = 0; i < tallied.size(); ++i) tallied[i].add(trial.measure(law_rules()[i].rule), pair);
  }
  for (std::size_t i = 0; i < tallied.size(); ++i)
    report.results.push_back(tallied[i].result(law_rules()[i].rule));
  return report;
}

LawReport examine_law(const LawFile& law, std::int64_t pairs, std::uint64_t seed) {
  LawFormula formula(law);
  return examine_law(
      law, [&formula](const PairMeeting& pair) { return formula.impulses(pair); }, pairs, seed);
}

LawReport examine_right_law(bool friction, std::int64_t pairs, std::uint64_t seed) {
  LawFile about;
  about.name = "the right law";
  const auto law = [friction](PairMeeting pair) {
    if (!friction) pair.surface.friction = 0.0;
    return right_impulses(pair);
  };
  return examine_law(about, law, pairs, seed);
}

}  // namespace carom
