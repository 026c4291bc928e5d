#pragma once

#include <array>
#include <cstddef>
#include <optional>

namespace carom {

/// Up to five numbers, in place: under drag quartics are solved for pairs in every step, and none may cost
/// an allocation. What does not fit is a mistake of the caller's.
class FewNumbers {
 public:
  static constexpr std::size_t kMost = 5;

  FewNumbers() = default;
  template <class... Numbers>
  requires(sizeof...(Numbers) > 0 &&
           sizeof...(Numbers) <= kMost) explicit constexpr FewNumbers(Numbers... numbers)
      : numbers_{numbers...}, size_(sizeof...(Numbers)) {}

  std::size_t size() const { return size_; }
  double operator[](std::size_t index) const { return numbers_[index]; }
  const double* begin() const { return numbers_.data(); }
  const double* end() const { return numbers_.data() + size_; }
  void push_back(double number) { numbers_[size_++] = number; }

 private:
  std::array<double, kMost> numbers_{};
  std::size_t size_ = 0;
};

/// Coefficients c₀ + c₁ t + c₂ t² + … up to degree four.
using Polynomial = FewNumbers;

double value_at(const Polynomial& f, double t);

/// The roots in (0, end) at which f changes sign, ascending. Between neighbouring roots of its derivative,
/// found in the same way, a polynomial is monotonic and a change of sign encloses one root; bisection then
/// runs until neighbouring doubles are reached.
FewNumbers sign_changes(const Polynomial& f, double end);

/// The first time in (0, end) at which f goes from positive to negative.
std::optional<double> first_fall_through_zero(const Polynomial& f, double end);

}  // namespace carom
