#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace carom {

/// Contacts with Coulomb friction that act on each other. Each has `axes` components: the first along its
/// normal, the others along the surface.
struct ConeProblem {
  Eigen::Index axes;
  /// B: column axes·c + k is direction k of contact c, weighted by the balls' 1/√m and 1/√I. BᵀB r is what
  /// impulses r change the contacts' velocities by.
  Eigen::SparseMatrix<double> directions;
  Eigen::VectorXd w;  ///< velocities without impulses; along the normal less what they may not fall below
  Eigen::VectorXd friction;  ///< μ, of each contact
  /// Unit direction in which the contact slides, `axes` components of each contact, the first is 0; all are 0
  /// where it may stick.
  Eigen::VectorXd slip;
  double rounding;  ///< in w's unit: as much is 0
};

/// Finds impulses r = (λ, T) of each contact with w' = w + BᵀB r, so that
///   0 <= λ  ⊥  w'_n >= 0,                                                              (1)
///   T = P(T - w'_t/W_t), P the projection onto |T| <= μ λ, where it may stick,         (2)
///   T = -μ λ s  where it slides along s,                                               (3)
/// W_n and W_t being the diagonal of W = BᵀB. (2) says that T ends the slip, or is μ λ against it. Newton's
/// method on the piecewise smooth equations (1) to (3) of the contacts with λ - w'_n/W_n > 0, the others have
/// r = 0; a step is halved as often as it takes to lower the sum of squares of what the equations miss, each
/// times its W. Redundant contacts leave W singular: each solution is drawn to the last one by the share p of
/// the diagonal, which is nothing where the iteration ends; p rises where no part of a step is of use. Where
/// that ends too early, whole steps are tried from the start. The method may fail, and then says so. Source:
/// P. Alart, A. Curnier, "A mixed formulation for frictional contact problems prone to Newton like solution
/// methods", Comput. Methods Appl. Mech. Eng. 92, 353 (1991), eqs. (20)-(24); for the damping V. Acary, M.
/// Brémond, O. Huber, "On solving contact problems with Coulomb friction: formulations and numerical
/// comparisons" (2018), §5. Not theirs: the radius of (2) is μ λ and not μ (λ - w'_n/W_n), the same where the
/// iteration ends.
///
/// @param impulse  where to start; replaced by the best that was found
/// @return whether it solves the problem to rounding
bool solve_cone(const ConeProblem& problem, Eigen::VectorXd& impulse);

/// By how much an impulse misses the equations, in units of what rounding explains: solved up to 1.
double cone_residual(const ConeProblem& problem, const Eigen::VectorXd& impulse);

}  // namespace carom
