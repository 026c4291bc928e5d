#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

namespace carom {

/// The law of a ball's share of the kinetic energy of N balls in equilibrium, whatever their masses.
///
/// In a box of smooth elastic walls nothing but the energy E is conserved, so the momenta √m_i v_i lie evenly
/// on the sphere of radius √(2E) in d N dimensions, and the share x = ½ m v²/E of one ball has the law
/// Beta(d/2, d(N-1)/2) (1), exactly for every N; Maxwell's law is its limit for large N, with
/// T = 2E/(dN). The shares of all balls together are Dirichlet's with N parameters d/2 (2).
class EnergyShare {
 public:
  EnergyShare(int dimension, std::size_t balls);

  /// The probability of a share up to x; 0 below 0, 1 above 1.
  double cdf(double x) const;

  /// a2 = N Σ x² d/(d+2) - 1, that is <v⁴>/((1 + 2/d) <v²>²) - 1 for equal masses: 0 in Maxwell's law. By (2)
  /// its mean is exactly -2/(dN + 2), and its standard deviation follows from the fourth moments of (2),
  /// E x^4 = a(a+1)(a+2)(a+3)/D and E x_i² x_j² = (a(a+1))²/D with a = d/2, D = s(s+1)(s+2)(s+3), s = dN/2.
  double fourth_moment_mean() const;
  double fourth_moment_deviation() const;

  /// The share of all balls of a group of `members` has mean members/N and this standard deviation, Beta's
  /// with parameters d members/2 and d (N - members)/2.
  double group_deviation(std::size_t members) const;

 private:
  int dimension_;
  std::size_t balls_;
};

/// The largest distance of a sample's empirical distribution from a law.
/// @pre the sample is sorted and not empty
double kolmogorov_distance(std::span<const double> sorted, const std::function<double(double)>& cdf);

/// The probability of at least this distance for a sample of n independent values of the law:
/// 2 Σ (-1)^{k-1} exp(-2 k² λ²) (A. N. Kolmogorov, 1933) with λ = (√n + 0.12 + 0.11/√n) D
/// (M. A. Stephens, J. R. Stat. Soc. B 32, 115, 1970).
double kolmogorov_p(double distance, std::size_t n);

/// The deviation of a normal variable, in its standard deviations, that is passed with this probability on
/// one side; 0 for p >= ½, and at most the 37 of the smallest double.
double sigmas_of(double p);

/// A mean over time, and the standard error of it.
struct TimeMean {
  double mean = 0.0;
  double error = 0.0;
};

/// By batch means: the series is cut into ten spans of equal length, and their means scatter as the mean of
/// all does, times √10, however the values of a span hang together. A rest that fills no span is left out in
/// front. @pre at least ten values
TimeMean time_mean(std::span<const double> series);

inline constexpr std::size_t kBatches = 10;

}  // namespace carom
