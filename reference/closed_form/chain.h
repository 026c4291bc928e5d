#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "reference/closed_form/twofold.h"
#include "scenario/scenario.h"

namespace carom::closed_form {

/// The uniform motion of a body from a moment on.
struct Leg {
  Twofold start_s;
  Twofold position_m;
  Twofold velocity_mps;

  Twofold position_at(const Twofold& time_s) const { return position_m + velocity_mps * (time_s - start_s); }
};

/// A ball or a wall on the line. A wall is a body of no radius and infinite mass at rest.
struct Body {
  double mass_kg = std::numeric_limits<double>::infinity();
  double radius_m = 0.0;
  std::optional<std::size_t> ball;  ///< its index in the scene; none for a wall
  std::vector<Leg> legs;

  bool immovable() const { return std::isinf(mass_kg); }
};

struct Impact {
  Twofold time_s;
  Twofold external_Ns;  ///< along the line, of all impacts so far
};

/// The finite sequence of impacts of bodies on a line. Pair p is made of bodies p and p + 1.
class Chain {
 public:
  Chain(const Scenario& scenario, std::vector<Body> bodies);

  /// Follows the impacts up to the horizon. Says why it cannot, or nothing.
  std::string follow();

  const std::vector<Body>& bodies() const { return bodies_; }
  const std::vector<Impact>& impacts() const { return impacts_; }

 private:
  Twofold gap_m(std::size_t pair, const Twofold& time_s) const;
  Twofold approach_mps(std::size_t pair) const;
  void predict(std::size_t pair, const Twofold& now_s);
  std::string collide(std::size_t pair, const Twofold& now_s);
  bool is_due_too(std::size_t pair, const Twofold& now_s) const;
  std::size_t pairs() const { return bodies_.size() - 1; }

  const Scenario& scenario_;
  double touch_m_;
  std::vector<Body> bodies_;
  std::vector<std::optional<Twofold>> due_s_;
  std::vector<Impact> impacts_;
};

}  // namespace carom::closed_form
