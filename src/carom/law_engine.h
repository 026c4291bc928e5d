#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "carom/laws/law_file.h"
#include "engine/engine.h"

namespace carom {

inline constexpr std::string_view kLawEngineName = "carom:law";

/// The hand-written engine with laws of impact from files, each as a profile with the name of its file: what
/// differs from carom:toi is the law between balls and nothing else. Of two laws each can be switched to the
/// other. @pre every id is another
std::unique_ptr<Engine> make_law_engine(std::vector<LawFile> laws);

}  // namespace carom
