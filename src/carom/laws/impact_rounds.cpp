#include "carom/laws/impact_rounds.h"

#include <algorithm>
#include <cmath>

#include "carom/laws/complementarity.h"

namespace carom {

namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// Rounds after which balls are taken for wedged. A light ball between a wall and a heavy one needs
/// π/2 √(M/m) of them, Galperin's count: enough for masses 10⁷ apart.
constexpr int kMostImpactRounds = 10'000;

/// Roundings of an opening velocity, each ε of all that the velocities of both balls were changed by: twelve
/// impulses on a ball, the dot product, and the impulses themselves.
constexpr double kRoundingsOfOpening = 16.0;

/// Some of the closed contacts, with what (1) asks of each.
struct Round {
  std::vector<std::size_t> contacts;
  std::vector<double> w;
  bool approaches = false;
};

template <int Dim>
class ImpactCluster {
 public:
  ImpactCluster(World<Dim>& world, std::span<ClosedContact<Dim>> contacts)
      : world_(world), contacts_(contacts) {
    for (ClosedContact<Dim>& contact : contacts) {
      contact.impulse = 0.0;
      balls_.push_back(contact.a);
      if (!contact.wall) balls_.push_back(contact.b);
    }
    std::sort(balls_.begin(), balls_.end(), before());
    balls_.erase(std::unique(balls_.begin(), balls_.end()), balls_.end());
    for (const std::uint32_t ball : balls_) speed_.push_back(world.velocity[ball].norm());
  }

  Round next_round(AtRest at_rest) const {
    Round round;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      const double u = opening(contacts_[c]);
      const bool approaches = u < -rounding(contacts_[c]);
      const bool rests = std::abs(u) <= rounding(contacts_[c]);
      if (!can_open(contacts_[c]) || !(approaches || (rests && at_rest == AtRest::takes_part))) continue;
      round.contacts.push_back(c);
      round.w.push_back(approaches ? (1.0 + contacts_[c].restitution) * u : u);
      round.approaches = round.approaches || approaches;
    }
    return round;
  }

  Round stopping_round() const {
    Round round;
    for (std::size_t c = 0; c < contacts_.size(); ++c) {
      if (!can_open(contacts_[c])) continue;
      round.contacts.push_back(c);
      round.w.push_back(opening(contacts_[c]));
    }
    return round;
  }

  void resolve(const Round& round) {
    const auto count = static_cast<Index>(round.contacts.size());
    const VectorXd w = VectorXd::Map(round.w.data(), count);
    VectorXd u(count);
    VectorXd roundings(count);
    for (Index k = 0; k < count; ++k) {
      u[k] = opening(contact_of(round, k));
      roundings[k] = rounding(contact_of(round, k));
    }
    const Complementary found = solve_complementarity(normals(round), w, roundings);
    const VectorXd impulses = share_without_gain(found, u) * found.impulse;
    for (Index k = 0; k < count; ++k) push(contact_of(round, k), impulses[k]);
  }

 private:
  ClosedContact<Dim>& contact_of(const Round& round, Index k) const {
    return contacts_[round.contacts[static_cast<std::size_t>(k)]];
  }

  /// A share s of impulses λ changes the energy by s λᵀu + ½ s² λᵀA λ. All of it is taken unless rounding, or
  /// sweeps that were cut off, would gain by it.
  static double share_without_gain(const Complementary& found, const VectorXd& u) {
    const double spent = found.impulse.dot(u);
    const double gained = 0.5 * found.impulse.dot(found.change);
    return spent + gained > 0.0 ? std::max(0.0, -spent / gained) : 1.0;
  }

  /// u of a contact, m/s.
  double opening(const ClosedContact<Dim>& contact) const {
    if (contact.wall) return contact.normal.dot(world_.velocity[contact.a]);
    return contact.normal.dot(world_.velocity[contact.b] - world_.velocity[contact.a]);
  }

  bool can_open(const ClosedContact<Dim>& contact) const {
    return world_.inverse_mass[contact.a] > 0.0 || (!contact.wall && world_.inverse_mass[contact.b] > 0.0);
  }

  double rounding(const ClosedContact<Dim>& contact) const {
    const double speeds = speed_[number_of(contact.a)] + (contact.wall ? 0.0 : speed_[number_of(contact.b)]);
    return kRoundingsOfOpening * kEpsilon * speeds;
  }

  /// Of a ball among those of the cluster.
  std::size_t number_of(std::uint32_t ball) const {
    const auto found = std::lower_bound(balls_.begin(), balls_.end(), ball, before());
    return static_cast<std::size_t>(found - balls_.begin());
  }

  auto before() const {
    return [this](std::uint32_t a, std::uint32_t b) { return world_.before(a, b); };
  }

  /// B of solve_complementarity().
  Eigen::SparseMatrix<double> normals(const Round& round) const {
    std::vector<Eigen::Triplet<double>> entries;
    const auto add = [&](std::uint32_t ball, Index column, const Vec<Dim>& normal) {
      const double weight = std::sqrt(world_.inverse_mass[ball]);
      const auto row = Dim * static_cast<Index>(number_of(ball));
      for (int axis = 0; axis < Dim; ++axis) entries.emplace_back(row + axis, column, weight * normal[axis]);
    };
    const auto columns = static_cast<Index>(round.contacts.size());
    for (Index column = 0; column < columns; ++column) {
      const ClosedContact<Dim>& contact = contact_of(round, column);
      add(contact.a, column, contact.wall ? contact.normal : Vec<Dim>(-contact.normal));
      if (!contact.wall) add(contact.b, column, contact.normal);
    }
    Eigen::SparseMatrix<double> matrix(Dim * static_cast<Index>(balls_.size()), columns);
    matrix.setFromTriplets(entries.begin(), entries.end());
    return matrix;
  }

  void push(ClosedContact<Dim>& contact, double impulse) {
    contact.impulse += impulse;
    if (contact.wall) {
      push_ball(contact.a, contact.normal, impulse);
    } else {
      push_ball(contact.a, -contact.normal, impulse);
      push_ball(contact.b, contact.normal, impulse);
    }
  }

  void push_ball(std::uint32_t ball, const Vec<Dim>& normal, double impulse) {
    const double change = world_.inverse_mass[ball] * impulse;
    world_.velocity.set(ball, world_.velocity[ball] + change * normal);
    speed_[number_of(ball)] += change;
  }

  World<Dim>& world_;
  std::span<ClosedContact<Dim>> contacts_;
  std::vector<std::uint32_t> balls_;  ///< of the cluster, sorted by their numbers
  std::vector<double> speed_;  ///< m/s: of each, with all that it was changed by; what rounding goes by
};

}  // namespace

template <int Dim>
void resolve_in_rounds(World<Dim>& world, std::span<ClosedContact<Dim>> contacts, AtRest at_rest) {
  ImpactCluster<Dim> cluster(world, contacts);
  for (int count = 0; count < kMostImpactRounds; ++count) {
    const Round round = cluster.next_round(at_rest);
    if (!round.approaches) return;
    cluster.resolve(round);
  }
  cluster.resolve(cluster.stopping_round());
}

template void resolve_in_rounds<2>(World<2>&, std::span<ClosedContact<2>>, AtRest);
template void resolve_in_rounds<3>(World<3>&, std::span<ClosedContact<3>>, AtRest);

}  // namespace carom
