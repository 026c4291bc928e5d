#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "carom/laws/law_file.h"
#include "engine/engine.h"
#include "trajectory/record.h"

namespace carom {

/// The name of the right law among those that come with Carom.
inline constexpr std::string_view kRightLaw = "right";

/// The laws that words of the command line mean: paths, or names of those that come with Carom.
/// @throws InputError also where two of them would run under one name
std::vector<LawFile> load_laws(const std::vector<std::string>& words);

/// Every law that comes with Carom, in the order of their names.
std::vector<LawFile> all_laws();

/// carom:law with these laws as its profiles.
EngineSource law_source(std::vector<LawFile> laws);

}  // namespace carom
