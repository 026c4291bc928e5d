#include "reference/exact/cluster.h"

#include <algorithm>
#include <optional>

#include "reference/exact/encounter.h"

namespace carom::exact {

namespace {

class Judge {
 public:
  Judge(const Setting& setting, const Scenario& scene, const Cluster& cluster, const Slack& slack)
      : setting_(setting), scene_(scene), cluster_(cluster), slack_(slack) {}

  using Bodies = std::map<std::uint32_t, Body>;

  bool approaches(const Touch& touch, Bodies& bodies) const {
    return encounter(touch, bodies).approach_mps() > slack_.speed_mps;
  }

  /// What comes out when `first` is first; nothing where a contact is hit that was not about to be, or twice.
  std::optional<Bodies> outcome(std::vector<Touch> due, const Touch& first, bool from_the_back) const {
    if (from_the_back) std::reverse(due.begin(), due.end());
    std::erase(due, first);
    Bodies bodies = cluster_.bodies;
    encounter(first, bodies).collide();
    while (true) {
      const auto next =
          std::find_if(due.begin(), due.end(), [&](const Touch& touch) { return approaches(touch, bodies); });
      if (next == due.end()) break;
      encounter(*next, bodies).collide();
      due.erase(next);
    }
    for (const Touch& touch : cluster_.touches) {
      if (approaches(touch, bodies)) return std::nullopt;
    }
    return bodies;
  }

 private:
  Encounter encounter(const Touch& touch, Bodies& bodies) const {
    Body& ball = bodies.at(touch.ball);
    return {setting_, scene_, touch, ball, touch.wall ? ball : bodies.at(touch.partner)};
  }

  const Setting& setting_;
  const Scenario& scene_;
  const Cluster& cluster_;
  const Slack& slack_;
};

bool same(const Setting& setting, const Judge::Bodies& one, const Judge::Bodies& other,
          const Real& tolerance_mps) {
  return std::all_of(one.begin(), one.end(), [&](const auto& entry) {
    const auto& [ball, body] = entry;
    const Body& twin = other.at(ball);
    const Real turns = length(body.spin_radps - twin.spin_radps) * setting.matter[ball].radius_m;
    return length(body.velocity_mps - twin.velocity_mps) <= tolerance_mps && turns <= tolerance_mps;
  });
}

}  // namespace

Order judge(const Setting& setting, const Scenario& scene, const Cluster& cluster, const Slack& slack,
            const Real& tolerance_mps) {
  const Judge judge(setting, scene, cluster, slack);
  Judge::Bodies bodies = cluster.bodies;
  std::vector<Touch> due = {cluster.touches.front()};
  for (std::size_t k = 1; k < cluster.touches.size(); ++k) {
    if (judge.approaches(cluster.touches[k], bodies)) due.push_back(cluster.touches[k]);
  }
  const std::optional<Judge::Bodies> expected = judge.outcome(due, due.front(), false);
  if (due.size() == 1) return expected ? Order::single : Order::passed_on;
  if (!expected) return Order::matters;
  for (const Touch& first : due) {
    for (const bool from_the_back : {false, true}) {
      const auto other = judge.outcome(due, first, from_the_back);
      if (!other || !same(setting, *expected, *other, tolerance_mps)) return Order::matters;
    }
  }
  return Order::irrelevant;
}

}  // namespace carom::exact
