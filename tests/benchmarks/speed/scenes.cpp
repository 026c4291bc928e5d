#include "tests/benchmarks/speed/scenes.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "scenario/parse.h"

namespace carom::benchmark {

namespace {

constexpr double kRadius_m = 0.5;
/// Between the surfaces of balls in a corner.
constexpr double kGap_m = 0.05;
/// Of a box whose balls are in one corner, by the side of their lattice.
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
  const double per_axis = std::ceil(std::pow(static_cast<double>(balls), 1.0 / layout.dimension));
  if (layout.in_a_corner) return kEmptiness * per_axis * (2.0 * kRadius_m + kGap_m);
  const double volume = static_cast<double>(balls) * mean_power(layout) * unit_volume(layout.dimension) *
                        std::pow(kRadius_m, layout.dimension);
  return std::pow(volume / layout.packing, 1.0 / layout.dimension);
}

/// The same number along each axis: "[0, 0, 0]".
std::string along_axes(int dimension, double value) {
  const std::string one = fmt::format("{}", value);
  return "[" + one + ", " + one + (dimension == 3 ? ", " + one : "") + "]";
}

std::string placing(const Layout& layout) {
  if (layout.in_a_corner) {
    return fmt::format("kind = \"lattice\"\nposition = {}\ngap = {}\nradius = {}\n",
                       along_axes(layout.dimension, kRadius_m + kGap_m), kGap_m, kRadius_m);
  }
  const std::string radius = layout.size_ratio == 1.0
                                 ? fmt::format("{}", kRadius_m)
                                 : fmt::format("[{}, {}]", kRadius_m, layout.size_ratio * kRadius_m);
  return fmt::format("kind = \"gas\"\npacking = {}\nradius = {}\n", layout.packing, radius);
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
    layouts.push_back(corner);
  }
  return layouts;
}

std::string toml_of(const Layout& layout, std::size_t balls) {
  return fmt::format(
      "title = \"{} balls\"\nabout = \"What engines are timed with\"\ndimension = {}\nduration = {}\nstep = "
      "{}\n"
      "frames = 100\n[truth]\nkind = \"none\"\n[box]\nmin = {}\nmax = {}\n"
      "[[balls]]\ncount = {}\nseed = 1\nmass = 1.0\nspeed = 1.0\n{}",
      balls, layout.dimension, 1000.0 / 240.0, 1.0 / 240.0, along_axes(layout.dimension, 0.0),
      along_axes(layout.dimension, side_m(layout, balls)), balls, placing(layout));
}

Scenario scene_of(const Layout& layout, std::size_t balls) {
  return *parse_scene(toml_of(layout, balls), layout.name);
}

}  // namespace carom::benchmark
