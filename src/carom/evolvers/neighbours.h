#pragma once

#include <memory>
#include <vector>

#include "carom/broad_phase/broad_phase.h"

namespace carom {

/// How far each ball may get in a step, and so which balls may meet: the broad phase, and what it looks at.
template <int Dim, class Balls>
class Neighbours {
 public:
  Neighbours(const Balls& flights, std::unique_ptr<BroadPhase<Dim>> broad_phase)
      : flights_(flights),
        broad_phase_(std::move(broad_phase)),
        start_(flights.size()),
        bound_(flights.size(), 0.0) {}

  void begin_step() {
    start_ = flights_.world().position;
    for (std::size_t i = 0; i < flights_.size(); ++i) {
      bound_[i] = flights_.world().radius[i] + flights_.path_bound(i, flights_.step_s());
    }
    broad_phase_->build(start_, bound_);
  }

  void find_pairs(std::vector<BallPair>& pairs) const { broad_phase_->find_pairs(pairs); }

  void find_near(std::size_t ball, std::vector<std::uint32_t>& others) const {
    broad_phase_->find_near(ball, others);
  }

  /// After a new flight has begun: tells the broad phase where it may lead. Returns whether the ball may meet
  /// more than before.
  bool widen(std::size_t ball) {
    const double moved = (flights_.world().position[ball] - start_[ball]).norm();
    const double bound =
        flights_.world().radius[ball] + moved + flights_.path_bound(ball, flights_.left_s(ball));
    if (bound <= bound_[ball]) return false;
    bound_[ball] = bound;
    broad_phase_->bound_grew(ball);
    return true;
  }

  std::string_view name() const { return broad_phase_->name(); }

 private:
  const Balls& flights_;
  std::unique_ptr<BroadPhase<Dim>> broad_phase_;
  VectorColumn<Dim> start_;    ///< positions when the step began
  std::vector<double> bound_;  ///< m, see the broad phases
};

}  // namespace carom
