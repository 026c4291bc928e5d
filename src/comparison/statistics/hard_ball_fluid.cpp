#include "comparison/statistics/hard_ball_fluid.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace carom::fluid {

namespace {

constexpr double kPi = std::numbers::pi;

double volume_of_ball(int dimension, double diameter_m) {
  return dimension == 3 ? kPi / 6.0 * diameter_m * diameter_m * diameter_m
                        : kPi / 4.0 * diameter_m * diameter_m;
}

/// What 2D scaled particle theory lacks in thin gases.
constexpr double kThinDisks = 8.0 / (3.0 * kPi);

double cube(double x) {
  return x * x * x;
}

/// The box that the centres reach.
struct Room {
  std::array<double, 3> sides_m{};
  double volume = 1.0;
  double surface = 0.0;

  Room(int dimension, const std::array<double, 3>& box_m, double diameter_m) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
      sides_m[i] = box_m[i] - diameter_m;
      volume *= sides_m[i];
    }
    for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i)
      surface += 2.0 * volume / sides_m[i];
  }

  /// ∂A/∂ℓ_i: the faces that are not across i grow with ℓ_i.
  double surface_slope(std::size_t i) const { return (surface - 2.0 * volume / sides_m[i]) / sides_m[i]; }
};

/// (5) and (6) with γ times a factor.
class Solution {
 public:
  Solution(int dimension, double count, const Room& room, double diameter_m, double tension_factor)
      : dimension_(dimension), diameter_m_(diameter_m), factor_(tension_factor), room_(room) {
    // N grows with the packing, so it can be bisected until no double lies between.
    double low = 0.0;
    double high = 1.0;
    while (true) {
      packing = 0.5 * (low + high);
      if (packing <= low || packing >= high) return;
      (count_at(packing) < count ? low : high) = packing;
    }
  }

  double packing = 0.0;

  double pressure() const {  // by T
    return packing / volume_of_ball(dimension_, diameter_m_) * compressibility(dimension_, packing);
  }
  double tension() const { return factor_ * wall_tension(dimension_, packing, diameter_m_); }  // by T

 private:
  double count_at(double eta) const {
    const double n = eta / volume_of_ball(dimension_, diameter_m_);
    const double pressure_slope =
        compressibility_slope(dimension_, eta) / volume_of_ball(dimension_, diameter_m_);
    const double tension_slope = factor_ * wall_tension_slope(dimension_, eta, diameter_m_);
    return n * (room_.volume - tension_slope / pressure_slope * room_.surface);
  }

  int dimension_;
  double diameter_m_;
  double factor_;
  const Room& room_;
};

struct Forces {
  double on_walls = 0.0;  // by T
  double virial = 0.0;    // Σ F_i ℓ_i by T
};

Forces forces_of(int dimension, const Room& room, const Solution& solution) {
  Forces forces;
  for (std::size_t i = 0; i < static_cast<std::size_t>(dimension); ++i) {
    const double side = room.sides_m[i];
    const double force =
        solution.pressure() * room.volume / side - solution.tension() * room.surface_slope(i);
    forces.on_walls += 2.0 * force;
    forces.virial += force * side;
  }
  return forces;
}

}  // namespace

double compressibility(int dimension, double eta) {
  if (dimension == 3) return (1.0 + eta + eta * eta - cube(eta)) / cube(1.0 - eta);
  return (1.0 + eta * eta / 8.0) / ((1.0 - eta) * (1.0 - eta));
}

double compressibility_slope(int dimension, double eta) {
  if (dimension == 3) {
    const double numerator = 1.0 + 4.0 * eta + 4.0 * eta * eta - 4.0 * cube(eta) + cube(eta) * eta;
    return numerator / (cube(1.0 - eta) * (1.0 - eta));
  }
  const double numerator = (1.0 + 3.0 / 8.0 * eta * eta) * (1.0 - eta) + 2.0 * (eta + cube(eta) / 8.0);
  return numerator / cube(1.0 - eta);
}

