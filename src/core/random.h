#pragma once

#include <boost/random/mersenne_twister.hpp>
#include <cstdint>

namespace carom {

/// Random numbers whose bits are the same on every machine: the generator is fixed by the C++ standard
/// (mt19937_64) and the distributions below use only comparisons and correctly rounded arithmetic, no libm
/// (the standard library's distributions are free to differ between implementations). Boost's generator gives
/// the same bits as GCC's in a third of the time, for its branches do not depend on chance.
class Random {
 public:
  explicit Random(std::uint64_t seed) : generator_(seed) {}

  /// Uniform in [0, 1), a multiple of 2^-53.
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1p-53; }

  double uniform(double low, double high) { return low + (high - low) * uniform(); }

  /// Standard normal deviate by rejection, without logarithm or cosine.
  /// Source: C. F. F. Karney, "Sampling exactly from the normal distribution", ACM Trans. Math. Softw. 42:3
  /// (2016), algorithm N: y = k + x with k integer and x in [0, 1) is accepted with probability
  /// exp(-k/2) exp(-k(k-1)/2) exp(-x(2k + x)/2), which is exp(-y²/2). Here x has 53 bits.
  double normal() {
    while (true) {
      int k = 0;
      while (happens_with_exp_of_minus(0.5)) ++k;
      if (!all_of(k * (k - 1), 0.5)) continue;
      const double x = uniform();
      // The exponent is split into k + 1 equal parts, each at most 1 as the method below wants it.
      if (!all_of(k + 1, x * (2 * k + x) / (2 * k + 2))) continue;
      const double y = k + x;
      return (generator_() & 1U) == 0U ? y : -y;
    }
  }

 private:
  bool all_of(int times, double exponent) {
    for (int i = 0; i < times; ++i) {
      if (!happens_with_exp_of_minus(exponent)) return false;
    }
    return true;
  }

  /// True with probability exp(-x), 0 <= x <= 1: von Neumann's comparison game. In a run of uniforms
  /// x > u1 > u2 > … the length is even with exactly this probability.
  bool happens_with_exp_of_minus(double x) {
    bool even = true;
    double last = x;
    while (true) {
      const double next = uniform();
      if (next >= last) return even;
      last = next;
      even = !even;
    }
  }

  boost::random::mt19937_64 generator_;
};

}  // namespace carom
