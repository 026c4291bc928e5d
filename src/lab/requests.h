#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "engine/truth_source.h"
#include "trajectory/record.h"

namespace carom {

/// What one request may ask for at most.
struct LabLimits {
  std::size_t body_bytes = std::size_t{1} << 20U;
  std::size_t balls = 5000;
  std::size_t states = 2'000'000;  ///< of one run: balls × frames
  std::size_t engines = 8;
  double run_seconds = 20.0;      ///< of one run, and of the truth
  double request_seconds = 60.0;  ///< of all that a request does
  double memory_mib = 1024.0;     ///< of one run
};

/// What the lab needs to know of the program that it is a part of.
struct LabSetup {
  std::filesystem::path scenarios;  ///< <group>/<name>.toml
  std::filesystem::path page;       ///< the folder with the lab's page
  std::vector<EngineSource> engines;
  std::vector<std::string> engine_names;  ///< that a scene's gates may name
  /// The engines of these names (`name` or `name@profile`), and one by the text of a law file where there is
  /// one. @throws InputError as on the command line
  std::function<std::vector<EngineChoice>(const std::vector<std::string>& names, const std::string& law)>
      choose;
  /// A report on a law file as JSON; none: this program cannot tell.
  std::function<std::string(const std::string& law)> judge_law;
  std::vector<std::shared_ptr<const TruthSource>> truths;
  int parallel = 1;
  LabLimits limits;
};

/// An answer of the API: an HTTP status and a JSON text.
struct LabAnswer {
  int status = 200;
  std::string json;
};

/// {"error": message}
LabAnswer lab_error(int status, std::string_view message);

/// What can be asked for. Bodies are JSON objects; what is wrong in them is answered with status 400 and, for
/// scenes, laws and engines, the message of the command line.
///
///   modes    → [{id, title, about, dimension}], course/ first
///   engines  → [{label (name or name@profile), name, about, profile, profile_about, version, precision,
///            cannot: {effect: reason}}]
///   scene    {id} → {toml}
///   run      {toml or id, engines?: labels, law?: law file, truth?: true} → a playback (report/playback.h);
///            the law's run is called law@own. With both, toml is run and id is its name
///   toml     {toml or id, event: {…}} → {toml} with the event appended as [[event]], keys as in a scene file
///   law      {law: law file} → what it conserves and breaks
///
/// This is the body of a process of its own, which may be stopped at any time: it reads what users wrote, and
/// runs engines in further processes. It does not throw.
LabAnswer answer_lab(const LabSetup& setup, std::string_view what, const std::string& body);

}  // namespace carom
