#pragma once

#include <cstdint>

#include "reference/measured/measure.h"

namespace carom::measured {

// A hard-sphere fluid in a box with hard walls, σ = m = T = 1 (Boltzmann's constant with T), measured as if
// the walls were not there. Nothing here asks a scene for periodic boundaries, which Carom does not have.

/// What was measured, and the density far from the walls in two ways that know nothing of each other.
struct FluidMeasurement {
  Measurement compressibility;      ///< Z = P/(n T)
  Measurement density_by_theory;    ///< n σ³
  Measurement density_by_counting;  ///< n σ³
};

/// Z of the fluid far from walls, by counting the impacts of N spheres.
///
/// The box is made so that the density far from its walls is about the one asked for. With L the side that
/// centres have, V = L³, A = 6 L² and the excess Γ of spheres at a wall and ε at an edge,
///   N = n V + Γ(n) A + ε(n) 12 L.                                                                        (1)
/// Γ is from scaled-particle theory, whose wall tension about the centres' limit is
///   γ = -(9/2π) η² (1 + η)/(1 - η)³ T/σ²,  η = π n/6 (2)
/// (H. Reiss, H. L. Frisch, E. Helfand, J. L. Lebowitz, J. Chem. Phys. 32, 119 (1960)), by Gibbs' Γ = -∂γ/∂μ,
/// with ∂μ/∂n of Carnahan and Starling:
///   Γ σ² = (9/2π)(2 η² + 4 η³)/(1 + 4 η + 4 η² - 4 η³ + η⁴). (3)
/// An edge is curvature in one line: what that costs a sphere of radius R, in the same theory, is 18 y³ T R/σ
/// with y = η/(1 - η), an integral of the mean curvature of 4πR. That of a box is 3πL, seen from inside, so
/// that
///   Ω_e = -(27/2) y³ T L/σ,  ε σ = (27/8) η³/(1 + 4 η + 4 η² - 4 η³ + η⁴). (4)
/// (P. M. König, R. Roth, K. R. Mecke, Phys. Rev. Lett. 93, 160601 (2004), on why curvature is enough.)
///
/// The average pressure on the walls follows from counts without any account of impulses, by the virial
/// theorem and Maxwell's distribution, both exact: two spheres exchange √(π m T) on average, so that with R
/// impacts of two spheres a second
///   3 P_w V = 3 N T + σ √(π m T) R. (5)
/// On a wall of finite size it is larger than in the fluid, by the work that widening a wall and lengthening
/// an edge costs,
///   P_w = P - 4 γ/L - ∂Ω_e/∂V,  ∂Ω_e/∂V = -(9/2) y³ T/(σ L²). (6)
///
/// The density n that P belongs to is known in two ways, and the one with the smaller uncertainty is taken:
/// - from (1); its uncertainty is the share by which scaled-particle theory is off in what is known, its
///   pressure (1 + η + η²)/(1 - η)³ against Carnahan-Starling's, of Γ A/V, and all of ε 12 L/V, for (4) knows
///   nothing of how sharp edges are.
/// - by counting centres in a window that begins 3 σ from where centres are stopped and opens as
///   sin² over 2 σ. The layers at a wall are about σ apart, so that such a ramp is blind to them. Its
///   uncertainty is twice the standard error and what a window shows that begins σ further inside.
/// Z is then moved from there to the density asked for along Carnahan and Starling's Z(n), by less than 1 %
/// of n, and theirs is right to 0.2 %.
///
/// The uncertainty of Z: twice the standard error of R; that of n times (1 + d ln Z/d ln n) Z/n;
/// scaled-particle theory's share of the term with γ and all of that with Ω_e; and 1/N, for the energy of N
/// spheres is fixed and Maxwell's distribution is its limit. Standard errors are those of blocks of time, or
/// of pairs of blocks where those are larger. A block is as long as sound needs across the box, L/√(∂P/∂n),
/// because what is uneven evens out no sooner; the window is looked at ten times in each.
FluidMeasurement measure_fluid(const Fluid& fluid, const Runner& run);

/// t₀ = √π/(6 (Z - 1)), exact for hard spheres: collisions are what pressure is made of.
Measurement mean_free_time(const Measurement& compressibility);

/// The scene: N spheres on a simple cubic lattice with Maxwell's velocities, five blocks of time to forget
/// it, then the blocks that are measured. Simple cubic, for it stands at any density of the fluid and is
/// stable at none: at n σ³ = 0.9 it is gone within 30 collisions of each sphere, a third of a block, while a
/// face-centred one, which is what hard spheres freeze into, took about eight blocks to melt (N = 10,000).
Scenario fluid_scene(const Fluid& fluid);

/// The box without spheres, made by (1).
Scenario fluid_box(const Fluid& fluid);

/// t₀ by Carnahan and Starling: to choose durations by, s.
double collision_time(double density);

/// Impacts of two spheres. @throws std::runtime_error where the runner does not tell those on walls apart.
std::int64_t impacts_of_pairs(const Tally& tally);

}  // namespace carom::measured
