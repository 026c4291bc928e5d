#include "report/csv.h"

#include <fmt/format.h>

namespace carom {

std::string trajectory_csv(const Trajectory& trajectory) {
  std::string csv = "time,ball,x,y,z,vx,vy,vz,wx,wy,wz\n";
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    const auto balls = trajectory.frame(k);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (!trajectory.present(k, i)) continue;
      const Vec3& x = balls[i].position;
      const Vec3& v = balls[i].velocity;
      const Vec3& w = balls[i].spin;
      // "{}" prints the shortest digits that read back to the same double.
      fmt::format_to(std::back_inserter(csv), "{},{},{},{},{},{},{},{},{},{},{}\n", trajectory.time(k), i,
                     x.x(), x.y(), x.z(), v.x(), v.y(), v.z(), w.x(), w.y(), w.z());
    }
  }
  return csv;
}

}  // namespace carom
