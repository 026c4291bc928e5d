#include "app/coefficients.h"

namespace carom {

std::vector<CoefficientPanel> measure_coefficients(const std::vector<EngineChoice>& engines,
                                                   const ProcessLimits& limits, int parallel) {
  const std::vector<CoefficientProbe> probes = coefficient_probes();
  std::vector<std::string> labels;
  labels.reserve(engines.size());
  for (const EngineChoice& engine : engines)
    labels.push_back(engine_label(engine.source.name, engine.profile));
  std::vector<CoefficientPanel> panels = empty_panels(probes, labels);
  for (const CoefficientProbe& probe : probes) {
    add_delivered(probe, run_engines(probe.scene, engines, limits, parallel), panels);
  }
  return panels;
}

}  // namespace carom
