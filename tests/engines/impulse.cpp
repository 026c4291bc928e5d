#include "carom/compose.h"
#include "carom/evolvers/toi.h"
#include "carom/evolvers/traits.h"
#include "carom/laws/frictionless.h"
#include "tests/engines/still.h"

namespace carom::test {

namespace {

/// The frictionless law with its impulse a thousandth too large: the mistake that every gate must catch.
struct ImpulseTooLarge {
  static constexpr std::string_view kName = "frictionless, times 1.001";
  static constexpr bool kFriction = false;

  /// (1 + e') = 1.001 (1 + e) makes the impulse that much larger.
  static Contact too_large(Contact surface) {
    constexpr double kFactor = 1.001;
    surface.restitution = kFactor * (1.0 + surface.restitution) - 1.0;
    return surface;
  }

  template <int Dim>
  static Vec<Dim> between(World<Dim>& world, std::size_t a, std::size_t b, const Vec<Dim>& normal,
                          const Contact& surface) {
    return Frictionless::between<Dim>(world, a, b, normal, too_large(surface));
  }

  template <int Dim>
  static Vec<Dim> on_wall(World<Dim>& world, std::size_t ball, const Vec<Dim>& normal,
                          const Contact& surface) {
    return Frictionless::on_wall<Dim>(world, ball, normal, too_large(surface));
  }
};

template <int Dim>
std::unique_ptr<Simulation> simulation(const Scenario& scene) {
  Parts<Dim> parts = make_parts<Dim>(scene);
  if (parts.flight) {
    return std::make_unique<ToiEvolver<Traits<Dim, true, ImpulseTooLarge, false>>>(scene, std::move(parts));
  }
  return std::make_unique<ToiEvolver<Traits<Dim, false, ImpulseTooLarge, false>>>(scene, std::move(parts));
}

class ImpulseEngine final : public Engine {
 public:
  EngineInfo info() const override { return TestEngine<StillSimulation>().info(); }

  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view /*profile*/) const override {
    return scene.dimension == 2 ? simulation<2>(scene) : simulation<3>(scene);
  }
};

}  // namespace

}  // namespace carom::test

CAROM_ENGINE_MODULE(carom::test::ImpulseEngine)
