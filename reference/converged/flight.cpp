#include "reference/converged/flight.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace carom::converged {

namespace {

/// The Taylor coefficients of |u(t)|, u(t) = Σ u_k t^k, for t >= 0. With y_j = u_{j+f}, where u_f is the
/// first coefficient that is not zero (f is 0; or 1, where a ball starts from rest), |u| = t^f |y|, and r =
/// |y| follows from r² = p, p = y·y, coefficient by coefficient:
///
///   p_m = Σ_{j=0..m} y_j·y_{m-j},   r_0 = |y_0|,   r_m = (p_m - Σ_{j=1..m-1} r_j r_{m-j}) / (2 r_0)      (1)
///
/// Source: the power series of a square root; e.g. A. Griewank, A. Walther, "Evaluating Derivatives", SIAM
/// (2008), table 13.1.
class SpeedSeries {
 public:
  explicit SpeedSeries(const std::vector<Vector>& u) : u_(u) {}

  /// w_k, from u_0 to u_k. @pre asked for in the order of k, and u_0 or u_1 is not zero once k >= 1.
  Real next() {
    const std::size_t k = asked_++;
    if (k == 0) first_ = u_[0].isZero(Real(0)) ? 1 : 0;
    if (k < first_) return 0;
    add(k - first_);
    return r_.back();
  }

  /// A power of two below the distance of the nearest complex zero of p, where |u| stops being analytic:
  /// there is none where Σ_{m>=1} |p_m| h^m < p_0.
  Real clear_s() const {
    int exponent = kFarthest;
    for (std::size_t m = 1; m < p_.size(); ++m) {
      if (p_[m] == 0) continue;
      int ratio = 0;
      frexp(p_[0] / abs(p_[m]), &ratio);
      exponent = std::min(exponent, ratio / static_cast<int>(m) + 1);  // no term alone may reach p_0
    }
    const auto rest = [&](const Real& h) {
      Real sum = 0;
      for (std::size_t m = p_.size() - 1; m > 0; --m) sum = (sum + abs(p_[m])) * h;
      return sum;
    };
    while (rest(power_of_two(exponent)) >= p_[0]) --exponent;
    return power_of_two(exponent);
  }

 private:
  static constexpr int kFarthest = 300;  // as a power of two of a second; no flight is as long

  /// (1); the sums are symmetric, so that half of each is enough.
  void add(std::size_t m) {
    Real half_p = 0;
    Real half_r = 0;
    for (std::size_t j = 0; 2 * j < m; ++j) half_p += u_[first_ + j].dot(u_[first_ + m - j]);
    for (std::size_t j = 1; 2 * j < m; ++j) half_r += r_[j] * r_[m - j];
    const bool even = m % 2 == 0;
    p_.push_back(2 * half_p + (even ? u_[first_ + m / 2].squaredNorm() : Real(0)));
    if (m == 0) {
      r_.push_back(sqrt(p_[0]));
    } else {
      const Real middle = even ? Real(r_[m / 2] * r_[m / 2]) : Real(0);
      r_.push_back((p_[m] - 2 * half_r - middle) / (2 * r_[0]));
    }
  }

