#include "reference/closed_form/closed_form.h"

#include <fmt/format.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "reference/closed_form/motion.h"
#include "reference/closed_form/scene_facts.h"

namespace carom {

namespace {

using closed_form::Attempt;
using closed_form::Motion;
using closed_form::Twofold;

/// The families in the order in which they are tried.
constexpr std::array kFamilies = {closed_form::try_rough_wall, closed_form::try_separable,
                                  closed_form::try_drag,       closed_form::try_magnus,
                                  closed_form::try_line,       closed_form::try_pair};

/// The first family that solves the scene; or else the first reason that one gives.
Attempt find_motion(const Scenario& scenario) {
  std::string reason = closed_form::starts_outside(scenario);
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
    time_s_ += closed_form::exact_product(step_s, static_cast<double>(steps));
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
  closed_form::Twofold time_s_;
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
    const Attempt made = find_motion(scenario);
    return made.motion ? std::string() : "no closed form: " + made.reason;
  }

  std::unique_ptr<Simulation> create(const Scenario& scenario, std::string_view) const override {
    Attempt made = find_motion(scenario);
    if (!made.motion) throw std::logic_error("closed-form: create() after a refusal: " + made.reason);
    return std::make_unique<ClosedFormSimulation>(scenario, std::move(made.motion));
  }
};

class ClosedFormTruth final : public TruthSource {
 public:
  std::string_view kind() const override { return "closed-form"; }

  std::string refuses(const Scenario& scenario) const override {
    return unsupported_reason(ClosedFormEngine(), scenario, "faithful");
  }

  Solution solve(const Scenario& scenario, std::span<const Moment> moments,
                 const Taker& take) const override {
    const Attempt made = find_motion(scenario);
    std::vector<BallState> balls(scenario.balls.size());
    for (std::size_t k = 0; k < moments.size(); ++k) {
      const Twofold time_s =
          closed_form::exact_product(moments[k].step_s, static_cast<double>(moments[k].steps));
      for (std::size_t i = 0; i < balls.size(); ++i) balls[i].spin = scenario.balls[i].spin;
      made.motion->evaluate(time_s, balls);
      take(k, balls, made.motion->tally(time_s));
    }
    Solution solution;
    solution.uncertainty_m = made.motion->uncertainty_m();
    if (!moments.empty()) {
      const Moment& last = moments.back();
      const Twofold end_s = closed_form::exact_product(last.step_s, static_cast<double>(last.steps));
      solution.impact_count = made.motion->tally(end_s).impacts;
    }
    return solution;
  }
};

}  // namespace

std::unique_ptr<TruthSource> make_closed_form_truth() {
  return std::make_unique<ClosedFormTruth>();
}

std::unique_ptr<Engine> make_closed_form_engine() {
  return std::make_unique<ClosedFormEngine>();
}

}  // namespace carom
