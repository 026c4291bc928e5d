#include "carom/laws/cone.h"

#include <Eigen/SparseLU>
#include <algorithm>
#include <limits>
#include <vector>

namespace carom {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

/// Newton steps at most. Each settles which contacts stick, slide and push; where these go on changing sweeps
/// must find them.
constexpr int kMostSteps = 10;

/// Halvings of a step at most. Where they do not help, shorter steps in other directions may: see
/// kProximalStep.
constexpr int kMostHalvings = 3;

/// Of the diagonal of W, see solve_cone().
constexpr double kLeastProximal = 1e-12;
constexpr double kProximalStep = 1e6;

/// Of all that impulses add to a velocity, in units of ε: sums over a dozen contacts of a ball and three
/// axes.
constexpr double kRoundingsInEpsilon = 32.0;

class Newton {
 public:
  Newton(const ConeProblem& problem, const VectorXd& start)
      : problem_(problem),
        matrix_(problem.directions.transpose() * problem.directions),
        absolute_directions_(problem.directions.cwiseAbs()),
        diagonal_(matrix_.diagonal()),
        best_(start) {}

  /// With steps that lower what is missed; where these end too early, with whole ones.
  bool solve() {
    const VectorXd start = best_;
    if (solve_damped()) return true;
    const VectorXd damped = best_;
    best_ = start;
    proximal_ = kLeastProximal;
    measure(best_);
    for (int step = 0; step < kMostSteps && !is_solved(); ++step) {
      best_ = newton_point();
      measure(best_);
    }
    if (is_solved()) return true;
    best_ = damped;
    return false;
  }

  const VectorXd& best() const { return best_; }

  /// What the equations miss, in units of rounding.
  double residual(const VectorXd& impulse) {
    measure(impulse);
    return worst_;
  }

 private:
  bool solve_damped() {
    double least = measure(best_);
    for (int step = 0; step < kMostSteps && !is_solved(); ++step) {
      const VectorXd way = newton_point() - best_;
      double share = 1.0;
      VectorXd next = best_ + way;
      double size = measure(next);
      for (int halving = 0; halving < kMostHalvings && !(size < least); ++halving) {
        share *= 0.5;
        next = best_ + share * way;
        size = measure(next);
      }
      if (size < least) {
        least = size;
        best_ = next;
        if (share == 1.0) proximal_ = std::max(kLeastProximal, proximal_ / kProximalStep);
        continue;
      }
      measure(best_);
      if (proximal_ >= 1.0) return false;
      proximal_ *= kProximalStep;
    }
    return is_solved();
  }

  Index axes() const { return problem_.axes; }
  Index count() const { return problem_.friction.size(); }
  bool is_solved() const { return worst_ <= 1.0; }
  bool slides(Index c) const { return !problem_.slip.segment(axes() * c, axes()).isZero(0.0); }
  double pull_back(Index c, const VectorXd& impulse) const {
    return impulse[axes() * c] - velocity_[axes() * c] / diagonal_[axes() * c];
  }

  /// T - w'_t/W_t.
  VectorXd aim(Index c, const VectorXd& impulse) const {
    const Index first = axes() * c + 1;
    const Index tangents = axes() - 1;
    return impulse.segment(first, tangents) - velocity_.segment(first, tangents) / yield(c);
  }

  /// W_t: one for both axes of the surface, which it is but for rounding.
  double yield(Index c) const { return diagonal_[axes() * c + 1]; }

  /// Sum of squares of what the equations miss; velocity_ and worst_ are those of the impulse then.
  double measure(const VectorXd& impulse) {
    velocity_ = problem_.w + problem_.directions.transpose() * (problem_.directions * impulse);
    constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
    const VectorXd added = absolute_directions_.transpose() * (absolute_directions_ * impulse.cwiseAbs());
    double sum = 0.0;
    worst_ = 0.0;
    for (Index c = 0; c < count(); ++c) {
      const Index normal = axes() * c;
      const double push = impulse[normal];
      const double missing = diagonal_[normal] * (push - std::max(0.0, pull_back(c, impulse)));
      const auto drag = impulse.segment(normal + 1, axes() - 1);
      const VectorXd wanted = wanted_drag(c, impulse);
      const double missing_drag = yield(c) * (drag - wanted).norm();
      const double known =
          problem_.rounding + kRoundingsInEpsilon * kEpsilon * added.segment(normal, axes()).maxCoeff();
      sum += missing * missing + missing_drag * missing_drag;
      worst_ = std::max({worst_, std::abs(missing) / known, missing_drag / known});
    }
    return sum;
  }

  VectorXd wanted_drag(Index c, const VectorXd& impulse) const {
    const double most = problem_.friction[c] * std::max(0.0, impulse[axes() * c]);
    if (slides(c)) return -most * problem_.slip.segment(axes() * c + 1, axes() - 1);
    VectorXd wanted = aim(c, impulse);
    if (const double size = wanted.norm(); size > most) wanted *= most / size;
    return wanted;
  }

