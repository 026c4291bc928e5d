#pragma once

#include <span>
#include <string_view>

#include "carom/broad_phase/reach.h"

namespace carom {

/// The broad phase of scenes without collisions between balls: no pair, no cost.
template <int Dim>
class NobodyMeets {
 public:
  static constexpr std::string_view kName = "none";

  void build(const VectorColumn<Dim>& /*position*/, Bounds /*bound*/) {}
  template <class Visit>
  void for_each_pair(Visit&& /*visit*/) const {}
  void bound_grew(std::size_t /*ball*/) {}
  template <class Visit>
  void for_each_near(const Reach<Dim>& /*reach*/, Visit&& /*visit*/) const {}
};

}  // namespace carom
