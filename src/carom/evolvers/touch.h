#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace carom {

/// A contact found in a step: of a ball and another one, or of a ball and a plane.
struct Touch {
  std::uint32_t a;
  std::uint32_t b;  ///< a ball, or a plane
  /// Pairs by their balls' numbers, then planes, each with its balls. No scene has 2³¹ balls.
  std::uint64_t rank;

  static Touch of_balls(std::uint32_t a, std::uint32_t b, std::uint32_t number_a, std::uint32_t number_b) {
    return {a, b, std::uint64_t{number_a} << 32U | number_b};
  }
  static Touch of_plane(std::uint32_t ball, std::uint32_t plane, std::uint32_t number) {
    return {ball, plane, kPlane | std::uint64_t{plane} << 32U | number};
  }

  bool plane() const { return rank >= kPlane; }
  bool operator<(const Touch& other) const { return rank < other.rank; }
  bool operator==(const Touch& other) const { return rank == other.rank; }

 private:
  static constexpr std::uint64_t kPlane = std::uint64_t{1} << 63U;
};

/// The balls that are in contact, and whether each is in more than one.
class TouchedBalls {
 public:
  explicit TouchedBalls(std::size_t balls) : is_touched_(balls), is_shared_(balls) {}

  /// Whose contacts these are; forgets those noted before.
  void note(std::span<const Touch> touches) {
    for (const std::uint32_t ball : touched_) is_touched_[ball] = is_shared_[ball] = false;
    touched_.clear();
    for (const Touch& touch : touches) {
      note(touch.a);
      if (!touch.plane()) note(touch.b);
    }
  }

  /// Each once, in the order of the contacts.
  std::span<const std::uint32_t> balls() const { return touched_; }

  /// Whether the balls of a contact are in no other. @pre it was noted
  bool is_isolated(const Touch& touch) const {
    return !is_shared_[touch.a] && (touch.plane() || !is_shared_[touch.b]);
  }

 private:
  void note(std::uint32_t ball) {
    if (is_touched_[ball]) {
      is_shared_[ball] = true;
    } else {
      is_touched_[ball] = true;
      touched_.push_back(ball);
    }
  }

  std::vector<std::uint32_t> touched_;
  std::vector<bool> is_touched_;  ///< of each ball
  std::vector<bool> is_shared_;   ///< of each ball, by contacts
};

}  // namespace carom
