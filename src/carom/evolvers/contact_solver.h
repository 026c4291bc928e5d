#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "carom/laws/complementarity.h"
#include "carom/world.h"

namespace carom {

/// A contact that is kept closed: ball a and ball b, or ball a and plane b.
template <int Dim>
struct KeptContact {
  std::uint32_t a;
  std::uint32_t b;
  bool wall;
  Vec<Dim> normal;                   ///< unit; from a to b, or from the plane to ball a
  double friction = 0.0;             ///< μ
  double least = 0.0;                ///< what u_n may not fall below, in the unit of u
  Vec<Dim> slip = Vec<Dim>::Zero();  ///< unit direction in which the contact slides; zero where it may stick
  double push = 0.0;  ///< λ >= 0 along the normal, kg × the unit of u: on b, or on a from a plane
  Vec<Dim> drag = Vec<Dim>::Zero();  ///< the tangential part
};

/// Contacts that stay closed, solved together: balls that lie on a wall, on each other, or in a pile.
///
/// Given a column u of vectors (velocities, or accelerations) and, with friction, a column w of spins (or
/// their accelerations), pushes are found such that for every contact
///   0 <= λ  ⊥  u_n - u_min >= 0,                                                      (1)
///   |T| <= μ λ, and T ends the slip g, or is μ λ against it,                          (2)
/// with g the tangential part of (u_b - w_b × r_b n) - (u_a + w_a × r_a n). A linear complementarity problem
/// with Coulomb's cone, taken on by projected Gauss–Seidel sweeps
///   λ ← max(0, λ - ω (u_n - u_min)/Σ 1/m),  T ← T - g/Σ (1/m + r²/I) cut to μ λ.      (3)
/// For velocities that is the perfectly inelastic impact of all contacts at once, which cannot gain energy
/// where u_min <= 0: it is the projection onto a convex set that contains rest. For accelerations it is
/// statics. Source: R. W. Cottle, J.-S. Pang, R. E. Stone, "The Linear Complementarity Problem" (1992), §5.2;
/// for the cone J. J. Moreau, "Unilateral contact and dry friction in finite freedom dynamics" (1988).
template <int Dim, bool kFriction>
class ContactSolver {
 public:
  using Contact = KeptContact<Dim>;

  /// Sweeps to do: as many as it takes.
  static constexpr int kUntilSolved = std::numeric_limits<int>::max();

  std::vector<Contact>& contacts() { return contacts_; }
  const std::vector<Contact>& contacts() const { return contacts_; }

  /// Lets the pushes that stand in contacts() act on u and w: from there solve() goes on.
  template <class Response>
  void start(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
             const Response& response) const {
    for (const Contact& contact : contacts_) {
      apply(world, u, w, response, contact, contact.push * contact.normal + contact.drag);
    }
  }

  /// Changes u and w until (1) and (2) hold; returns false where they do not come to hold. Contacts whose
  /// direction of slip is given may have no solution at all (P. Painlevé's paradox). @pre the pushes that
  /// stand in contacts() have acted.
  /// @param response   of a ball, 1/kg: what a unit of push changes of its u
  /// @param tolerance  in u's unit: sweeps end once none changes a u_n by more, or by more than the pushes
  /// round
  /// @param sweeps     kUntilSolved, or so few that they are all that is done: a first guess
  template <class Response>
  bool solve(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
             const Response& response, double tolerance, int sweeps) {
    double largest_change = std::numeric_limits<double>::infinity();
    double rounding = tolerance;
    double first_change = 0.0;
    for (int sweep = 0; sweep < std::min(kMostSweeps, sweeps) && largest_change > rounding; ++sweep) {
      if (sweep == 1) first_change = largest_change;
      if (!(largest_change <= kDiverged * first_change) && sweep > 1) return false;
      largest_change = 0.0;
      rounding = tolerance;
      for (Contact& contact : contacts_) {
        double change = relax_push(world, u, w, response, contact, relaxation(sweep));
        if constexpr (kFriction) {
          if (contact.friction > 0.0) change = std::max(change, relax_drag(world, u, w, response, contact));
        }
        largest_change = std::max(largest_change, change);
        const double size = contact.push * sum_of_responses(response, contact);
        rounding = std::max(rounding, kRoundings * kEpsilon * size);
      }
    }
    if (sweeps != kUntilSolved) return largest_change <= rounding;
    if constexpr (!kFriction) {
      if (largest_change > rounding) solve_directly(world, u, w, response, rounding);
      return true;
    }
    return largest_change <= rounding;
  }