  /// Where the equations, linear around best_, hold.
  VectorXd newton_point() {
    VectorXd point = VectorXd::Zero(best_.size());
    const std::vector<Index> rows = closed_rows();
    if (rows.empty()) return point;
    const auto size = static_cast<Index>(rows.size());
    std::vector<Index> place(static_cast<std::size_t>(best_.size()), -1);
    for (Index k = 0; k < size; ++k) place[static_cast<std::size_t>(rows[static_cast<std::size_t>(k)])] = k;

    entries_.clear();
    VectorXd right = VectorXd::Zero(size);
    for (Index k = 0; k < size; k += axes())
      add_contact(rows[static_cast<std::size_t>(k)] / axes(), k, place, right);
    SparseMatrix<double> equations(size, size);
    equations.setFromTriplets(entries_.begin(), entries_.end());
    Eigen::SparseLU<SparseMatrix<double>, Eigen::COLAMDOrdering<int>> factors;
    factors.compute(equations);
    if (factors.info() != Eigen::Success) return best_;
    VectorXd solution = factors.solve(right);
    solution += factors.solve(right - equations * solution);
    point(rows) = solution;
    return point;
  }

  /// The components of the contacts that push, or would.
  std::vector<Index> closed_rows() const {
    std::vector<Index> rows;
    for (Index c = 0; c < count(); ++c) {
      if (!(pull_back(c, best_) > 0.0)) continue;
      for (Index k = 0; k < axes(); ++k) rows.push_back(axes() * c + k);
    }
    return rows;
  }

  /// Adds factor × (row of W), and brings factor × w to the right.
  void add_row(Index row, Index number, double factor, const std::vector<Index>& place, VectorXd& right) {
    for (SparseMatrix<double>::InnerIterator at(matrix_, row); at; ++at) {
      const Index column = place[static_cast<std::size_t>(at.row())];
      if (column >= 0) entries_.emplace_back(number, column, factor * at.value());
    }
    entries_.emplace_back(number, place[static_cast<std::size_t>(row)], factor * proximal_ * diagonal_[row]);
    right[number] += factor * (proximal_ * diagonal_[row] * best_[row] - problem_.w[row]);
  }

  void add_contact(Index c, Index number, const std::vector<Index>& place, VectorXd& right) {
    const Index normal = axes() * c;
    add_row(normal, number, 1.0 / diagonal_[normal], place, right);
    const double most = problem_.friction[c] * std::max(0.0, best_[normal]);
    const VectorXd q = aim(c, best_);
    const double size = q.norm();
    for (Index k = 1; k < axes(); ++k) {
      if (slides(c) || problem_.friction[c] == 0.0) {
        entries_.emplace_back(number + k, number + k, 1.0);
        entries_.emplace_back(number + k, number, problem_.friction[c] * problem_.slip[normal + k]);
      } else if (size <= most) {
        add_row(normal + k, number + k, 1.0 / yield(c), place, right);
      } else {
        add_sliding_row(c, k, number, most / size, q / size, place, right);
      }
    }
  }

  /// T - μ λ d - s (1 - d dᵀ)(T - w'_t/W_t) = 0, with d the direction of q = T - w'_t/W_t and s = μ λ/|q|.
  void add_sliding_row(Index c, Index k, Index number, double s, const VectorXd& d,
                       const std::vector<Index>& place, VectorXd& right) {
    entries_.emplace_back(number + k, number + k, 1.0);
    entries_.emplace_back(number + k, number, -problem_.friction[c] * d[k - 1]);
    if (axes() == 2) return;  // along one axis the direction does not turn
    for (Index l = 1; l < axes(); ++l) {
      const double across = s * ((k == l ? 1.0 : 0.0) - d[k - 1] * d[l - 1]);
      entries_.emplace_back(number + k, number + l, -across);
      add_row(axes() * c + l, number + k, across / yield(c), place, right);
    }
  }

  const ConeProblem& problem_;
  const SparseMatrix<double> matrix_;  ///< W
  const SparseMatrix<double> absolute_directions_;
  const VectorXd diagonal_;
  VectorXd best_;
  VectorXd velocity_;  ///< w'
  double worst_ = 0.0;
  double proximal_ = kLeastProximal;
  std::vector<Eigen::Triplet<double>> entries_;
};

}  // namespace

bool solve_cone(const ConeProblem& problem, VectorXd& impulse) {
  Newton newton(problem, impulse);
  const bool solved = newton.solve();
  impulse = newton.best();
  return solved;
}

double cone_residual(const ConeProblem& problem, const VectorXd& impulse) {
  return Newton(problem, impulse).residual(impulse);
}

}  // namespace carom
