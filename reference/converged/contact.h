#pragma once

#include "reference/converged/flight.h"

namespace carom::converged {

// When two bodies touch first. The gap γ(t) between them is followed from the left by steps that are proved
// too short to pass a contact, so that none is missed, however shallow (contact.cpp).

/// The gap between two bodies at one moment.
struct Gap {
  Real gap_m;
  Real rate_mps;        ///< γ'
  Real curvature_mps2;  ///< γ''
  Real resolution_m;    ///< what rounding leaves unsure of the gap
};

/// The same, computed in double.
struct SketchedGap {
  double gap_m;
  double rate_mps;
  double size_m;  ///< of the numbers that it was computed from
};

/// Bounds while both pieces last.
struct GapBounds {
  Real most_inward_mps2;  ///< γ'' >= -this
  Real most_jerk_mps3;    ///< |γ'''| <= this, while the bodies are all but in touch
  Real most_speed_mps;    ///< of the bodies together
  Real unsure_mps;        ///< what rounding leaves unsure of γ'
};

/// A ball over a plane.
class WallGap {
 public:
  WallGap(const Piece& piece, double radius_m, const Wall& wall, int bits);
  Gap at(const Real& time_s) const;
  GapBounds bounds() const;
  std::int64_t cost() const { return piece_.cost(); }
  bool is_sketched() const { return piece_.is_sketched(); }
  SketchedGap sketch_at(double time_s) const;
  std::int64_t sketch_cost() const { return piece_.sketch_cost(); }

 private:
  const Piece& piece_;
  Vector normal_;
  Vec3 plain_normal_;
  Real reach_m_;
  int bits_;
};

/// Two balls.
class PairGap {
 public:
  PairGap(const Piece& a, double radius_a_m, const Piece& b, double radius_b_m, int bits);
  Gap at(const Real& time_s) const;
  GapBounds bounds() const;
  std::int64_t cost() const { return a_.cost() + b_.cost(); }
  bool is_sketched() const { return a_.is_sketched() && b_.is_sketched(); }
  SketchedGap sketch_at(double time_s) const;
  std::int64_t sketch_cost() const { return a_.sketch_cost() + b_.sketch_cost(); }

 private:
  const Piece& a_;
  const Piece& b_;
  Real reach_m_;
  int bits_;
};

enum class Found {
  nothing,
  impact,      ///< they meet
  unresolved,  ///< they touch so gently that no digit here tells whether they meet, graze or stay in touch
};

struct FirstContact {
  Found found = Found::nothing;
  Real time_s = 0;
};

/// The first contact within [from_s, until_s]. Adds to `work` what it cost, in multiplications.
FirstContact first_contact(const WallGap& gap, const Real& from_s, const Real& until_s, std::int64_t& work);
FirstContact first_contact(const PairGap& gap, const Real& from_s, const Real& until_s, std::int64_t& work);

}  // namespace carom::converged
