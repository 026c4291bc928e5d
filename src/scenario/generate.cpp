#include "scenario/generate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "core/random.h"
#include "scenario/place.h"

namespace carom {

namespace {

/// A stated packing and stated radii agree when they do to this relative amount: box sides and radii are
/// written with two or three digits.
constexpr double kPackingAgrees = 0.01;

double volume(double radius, int dimension) {
  if (dimension == 2) return std::numbers::pi * radius * radius;
  return 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
}

/// x^(1/dimension) by correctly rounded operations only (std::cbrt may round differently elsewhere).
/// Newton's iteration for y³ = x, y ← (2y + x/y²)/3, started above the root and run until it stops falling.
double root(double x, int dimension) {
  if (dimension == 2) return std::sqrt(x);
  double y = std::max(1.0, x);
  while (true) {
    const double next = (2.0 * y + x / (y * y)) / 3.0;
    if (!(next < y)) return y;
    y = next;
  }
}

double box_volume(const Scenario& scene) {
  double product = 1.0;
  for (int axis = 0; axis < scene.dimension; ++axis) product *= scene.box->max[axis] - scene.box->min[axis];
  return product;
}

std::vector<double> draw_radii(const Generator& g, Scenario& scene, Random& random) {
  const auto [low, high] = g.radius.value_or(std::pair(1.0, 1.0));
  std::vector<double> radii(g.count);
  for (double& radius : radii) radius = low < high ? random.uniform(low, high) : low;
  if (!g.packing) return radii;

  double total = 0.0;
  for (const double radius : radii) total += volume(radius, scene.dimension);
  const double drawn = total / box_volume(scene);
  if (g.radius && std::abs(drawn - *g.packing) <= kPackingAgrees * *g.packing) return radii;
  const double scale = root(*g.packing / drawn, scene.dimension);
  for (double& radius : radii) radius *= scale;
  if (g.radius) {
    scene.notes.push_back(fmt::format(
        "balls: radius and count fill {:.4g} of the box; every radius was multiplied by {:.6g} so "
        "that packing is {}",
        drawn, scale, *g.packing));
  }
  return radii;
}

std::vector<Ball> with_masses(const Generator& g, const Scenario& scene, const std::vector<double>& radii) {
  std::vector<Ball> balls(radii.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    balls[i].radius = radii[i];
    balls[i].mass = g.density ? *g.density * volume(radii[i], scene.dimension) : g.mass.value_or(1.0);
    balls[i].inertia = g.inertia;
  }
  return balls;
}

/// Maxwell's distribution: each component normal with variance T/m, the total momentum then taken out, and
/// the whole scaled so that the root of the mean square speed is the one asked for.
void give_speeds(const Generator& g, int dimension, Random& random, std::vector<Ball>& balls) {
  if (g.speed > 0.0) {
    Vec3 momentum = Vec3::Zero();
    double mass = 0.0;
    for (Ball& ball : balls) {
      for (int axis = 0; axis < dimension; ++axis)
        ball.velocity[axis] = random.normal() / std::sqrt(ball.mass);
      momentum += ball.mass * ball.velocity;
      mass += ball.mass;
    }
    double square = 0.0;
    for (Ball& ball : balls) {
      ball.velocity -= momentum / mass;
      square += ball.velocity.squaredNorm();
    }
    const double scale = g.speed / std::sqrt(square / static_cast<double>(balls.size()));
    for (Ball& ball : balls) ball.velocity *= scale;
  }
  if (g.velocity) {
    for (Ball& ball : balls) ball.velocity += *g.velocity;
  }
}

/// A row of balls, equal gaps between surfaces; with a box and no gap they are spread over it evenly.
void place_line(const Generator& g, const Scenario& scene, std::vector<Ball>& balls) {
  const Vec3 direction = g.direction.value_or(Vec3::UnitX()).stableNormalized();
  double diameters = 0.0;
  for (const Ball& ball : balls) diameters += 2.0 * ball.radius;

  double gap = g.gap.value_or(2.0 * balls.front().radius);
  Vec3 first = g.position.value_or(Vec3::Zero());
  if (scene.box && !g.position) {
    const Vec3 extent = scene.box->max - scene.box->min;
    const double length = extent.dot(direction.cwiseAbs());
    if (!g.gap) gap = (length - diameters) / static_cast<double>(balls.size() + 1);
    const double occupied = diameters + gap * static_cast<double>(balls.size() - 1);
    first = 0.5 * (scene.box->min + scene.box->max) + (balls.front().radius - 0.5 * occupied) * direction;
  }
  if (gap < 0.0) throw DoesNotFit(fmt::format("a line of {} balls is longer than the box", balls.size()));

  double along = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    if (i > 0) along += balls[i - 1].radius + gap + balls[i].radius;
    balls[i].position = first + along * direction;
  }
}

/// A lattice as a rectangular grid of sites, in units of the distance between nearest neighbours: all of the
/// sites, or every other one, like the black fields of a chessboard (those with an even sum of indices).
struct Lattice {
  Vec3 spacing = Vec3::Ones();
  bool chessboard = false;
  Eigen::Vector3i growth = Eigen::Vector3i::Ones();  ///< of a block without a box, in sites

