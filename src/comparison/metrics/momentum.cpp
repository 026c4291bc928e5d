#include "comparison/metrics/momentum.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "comparison/metrics/brought.h"

namespace carom {

namespace {

/// Σ Δx of the movable balls, m, leaps by events left out: linear drag takes c times this from the momentum,
/// whatever happens on the way.
class Displacement {
 public:
  Displacement(const Scenario& scene, const Run& run) : scene_(scene), run_(run), cast_(scene) {
    for (const Ball& ball : scene.balls) homes_.push_back(ball.position);
    homes_.resize(cast_.size(), Vec3::Zero());
  }

  /// @pre frames are asked for in order
  Vec3 at_frame(std::size_t frame) {
    cast_.to_frame(static_cast<std::int64_t>(frame));
    for (; next_ < run_.interferences.size(); ++next_) {
      if (first_frame_after(scene_, scene_.events[next_]) > static_cast<std::int64_t>(frame)) break;
      for (const BallChange& change : run_.interferences[next_].changes) leap(change);
    }
    Vec3 sum = of_the_gone_;
    const auto balls = run_.trajectory.frame(frame);
    for (std::size_t i = 0; i < balls.size(); ++i) {
      if (cast_[i] && std::isfinite(cast_[i]->mass)) sum += balls[i].position - homes_[i];
    }
    return sum;
  }

 private:
  void leap(const BallChange& change) {
    Vec3& home = homes_[change.ball];
    if (!change.before) {
      home = change.after->position;
    } else if (change.after) {
      home += change.after->position - change.before->position;
    } else if (std::isfinite(change.before->mass)) {
      of_the_gone_ += change.before->position - home;
    }
  }

  const Scenario& scene_;
  const Run& run_;
  Cast cast_;
  std::vector<Vec3> homes_;
  Vec3 of_the_gone_ = Vec3::Zero();
  std::size_t next_ = 0;
};

/// Whether something outside the movable balls can push one.
bool bounded(const Scenario& scene) {
  return !scene.walls.empty() || ever(scene, [](const Ball& ball) { return std::isinf(ball.mass); });
}

/// What the momenta of one run are expected to be, frame after frame.
class Expectation {
 public:
  Expectation(const Yardstick& yardstick, const Run& run)
      : yardstick_(yardstick),
        scene_(yardstick.scene()),
        run_(run),
        brought_(brought_by_events(yardstick.reference(), run)),
        gravity_(yardstick.reference(), run),
        displacement_(scene_, run),
        bounded_(bounded(scene_)) {}

  /// N s; unknown where nothing tells what to expect.
  double momentum_error(const Conserved& now, std::size_t frame) {
    const Tally& tally = run_.trajectory.tally(frame);
    // What these take from the momentum depends on the whole path.
    const bool quadratic = scene_.effects.drag && scene_.effects.drag->kind == Drag::Kind::quadratic;
    if (quadratic || scene_.effects.magnus || !tally.external_known) {
      return yardstick_.truth_known_at(frame) ? yardstick_.momentum_off_truth(now, frame).norm() : kNotKnown;
    }
    Vec3 expected =
        yardstick_.reference().start.momentum_Ns + brought_[frame].momentum_Ns + tally.external_impulse;
    if (scene_.effects.gravity) expected += gravity_.at_frame(frame).impulse_Ns;
    if (scene_.effects.drag) expected -= scene_.effects.drag->coefficient * displacement_.at_frame(frame);
    return (now.momentum_Ns - expected).norm();
  }

  /// N m s; unknown where nothing tells what to expect.
  double angular_momentum_error(const Conserved& now, std::size_t frame) {
    if (yardstick_.truth_known_at(frame)) return yardstick_.angular_momentum_off_truth(now, frame).norm();
    const Reference& reference = yardstick_.reference();
    const Tally& tally = run_.trajectory.tally(frame);
    if (scene_.effects.drag || !tally.external_known) return kNotKnown;
    Vec3 error = now.angular_momentum_Nms - reference.start.angular_momentum_Nms -
                 brought_[frame].angular_momentum_Nms -
                 (tally.external_angular_impulse - reference.origin.cross(tally.external_impulse));
    if (!scene_.effects.gravity) return error.norm();
    if (bounded_) {
      if (scene_.dimension == 2) return kNotKnown;  // gravity lies in the plane, angular momentum across it
      return std::abs(error.dot(scene_.effects.gravity->normalized()));
    }
    error -= gravity_.at_frame(frame).angular_impulse_Nms;
    return error.norm();
  }

 private:
  const Yardstick& yardstick_;
  const Scenario& scene_;
  const Run& run_;
  std::vector<Conserved> brought_;
  GravityOverTime gravity_;
  Displacement displacement_;
  bool bounded_;
};

}  // namespace

void measure_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                      RunComparison& result) {
  Expectation expectation(yardstick, result.run);
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    result.series.momentum.push_back(yardstick.by_momentum(expectation.momentum_error(conserved[k], k)));
  }
  result.metrics[Metric::momentum] = largest(result.series.momentum);
}

void measure_angular_momentum(const Yardstick& yardstick, const std::vector<Conserved>& conserved,
                              RunComparison& result) {
  Expectation expectation(yardstick, result.run);
  std::vector<double> errors;
  for (std::size_t k = 0; k < conserved.size(); ++k) {
    errors.push_back(yardstick.by_angular_momentum(expectation.angular_momentum_error(conserved[k], k)));
  }
  result.metrics[Metric::angular_momentum] = largest(errors);
}

}  // namespace carom
