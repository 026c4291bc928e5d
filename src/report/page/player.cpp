#include "report/page/player.h"

#include <algorithm>

#include "report/playback.h"

namespace carom::page {

namespace {

// Most scenes take some ten kilobytes. A gas whose balls meet between any two frames takes up to ten bytes
// for each ball and frame: a thousand balls in 600 frames fit as they are, in one run and its truth. Where
// that is too much, runs are on grids that nobody sees, and in ever fewer frames until all of them fit: who
// compares engines misses one of them more than every second picture.
constexpr std::size_t kMostBytes = 1800000;
constexpr PlaybackLimits kWhole = {.balls = 2000, .states = 700000, .bytes = kMostBytes, .impacts = 3000};
constexpr PlaybackLimits kThinned = {.balls = 2000,
                                     .states = 320000,
                                     .bytes = kMostBytes,
                                     .impacts = 1000,
                                     .position_bits = 10,
                                     .speed_bits = 12};
/// Fewer would be fewer than 20 frames of a thousand balls; what does not fit then is left out, and said to
/// be.
constexpr std::size_t kFewestStates = 20000;

/// What comes first when not all fits: carom and the engines set for fidelity, then others, then carom's
/// variants.
int rank(const Run& run) {
  if (run.engine.starts_with("carom:")) return 3;
  if (run.engine == "carom") return 0;
  return run.profile == "faithful" ? 1 : 2;
}

PlaybackText playback_of(const SceneComparison& scene, const std::vector<const Run*>& runs) {
  PlaybackText text = write_playback(*scene.scene, runs, &scene.truth, kWhole);
  for (PlaybackLimits limits = kThinned; !text.left_out.empty() && limits.states >= kFewestStates;
       limits.states /= 2) {
    text = write_playback(*scene.scene, runs, &scene.truth, limits);
  }
  return text;
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
  add(box, "script", {{"class", "playback"}, {"type", "application/json"}}, playback_of(scene, runs).json);
}

}  // namespace carom::page