  /// How fast the contact opens, in u's unit.
  static double opening(const Contact& contact, const VectorColumn<Dim>& u) {
    return contact.normal.dot(contact.wall ? u[contact.a] : Vec<Dim>(u[contact.b] - u[contact.a]));
  }

  /// The slip g of the surfaces: of b against a, or of ball a against the plane.
  static Vec<Dim> slip(const World<Dim>& world, const Contact& contact, const VectorColumn<Dim>& u,
                       const VectorColumn<kSpinAxes<Dim>>& w) {
    Vec<Dim> g = surface(world, contact, contact.a, contact.wall ? -1.0 : 1.0, u, w);
    if (!contact.wall) g = surface(world, contact, contact.b, -1.0, u, w) - g;
    return g - contact.normal.dot(g) * contact.normal;
  }

 private:
  /// From the pushes of the step before, few sweeps do. Without friction what they leave is solved directly;
  /// Coulomb's cone is left to them alone.
  static constexpr int kMostSweeps = kFriction ? 2000 : 64;
  /// Sweeps that change more than the first by this factor do not converge.
  static constexpr double kDiverged = 1e3;
  /// Of a push, in units of ε: up to twelve neighbours push as much on each ball of a contact.
  static constexpr double kRoundings = 4.0;

  /// ω of (3). With ω = 1 a row of n balls takes about n² sweeps for each factor e, with the best ω < 2, that
  /// nears 2 as rows grow, about n. Which it is nobody knows beforehand, so it nears 2 as the sweeps go on;
  /// any sequence in (0, 2) converges. Coulomb's cone does not bear it.
  static double relaxation(int sweep) {
    if constexpr (kFriction) return 1.0;
    constexpr double kRamp = 16.0;  // sweeps in which what is near settles by itself
    return 2.0 - 1.0 / (1.0 + sweep / kRamp);
  }

  /// (1) by complementarity.h, for many contacts from where the sweeps have come to.
  template <class Response>
  void solve_directly(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                      const Response& response, double rounding) {
    std::vector<std::uint32_t> balls;
    for (const Contact& contact : contacts_) {
      apply(world, u, w, response, contact, -contact.push * contact.normal);
      balls.push_back(contact.a);
      if (!contact.wall) balls.push_back(contact.b);
    }
    std::sort(balls.begin(), balls.end());
    balls.erase(std::unique(balls.begin(), balls.end()), balls.end());
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](Eigen::Index column, std::uint32_t ball, const Vec<Dim>& normal) {
      const auto row = Dim * (std::lower_bound(balls.begin(), balls.end(), ball) - balls.begin());
      const Vec<Dim> weighted = std::sqrt(response(ball)) * normal;
      for (int axis = 0; axis < Dim; ++axis) entries.emplace_back(row + axis, column, weighted[axis]);
    };
    const auto count = static_cast<Eigen::Index>(contacts_.size());
    Eigen::VectorXd above(count);
    Eigen::VectorXd pushes(count);
    for (Eigen::Index c = 0; c < count; ++c) {
      const Contact& contact = contacts_[static_cast<std::size_t>(c)];
      add(c, contact.a, contact.wall ? contact.normal : Vec<Dim>(-contact.normal));
      if (!contact.wall) add(c, contact.b, contact.normal);
      above[c] = opening(contact, u) - contact.least;
      pushes[c] = contact.push;
    }
    Eigen::SparseMatrix<double> normals(Dim * static_cast<Eigen::Index>(balls.size()), count);
    normals.setFromTriplets(entries.begin(), entries.end());
    const Eigen::VectorXd roundings = Eigen::VectorXd::Constant(count, rounding);
    const Complementary found = count <= kMostPivoted
                                    ? solve_by_pivoting(normals, above, roundings)
                                    : solve_by_sweeps_from(pushes, normals, above, roundings);
    for (Eigen::Index c = 0; c < count; ++c) {
      Contact& contact = contacts_[static_cast<std::size_t>(c)];
      contact.push = found.impulse[c];
      apply(world, u, w, response, contact, contact.push * contact.normal);
    }
  }

