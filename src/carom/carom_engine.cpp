#include "carom/carom_engine.h"

#include <fmt/format.h>

#include <map>

#include "carom/broad_phase/list.h"
#include "carom/compose.h"
#include "carom/evolvers/list.h"
#include "carom/textbook/textbook.h"
#include "carom/tuning.h"

namespace carom {

namespace {

/// In fewer balls there is less to share than threads take to meet.
constexpr std::size_t kBallsToShare = 50'000;

std::map<std::string, Variant> all_variants() {
  std::map<std::string, Variant> variants = {{"carom", {}}};
  for (const int dimension : {2, 3}) {
    for (const std::string_view broad_phase : broad_phase_names(dimension)) {
      variants[fmt::format("carom:{}", broad_phase)] = {"", std::string(broad_phase)};
      for (const Evolver& evolver : all_evolvers()) {
        variants[fmt::format("carom:{}", evolver.name)] = {std::string(evolver.name), ""};
        if (!evolver.takes_broad_phase) continue;
        variants[fmt::format("carom:{}:{}", evolver.name, broad_phase)] = {std::string(evolver.name),
                                                                           std::string(broad_phase)};
      }
    }
  }
  return variants;
}

std::string about(const Variant& variant) {
  if (!variant.evolver.empty()) {
    for (const Evolver& evolver : all_evolvers()) {
      if (evolver.name == variant.evolver) return fmt::format("The hand-written engine: {}", evolver.about);
    }
  }
  return "The hand-written engine: the most accurate evolver that the scene allows";
}

class CaromEngine final : public Engine, public Tunable {
 public:
  CaromEngine(std::string name, Variant variant) : name_(std::move(name)), variant_(std::move(variant)) {}

  EngineInfo info() const override {
    EngineInfo info;
    info.name = name_;
    info.about = about(variant_);
    info.version = CAROM_VERSION;
    info.precision = "float64";
    info.profiles = {{"faithful", "As a user would run it."}};
    info.limits = {
        "Flight under drag or Magnus force is of second order in the step; all other flight is exact but for "
        "rounding.",
        "Impacts at one moment are resolved one after the other, so what touching balls do depends on their "
        "order, unless the scene names a law for several contacts at once.",
        "Where balls still chatter after several flights in a step, its rest is taken in one piece, of first "
        "order: "
        "piles that form, and inelastic collapse.",
        "Rough piles of 200 balls cost tens of milliseconds a step while they form. In a crowd friction is "
        "met as far "
        "as a few turns of the solver bring it; what overlaps is not left to that.",
        "Friction between balls that lie on each other follows the contacts' normals once a step.",
    };
    return info;
  }

  std::string refuses(const Scenario& scenario, std::string_view /*profile*/) const override {
    return refusal(scenario, variant_);
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view /*profile*/) const override {
    return compose(scenario, variant_for(scenario));
  }

  bool takes_steps(const Scenario& scenario) const override {
    return choose_evolver(scenario, variant_).takes_steps;
  }

  ClaimedOrder claimed_order(const Scenario& scenario) const override {
    const Evolver& evolver = choose_evolver(scenario, variant_);
    return evolver.claimed_order == nullptr ? std::nullopt : evolver.claimed_order(scenario);
  }

  std::vector<Tuning> tunings(const Scenario& scenario, std::string_view /*profile*/) const override {
    return variant_tunings(scenario, variant_);
  }

  std::unique_ptr<Simulation> create_tuned(const Scenario& scenario, std::string_view /*profile*/,
                                           const Tuned& tuned) const override {
    return compose_tuned(scenario, variant_for(scenario), tuned);
  }

 private:
  Variant variant_for(const Scenario& scene) const {
    Variant variant = variant_;
    if (scene.balls.size() < kBallsToShare) variant.threads = 1;
    return variant;
  }

  std::string name_;
  Variant variant_;
};

}  // namespace

std::vector<std::string> carom_variant_names() {
  std::vector<std::string> names;
  for (const auto& [name, variant] : all_variants()) {
    if (name != "carom") names.push_back(name);
  }
  names.emplace_back(kTextbookName);
  return names;
}

std::unique_ptr<Engine> make_carom_engine(const std::string& name, std::size_t threads) {
  if (name == kTextbookName) return make_textbook_engine();
  Variant variant = all_variants().at(name);
  variant.threads = threads;
  return std::make_unique<CaromEngine>(name, variant);
}

}  // namespace carom
