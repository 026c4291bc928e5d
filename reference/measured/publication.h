#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace carom::measured {

/// What the ball meets, with its lowest point.
enum class Partner {
  wall,
  equal,     ///< a ball like it, at rest
  mirrored,  ///< a ball like it, with the opposite velocity and the opposite spin
  heavy,     ///< a ball of five times its radius and 1000 times its density, at rest
};

/// One impact in the plane: a solid sphere comes down on its partner.
struct Impact {
  double radius_m = 0.1;
  double normal_mps = 1.0;      ///< along -y, > 0
  double tangential_mps = 0.0;  ///< along x
  double spin_radps = 0.0;      ///< about z
  double restitution = 1.0;
  double friction = 0.0;
  double tangential_restitution = 0.0;
  Partner partner = Partner::wall;
};

/// A fluid of hard spheres with diameter σ = 1, mass 1 and temperature 1.
struct Fluid {
  double density = 0.5;      ///< n σ³, far from walls
  std::size_t count = 2000;  ///< spheres
  double collisions = 0.0;   ///< of each since the start, for what is measured at one moment
  std::int64_t blocks = 20;  ///< of time, for what is measured on the average; not in the file
};

enum class Quantity {
  restitution,       ///< -v_n'/v_n
  tangential_ratio,  ///< the ball's v_x' by v_x
  tangential,        ///< the ball's v_x', m/s
  spin,              ///< the ball's, after, rad/s
  beta,              ///< -g_t'/g_t, of the slip where the two touch
  scaled_slip,       ///< g_t'/(μ v_n')
  scaled_spin,       ///< r ω'/(μ v_n)
  friction,          ///< |J_t|/|J_n|, for solid spheres: (2/7) |Δg_t|/|Δv_n|
  compressibility,   ///< Z = P/(n T)
  mean_free_time,    ///< between two collisions of a sphere, in σ √(m/T)
  fourth_cumulant,   ///< a₂ = ⟨v⁴⟩/((5/3)⟨v²⟩²) - 1, spheres that started with equal speeds
};

/// A published number, and what to run to get it.
struct Value {
  std::string name;
  Quantity quantity = Quantity::restitution;
  std::string unit;
  std::optional<double> published;  ///< nothing: the law under test cannot give it, and `cannot` says why
  double uncertainty = 0.0;
  std::string uncertainty_from;
  std::string
      beyond;  ///< why a right engine is outside the uncertainty all the same; empty where it is inside
  std::string cannot;
  std::variant<Impact, Fluid> experiment;
};

struct Publication {
  std::string key;  ///< the file's name
  std::string title;
  std::string authors;
  std::string journal;
  int year = 0;     ///< 0: not known
  std::string doi;  ///< empty: not known, and the note says so
  std::string note;
  std::vector<Value> values;
};

/// Reads one file of this folder. @throws InputError "file:line:column: key: what is wrong, what is allowed"
Publication read_publication(const std::filesystem::path& file);

/// All of a folder, by name.
std::vector<Publication> read_publications(const std::filesystem::path& folder);

}  // namespace carom::measured
