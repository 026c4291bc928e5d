#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/engine.h"

namespace carom {

/// The names under which the hand-written engine runs with its evolver or its broad phase, or both, chosen by
/// name and not for the scene: "carom:step", "carom:quadtree", "carom:toi:brute-force". And "carom:textbook",
/// the course program.
std::vector<std::string> carom_variant_names();

/// The hand-written engine.
/// @param name     "carom", or one of carom_variant_names()
/// @param threads  for scenes that are large enough for more than one; the results are the same
std::unique_ptr<Engine> make_carom_engine(const std::string& name = "carom", std::size_t threads = 1);

}  // namespace carom
