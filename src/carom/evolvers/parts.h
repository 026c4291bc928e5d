#pragma once

#include <memory>

#include "carom/broad_phase/broad_phase.h"
#include "carom/flight.h"
#include "carom/laws/cluster_law.h"

namespace carom {

/// What an evolver is put together from, apart from what it is compiled with.
template <int Dim>
struct Parts {
  std::unique_ptr<BroadPhase<Dim>> broad_phase;
  std::unique_ptr<Flight<Dim>> flight;           ///< null: balls fly straight on
  std::unique_ptr<ClusterLaw<Dim>> cluster_law;  ///< null: sequential
};

}  // namespace carom
