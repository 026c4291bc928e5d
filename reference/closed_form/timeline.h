#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

#include "reference/closed_form/twofold.h"

namespace carom::closed_form {

/// Of stretches in the order of their `start_s`, the one that a moment falls into. @pre not empty, and the
/// first starts no later than that.
template <class Stretch>
const Stretch& stretch_at(const std::vector<Stretch>& stretches, const Twofold& time_s) {
  const auto later = std::upper_bound(std::next(stretches.begin()), stretches.end(), time_s,
                                      [](const Twofold& t, const Stretch& s) { return t < s.start_s; });
  return *std::prev(later);
}

}  // namespace carom::closed_form
