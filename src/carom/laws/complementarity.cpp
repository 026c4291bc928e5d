#include "carom/laws/complementarity.h"

#include <Eigen/QR>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

namespace carom {

namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::SparseMatrix;
using Eigen::VectorXd;

constexpr double kNever = std::numeric_limits<double>::infinity();

/// √ε of a normal's length: what of it the other normals do not span is nothing below this, for its square is
/// the rounding of the whole. Of a light ball between heavy ones √(m/M) is left, so masses may be 10¹⁶ apart.
constexpr double kIndependent = 0x1p-26;

/// Sweeps before each solution on the contacts that push. They find which these are; few do, as another pass
/// corrects them.
constexpr int kSweepsInAPass = 8;

/// Passes that are made at most. What they leave undone is for the next round of the impact.
constexpr int kMostPasses = 200;

/// Of the diagonal of BᵀB. Whatever the normals do not span to more than its root, 10⁻⁶ of their length, is
/// approached over several passes.
constexpr double kProximal = 1e-12;

/// Proximal steps with one factorization: the second takes out what rounding and kProximal left of the first.
constexpr int kRefinements = 2;

/// Of a bent step: less is not tried.
constexpr double kLeastShare = 0x1p-10;

/// Three components of two balls.
constexpr std::size_t kMostEntriesOfANormal = 6;

/// Pivots per contact that are made at most. Each raises the dual objective, so none comes twice but for
/// rounding; about one per contact is needed.
constexpr Index kMostPivotsEach = 20;

/// Roundings of an opening velocity, each ε/2 of all that impulses have changed it by: sums over a dozen
/// contacts of a ball and over three axes.
constexpr double kRoundings = 32.0;

/// What w' is known to, m/s: what w was, and what the impulses have added.
template <class Matrix>
VectorXd rounding_after(const VectorXd& rounding, const Matrix& absolute_normals, const VectorXd& impulse) {
  constexpr double kHalfUlp = 0.5 * std::numeric_limits<double>::epsilon();
  return rounding + kRoundings * kHalfUlp * (absolute_normals.transpose() * (absolute_normals * impulse));
}

/// The dual active-set method: contacts below their aim are made active one by one, and active ones that
/// would have to pull are let go. Between the steps λ >= 0 and λᵀw' = 0 hold, so it ends where w' >= 0.
/// Source: D. Goldfarb, A. Idnani, "A numerically stable dual method for solving strictly convex quadratic
/// programs", Math. Programming 27, 1 (1983), §3, with the identity for the matrix of the objective.
class DualActiveSet {
 public:
  DualActiveSet(const SparseMatrix<double>& normals, const VectorXd& w, const VectorXd& rounding)
      : normals_(normals),
        absolute_normals_(normals_.cwiseAbs()),
        start_(w),
        rounding_(rounding),
        impulse_(VectorXd::Zero(w.size())),
        change_(VectorXd::Zero(w.size())),
        pivots_left_(kMostPivotsEach * w.size()) {}

  Complementary solve() {
    for (Index contact = farthest_below(); contact >= 0; contact = farthest_below()) {
      if (!activate(contact)) break;
      meet_aims();
    }
    return {impulse_, change_};
  }

 private:
  /// Of the contacts that are not active, the one farthest below its aim, in the metric of y; -1 where none
  /// is.
  Index farthest_below() const {
    Index farthest = -1;
    double most = 0.0;
    const VectorXd rounding = rounding_after(rounding_, absolute_normals_, impulse_);
    for (Index c = 0; c < start_.size(); ++c) {
      const double w = start_[c] + change_[c];
      if (w >= -rounding[c] || std::find(active_.begin(), active_.end(), c) != active_.end()) continue;
      const double below = -w / normals_.col(c).norm();
      if (below <= most) continue;
      farthest = c;
      most = below;
    }
    return farthest;
  }

  /// Raises the contact's impulse until its aim is met, letting go of active ones on the way. False where no
  /// impulse meets it: the contact is wedged, or every pivot is spent.
  bool activate(Index contact) {
    const VectorXd normal = normals_.col(contact);
    while (--pivots_left_ >= 0) {
      const VectorXd relief = relief_of(normal);
      const VectorXd free = normal - active_normals() * relief;
      const bool independent = free.norm() > kIndependent * normal.norm();
      const double meets = independent ? -(start_[contact] + change_[contact]) / free.squaredNorm() : kNever;
      const auto [lets_go, position] = first_to_let_go(relief);
      const double raise = std::min(meets, lets_go);
      if (raise == kNever) return false;
      impulse_[contact] += raise;
      impulse_(active_) -= raise * relief;
      if (independent) change_ += raise * (normals_.transpose() * free);
      if (meets <= lets_go) {
        active_.push_back(contact);
        return true;
      }
      impulse_[active_[position]] = 0.0;
      active_.erase(active_.begin() + static_cast<std::ptrdiff_t>(position));
    }
    return false;
  }

