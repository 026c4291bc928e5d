#include "comparison/gates.h"

#include <algorithm>

namespace carom {

namespace {

/// [gate] for the engines under test, and over it what [gate.<engine>] says of one engine.
Limits limits_for(const Gate& gate, const RunComparison& result) {
  Limits limits = result.under_test ? gate.under_test : Limits{};
  const auto own = gate.per_engine.find(result.run.label());
  if (own == gate.per_engine.end()) return limits;
  for (const auto& [metric, limit] : own->second) limits[metric] = limit;
  return limits;
}

}  // namespace

Verdict verdict_of(const RunComparison& result) {
  switch (result.run.status) {
    case RunStatus::unsupported:
      return Verdict::unsupported;
    case RunStatus::crashed:
    case RunStatus::timeout:
    case RunStatus::invalid:
      return Verdict::error;
    case RunStatus::ok:
      break;
  }
  if (result.gates.empty()) return Verdict::shown;
  const bool all_hold = std::all_of(result.gates.begin(), result.gates.end(),
                                    [](const GateResult& gate) { return gate.holds; });
  return all_hold ? Verdict::pass : Verdict::fail;
}

void hold_gates(const Gate& gate, RunComparison& result) {
  for (const auto& [metric, limit] : limits_for(gate, result)) {
    const std::optional<double> value = result.metrics[metric];
    result.gates.push_back({metric, limit, value, value && *value <= limit, std::nullopt});
  }
  result.verdict = verdict_of(result);
}

}  // namespace carom
