#pragma once

#include <cstdint>
#include <vector>

namespace carom {

// What the course program's formulas (carom/textbook/program.h) come to, measured by running them. Nothing
// here is known beforehand but the mechanics that they are held against.

/// Random pairs that meet, each through one update, against the elastic law in double precision.
struct ImpulseAccuracy {
  std::int64_t pairs = 0;  ///< that approached, and got an impulse
  double velocity = 0.0;   ///< the largest error of a velocity, of the sum of the speeds
  double momentum = 0.0;   ///< the largest change of Σ m v, of Σ m|v|
  double energy = 0.0;     ///< the largest change of Σ ½ m v², of itself
};

/// Two balls at rest that overlap, through one update. R is the sum of the radii.
struct ShiftMeasured {
  double overlap = 0.0;  ///< of R
  double first = 0.0;    ///< what the first ball is moved by, in overlaps
  double second = 0.0;   ///< what the second is moved by, in overlaps
  double gap = 0.0;      ///< between them afterwards, of R
  double centre_of_mass =
      0.0;  ///< what it is moved by, in overlaps, where the second weighs a hundred times more
};

/// A ball dropped on another in a shaft with a floor, both elastic, for ten seconds.
struct DropMeasured {
  int rate_hz = 0;          ///< updates a second
  double energy = 0.0;      ///< the change of the energy, of what it was
  double correction = 0.0;  ///< what moving balls apart did to it, of what it was
  double flight = 0.0;      ///< what the fall in whole updates and late impacts did, of what it was
};

/// Two balls with one centre and one velocity, and a third that they fly at.
struct CoincidentMeasured {
  int not_finite_after_one = 0;  ///< balls whose state is not a number after one update
  int not_finite_after_all = 0;  ///< … after they would have met the third
  bool third_untouched = false;  ///< whether that one is where it was
};

/// One impact of two balls on a line by the law of impact, m₁ = 1 kg at 2 m/s and m₂ = 3 kg at −1 m/s.
struct SquaredLaw {
  double restitution = 1.0;
  double momentum_before = 0.0;  ///< Σ m v, kg m/s
  double momentum_after = 0.0;
  double squares_before = 0.0;  ///< Σ m v², the law as it was printed, J
  double squares_after = 0.0;
};

/// What another frame rate makes of the same program.
struct RateMeasured {
  int rate_hz = 0;
  double speed_mps = 0.0;  ///< of a ball whose velocity is 0.02 m per update
  double unseen = 0.0;     ///< share of balls at 20 m/s that pass a resting one head-on without an impact
  double unseen_by_formula = 0.0;  ///< 1 − R/(v · update), or 0: see examine_textbook.cpp
  double late_s = 0.0;             ///< by how much the impacts of the others come late, their mean
};

/// What is drawn of a ball that flies its circumference once.
struct SpinMeasured {
  double drawn_rad = 0.0;
  double rolling_rad = 0.0;  ///< path over radius
};

struct TextbookFindings {
  ImpulseAccuracy impulse;
  std::vector<ShiftMeasured> shifts;
  double swapped =
      0.0;  ///< how far balls end from where they do when they are numbered the other way, in overlaps
  std::vector<DropMeasured> drops;
  CoincidentMeasured coincident;
  std::vector<SquaredLaw> squares;
  std::vector<RateMeasured> rates;
  SpinMeasured spin;
};

/// Runs all of it; the same bits every time.
TextbookFindings examine_textbook();

}  // namespace carom
