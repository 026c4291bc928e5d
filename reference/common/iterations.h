#pragma once

#include <array>
#include <variant>
#include <vector>

#include "engine/tuning.h"

namespace carom::reference {

/// The rounds of a sequential solver over all contacts, as something to tune: a single round, which is all
/// that contacts need that share no ball; few, as engines come; and many.
/// @param name  as in Simulation::settings()
/// @param own   those of the profile
inline std::vector<Tuning> iteration_tunings(const char* name, int own) {
  constexpr std::array kRounds = {1, 8, 50};
  Tuning tuning{name, "rounds over all contacts until their impulses agree", {}, true};
  for (const int rounds : kRounds) {
    const bool many_already = rounds == kRounds.back() && own > rounds;
    if (rounds != own && !many_already) tuning.values.emplace_back(static_cast<double>(rounds));
  }
  return {tuning};
}

/// @pre the setting is one of iteration_tunings()
inline int iterations_of(const Tuned& tuned) {
  return static_cast<int>(std::get<double>(tuned.value));
}

}  // namespace carom::reference
