#include "carom/laws/simultaneous.h"

#include "carom/laws/impact_rounds.h"

namespace carom {

template <int Dim>
void Simultaneous<Dim>::resolve(World<Dim>& world, std::span<ClosedContact<Dim>> contacts) const {
  resolve_in_rounds<Dim>(world, contacts, AtRest::takes_part);
}

template class Simultaneous<2>;
template class Simultaneous<3>;

}  // namespace carom
