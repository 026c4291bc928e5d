#pragma once

#include "comparison/statistics/gas.h"
#include "trajectory/trajectory.h"

namespace carom {

/// The second Sonine coefficient of a homogeneously cooling gas, by the first of their approximations
/// (T. P. C. van Noije, M. H. Ernst, Granular Matter 1, 57, 1998, eq. (20)):
///   a2 = 16 (1-e)(1-2e²)/(9 + 24d + (8d - 41)e + 30e²(1-e)) (1).
double sonine_coefficient(int dimension, double restitution);

/// The cooling rate 1/τ of Haff's law T(t) = T0/(1 + t/τ)² (2) (P. K. Haff, J. Fluid Mech. 134, 401, 1983):
///   1/τ = Γ0 (1 - e²)/(2d) (1 + 3 a2/16) (3),
/// Γ0 the collisions of a ball in a second at T0: each takes ¼ m (1 - e²) v_n² from two balls,
/// (1 - e²) T on average over those that meet, and E = dNT/2. The last factor is what the departure from
/// Maxwell's law does to the mean of v_n³.
double cooling_rate_per_s(int dimension, double restitution, double collisions_per_ball_per_s);

/// Holds the temperature in every frame against (2), as long as it is above a tenth of T0: the frame that is
/// off the most, in allowances. The first five collisions of a ball are left out, as the balls' arrangement
/// and their speeds still remember the start.
///
/// The allowance, for L = -ln(T/T0): n collisions each take an exponentially distributed part of L, for v_n²
/// of those that meet is so distributed, hence √(2/n) L (4) by chance; and the relative error of Γ0 and of
/// (3), for which all of 3 a2/16 is taken, times L.
void measure_cooling(const Gas& gas, const Trajectory& trajectory, RunStatistics& statistics);

}  // namespace carom
