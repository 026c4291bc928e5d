#include "app/laws.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>
#include <memory>

#include "app/layout.h"
#include "carom/law_engine.h"
#include "core/error.h"

namespace carom {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> law_files() {
  std::vector<fs::path> files;
  if (!fs::is_directory(law_folder())) return files;
  for (const fs::directory_entry& entry : fs::directory_iterator(law_folder())) {
    if (entry.is_regular_file() && entry.path().extension() == ".toml") files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

fs::path law_file(const std::string& word) {
  if (fs::is_regular_file(word)) return word;
  std::vector<std::string> names;
  for (const fs::path& file : law_files()) {
    names.push_back(file.stem().string());
    if (names.back() == word) return file;
  }
  throw InputError(
      fmt::format("no law \"{}\"; allowed: a path to a .toml file, or one that comes with Carom: {}", word,
                  fmt::join(names, ", ")));
}

}  // namespace

std::vector<LawFile> load_laws(const std::vector<std::string>& words) {
  std::vector<LawFile> laws;
  for (const std::string& word : words) {
    LawFile law = load_law(law_file(word));
    for (const LawFile& other : laws) {
      if (other.id != law.id) continue;
      throw InputError(fmt::format("{}: {} is called {} too, allowed: files with different names", law.file,
                                   other.file, law.id));
    }
    laws.push_back(std::move(law));
  }
  return laws;
}

std::vector<LawFile> all_laws() {
  std::vector<LawFile> laws;
  for (const fs::path& file : law_files()) laws.push_back(load_law(file));
  return laws;
}

EngineSource law_source(std::vector<LawFile> laws) {
  const std::shared_ptr<const Engine> engine = make_law_engine(std::move(laws));
  return {std::string(kLawEngineName), [engine]() -> const Engine& { return *engine; }};
}

}  // namespace carom
