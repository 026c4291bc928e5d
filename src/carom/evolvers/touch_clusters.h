#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "carom/evolvers/touch.h"
#include "carom/world.h"

namespace carom {

/// Contacts that hang together: whose balls touch others that touch others, and so on.
template <int Dim>
class TouchClusters {
 public:
  /// Calls visit(contacts) for the contacts of each cluster, which it puts side by side, in the order of what
  /// contacts rank. The clusters come by the first numbers of their balls.
  template <class Visit>
  void for_each(const World<Dim>& world, std::vector<Touch>& touches, const Visit& visit) {
    join(world, touches);
    const auto cluster_of = [&](const Touch& touch) {
      const bool by_first = touch.plane() || world.inverse_mass[touch.a] > 0.0;
      return world.number_of(root_of(by_first ? touch.a : touch.b));
    };
    std::stable_sort(touches.begin(), touches.end(),
                     [&](const Touch& x, const Touch& y) { return cluster_of(x) < cluster_of(y); });
    for (auto begin = touches.begin(); begin != touches.end();) {
      const auto end = std::find_if(
          begin, touches.end(), [&](const Touch& touch) { return cluster_of(touch) != cluster_of(*begin); });
      visit(std::span<const Touch>(begin, end));
      begin = end;
    }
  }

 private:
  /// Immovable balls and planes pass nothing on.
  void join(const World<Dim>& world, std::span<const Touch> touches) {
    root_.resize(world.size());
    std::iota(root_.begin(), root_.end(), 0U);
    for (const Touch& touch : touches) {
      if (touch.plane() || world.inverse_mass[touch.a] * world.inverse_mass[touch.b] == 0.0) continue;
      const std::uint32_t one = root_of(touch.a);
      const std::uint32_t other = root_of(touch.b);
      world.before(one, other) ? root_[other] = one : root_[one] = other;
    }
  }

  std::uint32_t root_of(std::uint32_t ball) const {
    while (root_[ball] != ball) ball = root_[ball];
    return ball;
  }

  std::vector<std::uint32_t> root_;  ///< of each ball one that it hangs together with; itself, of one
};

}  // namespace carom