  const std::vector<Vector>& u_;
  std::size_t asked_ = 0;
  std::size_t first_ = 0;
  std::vector<Real> p_;
  std::vector<Real> r_;
};

struct Series {
  std::vector<Vector> c;        ///< Taylor coefficients of the place
  std::optional<Real> clear_s;  ///< nearer than this |v| has no singular point, where it matters
};

/// The Taylor coefficients c_k of the place. With u_k those of the velocity and w_k those of its size:
///
///   (k+1) u_{k+1} = g δ_{k0} - k u_k - q Σ_{j=0..k} w_j u_{k-j} + Ω × u_k,   (k+1) c_{k+1} = u_k    (2)
///
/// which is the law of motion, coefficient by coefficient. Source of the method: R. E. Moore, "Interval
/// Analysis" (1966), chapter 11; À. Jorba, M. Zou, Experimental Mathematics 14, 99 (2005).
Series taylor(const Flow& flow, const Vector& x, const Vector& v, int order, bool straight) {
  const std::size_t degree = flow.is_polynomial() ? 2 : static_cast<std::size_t>(order);
  const bool resting = v.isZero(Real(0)) && flow.gravity.isZero(Real(0));
  const bool quadratic = flow.quadratic != 0 && !resting;
  std::vector<Vector> u = {v};
  std::vector<Vector> c = {x, v};
  std::vector<Real> w;
  SpeedSeries speed(u);
  for (std::size_t k = 0; k + 2 <= degree; ++k) {
    Vector a = k == 0 ? flow.gravity : Vector(Vector::Zero());
    if (flow.linear != 0) a -= u[k] * flow.linear;
    if (quadratic) {
      w.push_back(speed.next());
      Vector sum = Vector::Zero();
      for (std::size_t j = 0; j <= k; ++j) sum += u[k - j] * w[j];
      a -= sum * flow.quadratic;
    }
    a += flow.turning.cross(u[k]);
    u.push_back(a / Real(k + 1));
    c.push_back(u.back() / Real(k + 2));
  }
  if (!quadratic || straight) return {c, std::nullopt};
  return {c, speed.clear_s()};
}

/// The longest h, but for a factor near 1, with |coefficient| h^power <= 2^-bits scale. As 2^x <= 1 + x <=
/// 17/16 2^x for x in [0, 1], whole-number arithmetic is enough, and gives the same on every machine.
Real longest(const Vector& coefficient, int power, const Real& scale, int bits) {
  const Real size = coefficient.cwiseAbs().maxCoeff();
  if (size == 0) return std::numeric_limits<Real>::infinity();
  int exponent = 0;
  frexp(scale / size, &exponent);
  exponent -= bits + 1;  // scale/size >= 2^(exponent-1)
  const int whole = exponent >= 0 ? exponent / power : -((power - 1 - exponent) / power);
  const Real rest = Real(exponent - whole * power) / power;
  return ldexp(1 + rest, whole) * Real(16) / Real(17);
}

/// The step. A polynomial of order N leaves out about c_{N+1} h^{N+1} of the place and (N+1) c_{N+1} h^N of
/// the velocity; where the coefficients fall like those of a geometric series that is less than what its last
/// two terms add, which are made as small as asked for. (Two, for one may vanish by symmetry.)
Real step_s(const std::vector<Vector>& c, const Accuracy& accuracy, const Scale& scale) {
  Real h = std::numeric_limits<Real>::infinity();
  for (std::size_t k = c.size() - 2; k < c.size(); ++k) {
    const int power = static_cast<int>(k);
    h = std::min({h, longest(c[k], power, scale.length_m, accuracy.bits),
                  longest(c[k] * Real(power), power - 1, scale.speed_mps, accuracy.bits)});
  }
  return h;
}

/// Whether quadratic drag acts along one line with gravity. |v| then is the speed along it, without a
/// singular point, until a ball that rises turns round: there it has a kink. Within a few units of `bits`
/// nothing tells a flight from a straight one.
bool is_straight(const Flow& flow, const Vector& v, const Vector& up, int bits) {
  constexpr int kUnits = 4;  // as a power of two
  if (flow.quadratic == 0 || up.isZero(Real(0)) || !flow.turning.cross(up).isZero(Real(0))) return false;
  const Real rate = v.dot(up);
  return rate != 0 && (v - up * rate).norm() <= ldexp(Real(abs(rate)), kUnits - bits);
}

}  // namespace

Flow Flow::of(const Ball& ball, const Effects& effects, const Vector& spin_radps) {
  Flow flow;
  if (std::isinf(ball.mass)) return flow;
  if (effects.gravity) flow.gravity = widened(*effects.gravity);
  if (effects.drag) {
    Real& rate = effects.drag->kind == Drag::Kind::linear ? flow.linear : flow.quadratic;
    rate = Real(effects.drag->coefficient) / ball.mass;
  }
  if (effects.magnus) flow.turning = spin_radps * (Real(*effects.magnus) / ball.mass);
  return flow;
}

