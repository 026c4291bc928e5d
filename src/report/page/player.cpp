#include "report/page/player.h"

#include <algorithm>

#include "report/playback.h"

namespace carom::page {

namespace {

// Most scenes take some ten kilobytes. A gas whose balls meet between any two frames takes up to ten bytes
// for each ball and frame: where that is too much, 40,000 states of a run, on grids that nobody sees, make
// 0.4 MB, and three runs fit. With ten of them a page of a hundred scenes stays below 25 MB.
constexpr PlaybackLimits kWhole = {.balls = 2000, .states = 300000, .bytes = 600000, .impacts = 3000};
constexpr PlaybackLimits kThinned = {
    .balls = 2000, .states = 40000, .bytes = 1300000, .impacts = 3000, .position_bits = 10, .speed_bits = 12};

/// What comes first when not all fits: carom and the engines set for fidelity, then others, then carom's
/// variants.
int rank(const Run& run) {
  if (run.engine.starts_with("carom:")) return 3;
  if (run.engine == "carom") return 0;
  return run.profile == "faithful" ? 1 : 2;
}

}  // namespace

void add_player(Node parent, const SceneComparison& scene) {
  std::vector<const Run*> runs;
  for (const RunComparison& run : scene.runs) runs.push_back(&run.run);
  if (std::none_of(runs.begin(), runs.end(), [](const Run* run) { return run->status == RunStatus::ok; })) {
    return;
  }
  std::stable_sort(runs.begin(), runs.end(), [](const Run* a, const Run* b) { return rank(*a) < rank(*b); });
  Node box = add(parent, "div", {{"class", "player"}});
  PlaybackText text = write_playback(*scene.scene, runs, &scene.truth, kWhole);
  if (!text.left_out.empty()) text = write_playback(*scene.scene, runs, &scene.truth, kThinned);
  add(box, "script", {{"class", "playback"}, {"type", "application/json"}}, text.json);
}

}  // namespace carom::page
