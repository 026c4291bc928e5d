#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "scenario/scenario.h"

namespace carom {

/// What a [[balls]] table asks for. Unset values take the defaults stated at each member.
struct Generator {
  enum class Kind { gas, lattice, line };
  /// cubic: square in the plane. close: the densest there is, hexagonal in the plane, face-centred cubic in
  /// space.
  enum class Arrangement { cubic, close };
  Kind kind = Kind::gas;
  Arrangement arrangement = Arrangement::cubic;  ///< lattice only
  std::size_t count = 0;
  std::uint64_t seed = 0;
  std::optional<std::pair<double, double>> radius;  ///< m, drawn uniformly; without it `packing` decides
  std::optional<double> packing;                    ///< volume (area) fraction of the box; gas only
  std::optional<double> mass;                       ///< kg, default 1
  std::optional<double> density;                    ///< kg/m³ (kg/m² in 2D), instead of mass
  double inertia = 0.4;
  double speed = 0.0;             ///< m/s, root mean square, total momentum zero
  std::optional<Vec3> velocity;   ///< m/s, of every ball, added to the thermal one
  std::optional<Vec3> position;   ///< line: first centre; lattice: centre of the first ball
  std::optional<Vec3> direction;  ///< line: default x
  std::optional<double> gap;      ///< line, lattice: m between neighbouring surfaces
};

/// The balls do not fit where they should go; what() says how far one came. The file's place is not known
/// here.
class DoesNotFit : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Makes the balls of one table, free of overlap with each other, with the walls, slabs and barriers of
/// `scene` and with the balls that are in it already. The same seed gives the same bits on every machine. May
/// add a line to `scene.notes`. @throws DoesNotFit.
std::vector<Ball> generate(const Generator& generator, Scenario& scene);

}  // namespace carom
