#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "carom/world.h"

namespace carom {

/// Contacts that stay closed, solved together: balls that lie on a wall, on each other, or in a pile.
///
/// Given any column u of vectors (velocities, or accelerations), pushes λ_c >= 0 along the normals are found
/// such that no contact closes, u_n >= 0, and none pushes where it opens, λ_c u_n = 0: a linear
/// complementarity problem, solved by projected Gauss–Seidel sweeps
///   λ_c ← max(0, λ_c - u_n / (1/m_a + 1/m_b)),                                        (1)
/// with u kept up to date. For velocities that is the perfectly inelastic impact of all contacts at once,
/// which cannot gain energy; for accelerations it is statics. Source: R. W. Cottle, J.-S. Pang, R. E. Stone,
/// "The Linear Complementarity Problem" (1992), §5.2.
template <int Dim>
class RestingCluster {
 public:
  /// Ball a and ball b, or ball a and wall b. The normal points from a to b, or from the wall to ball a.
  struct Contact {
    std::uint32_t a;
    std::uint32_t b;
    bool wall;
    Vec<Dim> normal;
    double push = 0.0;  ///< λ of the last solve(), kg × the unit of u
  };

  void clear() { contacts_.clear(); }
  void add(const Contact& contact) { contacts_.push_back(contact); }
  const std::vector<Contact>& contacts() const { return contacts_; }

  /// Changes u so that no contact closes by more than `tolerance`, in u's unit; the pushes stay in
  /// contacts().
  /// @param inverse_mass  of a ball, 1/kg: what a unit of push changes of its u
  template <class InverseMass>
  void solve(VectorColumn<Dim>& u, const InverseMass& inverse_mass, double tolerance) {
    for (Contact& contact : contacts_) contact.push = 0.0;
    double largest_change = kEndless;
    for (int sweep = 0; sweep < kMostSweeps && largest_change > tolerance; ++sweep) {
      largest_change = 0.0;
      for (Contact& contact : contacts_) {
        largest_change = std::max(largest_change, relax(contact, u, inverse_mass));
      }
    }
  }

 private:
  /// What is left after these sweeps, a part in thousands of the weight in a pile of hundreds, is taken up by
  /// the next step.
  static constexpr int kMostSweeps = 200;
  static constexpr double kEndless = std::numeric_limits<double>::infinity();

  /// Returns by how much it changed u_n.
  template <class InverseMass>
  static double relax(Contact& contact, VectorColumn<Dim>& u, const InverseMass& inverse_mass) {
    const double inverse_a = inverse_mass(contact.a);
    const double inverse_b = contact.wall ? 0.0 : inverse_mass(contact.b);
    const double opening =
        contact.wall ? contact.normal.dot(u[contact.a]) : contact.normal.dot(u[contact.b] - u[contact.a]);
    const double push = std::max(0.0, contact.push - opening / (inverse_a + inverse_b));
    const double change = push - contact.push;
    contact.push = push;
    if (contact.wall) {
      u.set(contact.a, u[contact.a] + (change * inverse_a) * contact.normal);
    } else {
      u.set(contact.a, u[contact.a] - (change * inverse_a) * contact.normal);
      u.set(contact.b, u[contact.b] + (change * inverse_b) * contact.normal);
    }
    return std::abs(change) * (inverse_a + inverse_b);
  }

  std::vector<Contact> contacts_;
};

}  // namespace carom
