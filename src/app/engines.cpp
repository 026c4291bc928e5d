#include "app/engines.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <memory>

#include "carom/carom_engine.h"
#include "carom/law_engine.h"
#include "core/error.h"
#include "engine/modules.h"
#include "reference/closed_form/closed_form.h"
#include "reference/converged/converged.h"
#include "reference/engine_table.h"
#include "reference/exact/exact.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

EngineSource module_source(const std::string& name, const fs::path& file) {
  return {name, [file]() -> const Engine& { return open_engine_module(file); }};
}

EngineSource carom_source(const std::string& name, std::size_t threads) {
  const std::shared_ptr<const Engine> engine = make_carom_engine(name, threads);
  return {name, [engine]() -> const Engine& { return *engine; }};
}

std::vector<fs::path> modules_in(const fs::path& folder) {
  if (!fs::is_directory(folder)) {
    throw InputError(fmt::format("{}: no such folder of engine modules", folder.string()));
  }
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (entry.path().extension() == ".so") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace

EngineCatalog::EngineCatalog(const fs::path& modules, const std::vector<std::string>& extra,
                             std::size_t threads)
    : threads_(threads) {
  sources_.push_back(carom_source("carom", threads_));
  for (const KnownEngine& known : kKnownEngines) {
    const std::string name(known.name);
    const fs::path file = modules / (name + ".so");
    if (fs::exists(file)) {
      sources_.push_back(module_source(name, file));
    } else {
      missing_.push_back({name, std::string(known.package)});
    }
  }
  for (const std::string& folder : extra) {
    for (const fs::path& file : modules_in(folder)) {
      const std::string name = file.stem().string();
      const std::vector<std::string> taken = names();
      if (std::find(taken.begin(), taken.end(), name) != taken.end()) {
        throw InputError(
            fmt::format("{}: there is an engine {} already, rename the module", file.string(), name));
      }
      sources_.push_back(module_source(name, file));
    }
  }
}

std::vector<std::string> EngineCatalog::names() const {
  std::vector<std::string> names;
  for (const EngineSource& source : sources_) names.push_back(source.name);
  for (const MissingEngine& engine : missing_) names.push_back(engine.name);
  for (std::string& variant : carom_variant_names()) names.push_back(std::move(variant));
  names.emplace_back(kLawEngineName);
  return names;
}

EngineSource EngineCatalog::find(const std::string& name) const {
  for (const EngineSource& source : sources_) {
    if (source.name == name) return source;
  }
  if (name == kLawEngineName) {
    throw InputError(fmt::format("engine {} takes part with --law FILE, and is not named", name));
  }
  const std::vector<std::string> variants = carom_variant_names();
  if (std::find(variants.begin(), variants.end(), name) != variants.end()) {
    return carom_source(name, threads_);
  }
  for (const MissingEngine& engine : missing_) {
    if (engine.name == name) {
      throw InputError(fmt::format("engine {} is not built: {} is not installed", name, engine.package));
    }
  }
  if (name.starts_with("carom:")) {
    throw InputError(fmt::format("no variant \"{}\"; allowed: {}", name, fmt::join(variants, ", ")));
  }
  std::vector<std::string> built;
  for (const EngineSource& source : sources_) built.push_back(source.name);
  throw InputError(fmt::format("no engine \"{}\"; allowed: {}, and carom's variants (carom list engines)",
                               name, fmt::join(built, ", ")));
}

std::vector<std::shared_ptr<const TruthSource>> truth_sources() {
  return {make_closed_form_truth(), make_exact_truth(), make_converged_truth()};
}

}  // namespace carom
