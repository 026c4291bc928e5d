#pragma once

#include <limits>
#include <numbers>

/// Numbers that tolerances and scenes are made of.
namespace carom::test {

inline constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();
inline constexpr double kPi = std::numbers::pi;
inline constexpr double kGravity = 9.81;  // m/s²

/// Statistical bounds are this many standard deviations. The seeds are fixed, so a test that passes once
/// always does; a right generator misses a bound with probability 7e-6, once and for all.
inline constexpr double kDeviations = 4.5;

/// The sanitizers ask what memory is read, not how many scenes come out right, and make all of it ten times
/// slower: what runs for long does so many times less under them.
#ifdef __SANITIZE_ADDRESS__
inline constexpr int kPart = 4;
#else
inline constexpr int kPart = 1;
#endif

}  // namespace carom::test
