#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "reference/exact/meeting.h"
#include "reference/exact/setting.h"

namespace carom::exact {

/// Balls that touch each other or walls at one moment, as far as the scene's numbers tell.
struct Cluster {
  std::vector<Touch> touches;  ///< the impact that is due is the first
  std::map<std::uint32_t, Body> bodies;
};

/// What an impact in a cluster leads to.
enum class Order {
  single,      ///< it is the only impact
  irrelevant,  ///< others come at the same moment, and whatever the order, the outcome is the same
  matters,     ///< others come at the same moment, and the outcome depends on which is first
  passed_on,   ///< it pushes a ball into another that it touches
};

/// Judges by carrying out the impacts in different orders: every approaching contact first, and then those
/// that approach, from the front of the list or from its back, until none does.
/// @param tolerance_mps  outcomes that differ by no more are the same
Order judge(const Setting& setting, const Scenario& scene, const Cluster& cluster, const Slack& slack,
            const Real& tolerance_mps);

}  // namespace carom::exact
