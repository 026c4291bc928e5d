#include "carom/compose.h"
#include "carom/laws/frictionless.h"
#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// The frictionless law with its impulse a thousandth too large: the mistake that every gate must catch.
struct ImpulseTooLarge {
  static constexpr std::string_view kName = "frictionless, times 1.001";
  static constexpr double kFactor = 1.001;

  template <int Dim>
  static Vec<Dim> between(World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                          double restitution) {
    // (1 + e') = 1.001 (1 + e) makes the impulse that much larger.
    return Frictionless::between<Dim>(world, a, b, normal, kFactor * (1.0 + restitution) - 1.0);
  }

  template <int Dim>
  static Vec<Dim> on_wall(World<Dim>& world, std::size_t ball, const Vec<Dim>& normal, double restitution) {
    return Frictionless::on_wall<Dim>(world, ball, normal, kFactor * (1.0 + restitution) - 1.0);
  }
};

class ImpulseEngine final : public Engine {
 public:
  EngineInfo info() const override { return TestEngine<StillSimulation>().info(); }

  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view /*profile*/) const override {
    return compose<ImpulseTooLarge>(scene);
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::ImpulseEngine)
