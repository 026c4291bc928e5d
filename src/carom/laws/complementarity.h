#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>

namespace carom {

/// The impulses of contacts that act on each other, and what they change.
struct Complementary {
  Eigen::VectorXd impulse;  ///< λ, N s
  Eigen::VectorXd change;   ///< BᵀB λ, m/s: of each contact's opening velocity
};

/// Finds pushes that leave no contact below its aim, and push nowhere else:
///   λ >= 0,  w' = w + BᵀB λ >= 0,  λᵀw' = 0.                                          (1)
/// Column c of B is the normal of contact c, weighted by the balls' 1/√m: with y = √m v the velocities of all
/// balls, Bᵀy are the opening velocities, and B λ is what impulses λ do to y. w is by how much each contact
/// opens faster than it must. (1) says that y' is the nearest point to y in the cone (polyhedron) of what the
/// contacts allow, so y' is unique; λ is not where contacts support each other redundantly.
/// Source: R. W. Cottle, J.-S. Pang, R. E. Stone, "The Linear Complementarity Problem" (1992), §1.2 and §5.2.
///
/// Up to kMostPivoted contacts it is solved by pivoting, beyond them by sweeps; both to rounding.
/// @param rounding  of each contact, m/s: as much below 0 is not below it
/// @pre no column of B is zero
Complementary solve_complementarity(const Eigen::SparseMatrix<double>& normals, const Eigen::VectorXd& w,
                                    const Eigen::VectorXd& rounding);

/// Pivoting ends after finitely many steps, whatever the contacts, but each costs a factorization, O(n³), and
/// there are about n of them: 32 contacts in a row take 0.7 ms, 64 of them 10 ms. Sweeps with a solution of
/// the pushing contacts as equations take 0.2 ms for 65 and 70 ms for 1000, also to rounding, but how many
/// passes they need is not bounded by anything that is known.
inline constexpr Eigen::Index kMostPivoted = 32;

/// The two methods by themselves.
Complementary solve_by_pivoting(const Eigen::SparseMatrix<double>& normals, const Eigen::VectorXd& w,
                                const Eigen::VectorXd& rounding);
Complementary solve_by_sweeps(const Eigen::SparseMatrix<double>& normals, const Eigen::VectorXd& w,
                              const Eigen::VectorXd& rounding);

/// Sweeps that begin from impulses `start` >= 0 near the solution; w is without them.
Complementary solve_by_sweeps_from(const Eigen::VectorXd& start, const Eigen::SparseMatrix<double>& normals,
                                   const Eigen::VectorXd& w, const Eigen::VectorXd& rounding);

}  // namespace carom
