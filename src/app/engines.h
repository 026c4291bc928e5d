#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "comparison/results.h"
#include "engine/truth_source.h"
#include "trajectory/record.h"

namespace carom {

/// Every engine that this program can run: the hand-written one, the reference engines that were built, and
/// the modules of folders that the user names.
class EngineCatalog {
 public:
  /// @param modules  the folder with the reference engines' modules
  /// @param extra    folders with further modules; an engine is called like its file
  /// @param threads  for a run of the hand-written engine
  EngineCatalog(const std::filesystem::path& modules, const std::vector<std::string>& extra,
                std::size_t threads = 1);

  const std::vector<EngineSource>& sources() const { return sources_; }
  const std::vector<MissingEngine>& missing() const { return missing_; }

  /// Names that a scene's gate may use, built or not.
  std::vector<std::string> names() const;

  /// An engine, or a variant of the hand-written one. @throws InputError with what there is
  EngineSource find(const std::string& name) const;

 private:
  std::vector<EngineSource> sources_;
  std::vector<MissingEngine> missing_;
  std::size_t threads_;
};

/// What truths come from, in the order in which they are asked.
std::vector<std::shared_ptr<const TruthSource>> truth_sources();

}  // namespace carom
