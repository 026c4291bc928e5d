#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "carom/laws/law_file.h"
#include "carom/laws/pair_meeting.h"

namespace carom {

// What a law of impact keeps and what it breaks: asked over random pairs, of any law that answers with
// impulses.

using PairLaw = std::function<PairImpulses(const PairMeeting&)>;

/// What must hold in every impact, whatever the law's coefficients.
enum class LawRule {
  momentum,          ///< Σ m v is kept
  energy_elastic,    ///< Σ ½ m v² + ½ I ω² is kept where e = 1 and μ = 0
  energy_never_won,  ///< it never grows
  rebound,           ///< v_n′ = −e v_n
  parting,           ///< the balls do not go on approaching
  pushing,           ///< each ball is pushed away from the other, never pulled
  angular_momentum,  ///< Σ x × m v + I ω is kept, about any point
  exchange,          ///< ball 1 and ball 2 have the names only
  boost,             ///< it is the same from a moving train
  mirror,            ///< it is the same in a mirror
  units,             ///< it is the same in other units of mass, length and time
};

struct LawRuleName {
  LawRule rule;
  std::string_view name;     ///< as in JSON
  std::string_view meaning;  ///< a few words: what must hold
  std::string_view measure;  ///< what is measured, and in units of what
};

/// Every rule, in the order in which people read them.
const std::vector<LawRuleName>& law_rules();

/// How a law did by one rule. A pair breaks it where it is off by more than rounding can be.
struct RuleResult {
  LawRule rule = LawRule::momentum;
  double worst = 0.0;         ///< the largest measure over all pairs
  double median = 0.0;        ///< the measure that half of the pairs exceed
  double broken_share = 0.0;  ///< of the pairs, in [0, 1]
  PairMeeting worst_pair;     ///< the pair that `worst` is of

  bool holds() const { return broken_share == 0.0; }
};

struct LawReport {
  LawFile law;  ///< of the right law, only its name
  std::int64_t pairs = 0;
  std::uint64_t seed = 0;
  std::int64_t not_finite = 0;  ///< pairs for which the law gave what is no number; no rule was asked of them
  std::vector<RuleResult> results;  ///< one for each rule, in the order of law_rules()
};

inline constexpr std::int64_t kLawPairs = 20'000;
inline constexpr std::uint64_t kLawSeed = 1;

/// Asks a law about random pairs: masses over four powers of ten, radii over one, any normal, speeds and
/// spins, e in [0, 1], μ in [0, 1], β0 in [-1, 1]. The same seed gives the same pairs and the same bits.
/// @param law  may be asked about pairs in any order, several times each
LawReport examine_law(const LawFile& about, const PairLaw& law, std::int64_t pairs = kLawPairs,
                      std::uint64_t seed = kLawSeed);

/// The same of a law from a file.
LawReport examine_law(const LawFile& law, std::int64_t pairs = kLawPairs, std::uint64_t seed = kLawSeed);

/// The same of the law that carom has compiled in, three_parameter.h; without friction where the pairs are to
/// be held against a law that knows none.
LawReport examine_right_law(bool friction, std::int64_t pairs = kLawPairs, std::uint64_t seed = kLawSeed);

}  // namespace carom
