#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "carom/broad_phase/broad_phase.h"

namespace carom {

/// The names of the broad phases that can be asked for in this dimension.
std::vector<std::string_view> broad_phase_names(int dimension);

/// The broad phase of that name, or, with an empty name, the one that suits the scene: its number of balls
/// and how far their sizes spread. @pre the name is one of broad_phase_names(Dim), or empty
template <int Dim>
std::unique_ptr<BroadPhase<Dim>> make_broad_phase(const Scenario& scene, std::string_view name);

}  // namespace carom
