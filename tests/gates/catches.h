#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenario/metric.h"

namespace carom::gates {

/// Which gate must catch which broken engine (tests/engines/plain/defects.cpp): one for each, the one
/// whose business it is.
struct Catcher {
  std::string_view defect;
  std::string_view scene;
  Metric metric;
};

inline constexpr std::array kCatchers = {
    Catcher{"restitution-off", "impact/restitution-half", Metric::energy},
    Catcher{"velocity-threshold", "impact/resting-target", Metric::energy},
    Catcher{"wall-restitution-for-balls", "line/two-coefficients", Metric::energy},
    Catcher{"friction-sign", "friction/oblique-wall", Metric::energy},
    Catcher{"no-friction-cone", "friction/oblique-wall", Metric::position},
    Catcher{"tangential-restitution-ignored", "friction/sticking-wall", Metric::position},
    Catcher{"spin-of-second-ignored", "friction/two-spinning-balls", Metric::energy},
    Catcher{"disk-inertia", "friction/oblique-wall", Metric::angular_momentum},
    Catcher{"no-torque", "friction/oblique-wall", Metric::angular_momentum},
    Catcher{"mass-ratio-clamped", "impact/mass-ratio-million", Metric::position},
    Catcher{"immovable-is-heavy", "hard/immovable-squeeze", Metric::position},
    Catcher{"momentum-leak", "gas/hundred-2d", Metric::momentum},
    Catcher{"pair-order", "impact/head-on", Metric::momentum},
    Catcher{"labels-swapped", "impact/head-on", Metric::position},
    Catcher{"wall-impulse-sign", "wall/bounce", Metric::momentum},
    Catcher{"angular-impulse-not-booked", "wall/off-centre", Metric::angular_momentum},
    Catcher{"forgotten-wall", "course/normal-mode", Metric::escaped},
    Catcher{"cell-border", "gas/hundred-2d", Metric::penetration},
    Catcher{"collision-margin", "impact/restitution-zero", Metric::penetration},
    Catcher{"tie-forgotten", "hard/five-at-once", Metric::penetration},
    Catcher{"end-of-step", "course/thin-slab", Metric::escaped},
    Catcher{"first-order-gravity", "wall/drop-elastic", Metric::position},
    Catcher{"gravity-at-bounce", "wall/drop-elastic", Metric::energy},
    Catcher{"position-correction", "wall/drop-elastic", Metric::energy},
    Catcher{"time-lost", "impact/head-on", Metric::position},
    Catcher{"speed-limit", "hard/speed-fast", Metric::position},
    Catcher{"sleeping", "hard/speed-slow", Metric::position},
    Catcher{"damping", "line/gapped-cradle", Metric::energy},
    Catcher{"single-precision", "impact/oblique", Metric::energy},
    Catcher{"drag-sign", "flight/linear-drag", Metric::energy},
    Catcher{"magnus-sign", "flight/magnus-circle", Metric::position},
};

/// What a run of `carom check` said of a broken engine in the scene and metric of its catcher.
struct Catch {
  std::string engine;  ///< plain@<defect>
  std::string broken;  ///< what is broken
  std::string scene;
  std::string metric;
  double value = 0.0;
  double limit = 0.0;
  bool caught = false;  ///< the gate is there, and does not hold
};

/// Runs `carom check` with every broken engine of the plain module in the scene that must catch it. A
/// broken engine that no row of kCatchers names comes without a scene, and is not caught.
/// @param modules  the folder of the plain module
std::vector<Catch> run_catches(const std::filesystem::path& modules);

/// What stands in reports/measured/gates.json: the same from every build, but for rounding, of which three
/// digits are told.
std::string catches_json(const std::vector<Catch>& catches);

}  // namespace carom::gates
