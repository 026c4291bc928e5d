#include "report/page/paths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "report/page/canvas.h"
#include "report/page/view.h"
#include "report/page/wording.h"
#include "scenario/cast.h"

namespace carom::page {

namespace {

constexpr double kWidth_px = 230.0;
constexpr double kLowest_px = 70.0;    // a flatter scene gets room above and below
constexpr double kHighest_px = 250.0;  // a higher one gets room at its sides
constexpr double kTimeHeight_px = 170.0;
constexpr int kTicks = 5;
constexpr double kSmallestDot_px = 1.2;    // a smaller ball would not be seen
constexpr std::size_t kNumberedBalls = 6;  // with more of them, numbers cover each other
constexpr std::size_t kDrawnEnds = 1000;
constexpr std::size_t kPointsPerPicture = 1200;  // shared by its paths; keeps a page of many scenes small
constexpr const char* kAxisNames[] = {"x", "y", "z"};

/// One picture: its canvas, and how the scene is put on it.
class Picture {
 public:
  /// @param first  whether it is the first picture of its scene
  Picture(const SceneComparison& scene, const View& view, const Canvas& canvas, bool first)
      : scene_(*scene.scene), view_(view), canvas_(canvas), first_(first), cast_(*scene.scene) {
    cast_.to_frame(scene_.frames);
  }

  void draw_surroundings() const;
  void draw_truth(const Trajectory& truth) const;
  void draw_run(const Trajectory& trajectory, const LineStyle& style) const;

 private:
  Point at(const Trajectory& trajectory, std::size_t frame, std::size_t ball) const {
    const Vec3& position = trajectory.frame(frame)[ball].position;
    if (view_.kind == View::Kind::over_time) return canvas_.at(trajectory.time(frame), position[view_.axis]);
    return canvas_.at(position.x(), position.y());
  }

  /// Of a ball at the end; at the start of one that is gone then.
  double radius_px(std::size_t ball) const {
    return px_of(cast_[ball] ? cast_[ball]->radius : first_m(ball));
  }
  double first_radius_px(std::size_t ball) const { return px_of(first_m(ball)); }
  double first_m(std::size_t ball) const {
    return ball < scene_.balls.size() ? scene_.balls[ball].radius : 0.0;
  }
  double px_of(double length_m) const { return length_m * canvas_.height / (view_.y_high - view_.y_low); }

  static std::size_t points_per_path(const Trajectory& trajectory) {
    return std::min(kPointsPerPicture / std::clamp<std::size_t>(trajectory.balls(), 1, kDrawnPaths),
                    kMaxPoints);
  }

  Polyline path(const Trajectory& trajectory, std::size_t ball) const {
    Polyline line;
    for (std::size_t k = 0; k < trajectory.frames(); ++k) line.push_back(at(trajectory, k, ball));
    return line;
  }

  void draw_box() const;
  std::string sheet(const Vec3& normal, double offset, double thickness) const;
  void draw_sheet(const char* look, const Vec3& normal, double offset, double thickness) const;
  void draw_extent(const Polyline& line, double radius, const LineStyle& style) const;
  void draw_discs(const Trajectory& trajectory, const LineStyle& style) const;
  void draw_disc(const std::string& look, const Point& centre, double radius) const;
  void draw_number(const Point& centre, std::size_t ball) const;
  void draw_other_ends(const Trajectory& trajectory, const LineStyle& style) const;