  MatrixXd active_normals() const { return normals_(Eigen::all, active_); }

  /// How much less the active contacts push for a unit of push along `normal`.
  VectorXd relief_of(const VectorXd& normal) const {
    if (active_.empty()) return VectorXd();
    return active_normals().householderQr().solve(normal);
  }

  struct LettingGo {
    double raise;
    std::size_t position;  ///< in active_
  };

  LettingGo first_to_let_go(const VectorXd& relief) const {
    LettingGo first{kNever, 0};
    for (std::size_t k = 0; k < active_.size(); ++k) {
      const double less = relief[static_cast<Index>(k)];
      if (less <= 0.0) continue;
      const double raise = std::max(0.0, impulse_[active_[k]] / less);
      if (raise < first.raise) first = {raise, k};
    }
    return first;
  }

  /// Takes out what rounding has left at the active contacts.
  void meet_aims() {
    const MatrixXd normals = active_normals();
    const Eigen::HouseholderQR<MatrixXd> factors(normals);
    const auto upper = factors.matrixQR().topRows(normals.cols()).template triangularView<Eigen::Upper>();
    change_ = normals_.transpose() * (normals_ * impulse_);
    const VectorXd missing = -(start_ + change_)(active_);
    impulse_(active_) += upper.solve(upper.transpose().solve(missing));
    impulse_ = impulse_.cwiseMax(0.0);
    change_ = normals_.transpose() * (normals_ * impulse_);
  }

  const MatrixXd normals_;
  const MatrixXd absolute_normals_;
  const VectorXd& start_;
  const VectorXd& rounding_;
  VectorXd impulse_;
  VectorXd change_;
  Index pivots_left_;
  std::vector<Index> active_;  ///< contacts that push and meet their aims, their normals independent
};

/// Projected Gauss–Seidel, λ_c ← max(0, λ_c - w'_c/|b_c|²) contact by contact, with the contacts that push
/// then solved as equations. Both lower ½ λᵀBᵀBλ + λᵀw, whose least value over λ >= 0 solves (1). The sweeps
/// alone would need O(n²) of them to carry an impulse through n balls in a row.
/// Source: M. Silcowitz, S. Niebur, K. Erleben, "Projected Gauss-Seidel subspace minimization method for
/// interactive rigid body dynamics", GRAPP (2010); the projected step, J. J. Moré, G. Toraldo, "On the
/// solution of large quadratic programming problems with bound constraints", SIAM J. Optim. 1, 93 (1991).
class SweepsAndSubspace {
 public:
  SweepsAndSubspace(const SparseMatrix<double>& normals, const VectorXd& w, const VectorXd& rounding,
                    VectorXd start)
      : normals_(normals),
        absolute_normals_(normals.cwiseAbs()),
        start_(w),
        rounding_(rounding),
        impulse_(std::move(start)),
        moved_(normals * impulse_),
        squares_(w.size()) {
    for (Index c = 0; c < w.size(); ++c) squares_[c] = normals_.col(c).squaredNorm();
  }

  Complementary solve() {
    for (int pass = 0; pass < kMostPasses; ++pass) {
      for (int sweep = 0; sweep < kSweepsInAPass; ++sweep) relax_all();
      solve_pushing();
      if (solved()) break;
    }
    return {impulse_, normals_.transpose() * moved_};
  }

 private:
  void relax_all() {
    for (Index c = 0; c < start_.size(); ++c) {
      const double w = start_[c] + normals_.col(c).dot(moved_);
      const double next = std::max(0.0, impulse_[c] - w / squares_[c]);
      if (next == impulse_[c]) continue;
      moved_ += (next - impulse_[c]) * normals_.col(c);
      impulse_[c] = next;
    }
  }

  VectorXd openings() const { return start_ + normals_.transpose() * moved_; }

