#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "carom/laws/law_file.h"
#include "carom/laws/pair_meeting.h"

namespace carom {

/// A name that an expression may use.
struct LawName {
  std::string_view name;
  std::string_view meaning;  ///< with its unit
};

/// What an expression knows of the two balls, in the order in which people read it.
const std::vector<LawName>& law_names();

/// The functions that an expression may call.
const std::vector<std::string_view>& law_functions();

/// A law of a file, ready to be asked. It depends on no locale and keeps nothing from one pair to the next.
class LawFormula {
 public:
  /// @throws InputError with the place in the file where an expression is wrong, and the names that exist
  explicit LawFormula(LawFile file);
  LawFormula(const LawFormula&) = delete;
  LawFormula& operator=(const LawFormula&) = delete;
  ~LawFormula();

  const LawFile& file() const { return file_; }

  /// What the law gives this pair. Not a number where its expressions are none.
  PairImpulses impulses(const PairMeeting& pair);

 private:
  struct Compiled;
  LawFile file_;
  std::unique_ptr<Compiled> compiled_;
};

}  // namespace carom
