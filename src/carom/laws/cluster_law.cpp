#include "carom/laws/cluster_law.h"

#include "carom/laws/generalized_reflections.h"
#include "carom/laws/simultaneous.h"

namespace carom {

template <int Dim>
std::unique_ptr<ClusterLaw<Dim>> make_cluster_law(const Scenario& scene) {
  switch (scene.multi_contact) {
    case MultiContact::sequential:
      return nullptr;
    case MultiContact::simultaneous:
      return std::make_unique<Simultaneous<Dim>>();
    case MultiContact::generalized_reflections:
      return std::make_unique<GeneralizedReflections<Dim>>();
  }
  return nullptr;
}

template std::unique_ptr<ClusterLaw<2>> make_cluster_law<2>(const Scenario&);
template std::unique_ptr<ClusterLaw<3>> make_cluster_law<3>(const Scenario&);

}  // namespace carom
