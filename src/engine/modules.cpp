#include "engine/modules.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include "core/error.h"

namespace carom {

namespace {

#define CAROM_STRINGIFY_EXPANDED(name) #name
#define CAROM_STRINGIFY(name) CAROM_STRINGIFY_EXPANDED(name)

}  // namespace

Engine& open_engine_module(const std::filesystem::path& file) {
  void* module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (module == nullptr) throw MachineError(fmt::format("cannot load engine: {}", dlerror()));
  void* symbol = dlsym(module, CAROM_STRINGIFY(CAROM_ENGINE_SYMBOL));
  if (symbol == nullptr) {
    throw MachineError(fmt::format("{} is no engine module: it lacks {}", file.string(),
                                   CAROM_STRINGIFY(CAROM_ENGINE_SYMBOL)));
  }
  Engine* engine = reinterpret_cast<EngineFactory>(symbol)();
  if (engine == nullptr) throw MachineError(fmt::format("{} hands out no engine", file.string()));
  return *engine;
}

}  // namespace carom
