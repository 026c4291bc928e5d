#include "carom/flight.h"

#include "carom/effects/list.h"

namespace carom {

template <int Dim>
std::unique_ptr<Flight<Dim>> make_flight(const Scenario& scene) {
  return with_effects(scene, EffectSlots<Dim>{}, [](auto... effects) -> std::unique_ptr<Flight<Dim>> {
    if constexpr (sizeof...(effects) == 0) {
      return nullptr;
    } else {
      return std::make_unique<FlightModel<Dim, decltype(effects)...>>(effects...);
    }
  });
}

template std::unique_ptr<Flight<2>> make_flight<2>(const Scenario&);
template std::unique_ptr<Flight<3>> make_flight<3>(const Scenario&);

}  // namespace carom
