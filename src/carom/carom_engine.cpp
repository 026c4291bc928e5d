#include "carom/carom_engine.h"

#include "carom/compose.h"
#include "carom/laws/frictionless.h"

namespace carom {

namespace {

class CaromEngine final : public Engine {
 public:
  EngineInfo info() const override { return carom_engine_info(); }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view /*profile*/) const override {
    return compose<Frictionless>(scenario);
  }
};

}  // namespace

EngineInfo carom_engine_info() {
  EngineInfo info;
  info.name = "carom";
  info.about = "The hand-written engine: fixed steps, every impact at its time within the step";
  info.version = CAROM_VERSION;
  info.precision = "float64";
  info.profiles = {{"faithful", "As a user would run it."}};
  info.limits = {
      "Flight under drag is of second order in the step; flight without it is exact but for rounding.",
      "Impacts at one moment are resolved one after the other, so what touching balls do depends on their "
      "order.",
      "Piles settle slowly: one of 20 balls costs milliseconds a step, gains up to 1e-6 of its energy and "
      "misses a few hundredths in the account of the floor's push while it forms; one of 50 may not end in "
      "time.",
  };
  info.cannot = {
      {Feature::spin, "carom's balls do not rotate yet"},
      {Feature::magnus, "needs spin, and carom's balls do not rotate yet"},
      {Feature::friction, "carom has no friction yet"},
      {Feature::tangential_restitution, "carom has no friction yet"},
      {Feature::slab, "carom has no slabs yet"},
      {Feature::barrier, "carom has no quantum barriers yet"},
      {Feature::events, "carom takes no events yet"},
  };
  return info;
}

std::unique_ptr<Engine> make_carom_engine() {
  return std::make_unique<CaromEngine>();
}

}  // namespace carom
