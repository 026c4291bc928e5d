#pragma once

#include "reference/measured/measure.h"

namespace carom::measured {

/// The compressibility factor Z = P/(n T) of a hard-sphere fluid far from walls, measured by counting the
/// impacts of N spheres in a box with hard walls, σ = m = T = 1 (Boltzmann's constant with T).
///
/// The box is made so that the density far from its walls is the one asked for. With L the side that centres
/// have, V = L³, A = 6 L² and the excess Γ of spheres at a wall and ε at an edge,
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
/// The average pressure on the walls follows from the counts without any account of impulses, by the virial
/// theorem and Maxwell's distribution, both exact: a pair exchanges √(π m T) on average and a wall √(2π m T),
/// so that with R impacts a second, walls included,
///   P_w (3 V + σ A/√2) = 3 N T + σ √(π m T) R. (4)
/// On a wall of finite size it is larger than in the fluid, P_w = P - 4 γ/L, by the work that widening a wall
/// costs.
///
/// The uncertainty: twice the standard error over blocks of time; for (2) and (3) the share by which
/// scaled-particle theory is off in what is known, its pressure (1 + η + η²)/(1 - η)³ against
/// Carnahan-Starling's; and all that the edges change, for (4) knows nothing of how sharp they are.
Measurement compressibility(const Fluid& fluid, const Runner& run);

/// t₀ = √π/(6 (Z - 1)), exact for hard spheres: collisions are what pressure is made of.
Measurement mean_free_time(const Measurement& compressibility);

/// The scene: N spheres from a random start, a first frame to come to rest in equilibrium, then the blocks.
Scenario fluid_scene(const Fluid& fluid);

}  // namespace carom::measured
