#include "carom/textbook/textbook.h"

#include <fmt/format.h>

#include "carom/textbook/program.h"

namespace carom {

namespace {

using textbook::Program;
using textbook::ProgramBall;

constexpr std::string_view kUpdatePer = "one_update_per";

class TextbookSimulation final : public Simulation {
 public:
  TextbookSimulation(const Scenario& scene, bool update_per_frame)
      : program_(scene), update_per_frame_(update_per_frame) {}

  void advance(double step_s, std::int64_t steps) override {
    if (update_per_frame_) {
      step_s *= static_cast<double>(steps);
      steps = 1;
    }
    program_.set_update(step_s);
    for (std::int64_t k = 0; k < steps; ++k) program_.update();
  }

  void snapshot(std::span<BallState> balls) const override {
    for (std::size_t i = 0; i < balls.size(); ++i) {
      const ProgramBall& ball = program_.balls()[i];
      balls[i] = {ball.x.cast<double>(), ball.v.cast<double>() / program_.update_s(), Vec3::Zero()};
    }
  }

  Tally tally() const override { return program_.tally(); }

  Settings settings() const override {
    return {{"law", std::string("the course program's")},
            {std::string(kUpdatePer), std::string(update_per_frame_ ? "frame" : "step")},
            {"pairs", std::string("every ordered pair")},
            {"update_s", program_.update_s()}};
  }

 private:
  Program program_;
  bool update_per_frame_;
};

class TextbookEngine final : public Engine {
 public:
  EngineInfo info() const override {
    EngineInfo info;
    info.name = kTextbookName;
    info.about = "The course program that Carom grew from: its formulas in its order, none of them put right";
    info.version = CAROM_VERSION;
    info.precision = "float32";
    info.profiles = {
        {"faithful", "An update lasts one of the scene's steps."},
        {"default", "An update lasts from one recorded frame to the next, as the program drew them."}};
    info.switches = {{std::string(kUpdatePer), "how long an update lasts"}};
    info.limits = {
        "It has no time step: a velocity is a length per update. In metres per second that is the length "
        "over "
        "the scene's step, so another step is another frame rate.",
        "What overlaps after an update is a contact: an impact is late by up to an update, and a ball that "
        "is "
        "faster than its diameter an update passes another unseen.",
        "Each of two balls that overlap is moved by the whole overlap and the second by more: they end "
        "apart, "
        "whatever they weigh, and the angular momentum changes.",
        "Two balls with one centre have no line of centres: it divides by zero and goes on with NaN.",
        "It looks at every pair twice in every update.",
    };
    const char* no_force = "the program's balls move uniformly; its text has no such force";
    const char* one_pair = "the program looks at one pair after the other";
    info.cannot = {
        {Feature::linear_drag, no_force},
        {Feature::quadratic_drag, no_force},
        {Feature::magnus, no_force},
        {Feature::spin,
         "the program's spin is the angle at which a ball is drawn, 0.1 v/r an update: nothing turns"},
        {Feature::friction, "the program's impulse acts along the line of centres"},
        {Feature::tangential_restitution, "the program's impulse acts along the line of centres"},
        {Feature::simultaneous, one_pair},
        {Feature::generalized_reflections, one_pair},
        {Feature::immovable, "p = 2s/(m₁ + m₂) is 0 for an infinite mass, and p m is not a number"},
        {Feature::slab, "the program's only solids are walls"},
        {Feature::barrier, "no formula for it is in the program's text"},
    };
    return info;
  }

  std::string refuses(const Scenario& scene, std::string_view /*profile*/) const override {
    const bool balls_meet = scene.effects.collisions && scene.balls.size() > 1;
    const double of_balls = balls_meet ? scene.ball_contact.restitution : 1.0;
    const double of_walls = scene.walls.empty() ? 1.0 : scene.wall_contact.restitution;
    if (of_balls == 1.0 && of_walls == 1.0) return {};
    return fmt::format("the program's impulse is that of elastic balls: restitution 1, not {}",
                       of_balls != 1.0 ? of_balls : of_walls);
  }

  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view profile) const override {
    return std::make_unique<TextbookSimulation>(scene, profile == "default");
  }

  std::unique_ptr<Simulation> create_switched(const Scenario& scene, std::string_view profile,
                                              std::span<const std::string> switched) const override {
    const bool other = !switched.empty();  // there is one setting to switch
    return std::make_unique<TextbookSimulation>(scene, (profile == "default") != other);
  }
};

}  // namespace

std::unique_ptr<Engine> make_textbook_engine() {
  return std::make_unique<TextbookEngine>();
}

}  // namespace carom