double compressibility_error(int dimension, double eta) {
  const double z = compressibility(dimension, eta);
  if (dimension == 3) {
    const double better = -2.0 / 3.0 * cube(eta) * (1.0 + eta);
    return std::abs(better + cube(eta)) / cube(1.0 - eta) / z;
  }
  const double less = cube(eta) / (128.0 * cube(1.0 - eta) * (1.0 - eta));
  return 2.0 * eta * less / z;
}

double contact_value(int dimension, double eta) {
  if (dimension == 3) return (1.0 - eta / 2.0) / cube(1.0 - eta);
  return (1.0 - 7.0 * eta / 16.0) / ((1.0 - eta) * (1.0 - eta));
}

double collision_rate_per_s(int dimension, double eta, double diameter_m, double temperature_J,
                            double mass_kg) {
  const double n = eta / volume_of_ball(dimension, diameter_m);
  const double speed = std::sqrt(kPi * temperature_J / mass_kg);
  const double cross_section = dimension == 3 ? 4.0 * diameter_m * diameter_m : 2.0 * diameter_m;
  return n * cross_section * contact_value(dimension, eta) * speed;
}

double wall_tension(int dimension, double eta, double diameter_m) {
  if (dimension == 3) {
    return -9.0 / (2.0 * kPi * diameter_m * diameter_m) * eta * eta * (1.0 + eta) / cube(1.0 - eta);
  }
  return -kThinDisks * 2.0 / (kPi * diameter_m) * eta * eta / ((1.0 - eta) * (1.0 - eta));
}

double wall_tension_slope(int dimension, double eta, double diameter_m) {
  if (dimension == 3) {
    const double slope = (2.0 * eta + 4.0 * eta * eta) / (cube(1.0 - eta) * (1.0 - eta));
    return -9.0 / (2.0 * kPi * diameter_m * diameter_m) * slope;
  }
  return -kThinDisks * 2.0 / (kPi * diameter_m) * 2.0 * eta / cube(1.0 - eta);
}

double wall_tension_error(int dimension, double eta) {
  // In units of σ = 1.
  const double own =
      dimension == 3 ? (1.0 + eta + eta * eta) / cube(1.0 - eta) : 1.0 / ((1.0 - eta) * (1.0 - eta));
  const double n = eta / volume_of_ball(dimension, 1.0);
  const double off = 0.5 * n * std::abs(own - compressibility(dimension, eta));
  const double corrected = dimension == 3 ? 0.0 : 1.0 - kThinDisks;
  return corrected + off / std::abs(wall_tension(dimension, eta, 1.0));
}

Boxed boxed_fluid(int dimension, double count, const std::array<double, 3>& sides_m, double diameter_m,
                  double temperature_J) {
  const Room room(dimension, sides_m, diameter_m);
  const Solution solution(dimension, count, room, diameter_m, 1.0);
  const double shortest =
      *std::min_element(room.sides_m.begin(), room.sides_m.begin() + static_cast<std::ptrdiff_t>(dimension));
  const double edges = (dimension == 3 ? 16.0 / (15.0 * kPi) : 3.0 / 16.0) * diameter_m / shortest;
  const double tension_error = wall_tension_error(dimension, solution.packing) + edges;
  const Solution other(dimension, count, room, diameter_m, 1.0 + tension_error);

  const Forces forces = forces_of(dimension, room, solution);
  const Forces others = forces_of(dimension, room, other);
  const double ideal = dimension * count;
  const double of_z = compressibility_error(dimension, solution.packing) * forces.virial;
  Boxed result;
  result.bulk_packing = solution.packing;
  result.wall_force_N = temperature_J * forces.on_walls;
  result.pair_virial_J_s = temperature_J * (forces.virial - ideal);
  result.force_error = std::abs(others.on_walls / forces.on_walls - 1.0) + of_z / forces.virial + 1.0 / count;
  result.virial_error =
      (std::abs(others.virial - forces.virial) + of_z) / (forces.virial - ideal) + 1.0 / count;
  return result;
}

}  // namespace carom::fluid
