#include "report/page/view.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace carom::page {

namespace {

// Motion across a line of less than this share of the motion along it cannot be seen in a drawing.
constexpr double kStraight = 1e-4;
// An engine that strays may widen the picture by this share to each side, less where a box is the frame; what
// leaves the picture is cut off.
constexpr double kStray = 0.4;
constexpr double kStrayFromBox = 0.08;
constexpr double kRoom = 0.04;  // to each side, so that nothing touches the frame
// Beyond it, m, nothing is in view, and squares would overflow.
constexpr double kNowhere_m = 1e150;

struct Interval {
  double low = std::numeric_limits<double>::infinity();
  double high = -std::numeric_limits<double>::infinity();

  void take(double from, double to) {
    if (!(std::abs(from) < kNowhere_m && std::abs(to) < kNowhere_m)) return;  // what is not finite, too
    low = std::min(low, from);
    high = std::max(high, to);
  }
  double size() const { return high - low; }
};

std::size_t drawn(const Trajectory& trajectory) {
  return std::min(trajectory.balls(), kDrawnPaths);
}

/// What the drawn balls cover along a coordinate, their radii included.
Interval covered(const Scenario& scene, const Trajectory& trajectory, int axis) {
  Interval interval;
  Cast cast(scene);
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    cast.to_frame(static_cast<std::int64_t>(k));
    for (std::size_t i = 0; i < drawn(trajectory); ++i) {
      if (!cast[i]) continue;
      const double centre = trajectory.frame(k)[i].position[axis];
      interval.take(centre - cast[i]->radius, centre + cast[i]->radius);
    }
  }
  return interval;
}

/// The farthest that a drawn ball moves along each coordinate, m.
std::array<double, 3> travel(const Trajectory& trajectory) {
  std::array<double, 3> farthest = {};
  for (std::size_t i = 0; i < drawn(trajectory); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      Interval interval;
      for (std::size_t k = 0; k < trajectory.frames(); ++k) {
        const double centre = trajectory.frame(k)[i].position[static_cast<int>(axis)];
        interval.take(centre, centre);
      }
      farthest[axis] = std::max(farthest[axis], interval.size());
    }
  }
  return farthest;
}

/// The box and what the leading run covers, and a little more where other engines go.
Interval in_view(const SceneComparison& scene, int axis) {
  Interval wanted = covered(*scene.scene, *leading_trajectory(scene), axis);
  const std::optional<Box>& box = scene.scene->box;
  if (box) wanted.take(box->min[axis], box->max[axis]);
  const double stray = (box ? kStrayFromBox : kStray) * wanted.size();
  Interval interval = wanted;
  for (const RunComparison& run : scene.runs) {
    if (run.run.status != RunStatus::ok) continue;
    const Interval own = covered(*scene.scene, run.run.trajectory, axis);
    interval.take(std::clamp(own.low, wanted.low - stray, wanted.high + stray),
                  std::clamp(own.high, wanted.low - stray, wanted.high + stray));
  }
  return interval;
}

Interval with_room(Interval interval, double room) {
  if (interval.size() <= 0.0) interval.take(interval.low - 1.0, interval.high + 1.0);
  return {interval.low - room, interval.high + room};
}

/// The floor or wall that a motion along a coordinate ends at belongs into the picture.
void take_walls(const Scenario& scene, int axis, Interval& interval) {
  for (const Wall& wall : scene.walls) {
    if (std::abs(wall.normal[axis]) < 1.0) continue;
    const double place = wall.offset * wall.normal[axis];
    if (std::abs(place - interval.low) < interval.size() ||
        std::abs(place - interval.high) < interval.size()) {
      interval.take(place, place);
    }
  }
}

}  // namespace

const Trajectory* leading_trajectory(const SceneComparison& scene) {
  if (scene.truth.known() && scene.truth.trajectory.frames() > 0) return &scene.truth.trajectory;
  const Trajectory* any = nullptr;
  for (const RunComparison& run : scene.runs) {
    if (run.run.status != RunStatus::ok) continue;
    if (run.under_test) return &run.run.trajectory;
    if (any == nullptr) any = &run.run.trajectory;
  }
  return any;
}

View view_of(const SceneComparison& scene) {
  const std::array<double, 3> moved = travel(*leading_trajectory(scene));
  const auto along = static_cast<std::size_t>(std::max_element(moved.begin(), moved.end()) - moved.begin());
  double across = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) across = std::max(across, axis == along ? 0.0 : moved[axis]);

  View view;
  if (moved[along] > 0.0 && across <= kStraight * moved[along]) {
    view.kind = View::Kind::over_time;
    view.axis = static_cast<int>(along);
    Interval place = in_view(scene, view.axis);
    take_walls(*scene.scene, view.axis, place);
    place = with_room(place, kRoom * place.size());
    return {view.kind, view.axis, 0.0, scene.scene->duration_s, place.low, place.high};
  }
  Interval x = in_view(scene, 0);
  Interval y = in_view(scene, 1);
  const double room = kRoom * std::max(x.size(), y.size());
  x = with_room(x, room);
  y = with_room(y, room);
  return {view.kind, view.axis, x.low, x.high, y.low, y.high};
}

}  // namespace carom::page
