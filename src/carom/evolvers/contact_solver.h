#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "carom/evolvers/kept_contact.h"
#include "carom/laws/complementarity.h"
#include "carom/laws/cone.h"
#include "carom/world.h"

namespace carom {

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
  template <class Response>
  bool solve(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
             const Response& response, double tolerance) {
    Course course = sweep(world, u, w, response, tolerance, kMostSweeps);
    if constexpr (!kFriction) {
      if (!course.converged()) solve_directly(world, u, w, response, course.rounding);
      return true;
    } else {
      const int attempts = contacts_.size() <= kFewContacts ? kMostAttemptsOfFew : kMostAttempts;
      for (int attempt = 0; !course.converged() && attempt < attempts; ++attempt) {
        if (solve_cone_directly(world, u, w, response, tolerance)) return true;
        course = sweep(world, u, w, response, tolerance, kMostSweeps);
        if (course.diverged) return false;
      }
      return course.converged();
    }
  }

  /// The first guess at a solution: some sweeps.
  template <class Response>
  void guess(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
             const Response& response, double tolerance, int sweeps) {
    sweep(world, u, w, response, tolerance, sweeps);
  }

  /// Like solve(), but of (2) only what comes out after kMostTurns turns of (1), exactly, with the drags as
  /// they are, and sweeps over both. The last is (1): nothing overlaps, however friction may differ.
  template <class Response>
  void solve_openings(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                      const Response& response, double tolerance) {
    Course course = sweep(world, u, w, response, tolerance, kMostSweeps);
    if (course.converged()) return;
    if constexpr (kFriction) {
      if (contacts_.size() <= kFewContacts && solve_cone_directly(world, u, w, response, tolerance)) return;
      for (int turn = 0; turn < kMostTurns; ++turn) {
        solve_directly(world, u, w, response, course.rounding);
        course = sweep(world, u, w, response, tolerance, kSweepsInATurn);
        if (course.converged()) return;
      }
    }
    solve_directly(world, u, w, response, course.rounding);
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
  /// From the pushes of the step before, few sweeps do. What they leave is solved directly.
  static constexpr int kMostSweeps = 64;
  /// Newton's method on Coulomb's cone, and sweeps that bring it nearer, by turns. What two turns do not
  /// solve for many contacts goes to the crowd; few cost little.
  static constexpr int kMostAttempts = 2;
  static constexpr int kMostAttemptsOfFew = 12;
  static constexpr std::size_t kFewContacts = 16;
  /// See solve_openings().
  static constexpr int kMostTurns = 3;
  static constexpr int kSweepsInATurn = 24;
  /// Sweeps that change more than the first by this factor do not converge.
  static constexpr double kDiverged = 1e3;
  /// Of a push, in units of ε: up to twelve neighbours push as much on each ball of a contact.
  static constexpr double kRoundings = 4.0;

  /// How a number of sweeps went.
  struct Course {
    double change = std::numeric_limits<double>::infinity();  ///< the largest of the last sweep, in u's unit
    double rounding = 0.0;
    bool diverged = false;
    bool converged() const { return !diverged && change <= rounding; }
  };

  template <class Response>
  Course sweep(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
               const Response& response, double tolerance, int sweeps) {
    Course course;
    double first_change = 0.0;
    for (int sweep = 0; sweep < sweeps && !(course.change <= course.rounding); ++sweep) {
      if (sweep == 1) first_change = course.change;
      course.diverged = sweep > 1 && !(course.change <= kDiverged * first_change);
      if (course.diverged) return course;
      course.change = 0.0;
      course.rounding = tolerance;
      for (Contact& contact : contacts_) {
        double change = relax_push(world, u, w, response, contact, relaxation(sweep));
        if constexpr (kFriction) {
          if (contact.friction > 0.0) change = std::max(change, relax_drag(world, u, w, response, contact));
        }
        course.change = std::max(course.change, change);
        const double size = contact.push * sum_of_responses(response, contact);
        course.rounding = std::max(course.rounding, kRoundings * kEpsilon * size);
      }
    }
    return course;
  }

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
    const auto count = static_cast<Eigen::Index>(contacts_.size());
    Eigen::VectorXd pushes(count);
    Eigen::VectorXd above(count);
    for (Eigen::Index c = 0; c < count; ++c) {
      pushes[c] = number(c).push;
      exchange(world, u, w, response, number(c), number(c).drag);
    }
    for (Eigen::Index c = 0; c < count; ++c) above[c] = opening(number(c), u) - number(c).least;
    const Eigen::SparseMatrix<double> normals = directions_of<1, Dim>(contacts_, world, response);
    const Eigen::VectorXd roundings = Eigen::VectorXd::Constant(count, rounding);
    const Complementary found = count <= kMostPivoted
                                    ? solve_by_pivoting(normals, above, roundings)
                                    : solve_by_sweeps_from(pushes, normals, above, roundings);
    for (Eigen::Index c = 0; c < count; ++c) {
      const Vec<Dim> impulse = found.impulse[c] * number(c).normal + number(c).drag;
      exchange(world, u, w, response, number(c), impulse);
    }
  }

  /// (1) and (2) by cone.h, from where the sweeps have come to.
  template <class Response>
  bool solve_cone_directly(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                           const Response& response, double tolerance) {
    const auto count = static_cast<Eigen::Index>(contacts_.size());
    ConeProblem problem{Dim,
                        directions_of<Dim, Dim>(contacts_, world, response),
                        Eigen::VectorXd(Dim * count),
                        Eigen::VectorXd(count),
                        Eigen::VectorXd(Dim * count),
                        tolerance};
    Eigen::VectorXd impulse(Dim * count);
    for (Eigen::Index c = 0; c < count; ++c) {
      const Frame<Dim> frame = frame_of<Dim>(number(c));
      impulse.segment<Dim>(Dim * c) =
          frame.transpose() * (number(c).push * number(c).normal + number(c).drag);
      problem.slip.segment<Dim>(Dim * c) = frame.transpose() * number(c).slip;
      problem.slip[Dim * c] = 0.0;
      problem.friction[c] = number(c).friction;
    }
    for (Eigen::Index c = 0; c < count; ++c) exchange(world, u, w, response, number(c), Vec<Dim>::Zero());
    for (Eigen::Index c = 0; c < count; ++c) {
      problem.w.segment<Dim>(Dim * c) = frame_of<Dim>(number(c)).transpose() * slip(world, number(c), u, w);
      problem.w[Dim * c] = opening(number(c), u) - number(c).least;
    }
    const bool solved = solve_cone(problem, impulse);
    for (Eigen::Index c = 0; c < count; ++c) {
      // Rounding, and steps that were halved, may leave a pull.
      if (impulse[Dim * c] < 0.0) impulse.segment<Dim>(Dim * c).setZero();
      const Vec<Dim> found = frame_of<Dim>(number(c)) * impulse.segment<Dim>(Dim * c);
      exchange(world, u, w, response, number(c), found);
    }
    return solved;
  }

  Contact& number(Eigen::Index c) { return contacts_[static_cast<std::size_t>(c)]; }

  /// Puts another impulse in the place of the contact's.
  template <class Response>
  static void exchange(const World<Dim>& world, VectorColumn<Dim>& u, VectorColumn<kSpinAxes<Dim>>& w,
                       const Response& response, Contact& contact, const Vec<Dim>& impulse) {
    const Vec<Dim> change = impulse - (contact.push * contact.normal + contact.drag);
    contact.push = contact.normal.dot(impulse);
    contact.drag = impulse - contact.push * contact.normal;
    apply(world, u, w, response, contact, change);
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
