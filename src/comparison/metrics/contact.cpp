#include "comparison/metrics/contact.h"

#include <algorithm>
#include <vector>

#include "comparison/overlap.h"

namespace carom {

namespace {

/// Whether a ball that started at `start` is where no ball can get, its centre being at `now`.
bool behind_something(const Scenario& scene, const Vec3& start, const Vec3& now) {
  for (const Wall& wall : scene.walls) {
    if (wall.normal.dot(now) < wall.offset) return true;
  }
  for (const Slab& slab : scene.slabs) {
    const auto side = [&slab](const Vec3& x) { return slab.normal.dot(x) > slab.offset; };
    if (side(now) != side(start)) return true;
  }
  return false;
}

/// Where each ball was last put, by the file or by an event: on which side of a slab it belongs.
class Places {
 public:
  Places(const Scenario& scene, const Run& run) : scene_(scene), run_(run) {
    for (const Ball& ball : scene.balls) places_.push_back(ball.position);
    places_.resize(run.trajectory.balls(), Vec3::Zero());
  }

  void to_frame(std::size_t frame) {
    for (; next_ < run_.interferences.size(); ++next_) {
      if (first_frame_after(scene_, scene_.events[next_]) > static_cast<std::int64_t>(frame)) return;
      for (const BallChange& change : run_.interferences[next_].changes) {
        const bool put =
            change.after && (!change.before || change.before->position != change.after->position);
        if (put) places_[change.ball] = change.after->position;
      }
    }
  }

  const Vec3& operator[](std::size_t ball) const { return places_[ball]; }

 private:
  const Scenario& scene_;
  const Run& run_;
  std::vector<Vec3> places_;
  std::size_t next_ = 0;
};

}  // namespace

void measure_contact(const Yardstick& yardstick, RunComparison& result) {
  const Scenario& scene = yardstick.scene();
  const Trajectory& trajectory = result.run.trajectory;
  double deepest = 0.0;
  OverlapSearch search(scene);
  std::vector<bool> outside(trajectory.balls(), false);
  Cast cast(scene);
  Places places(scene, result.run);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    cast.to_frame(static_cast<std::int64_t>(k));
    places.to_frame(k);
    const auto balls = trajectory.frame(k);
    const double overlap = scene.events.empty() ? search.deepest(balls) : deepest_overlap(scene, cast, balls);
    deepest = std::max(deepest, overlap);
    // A ball behind a wall overlaps it by its radius or more.
    if (overlap < 1.0 && scene.slabs.empty()) continue;
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (cast[i] && behind_something(scene, places[i], balls[i].position)) outside[i] = true;
    }
  }
  result.metrics[Metric::penetration] = deepest;
  if (!scene.walls.empty() || !scene.slabs.empty()) {
    result.metrics[Metric::escaped] = static_cast<double>(std::count(outside.begin(), outside.end(), true));
  }
}

}  // namespace carom