  const Scenario& scene_;
  const View& view_;
  const Canvas& canvas_;
  bool first_;
  Cast cast_;  ///< as it is at the end
};

/// A sheet between two parallel lines that reach beyond the picture, or nothing where it is not seen edge-on.
std::string Picture::sheet(const Vec3& normal, double offset, double thickness) const {
  if (view_.kind == View::Kind::over_time) {
    const double along = normal[view_.axis];
    if (std::abs(along) < 1.0) return {};
    const double near = canvas_.at(0.0, (offset - 0.5 * thickness) * along).y;
    const double far = canvas_.at(0.0, (offset + 0.5 * thickness) * along).y;
    return fmt::format("M0 {}h{}v{}H0z", px(near), px(canvas_.width), px(far - near));
  }
  if (normal.z() != 0.0) return {};
  const double reach_m = view_.x_high - view_.x_low + view_.y_high - view_.y_low;
  const Vec3 middle(0.5 * (view_.x_low + view_.x_high), 0.5 * (view_.y_low + view_.y_high), 0.0);
  const Vec3 foot = middle + (offset - normal.dot(middle)) * normal;
  const Vec3 along = reach_m * Vec3(-normal.y(), normal.x(), 0.0);
  const Vec3 half = 0.5 * thickness * normal;
  std::string data;
  for (const Vec3& corner : {Vec3(foot - half - along), Vec3(foot - half + along), Vec3(foot + half + along),
                             Vec3(foot + half - along)}) {
    const Point p = canvas_.at(corner.x(), corner.y());
    data += fmt::format("{}{} {}", data.empty() ? "M" : "L", px(p.x), px(p.y));
  }
  return data + "z";
}

void Picture::draw_sheet(const char* look, const Vec3& normal, double offset, double thickness) const {
  const std::string data = sheet(normal, offset, thickness);
  if (!data.empty()) add(canvas_.area, "path", {{"class", look}, {"d", data}});
}

void Picture::draw_box() const {
  const Point low = canvas_.at(scene_.box->min.x(), scene_.box->min.y());
  const Point high = canvas_.at(scene_.box->max.x(), scene_.box->max.y());
  add(canvas_.area, "rect",
      {{"class", "wall"},
       {"x", px(low.x)},
       {"y", px(high.y)},
       {"width", px(high.x - low.x)},
       {"height", px(low.y - high.y)}});
}

void Picture::draw_surroundings() const {
  // Seen from the front, a box ends at its corners; its walls come first.
  const bool framed = scene_.box && view_.kind == View::Kind::plane;
  if (framed) draw_box();
  for (std::size_t i = framed ? 2 * static_cast<std::size_t>(scene_.dimension) : 0; i < scene_.walls.size();
       ++i) {
    draw_sheet("wall", scene_.walls[i].normal, scene_.walls[i].offset, 0.0);
  }
  for (const Slab& slab : scene_.slabs) draw_sheet("slab", slab.normal, slab.offset, slab.thickness);
  for (const Barrier& barrier : scene_.barriers) {
    draw_sheet("barrier", barrier.normal, barrier.offset, barrier.thickness);
  }
}

void Picture::draw_truth(const Trajectory& truth) const {
  // The same in every picture of the scene, so only the first of them holds it.
  const std::string id = "truth-" + anchor_of(scene_);
  if (!first_) {
    add(canvas_.area, "use", {{"href", "#" + id}});
    return;
  }
  std::string data;
  for (std::size_t i = 0; i < std::min(truth.balls(), kDrawnPaths); ++i) {
    data += path_data(path(truth, i), points_per_path(truth));
  }
  add(canvas_.area, "path", {{"class", "truth"}, {"id", id}, {"d", data}});
}

void Picture::draw_disc(const std::string& look, const Point& centre, double radius) const {
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return;
  add(canvas_.area, "circle",
      {{"class", look},
       {"cx", px(centre.x)},
       {"cy", px(centre.y)},
       {"r", px(std::max(radius, kSmallestDot_px))}});
}

/// Over time a ball is a band as wide as its diameter: where two bands touch, the balls do.
void Picture::draw_extent(const Polyline& line, double radius, const LineStyle& style) const {
  std::string data;
  for (const Point& p : line) {
    data += fmt::format("{}{} {}", data.empty() ? "M" : "L", px(p.x), px(p.y - radius));
  }
  for (auto p = line.rbegin(); p != line.rend(); ++p)
    data += fmt::format("L{} {}", px(p->x), px(p->y + radius));
  add(canvas_.area, "path", {{"class", "extent " + style.colour_class}, {"d", data + "z"}});
}

void Picture::draw_number(const Point& centre, std::size_t ball) const {
  if (!std::isfinite(centre.x) || !std::isfinite(centre.y)) return;
  add(canvas_.area, "text", {{"class", "number middle"}, {"x", px(centre.x)}, {"y", px(centre.y + 3.5)}},
      std::to_string(ball));
}

/// Where the balls without a path end: dots drawn as points with round caps, one path for each size of dot.
void Picture::draw_other_ends(const Trajectory& trajectory, const LineStyle& style) const {
  std::map<std::string, std::string> data_of_size;
  for (std::size_t i = kDrawnPaths; i < std::min(trajectory.balls(), kDrawnEnds); ++i) {
    const Point end = at(trajectory, trajectory.frames() - 1, i);
    if (!std::isfinite(end.x) || !std::isfinite(end.y)) continue;
    const double diameter = 2.0 * std::max(radius_px(i), kSmallestDot_px);
    data_of_size[px(diameter)] += fmt::format("M{} {}h0", px(end.x), px(end.y));
  }
  for (const auto& [size, data] : data_of_size) {
    add(canvas_.area, "path",
        {{"class", "others " + style.colour_class}, {"stroke-width", size}, {"d", data}});
  }
}

void Picture::draw_run(const Trajectory& trajectory, const LineStyle& style) const {
  const std::size_t count = std::min(trajectory.balls(), kDrawnPaths);
  const std::size_t points = points_per_path(trajectory);
  const bool over_time = view_.kind == View::Kind::over_time;
  if (!over_time) draw_other_ends(trajectory, style);
  std::string data;
  for (std::size_t i = 0; i < count; ++i) {
    const Polyline line = path(trajectory, i);
    data += path_data(line, points);
    if (!over_time) continue;
    for (const Polyline& piece : pieces(line)) draw_extent(thinned(piece, points), radius_px(i), style);
  }
  if (!data.empty()) add(canvas_.area, "path", {{"class", "line " + style.colour_class}, {"d", data}});
  if (!over_time) draw_discs(trajectory, style);
}

/// Where the balls start and where they end.
void Picture::draw_discs(const Trajectory& trajectory, const LineStyle& style) const {
  for (std::size_t i = 0; i < std::min(trajectory.balls(), kDrawnPaths); ++i) {
    const Point start = at(trajectory, 0, i);
    draw_disc("start " + style.colour_class, start, first_radius_px(i));
    draw_disc("stop " + style.colour_class, at(trajectory, trajectory.frames() - 1, i), radius_px(i));
    if (trajectory.balls() > 1 && trajectory.balls() <= kNumberedBalls) draw_number(start, i);
  }
}

/// The view, widened so that a metre is as long upwards as sideways.
View to_scale(View view, double& height_px) {
  if (view.kind == View::Kind::over_time) {
    height_px = kTimeHeight_px;
    return view;
  }
  const double wide = view.x_high - view.x_low;
  const double high = view.y_high - view.y_low;
  height_px = std::clamp(kWidth_px * high / wide, kLowest_px, kHighest_px);
  const double metre_per_px = std::max(wide / kWidth_px, high / height_px);
  const double more_x = 0.5 * (metre_per_px * kWidth_px - wide);
  const double more_y = 0.5 * (metre_per_px * height_px - high);
  return {view.kind,           view.axis,           view.x_low - more_x, view.x_high + more_x,
          view.y_low - more_y, view.y_high + more_y};
}

std::string explanation(const SceneComparison& scene, const View& view) {
  std::string text = view.kind == View::Kind::over_time
                         ? fmt::format(
                               "All motion is along {0}, so {0} is drawn over time; a band is as wide as its "
                               "ball, and balls meet where bands touch.",
                               kAxisNames[view.axis])
                         : "Hollow: where a ball starts. Filled: where it ends. Sizes are true.";
  if (scene.scene->dimension == 3 && view.kind == View::Kind::plane)
    text += " Seen along z: x to the right, y up.";
  const std::size_t balls = scene.scene->balls.size();
  if (balls > kDrawnPaths) {
    text +=
        fmt::format(" Paths of the first {} of {} balls; of the others only the end.", kDrawnPaths, balls);
  }
  if (scene.truth.known()) text += " The wide pale line is the truth.";
  return text;
}

/// What one picture shows, in words.
std::string finding(const SceneComparison& scene, const RunComparison& run) {
  std::string text;
  const std::optional<double> position = run.metrics[Metric::position];
  if (position) text = fmt::format("At most {} m from the truth. ", number(*position));
  const Trajectory& trajectory = run.run.trajectory;
  const int dimension = scene.scene->dimension;
  for (std::size_t i = 0; i < std::min<std::size_t>(trajectory.balls(), 3); ++i) {
    if (!trajectory.present(0, i) || !trajectory.present(trajectory.frames() - 1, i)) continue;
    text += fmt::format("Ball {} goes from {} m to {} m. ", i,
                        coordinates(trajectory.frame(0)[i].position, dimension),
                        coordinates(trajectory.frame(trajectory.frames() - 1)[i].position, dimension));
  }
  return text;
}

void add_picture(Node parent, const SceneComparison& scene, const RunComparison& run, const View& view,
                 const Legend& legend) {
  const bool first = !parent.first_child();
  const std::string label = run.run.label();
  Node figure = add(parent, "figure", {{"class", "picture"}});
  Node caption = add(figure, "figcaption");
  legend.add_swatch(caption, label);
  add(caption, "strong", {}, label);
  double height_px = 0.0;
  const View scaled = to_scale(view, height_px);
  const bool over_time = view.kind == View::Kind::over_time;
  const Canvas canvas =
      add_canvas(figure, {"Paths in " + label, finding(scene, run)},
                 Axis::linear(scaled.x_low, scaled.x_high), Axis::linear(scaled.y_low, scaled.y_high),
                 kWidth_px, height_px, {kTicks, over_time ? "time, s" : "x, m"},
                 {kTicks, fmt::format("{}, m", over_time ? kAxisNames[view.axis] : "y")});
  const Picture picture(scene, scaled, canvas, first);
  picture.draw_surroundings();
  if (scene.truth.known()) picture.draw_truth(scene.truth.trajectory);
  picture.draw_run(run.run.trajectory, legend.style(label));
}

}  // namespace

void add_paths(Node parent, const SceneComparison& scene, const Legend& legend) {
  const bool any_ended_well = std::any_of(scene.runs.begin(), scene.runs.end(), [](const RunComparison& run) {
    return run.run.status == RunStatus::ok;
  });
  if (!any_ended_well) return;
  const View view = view_of(scene);
  add(parent, "h3", {}, "Paths");
  add(parent, "p", {{"class", "note"}}, explanation(scene, view));
  Node row = add(parent, "div", {{"class", "pictures"}});
  for (const RunComparison& run : scene.runs) {
    if (run.run.status == RunStatus::ok) add_picture(row, scene, run, view, legend);
  }
}

}  // namespace carom::page
