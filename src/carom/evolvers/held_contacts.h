#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <utility>

namespace carom {

/// A contact as it is met: ball a and ball b, or ball a and plane b.
struct ContactSeed {
  std::uint32_t a;
  std::uint32_t b;
  bool wall;
};

/// One number for a contact, whichever of its balls is named first.
inline std::uint64_t contact_key(std::size_t a, std::size_t b, bool wall) {
  if (!wall && b < a) std::swap(a, b);
  return (static_cast<std::uint64_t>(a) << 32U) | (static_cast<std::uint64_t>(b) << 1U) | (wall ? 1U : 0U);
}

/// The contacts that stay closed until the step ends or one of their balls begins a new flight, and how they
/// pushed last. They are looked up, never visited in the order of a hash. `Balls` are Flights (flights.h).
template <class Balls>
class HeldContacts {
 public:
  explicit HeldContacts(const Balls& flights) : flights_(flights) {}

  void begin_step() {
    held_.clear();
    known_.swap(learned_);
    learned_.clear();
  }

  bool empty() const { return held_.empty(); }

  void hold(std::size_t a, std::size_t b, bool wall) { held_[key(a, b, wall)] = stamps(a, b, wall); }

  bool has(std::size_t a, std::size_t b, bool wall) const {
    if (held_.empty()) return false;
    const auto found = held_.find(key(a, b, wall));
    return found != held_.end() && found->second == stamps(a, b, wall);
  }

  /// The contact's push along the normal, N, as this step or the one before last had it; 0 where neither did.
  double known_push(std::size_t a, std::size_t b, bool wall) const {
    const std::uint64_t contact = key(a, b, wall);
    if (const auto found = learned_.find(contact); found != learned_.end()) return found->second;
    const auto found = known_.find(contact);
    return found == known_.end() ? 0.0 : found->second;
  }

  void learn_push(std::size_t a, std::size_t b, bool wall, double push_N) {
    learned_[key(a, b, wall)] = push_N;
  }

 private:
  /// By the balls' numbers: between two steps balls may change their places.
  std::uint64_t key(std::size_t a, std::size_t b, bool wall) const {
    const auto& world = flights_.world();
    return contact_key(world.number_of(a), wall ? b : world.number_of(b), wall);
  }

  using Stamps = std::pair<std::uint32_t, std::uint32_t>;

  Stamps stamps(std::size_t a, std::size_t b, bool wall) const {
    if (wall) return {flights_.stamp(a), 0};
    return {flights_.stamp(std::min(a, b)), flights_.stamp(std::max(a, b))};
  }

  const Balls& flights_;
  std::unordered_map<std::uint64_t, Stamps> held_;
  std::unordered_map<std::uint64_t, double> known_;    ///< of the step before
  std::unordered_map<std::uint64_t, double> learned_;  ///< of this one
};

}  // namespace carom