Piece::Piece(const Flow& flow, const Vector& x, const Vector& v, const Real& start_s, const Real& latest_s,
             const Accuracy& accuracy, const Scale& scale)
    : start_s_(start_s), end_s_(latest_s) {
  const Vector up = flow.gravity.isZero(Real(0)) ? flow.gravity : Vector(-flow.gravity.normalized());
  const bool straight = is_straight(flow, v, up, accuracy.bits);
  Series series = taylor(flow, x, straight ? Vector(up * v.dot(up)) : v, accuracy.order, straight);
  coefficients_ = std::move(series.c);
  if (!flow.is_polynomial()) {
    // Halfway to a singular point, at most, the terms fall at least like 2^-k.
    Real step = step_s(coefficients_, accuracy, scale);
    if (series.clear_s) step = std::min(step, Real(*series.clear_s / 2));
    end_s_ = std::min(end_s_, Real(start_s + step));
  }
  if (straight && v.dot(up) > 0) end_at_standstill(up);
  find_bounds();
  sketch();
}

/// Newton's method for when the speed upwards, v, is 0. Of a ball that rises against gravity and drag it
/// falls ever more slowly, v'' >= 0, so that the tangent's zero comes before the curve's and the method never
/// overshoots; it ends where rounding is larger than its step.
void Piece::end_at_standstill(const Vector& up) {
  if (at(end_s_).v.dot(up) > 0) return;
  Real time_s = start_s_;
  constexpr int kMostSteps = 100;
  for (int i = 0; i < kMostSteps; ++i) {
    const Kinematics now = at(time_s);
    const Real next_s = time_s - now.v.dot(up) / now.a.dot(up);
    if (next_s <= time_s) break;
    time_s = next_s;
  }
  end_s_ = std::min(end_s_, time_s);
  stands_at_end_ = true;
}

/// |x^(d)(t)| <= Σ_k k…(k-d+1) |c_k| h^(k-d) for every t of the piece.
void Piece::find_bounds() {
  const Real h = end_s_ - start_s_;
  std::array<Real, 3> powers = {1, 0, 0};  // h^(k-d)
  std::array<Real, 3> sums = {0, 0, 0};
  for (std::size_t k = 1; k < coefficients_.size(); ++k) {
    Real size = coefficients_[k].norm();
    for (std::size_t d = 0; d < sums.size() && d < k; ++d) {
      size *= Real(k - d);
      sums[d] += size * powers[d];
    }
    powers = {powers[0] * h, powers[0], powers[1]};
  }
  most_speed_mps_ = sums[0];
  most_acceleration_mps2_ = sums[1];
  most_jerk_mps3_ = sums[2];
  constexpr double kUp = 1.0 + 1e-12;  // above any rounding to double
  around_m_ = rounded(coefficients_[0]);
  reach_m_ = kUp * static_cast<double>(sums[0] * h) + (kUp - 1.0) * around_m_.cwiseAbs().sum();
}

void Piece::sketch() {
  for (const Vector& coefficient : coefficients_) {
    sketch_.push_back(rounded(coefficient));
    if (!sketch_.back().allFinite()) return sketch_.clear();
  }
}

void Piece::sketch_at(double time_s, Vec3& x, Vec3& v) const {
  const double t = time_s - static_cast<double>(start_s_);
  x = sketch_.back();
  v.setZero();
  for (std::size_t k = sketch_.size() - 1; k-- > 0;) {
    v = v * t + x;
    x = x * t + sketch_[k];
  }
}

/// Horner's scheme with two derivatives.
Kinematics Piece::at(const Real& time_s) const {
  const Real t = time_s - start_s_;
  Kinematics now{coefficients_.back(), Vector::Zero(), Vector::Zero()};
  for (std::size_t k = coefficients_.size() - 1; k-- > 0;) {
    now.a = now.a * t + now.v;
    now.v = now.v * t + now.x;
    now.x = now.x * t + coefficients_[k];
  }
  now.a *= Real(2);
  return now;
}

Vector Piece::place_at(const Real& time_s) const {
  const Real t = time_s - start_s_;
  Vector x = coefficients_.back();
  for (std::size_t k = coefficients_.size() - 1; k-- > 0;) x = x * t + coefficients_[k];
  return x;
}

Kinematics Piece::at_end() const {
  Kinematics now = at(end_s_);
  if (stands_at_end_) now.v.setZero();
  return now;
}

}  // namespace carom::converged
