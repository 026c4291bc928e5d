#pragma once

#include <memory>
#include <type_traits>

#include "carom/broad_phase/pair_list.h"
#include "carom/flight.h"
#include "carom/laws/cluster_law.h"

namespace carom {

class LawFormula;

/// What an evolver is put together from, apart from what it is compiled with.
template <int Dim>
struct Parts {
  std::unique_ptr<BroadPhase<Dim>> broad_phase;
  std::unique_ptr<Flight<Dim>> flight;           ///< null: balls fly straight on
  std::unique_ptr<ClusterLaw<Dim>> cluster_law;  ///< null: sequential
  Listed listed = Listed::kNear;
  std::size_t threads = 1;
  std::shared_ptr<LawFormula> law = nullptr;  ///< of a law from a file; null: the law is compiled in
};

/// The law that an evolver was compiled with. One that is known at compile time is empty and costs nothing.
template <class Law, int Dim>
Law law_of(const Parts<Dim>& parts) {
  if constexpr (std::is_constructible_v<Law, std::shared_ptr<LawFormula>>) {
    return Law(parts.law);
  } else {
    return {};
  }
}

}  // namespace carom
