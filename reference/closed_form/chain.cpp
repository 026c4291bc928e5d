#include "reference/closed_form/chain.h"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "reference/closed_form/scene_facts.h"

namespace carom::closed_form {

namespace {

/// Longer sequences are refused: at 128 bytes an impact (two legs and its record) the lists then take 128 MB.
constexpr std::size_t kMostImpacts = 1'000'000;

}  // namespace

Chain::Chain(const Scenario& scenario, std::vector<Body> bodies)
    : scenario_(scenario), touch_m_(touch_m(scenario)), bodies_(std::move(bodies)), due_s_(bodies_.size()) {}

Twofold Chain::gap_m(std::size_t pair, const Twofold& time_s) const {
  const Body& a = bodies_[pair];
  const Body& b = bodies_[pair + 1];
  return b.legs.back().position_at(time_s) - a.legs.back().position_at(time_s) -
         exact_sum(a.radius_m, b.radius_m);
}

Twofold Chain::approach_mps(std::size_t pair) const {
  return bodies_[pair].legs.back().velocity_mps - bodies_[pair + 1].legs.back().velocity_mps;
}

/// An overlap by rounding that still closes is an impact now; one that opens is none.
void Chain::predict(std::size_t pair, const Twofold& now_s) {
  const Twofold speed = approach_mps(pair);
  due_s_[pair].reset();
  if (speed > 0.0) due_s_[pair] = now_s + std::max(Twofold(0.0), gap_m(pair, now_s)) / speed;
}

/// Newton's law on a line, with w the speed of approach:
///
///   v_a' = v_a - (1 + e) w m_b / (m_a + m_b),    v_b' = v_a' + e w
///
/// and likewise from b where that is the heavier one. The heavier is the one whose velocity changes less, and
/// an immovable one keeps its own to the bit; two with e = 0 go on at the same velocity to the bit.
std::string Chain::collide(std::size_t pair, const Twofold& now_s) {
  Body& a = bodies_[pair];
  Body& b = bodies_[pair + 1];
  if (a.immovable() && b.immovable()) return "an immovable ball meets another, or a wall";
  const Contact& contact = a.ball && b.ball ? scenario_.ball_contact : scenario_.wall_contact;
  if (contact.friction > 0.0) return "an impact on a rough surface";
  const double e = contact.restitution;
  const Twofold w = approach_mps(pair);
  const Twofold change = w * (Twofold(1.0) + e);
  const auto share = [](const Body& own, const Body& other) {
    return own.immovable() ? Twofold(0.0) : Twofold(other.mass_kg) / exact_sum(own.mass_kg, other.mass_kg);
  };
  Leg leg_a{now_s, a.legs.back().position_at(now_s), a.legs.back().velocity_mps};
  Leg leg_b{now_s, b.legs.back().position_at(now_s), b.legs.back().velocity_mps};
  Twofold external = impacts_.empty() ? Twofold(0.0) : impacts_.back().external_Ns;
  if (a.mass_kg >= b.mass_kg) {
    leg_a.velocity_mps -= change * share(a, b);
    leg_b.velocity_mps = leg_a.velocity_mps + w * e;
    if (a.immovable()) external += (leg_b.velocity_mps - b.legs.back().velocity_mps) * b.mass_kg;
  } else {
    leg_b.velocity_mps += change * share(b, a);
    leg_a.velocity_mps = leg_b.velocity_mps - w * e;
    if (b.immovable()) external += (leg_a.velocity_mps - a.legs.back().velocity_mps) * a.mass_kg;
  }
  a.legs.push_back(leg_a);
  b.legs.push_back(leg_b);
  impacts_.push_back({now_s, external});
  return {};
}

/// Whether a pair meets within rounding of now. What the scene's numbers leave open by then is the start's
/// touching gap, and two roundings of velocities over the time since.
bool Chain::is_due_too(std::size_t pair, const Twofold& now_s) const {
  const Twofold speed = approach_mps(pair);
  const double open_m = touch_m_ + 2.0 * kEpsilon * (speed * now_s).hi;
  return speed > 0.0 && gap_m(pair, now_s) <= open_m;
}

std::string Chain::follow() {
  const Twofold horizon = horizon_s(scenario_);
  for (std::size_t pair = 0; pair < pairs(); ++pair) {
    if (gap_m(pair, 0.0) < -touch_m_) return "balls start overlapping";
    predict(pair, 0.0);
  }
  while (true) {
    std::optional<std::size_t> next;
    for (std::size_t pair = 0; pair < pairs(); ++pair) {
      if (due_s_[pair] && (!next || *due_s_[pair] < *due_s_[*next])) next = pair;
    }
    if (!next || *due_s_[*next] > horizon) return {};
    if (impacts_.size() == kMostImpacts) return fmt::format("more than {} impacts on a line", kMostImpacts);
    const Twofold now_s = *due_s_[*next];
    std::string reason = collide(*next, now_s);
    if (!reason.empty()) return reason;
    const std::size_t first = *next == 0 ? 0 : *next - 1;
    const std::size_t last = std::min(*next + 1, pairs() - 1);
    for (std::size_t pair = first; pair <= last; ++pair) {
      predict(pair, now_s);
      if (pair != *next && is_due_too(pair, now_s)) return "simultaneous impacts have no unique outcome";
    }
  }
}

}  // namespace carom::closed_form