  bool has(int x, int y, int z) const { return !chessboard || (x + y + z) % 2 == 0; }

  /// How many of the sites of a block are taken; the first one, in the corner, always is.
  double count_in(const Eigen::Vector3i& shape) const {
    const double sites = shape.cast<double>().prod();
    return chessboard ? std::ceil(0.5 * sites) : sites;
  }
};

/// The closest packings on a chessboard. Plane: rows √3/2 apart, each shifted by half a distance against the
/// one below, so (±1, ±1) is at √((1/2)² + (√3/2)²) = 1, as (±2, 0) is. Space: corners and face centres of
/// cubes with the edge √2, so the sites are 1/√2 apart and (±1, ±1, 0) is at √(1/2 + 1/2) = 1.
Lattice lattice_of(const Generator& g, int dimension) {
  if (g.arrangement == Generator::Arrangement::cubic) return {};
  if (dimension == 3) return {Vec3::Constant(std::sqrt(0.5)), true};
  return {Vec3(0.5, 0.5 * std::numbers::sqrt3, 1.0), true, Eigen::Vector3i(2, 1, 1)};
}

/// How many sites along each axis: the smallest block that holds the balls, or as many as the box takes when
/// the first and the last site are half a pitch from its walls.
Eigen::Vector3i lattice_shape(const Generator& g, const Scenario& scene, const Lattice& lattice,
                              double pitch) {
  Eigen::Vector3i shape = lattice.growth;
  if (scene.box) {
    for (int axis = 0; axis < scene.dimension; ++axis) {
      const double extent = scene.box->max[axis] - scene.box->min[axis];
      const double spacing = lattice.spacing[axis];
      const double between = std::floor(extent / (spacing * pitch) - 1.0 / spacing);
      shape[axis] = static_cast<int>(std::clamp(between + 1.0, 0.0, 1e6));
    }
    return shape;
  }
  while (lattice.count_in(shape) < static_cast<double>(g.count)) {
    for (int axis = 0; axis < scene.dimension; ++axis) shape[axis] += lattice.growth[axis];
  }
  return shape;
}

/// The widest pitch at which the box still takes all the balls; each is half a pitch or more from the walls.
double widest_pitch(const Generator& g, const Scenario& scene, const Lattice& lattice, double least) {
  double low = least;
  double high = (scene.box->max - scene.box->min).maxCoeff();
  const auto fits = [&](double pitch) {
    return lattice.count_in(lattice_shape(g, scene, lattice, pitch)) >= static_cast<double>(g.count);
  };
  // Bisection down to neighbouring doubles takes fewer halvings than a double has bits.
  for (int halving = 0; halving < 64 && low < high; ++halving) {
    const double middle = 0.5 * (low + high);
    (fits(middle) ? low : high) = middle;
  }
  return low;
}

/// The balls on the sites of the lattice, x fastest, the first one at `first`.
void fill_sites(const Lattice& lattice, const Eigen::Vector3i& shape, const Vec3& first, double pitch,
                std::vector<Ball>& balls) {
  const Vec3 spacing = pitch * lattice.spacing;
  auto ball = balls.begin();
  for (int z = 0; z < shape[2]; ++z) {
    for (int y = 0; y < shape[1]; ++y) {
      for (int x = 0; x < shape[0]; ++x) {
        if (!lattice.has(x, y, z)) continue;
        if (ball == balls.end()) return;
        ball->position = first + spacing.cwiseProduct(Vec3(x, y, z));
        ++ball;
      }
    }
  }
}

/// A lattice in its arrangement; with a box and no gap as wide as the box allows.
void place_lattice(const Generator& g, const Scenario& scene, std::vector<Ball>& balls) {
  const Lattice lattice = lattice_of(g, scene.dimension);
  double largest = 0.0;
  for (const Ball& ball : balls) largest = std::max(largest, ball.radius);
  double pitch = 2.0 * largest + g.gap.value_or(scene.box ? 0.0 : 2.0 * largest);
  const double most = lattice.count_in(lattice_shape(g, scene, lattice, pitch));
  if (most < static_cast<double>(balls.size())) {
    throw DoesNotFit(fmt::format("the box holds {} balls on a lattice, not {}", most, balls.size()));
  }
  if (scene.box && !g.gap) pitch = widest_pitch(g, scene, lattice, pitch);

  const Vec3 corner = scene.box ? Vec3(scene.box->min) : Vec3(Vec3::Zero());
  Vec3 first = Vec3::Zero();
  for (int axis = 0; axis < scene.dimension; ++axis) first[axis] = corner[axis] + 0.5 * pitch;
  if (g.position) first = *g.position;
  fill_sites(lattice, lattice_shape(g, scene, lattice, pitch), first, pitch, balls);
}

/// @throws DoesNotFit where the gap beside a ball is negative by more than the rounding of its coordinates:
/// balls may be meant to touch.
void check_gap(const Ball& ball, double gap, double other_size, std::string_view does) {
  const double rounding = 8.0 * std::numeric_limits<double>::epsilon() *
                          (ball.position.cwiseAbs().sum() + std::abs(other_size) + ball.radius);
  if (gap >= -rounding) return;
  throw DoesNotFit(fmt::format("a ball at ({:.6g}, {:.6g}, {:.6g}) {} by {:.3g} m", ball.position.x(),
                               ball.position.y(), ball.position.z(), does, -gap));
}

void check_solids(const Scenario& scene, const std::vector<Ball>& balls) {
  for (const Ball& ball : balls) {
    for (const Wall& wall : scene.walls) {
      check_gap(ball, wall.normal.dot(ball.position) - wall.offset - ball.radius, wall.offset,
                "reaches behind a wall");
    }
    const auto check_beside = [&](const auto& sheet, std::string_view does) {
      const double distance =
          std::abs(sheet.normal.dot(ball.position) - sheet.offset) - 0.5 * sheet.thickness;
      check_gap(ball, distance - ball.radius, sheet.offset, does);
    };
    for (const Slab& slab : scene.slabs) check_beside(slab, "reaches into a slab");
    for (const Barrier& barrier : scene.barriers) check_beside(barrier, "reaches into a barrier");
  }
}

/// Balls against those that are there already. Sorted by their lower ends along x, only those whose extents
/// meet are looked at.
void check_others(const Scenario& scene, const std::vector<Ball>& balls) {
  std::vector<Ball> others = scene.balls;
  const auto low = [](const Ball& ball) { return ball.position.x() - ball.radius; };
  const auto by_low = [&](const Ball& a, const Ball& b) { return low(a) < low(b); };
  std::sort(others.begin(), others.end(), by_low);
  double widest = 0.0;
  for (const Ball& other : others) widest = std::max(widest, 2.0 * other.radius);
  for (const Ball& ball : balls) {
    Ball first = ball;
    first.position.x() -= widest;
    for (auto other = std::lower_bound(others.begin(), others.end(), first, by_low);
         other != others.end() && low(*other) <= ball.position.x() + ball.radius; ++other) {
      const double distance = (ball.position - other->position).norm();
      check_gap(ball, distance - ball.radius - other->radius, other->position.cwiseAbs().sum(),
                "overlaps another ball");
    }
  }
}

}  // namespace

std::vector<Ball> generate(const Generator& g, Scenario& scene) {
  Random random(g.seed);
  const std::vector<double> radii = draw_radii(g, scene, random);
  std::vector<Vec3> places;
  // Before the balls are made: of a million of them the search takes as much memory as they do.
  if (g.kind == Generator::Kind::gas) places = place_at_random(radii, scene, random);
  std::vector<Ball> balls = with_masses(g, scene, radii);
  switch (g.kind) {
    case Generator::Kind::gas:
      for (std::size_t i = 0; i < balls.size(); ++i) balls[i].position = places[i];
      break;
    case Generator::Kind::line:
      place_line(g, scene, balls);
      break;
    case Generator::Kind::lattice:
      place_lattice(g, scene, balls);
      break;
  }
  // Lines and lattices stand where they are told to, so they are checked; a gas is placed free of overlap.
  if (g.kind != Generator::Kind::gas) {
    check_solids(scene, balls);
    check_others(scene, balls);
  }
  give_speeds(g, scene.dimension, random, balls);
  return balls;
}

}  // namespace carom
