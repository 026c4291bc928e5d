#include "carom/laws/generalized_reflections.h"

#include "carom/laws/impact_rounds.h"

namespace carom {

template <int Dim>
void GeneralizedReflections<Dim>::resolve(World<Dim>& world, std::span<ClosedContact<Dim>> contacts) const {
  resolve_in_rounds<Dim>(world, contacts, AtRest::stands_by);
}

template class GeneralizedReflections<2>;
template class GeneralizedReflections<3>;

}  // namespace carom
