#pragma once

#include <memory>
#include <string>
#include <vector>

#include "carom/evolvers/list.h"

namespace carom {

/// What a user may choose about the hand-written engine; what is empty is chosen for the scene.
struct Variant {
  std::string evolver;
  std::string broad_phase;
  /// Of the evolvers of fixed steps: with kAll they look at all pairs in every step. The result is the same.
  Listed listed = Listed::kNear;
  /// Of the same: threads that share the work. The result is the same.
  std::size_t threads = 1;
};

/// The parts that the scene calls for, with the variant's broad phase or the one that suits the scene.
template <int Dim>
Parts<Dim> make_parts(const Scenario& scene, const Variant& variant = {});

/// The evolver of that name; else the first that suits the scene, and has use for a broad phase that is
/// named.
const Evolver& choose_evolver(const Scenario& scene, const Variant& variant);

/// Why this variant does not take the scene; empty where it does.
std::string refusal(const Scenario& scene, const Variant& variant);

/// The simulation that contains exactly what the scene calls for. @pre refusal() is empty
std::unique_ptr<Simulation> compose(const Scenario& scene, const Variant& variant = {});

}  // namespace carom
