#include "report/page/study_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string>

#include "report/page/canvas.h"
#include "report/page/wording.h"
#include "report/study_words.h"
#include "study/analyse.h"

namespace carom::page {

namespace {

constexpr double kStudyWidth_px = 620.0;
constexpr double kStudyHeight_px = 330.0;
constexpr double kGrowthWidth_px = 330.0;
constexpr double kGrowthHeight_px = 220.0;
constexpr int kStudyTicks = 9;
constexpr int kGrowthTicks = 6;

/// The least and the largest of what is put in.
struct Range {
  double low = std::numeric_limits<double>::infinity();
  double high = 0.0;

  void take(double value) {
    low = std::min(low, value);
    high = std::max(high, value);
  }
  Axis axis() const { return Axis::powers(low, high); }
};

void draw_line(const Canvas& canvas, const LineStyle& style, const Polyline& line) {
  if (line.size() < 2) return;
  Node path = add(canvas.area, "path", {{"class", "line " + style.colour_class}, {"d", path_data(line)}});
  if (!style.dashes.empty()) path.append_attribute("stroke-dasharray").set_value(style.dashes.c_str());
}

/// A marker that says what it is when the pointer rests on it.
void draw_marker(const Canvas& canvas, const LineStyle& style, const Point& at, bool tuned,
                 const std::string& what) {
  Node path =
      add(canvas.area, "path",
          {{"class", (tuned ? "marker tuned " : "marker ") + style.colour_class}, {"d", style.marker(at)}});
  add(path, "title", {}, what);
}

std::string description(const StudyScene& scene, const carom::Mark& mark) {
  return fmt::format("{}: {} {} in {}", words_of(scene, scene.points[mark.point]), number(mark.error),
                     unit_of(scene), time_words(mark.cpu_s.median));
}

/// Down where a run is better than all that are faster, and on to the right until one is.
Polyline staircase(const Canvas& canvas, const std::vector<carom::Mark>& front) {
  Polyline line;
  for (const carom::Mark& mark : front) {
    const Point at = canvas.at(mark.cpu_s.median, mark.error);
    if (!line.empty()) line.push_back({at.x, line.back().y});
    line.push_back(at);
  }
  if (!line.empty()) line.push_back({canvas.width, line.back().y});
  return line;
}

std::string front_in_words(const StudyScene& scene, const std::vector<carom::Mark>& front) {
  std::vector<std::string> words;
  words.reserve(front.size());
  for (const carom::Mark& mark : front) words.push_back(description(scene, mark));
  return "The front: " + list_of(words) + ".";
}

void draw_floor(const Canvas& canvas, const StudyScene& scene) {
  const double y = canvas.at(1.0, floor_of(scene)).y;
  add(canvas.area, "path", {{"class", "rule"}, {"d", fmt::format("M0 {}h{}", px(y), px(canvas.width))}});
  const char* text =
      measure_of(scene) == StudyMeasure::position_m ? "the truth is known to here" : "rounding of a double";
  add(canvas.area, "text", {{"class", "over end"}, {"x", px(canvas.width - 4.0)}, {"y", px(y - 4.0)}}, text);
}

void add_key(Node parent, const std::vector<std::string>& labels, const Legend& legend) {
  Node key = add(parent, "ul", {{"class", "key"}});
  for (const std::string& label : labels) {
    Node item = add(key, "li");
    legend.add_swatch(item, label);
    say(item, " " + label);
  }
}

std::vector<std::string> labels_of(const StudyScene& scene, const std::vector<carom::Mark>& marks) {
  std::vector<std::string> labels;
  for (const StudyEngine& engine : scene.engines) {
    const bool drawn = std::any_of(marks.begin(), marks.end(), [&](const carom::Mark& mark) {
      return scene.points[mark.point].engine == engine.label;
    });
    if (drawn) labels.push_back(engine.label);
  }
  return labels;
}

}  // namespace

void add_work_precision(Node parent, const StudyScene& scene, const Legend& legend) {
  const std::vector<carom::Mark> marks = marks_of(scene);
  const std::vector<carom::Mark> front = front_of(marks);
  Range times;
  Range errors;
  errors.take(floor_of(scene) * 0.5);  // room below it
  for (const carom::Mark& mark : marks) {
    times.take(mark.cpu_s.median);
    errors.take(mark.error);
  }
  const std::string quantity =
      measure_of(scene) == StudyMeasure::position_m ? "position error, m" : "energy error, relative";
  Node figure = add(parent, "figure", {{"class", "diagram"}});
  add(add(figure, "figcaption"), "strong", {},
      "Work and precision: the lower and the further left, the better.");
  add_key(figure, labels_of(scene, marks), legend);
  const Canvas canvas =
      add_canvas(figure, {"Error over CPU time, " + scene.title, front_in_words(scene, front)}, times.axis(),
                 errors.axis(), kStudyWidth_px, kStudyHeight_px, {kStudyTicks, "CPU time of the stepping, s"},
                 {kStudyTicks, quantity});
  add(canvas.area, "path", {{"class", "truth"}, {"d", path_data(staircase(canvas, front))}});
  draw_floor(canvas, scene);
  for (const Series& series : series_of(scene)) {
    const LineStyle style = legend.style(series.engine);
    Polyline line;
    for (const std::size_t i : series.points) {
      const auto mark =
          std::find_if(marks.begin(), marks.end(), [i](const carom::Mark& each) { return each.point == i; });
      if (mark != marks.end()) line.push_back(canvas.at(mark->cpu_s.median, mark->error));
    }
    if (series.setting.empty()) draw_line(canvas, style, line);
  }
  for (const carom::Mark& mark : marks) {
    const StudyPoint& point = scene.points[mark.point];
    draw_marker(canvas, legend.style(point.engine), canvas.at(mark.cpu_s.median, mark.error),
                !point.setting.empty(), description(scene, mark));
  }
}

void add_growth_plot(Node parent, const std::vector<StudyGrowth>& growths, const Legend& legend) {
  Range balls;
  Range times;
  std::vector<std::string> labels;
  for (const StudyGrowth& growth : growths) {
    bool any = false;
    for (const GrowthPoint& point : growth.points) {
      const std::optional<double> ns = per_ball_and_step_ns(point);
      if (!ns) continue;
      any = true;
      balls.take(static_cast<double>(point.balls));
      times.take(*ns);
    }
    if (any) labels.push_back(growth.engine);
  }
  if (labels.empty()) return;
  const std::string title = growths.front().dimension == 2 ? "Disks in the plane" : "Balls in space";
  Node figure = add(parent, "figure");
  add(add(figure, "figcaption"), "strong", {}, title + ".");
  add_key(figure, labels, legend);
  const Canvas canvas = add_canvas(figure, {title, "The numbers are in the table."}, balls.axis(),
                                   times.axis(), kGrowthWidth_px, kGrowthHeight_px, {kGrowthTicks, "balls"},
                                   {kGrowthTicks, "ns per ball and step"});
  for (const StudyGrowth& growth : growths) {
    const LineStyle style = legend.style(growth.engine);
    Polyline line;
    for (const GrowthPoint& point : growth.points) {
      const std::optional<double> ns = per_ball_and_step_ns(point);
      if (!ns) continue;
      line.push_back(canvas.at(static_cast<double>(point.balls), *ns));
      draw_marker(canvas, style, line.back(), false,
                  fmt::format("{}, {} balls: {} ns", growth.engine, point.balls, number(*ns)));
    }
    draw_line(canvas, style, line);
  }
}

}  // namespace carom::page
