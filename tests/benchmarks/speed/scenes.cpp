#include "tests/benchmarks/speed/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scenario/parse.h"

namespace carom::benchmark {

namespace {

constexpr double kRadius_m = 0.5;
/// Of balls that lie in a corner, in that corner.
constexpr double kPackingInCorner = 0.2;
/// The side of a box whose balls are in one corner, by that of the corner.
constexpr double kEmptiness = 10.0;

/// Of a ball of radius 1.
double unit_volume(int dimension) {
  return dimension == 2 ? std::numbers::pi : 4.0 / 3.0 * std::numbers::pi;
}

/// ⟨r^d⟩ of radii evenly spread from the smallest to `size_ratio` times that, by the smallest^d.
double mean_power(const Layout& layout) {
  if (layout.size_ratio == 1.0) return 1.0;
  const double power = layout.dimension + 1.0;
  return (std::pow(layout.size_ratio, power) - 1.0) / (power * (layout.size_ratio - 1.0));
}

double side_m(const Layout& layout, std::size_t balls) {
  const double volume = static_cast<double>(balls) * mean_power(layout) * unit_volume(layout.dimension) *
                        std::pow(kRadius_m, layout.dimension);
  return std::pow(volume / layout.packing, 1.0 / layout.dimension);
}

/// The same number along each axis: "[0, 0, 0]".
std::string along_axes(int dimension, double value) {
  const std::string one = fmt::format("{}", value);
  return "[" + one + ", " + one + (dimension == 3 ? ", " + one : "") + "]";
}

std::string radii(const Layout& layout) {
  return layout.size_ratio == 1.0 ? fmt::format("{}", kRadius_m)
                                  : fmt::format("[{}, {}]", kRadius_m, layout.size_ratio * kRadius_m);
}

/// Puts a box around the scene that is wider than the one that its balls fill. The walls of that go on
/// standing, so that the balls stay in their corner, where they would fill all the room in time.
void leave_in_a_corner(Scenario& scene) {
  scene.box->max *= kEmptiness;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    scene.walls.push_back({-Vec3::Unit(axis), -scene.box->max[axis]});
  }
}

}  // namespace

Layout gas(int dimension) {
  return {dimension == 2 ? "plane" : "space", dimension};
}

Layout hard_sphere_gas() {
  return {"space, nσ³ = 0.5", 3, std::numbers::pi / 12.0};
}

std::vector<Layout> growth_layouts() {
  std::vector<Layout> layouts;
  for (const int dimension : {2, 3}) {
    const Layout equal = gas(dimension);
    layouts.push_back(equal);
    Layout mixed = equal;
    mixed.name += ", radii 1:20";
    mixed.size_ratio = 20.0;
    layouts.push_back(mixed);
    Layout corner = equal;
    corner.name += ", in a corner";
    corner.in_a_corner = true;
    corner.packing = kPackingInCorner;
    layouts.push_back(corner);
  }
  return layouts;
}

std::string toml_of(const Layout& layout, std::size_t balls) {
  return fmt::format(
      "title = \"{} balls\"\nabout = \"What engines are timed with\"\ndimension = {}\nduration = {}\nstep = "
      "{}\n"
      "frames = 100\n[truth]\nkind = \"none\"\n[box]\nmin = {}\nmax = {}\n"
      "[[balls]]\nkind = \"gas\"\ncount = {}\nseed = 1\nmass = 1.0\nspeed = 1.0\npacking = {}\nradius = {}\n",
      balls, layout.dimension, 1000.0 / 240.0, 1.0 / 240.0, along_axes(layout.dimension, 0.0),
      along_axes(layout.dimension, side_m(layout, balls)), balls, layout.packing, radii(layout));
}

Scenario scene_of(const Layout& layout, std::size_t balls) {
  Scenario scene = *parse_scene(toml_of(layout, balls), layout.name);
  if (layout.in_a_corner) leave_in_a_corner(scene);
  return scene;
}

}  // namespace carom::benchmark
