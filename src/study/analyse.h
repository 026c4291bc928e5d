#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "study/study.h"

namespace carom {

// What the numbers of a study say. Nothing here measures or prints.

/// The middle of some timed runs, and how far they spread; by linear interpolation between them.
struct Spread {
  double least = 0.0;
  double lower_quartile = 0.0;
  double median = 0.0;
  double upper_quartile = 0.0;
};

/// @pre there is a value
Spread spread_of(std::vector<double> values);

/// What errors of a scene are measured by: positions where there is a truth, else the energy.
enum class StudyMeasure { position_m, energy };

StudyMeasure measure_of(const StudyScene& scene);

/// Below it errors cannot be told apart: the truth's uncertainty; of the energy, and of a truth that is known
/// better, the machine epsilon of double precision (times the smallest radius).
double floor_of(const StudyScene& scene);

/// A point of the diagram.
struct Mark {
  std::size_t point = 0;  ///< index into StudyScene::points
  double error = 0.0;     ///< at least the floor
  Spread cpu_s;
};

/// Every point whose error is known and that was timed, in the scene's order.
std::vector<Mark> marks_of(const StudyScene& scene);

/// The Pareto front: of these marks those than which none is both faster and better (as fast and better,
/// faster and as good), ascending in time, descending in error.
std::vector<Mark> front_of(std::vector<Mark> marks);

/// "carom" of "carom:toi"; an engine without variants is its own family. Profiles are families of their own.
std::string family_of(const std::string& label);

/// The families of a scene, in the order of its engines.
std::vector<std::string> families_of(const StudyScene& scene);

std::vector<Mark> marks_of_family(const StudyScene& scene, const std::vector<Mark>& marks,
                                  const std::string& family);

/// The fastest mark with at most this error; nothing where there is none.
std::optional<Mark> cheapest(const std::vector<Mark>& marks, double tolerance);

/// The best mark that takes at most this time; nothing where there is none.
std::optional<Mark> best_within(const std::vector<Mark>& marks, double cpu_s);

/// The tolerances that a study names the cheapest setting for: m, or relative where energy is measured.
inline constexpr std::array kTolerances = {1e-2, 1e-4, 1e-6, 1e-8};
/// Decimal digits from one of them to the next.
inline constexpr double kDigitsApart = 2.0;

/// One engine with one setting over all steps: a line of the diagram.
struct Series {
  std::string engine;
  std::string setting;
  std::vector<std::size_t> points;  ///< coarse steps first; indices into StudyScene::points
};

/// Every series of a scene; settings that are tried at one step alone are series of one point.
std::vector<Series> series_of(const StudyScene& scene);

/// How errors fall with the step.
struct Order {
  enum class Kind {
    fitted,
    rounding,  ///< every error is within what rounding may come to: there is nothing to fit
    too_few,   ///< fewer than kFewestToFit errors are neither at the floor nor as large as the scene
  };
  Kind kind = Kind::too_few;
  double order = 0.0;      ///< p in error ~ stepᵖ by least squares; below 0: a shorter step makes it worse
  double r_squared = 0.0;  ///< of the fit
  std::size_t used = 0;    ///< errors in the fit
};

inline constexpr std::size_t kFewestToFit = 4;
/// A fit whose R² is below this is no straight line, and its slope a hint at most: when an impact comes
/// within a step is chance, and scatters errors.
inline constexpr double kStraight = 0.9;

/// An error at a step.
struct ErrorAtStep {
  double step_s = 0.0;
  double error = 0.0;
  double rounding = 0.0;  ///< what rounding alone may come to
};

/// Fits the order. Left out are
/// - what cannot be told from the truth: errors up to twice the floor;
/// - what does not hit as it should any more: errors of `saturation` and more;
/// - the round-off floor: where the smallest error is not that of the finest step, errors stop falling there,
/// and
///   an error C hᵖ that has come down to a rounding of the same size is twice either of them. So that it is
///   rounding by less than about a quarter, an error must be four times the smallest, and of a coarser step.
/// @param errors  coarse steps first
Order fit_order(const std::vector<ErrorAtStep>& errors, double floor, double saturation);

Order order_of(const StudyScene& scene, const Series& series);

/// By which factor the time grows for an error that is ten times smaller: the slope of log time over -log
/// error, of the errors that order_of() uses. Nothing where there are too few, or errors do not fall.
std::optional<double> price_of_digit(const StudyScene& scene, const Series& series);

/// What a run costs by what it did.
struct Cost {
  std::optional<double> per_ball_and_step_ns;  ///< nothing where the engine takes no steps
  std::optional<double> per_impact_ns;         ///< nothing where there was none
};

/// @pre the point was timed
Cost cost_of(const StudyScene& scene, const StudyPoint& point);

/// Whether any number of balls was timed.
bool was_timed(const StudyGrowth& growth);

/// Of a gas that was timed; an engine without steps is held against those that have.
std::optional<double> per_ball_and_step_ns(const GrowthPoint& point);

/// A place on a peer's front where it is ahead of one's own.
struct Lead {
  std::string peer;  ///< family
  Mark mark;
  std::optional<Mark> own_at_error;  ///< the own cheapest that is as good; nothing where none is
  std::optional<Mark> own_at_cost;   ///< the own best that is as fast; nothing where none is
};

/// Where peers are ahead of `family`: the marks of each peer's front for which it has none that is as good
/// and as fast. Times are as good as each other where their quartiles overlap; errors where both are at the
/// floor.
std::vector<Lead> leads_over(const StudyScene& scene, const std::string& family);

/// One row of the overview: all families held against each other in one scene.
struct Comparison {
  struct Entry {
    std::string family;
    std::optional<double> error_at_cost;
    std::optional<double> cost_at_error_s;
  };
  /// The time within which every family that was timed has at least one run: the slowest one's fastest.
  double cost_s = 0.0;
  /// The error that every family that was timed reaches: the best of the worst one.
  double error = 0.0;
  std::vector<Entry> entries;
};

/// Nothing where no family was timed.
std::optional<Comparison> compare_families(const StudyScene& scene);

/// How the cost of a step grows: x in cost ~ ballsˣ by least squares over all numbers of balls that were
/// timed; nothing with fewer than three.
struct Growth {
  double exponent = 0.0;
  double r_squared = 0.0;
};
std::optional<Growth> growth_of(const StudyGrowth& growth);

}  // namespace carom
