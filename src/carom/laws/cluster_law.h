#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include "carom/world.h"
#include "scenario/scenario.h"

namespace carom {

/// One of the contacts that are closed at the same moment: ball a and ball b, or ball a and wall b.
template <int Dim>
struct ClosedContact {
  std::uint32_t a;
  std::uint32_t b;
  bool wall;
  Vec<Dim> normal;       ///< unit; from a to b, or from the wall to ball a
  double restitution;    ///< e of this contact
  double impulse = 0.0;  ///< N s >= 0 along the normal, set by a law: on b, or on a where b is a wall
};

/// What balls do that touch at several points at once (frictionless). `[contact] law` of a scene names one.
template <int Dim>
class ClusterLaw {
 public:
  ClusterLaw() = default;
  ClusterLaw(const ClusterLaw&) = delete;
  ClusterLaw& operator=(const ClusterLaw&) = delete;
  virtual ~ClusterLaw() = default;

  virtual std::string_view name() const = 0;

  /// Changes the velocities of the balls so that no contact is left approaching, and says with which
  /// impulses. The contacts are in an order that does not depend on memory: by (a, wall, b).
  virtual void resolve(World<Dim>& world, std::span<ClosedContact<Dim>> contacts) const = 0;
};

/// The law that the scene asks for; null for `sequential`, where contacts are resolved pair by pair as they
/// come.
template <int Dim>
std::unique_ptr<ClusterLaw<Dim>> make_cluster_law(const Scenario& scene);

}  // namespace carom
