#include "reference/exact/closed_form.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "reference/exact/motion.h"
#include "reference/exact/scene_facts.h"

namespace carom {

namespace {

using exact::Attempt;
using exact::Motion;

/// The families in the order in which they are tried.
constexpr std::array kFamilies = {exact::try_rough_wall, exact::try_separable, exact::try_drag,
                                  exact::try_magnus,     exact::try_line,      exact::try_pair};

/// The first family that solves the scene; or else the first reason that one gives.
Attempt solve(const Scenario& scenario) {
  std::string reason = exact::starts_outside(scenario);
  if (!reason.empty()) return {nullptr, reason};
  for (const auto attempt : kFamilies) {
    Attempt made = attempt(scenario);
    if (made.motion) return made;
    if (reason.empty()) reason = made.reason;
  }
  if (reason.empty()) {
    reason = fmt::format("{} balls in {} can meet", scenario.balls.size(),
                         scenario.dimension == 2 ? "the plane" : "space");
  }
  return {nullptr, reason};
}

class ClosedFormSimulation final : public Simulation {
 public:
  ClosedFormSimulation(const Scenario& scenario, std::unique_ptr<Motion> motion)
      : scenario_(scenario), motion_(std::move(motion)) {}

  /// The product is exact and the sum is carried as a pair, so that time is right after millions of calls.
  void advance(double step_s, std::int64_t steps) override {
    time_s_ += exact::exact_product(step_s, static_cast<double>(steps));
  }

  void snapshot(std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) balls[i].spin = scenario_.balls[i].spin;
    motion_->evaluate(time_s_, balls);
  }

  Tally tally() const override { return motion_->tally(time_s_); }

  Settings settings() const override { return {{"family", std::string(motion_->family())}}; }

  double uncertainty_m() const override { return motion_->uncertainty_m(); }

 private:
  const Scenario& scenario_;
  std::unique_ptr<Motion> motion_;
  exact::Twofold time_s_;
};

class ClosedFormEngine final : public Engine {
 public:
  EngineInfo info() const override {
    const std::string unsolved = "no family of closed forms here has it";
    const std::string pairwise = "its impacts are of one pair at a time";
    return {.name = "closed-form",
            .about = "Exact solutions, evaluated to the last digit of a double, for scenes that have one.",
            .version = "1",
            .precision = "float64",
            .profiles = {{"faithful", "There is nothing to set."}},
            .cannot = {{Feature::simultaneous, pairwise},
                       {Feature::generalized_reflections, pairwise},
                       {Feature::slab, unsolved},
                       {Feature::barrier, unsolved},
                       {Feature::events, unsolved}},
            .limits = {}};
  }

  std::string refuses(const Scenario& scenario, std::string_view) const override {
    const Attempt made = solve(scenario);
    return made.motion ? std::string() : "no closed form: " + made.reason;
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view) const override {
    Attempt made = solve(scenario);
    if (!made.motion) throw std::logic_error("closed-form: create() after a refusal: " + made.reason);
    return std::make_unique<ClosedFormSimulation>(scenario, std::move(made.motion));
  }
};

}  // namespace

std::unique_ptr<Engine> make_closed_form_engine() {
  return std::make_unique<ClosedFormEngine>();
}

}  // namespace carom
