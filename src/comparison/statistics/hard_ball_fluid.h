#pragma once

#include <array>

namespace carom::fluid {

// A fluid of equal hard balls (dimension 3) or disks (dimension 2) in equilibrium. η is the fraction of the
// volume (area) that they fill, n their number density, σ their diameter, m a mass and T a temperature in
// units of energy: ½ T for each degree of freedom. Away from freezing, which kDensest stays below.

/// The packing up to which the formulas below hold: short of freezing at 0.494 in space (W. G. Hoover,
/// F. H. Ree, J. Chem. Phys. 49, 3609, 1968), and of the hexatic phase at 0.70 in the plane (E. P. Bernard,
/// W. Krauth, Phys. Rev. Lett. 107, 155704, 2011).
constexpr double densest(int dimension) {
  return dimension == 3 ? 0.49 : 0.69;
}

/// Z = p/(n T).
/// 3D: N. F. Carnahan, K. E. Starling, J. Chem. Phys. 51, 635 (1969): Z = (1+η+η²-η³)/(1-η)³ (1).
/// 2D: D. Henderson, Mol. Phys. 30, 971 (1975): Z = (1+η²/8)/(1-η)² (2).
double compressibility(int dimension, double packing);

/// d(η Z)/dη of (1) and (2).
double compressibility_slope(int dimension, double packing);

/// How far Z may be off, as a share of it: its distance from a better equation.
/// 3D: T. Boublík, I. Kolafa (T. Boublík, Mol. Phys. 59, 371, 1986): -⅔η³(1+η) for -η³ in (1).
/// 2D: S. Luding, Phys. Rev. E 63, 042201 (2001): χ less by η³/(128 (1-η)⁴).
double compressibility_error(int dimension, double packing);

/// The value χ of the pair distribution at contact, by Z = 1 + 2^{d-1} η χ. It is (1-η/2)/(1-η)³ in 3D and
/// (1-7η/16)/(1-η)² in 2D.
double contact_value(int dimension, double packing);

/// Collisions of one ball per second, Enskog: 3D 4 n σ² χ √(πT/m), 2D 2 n σ χ √(πT/m) (3).
/// S. Chapman, T. G. Cowling, The Mathematical Theory of Non-Uniform Gases, 3rd ed. (1970), ch. 16.
double collision_rate_per_s(int dimension, double packing, double diameter_m, double temperature_J,
                            double mass_kg);

/// The tension γ/T of a flat hard wall, 1/m² (1/m in 2D), counted from the plane that the centres reach: what
/// the fluid's grand potential has per area beyond -p V. From scaled particle theory (H. Reiss, H. L. Frisch,
/// E. Helfand, J. L. Lebowitz, J. Chem. Phys. 32, 119, 1960): the work W(R) to open a cavity for a ball whose
/// centre keeps others at a distance R is -T ln(1 - n v(R)) up to R = σ/2, a polynomial ending in p v(R)
/// beyond, and W, W' and (3D) W'' are continuous; γ is the coefficient that goes with the surface:
///   3D: γ/T = -(9/2πσ²) η²(1+η)/(1-η)³,  2D: γ/T = -(16/3π²σ) η²/(1-η)² (4).
/// For thin gases γ/T = -¼ n² ∫ |x| over |x| < σ exactly, -(π/8) n²σ⁴ in 3D, as (4) has it, and -⅓ n²σ³ in
/// 2D, where the areas of overlapping disks are no polynomials and the theory gives -(π/8) n²σ³: there (4) is
/// what the theory gives, -(2/πσ) η²/(1-η)², times 8/(3π).
double wall_tension(int dimension, double packing, double diameter_m);

/// d/dη of (4).
double wall_tension_slope(int dimension, double packing, double diameter_m);

/// How far (4) may be off, as a share of it: in 2D by as much as it was corrected; and it stands with the
/// pressure of its own theory, 3D Z = (1+η+η²)/(1-η)³, 2D 1/(1-η)²; with (1) or (2) in its place γ/T differs
/// by n σ/2 |ΔZ|.
double wall_tension_error(int dimension, double packing);

/// A fluid in a box with smooth hard walls.
struct Boxed {
  double bulk_packing = 0.0;     ///< far from the walls
  double wall_force_N = 0.0;     ///< the mean force on all walls, summed over them
  double pair_virial_J_s = 0.0;  ///< σ times the impulse of all ball-ball impacts in a second, J/s = W
  double force_error = 0.0;      ///< how far the force may be off, as a share of it
  double virial_error = 0.0;     ///< the same of the virial
};

/// N balls in a box of these sides. With V, A the volume and surface of the box that the centres reach, sides
/// ℓ = L - σ, the grand potential is Ω = -p V + γ A + edges and corners, so that
///   N = n V - n (γ'/p') A (5),   F_i = p V/ℓ_i - γ ∂A/∂ℓ_i (6)
/// (primes by density) tell the density n far from the walls and the force on each wall across i; and by the
/// virial theorem, exactly,
///   d N T = Σ F_i ℓ_i - W (7).
/// The allowance: the error of Z; γ off by its own error and by the share that edges and corners have in the
/// second virial coefficient of the box, the integral of Π (ℓ_i - |x_i|) over |x| < σ: in a cube
/// (16/15)/π σ/ℓ of the surface's in 3D, (3/16) σ/ℓ in 2D; and 1/N, for N is fixed here and (5) lets it
/// vary.
/// @pre the sides are longer than σ; N fits at less than densest()
Boxed boxed_fluid(int dimension, double count, const std::array<double, 3>& sides_m, double diameter_m,
                  double temperature_J);

}  // namespace carom::fluid