  static Vec<Dim> surface(const World<Dim>& world, const Contact& contact, std::uint32_t ball, double side,
                          const VectorColumn<Dim>& u, const VectorColumn<kSpinAxes<Dim>>& w) {
    return u[ball] + turned<Dim>(w[ball], (side * world.radius[ball]) * contact.normal);
  }

  template <class Response>
  static double sum_of_responses(const Response& response, const Contact& contact) {
    return response(contact.a) + (contact.wall ? 0.0 : response(contact.b));
  }

  /// Returns by how much it changed u_n.
  template <class Response>
  static double relax_push(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                           const Response& response, Contact& contact, double relaxation) {
    const double sum = sum_of_responses(response, contact);
    const double missing = contact.least - opening(contact, u);
    const double push = std::max(0.0, contact.push + relaxation * missing / sum);
    const double change = push - contact.push;
    contact.push = push;
    Vec<Dim> pull = change * contact.normal;
    if constexpr (kFriction) {
      // What slides is dragged in proportion at once: Coulomb's cone moves with the push.
      if (!contact.slip.isZero(0.0)) {
        const Vec<Dim> drag = -(contact.friction * push) * contact.slip;
        pull += drag - contact.drag;
        contact.drag = drag;
      }
    }
    apply(world, u, w, response, contact, pull);
    return std::abs(change) * sum;
  }

  /// Sticking contacts only. Returns by how much it changed the slip.
  template <class Response>
  static double relax_drag(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                           const Response& response, Contact& contact) {
    if (!contact.slip.isZero(0.0)) return 0.0;
    double sum = sum_of_responses(response, contact) + turning(world, contact.a);
    if (!contact.wall) sum += turning(world, contact.b);
    Vec<Dim> drag = contact.drag - slip(world, contact, u, w) / sum;
    const double most = contact.friction * contact.push;
    const double size = drag.norm();
    if (size > most) drag *= most / size;
    const Vec<Dim> change = drag - contact.drag;
    contact.drag = drag;
    apply(world, u, w, response, contact, change);
    return change.norm() * sum;
  }

  static double turning(const World<Dim>& world, std::uint32_t ball) {
    return world.radius[ball] * world.radius[ball] * world.inverse_inertia[ball];
  }

  /// Adds what an impulse does: on b and against a, or from the plane on a.
  template <class Response>
  static void apply(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                    const Response& response, const Contact& contact, const Vec<Dim>& impulse) {
    const double sign = contact.wall ? 1.0 : -1.0;
    u.set(contact.a, u[contact.a] + (sign * response(contact.a)) * impulse);
    if (!contact.wall) u.set(contact.b, u[contact.b] + response(contact.b) * impulse);
    if constexpr (kFriction) {
      // Both arms carry the same moment: (r_a n) × (-J) = (-r n) × J, and the normal part has none.
      turn(world, w, contact.a, contact.normal, impulse);
      if (!contact.wall) turn(world, w, contact.b, contact.normal, impulse);
    }
  }

  static void turn(const World<Dim>& world, VectorColumn<kSpinAxes<Dim>>& w, std::uint32_t ball,
                   const Vec<Dim>& normal, const Vec<Dim>& impulse) {
    const Vec<Dim> arm = -world.radius[ball] * normal;
    w.set(ball, w[ball] + world.inverse_inertia[ball] * moment<Dim>(arm, impulse));
  }

  std::vector<Contact> contacts_;
};

}  // namespace carom
