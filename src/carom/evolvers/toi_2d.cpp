#include "carom/evolvers/list.h"
#include "carom/evolvers/toi.h"
#include "carom/evolvers/traits.h"

namespace carom {

std::unique_ptr<Simulation> make_toi_2d(const Scenario& scene, Parts<2> parts) {
  return make_with_traits<2, ToiEvolver>(scene, std::move(parts));
}

}  // namespace carom
