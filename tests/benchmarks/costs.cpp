// What a scene costs that names one thing more than colliding balls, in the composed engine with everything
// linked to it.
//
//   carom-costs                             every scene with every evolver that takes it, a pair to a line
//   carom-costs SCENE EVOLVER BALLS STEPS   advances the scene and prints what that took, a row of JSON

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "carom/compose.h"
#include "tests/benchmarks/gas.h"
#include "tests/benchmarks/live_bytes.h"

namespace carom::benchmark {
namespace {

/// The bare gas and one thing more, taken from the gas with everything.
struct SceneVariant {
  std::string name;
  void (*add)(Scenario& scene, const Scenario& full);
};

void add_spin(Scenario& scene, const Scenario& /*full*/) {
  scene.effects.spin = true;
}

const std::vector<SceneVariant>& all_scenes() {
  static const std::vector<SceneVariant> scenes = {
      {"bare", [](Scenario&, const Scenario&) {}},
      {"gravity", [](Scenario& s, const Scenario& full) { s.effects.gravity = full.effects.gravity; }},
      {"linear-drag",
       [](Scenario& s, const Scenario& full) {
         s.effects.drag = Drag{Drag::Kind::linear, full.effects.drag->coefficient};
       }},
      {"quadratic-drag", [](Scenario& s, const Scenario& full) { s.effects.drag = full.effects.drag; }},
      {"spin", add_spin},
      {"friction",
       [](Scenario& s, const Scenario& full) {
         add_spin(s, full);
         s.ball_contact = full.ball_contact;
       }},
      {"magnus",
       [](Scenario& s, const Scenario& full) {
         add_spin(s, full);
         s.effects.magnus = full.effects.magnus;
       }},
      {"walls", [](Scenario& s, const Scenario& full) { s.walls = full.walls; }},
      {"walls-only",
       [](Scenario& s, const Scenario& full) {
         s.walls = full.walls;
         s.effects.collisions = false;
       }},
      {"slab", [](Scenario& s, const Scenario& full) { s.slabs = full.slabs; }},
      {"barrier", [](Scenario& s, const Scenario& full) { s.barriers = full.barriers; }},
      {"everything", [](Scenario& s, const Scenario& full) { s = full; }},
  };
  return scenes;
}

Scenario scene_of(const SceneVariant& variant, std::size_t balls) {
  Scenario scene = bare_gas(balls);
  variant.add(scene, full_gas(balls));
  return scene;
}

void list() {
  constexpr std::size_t kFewBalls = 100;  // who takes a scene does not depend on how many there are
  for (const SceneVariant& variant : all_scenes()) {
    const Scenario scene = scene_of(variant, kFewBalls);
    for (const Evolver& evolver : all_evolvers()) {
      if (evolver.refuses(scene).empty()) fmt::print("{} {}\n", variant.name, evolver.name);
    }
  }
}

/// @pre list() has the pair
void measure_one(const std::string& name, const std::string& evolver, std::size_t balls, std::int64_t steps) {
  const auto variant = std::find_if(all_scenes().begin(), all_scenes().end(),
                                    [&](const SceneVariant& each) { return each.name == name; });
  const Scenario scene = scene_of(*variant, balls);
  all_evolvers();  // is made once, and belongs to no simulation
  const std::int64_t heap_before = live_bytes();
  const std::unique_ptr<Simulation> simulation = compose(scene, {evolver, {}});
  fmt::print("{}\n", measure(*simulation, scene, name, evolver, steps, heap_before));
}

}  // namespace
}  // namespace carom::benchmark

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 4) {
    carom::benchmark::measure_one(words[0], words[1], std::stoul(words[2]), std::stol(words[3]));
  } else {
    carom::benchmark::list();
  }
}