  /// Steps towards w' = 0 at the contacts that push. What would have to pull stops where it does not push:
  /// the path is bent there, and taken as far, by halves, as it lowers the objective. Where no half does, it
  /// ends where the first contact stops pushing: up to there it is straight, and leads down.
  void solve_pushing() {
    const VectorXd step = newton_step();
    const VectorXd w = openings();
    VectorXd next = (impulse_ + step).cwiseMax(0.0);
    double share = 1.0;
    while (share > kLeastShare && change_of_objective(next - impulse_, w) > 0.0) {
      share *= 0.5;
      next = (impulse_ + share * step).cwiseMax(0.0);
    }
    if (share <= kLeastShare) next = (impulse_ + first_stop(step) * step).cwiseMax(0.0);
    impulse_ = next;
    moved_ = normals_ * impulse_;
  }

  /// The share of a step at which the first contact does not push any more; at most 1.
  double first_stop(const VectorXd& step) const {
    double share = 1.0;
    for (Index c = 0; c < step.size(); ++c) {
      if (step[c] < 0.0) share = std::min(share, impulse_[c] / -step[c]);
    }
    return share;
  }

  double change_of_objective(const VectorXd& step, const VectorXd& w) const {
    return w.dot(step) + 0.5 * (normals_ * step).squaredNorm();
  }

  /// x of BᵀB x = -w' over the contacts that push, 0 at the others. Redundant contacts leave BᵀB singular:
  /// each solution is the nearest to the last one (a proximal step), with the share kProximal of the
  /// diagonal.
  VectorXd newton_step() const {
    VectorXd step = VectorXd::Zero(impulse_.size());
    std::vector<Index> pushing;
    for (Index c = 0; c < impulse_.size(); ++c) {
      if (impulse_[c] > 0.0) pushing.push_back(c);
    }
    if (pushing.empty()) return step;
    const auto count = static_cast<Index>(pushing.size());
    SparseMatrix<double> active(normals_.rows(), count);
    active.reserve(Eigen::VectorXi::Constant(count, static_cast<int>(kMostEntriesOfANormal)));
    for (Index k = 0; k < count; ++k) {
      for (SparseMatrix<double>::InnerIterator at(normals_, pushing[static_cast<std::size_t>(k)]); at; ++at) {
        active.insert(at.row(), k) = at.value();
      }
    }
    SparseMatrix<double> matrix = active.transpose() * active;
    for (Index k = 0; k < count; ++k) matrix.coeffRef(k, k) *= 1.0 + kProximal;
    const Eigen::SimplicialLDLT<SparseMatrix<double>> factors(matrix);
    if (factors.info() != Eigen::Success) return step;
    VectorXd residual = -openings()(pushing);
    VectorXd x = VectorXd::Zero(count);
    for (int refinement = 0; refinement < kRefinements; ++refinement) {
      const VectorXd more = factors.solve(residual);
      x += more;
      residual -= active.transpose() * (active * more);
    }
    if (x.allFinite()) step(pushing) = x;
    return step;
  }

  bool within_rounding(const VectorXd& residual) const {
    const VectorXd rounding = rounding_after(rounding_, absolute_normals_, impulse_);
    return (residual.cwiseAbs().array() <= rounding.array()).all();
  }

  bool solved() const {
    const VectorXd w = openings();
    return within_rounding((impulse_.array() > 0.0).select(w, w.cwiseMin(0.0)));
  }

  const SparseMatrix<double>& normals_;
  const SparseMatrix<double> absolute_normals_;
  const VectorXd& start_;
  const VectorXd& rounding_;
  VectorXd impulse_;
  VectorXd moved_;    ///< B λ
  VectorXd squares_;  ///< |b_c|²
};

}  // namespace

Complementary solve_by_pivoting(const SparseMatrix<double>& normals, const VectorXd& w,
                                const VectorXd& rounding) {
  return DualActiveSet(normals, w, rounding).solve();
}

Complementary solve_by_sweeps(const SparseMatrix<double>& normals, const VectorXd& w,
                              const VectorXd& rounding) {
  return SweepsAndSubspace(normals, w, rounding, VectorXd::Zero(w.size())).solve();
}

Complementary solve_by_sweeps_from(const VectorXd& start, const SparseMatrix<double>& normals,
                                   const VectorXd& w, const VectorXd& rounding) {
  return SweepsAndSubspace(normals, w, rounding, start).solve();
}

Complementary solve_complementarity(const SparseMatrix<double>& normals, const VectorXd& w,
                                    const VectorXd& rounding) {
  return w.size() <= kMostPivoted ? solve_by_pivoting(normals, w, rounding)
                                  : solve_by_sweeps(normals, w, rounding);
}

}  // namespace carom
