#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "engine/engine.h"

namespace carom::reference {

/// One setting in which the two profiles of an adapter differ: how it is called, and how it is copied from
/// one set-up to another. An adapter has a table of these; a row is all that a further setting takes.
template <class Setup>
struct SetupSwitch {
  std::string_view name;     ///< as in Simulation::settings()
  std::string_view meaning;  ///< what it does, a few words
  void (*copy)(Setup& to, const Setup& from);
};

/// Copies these members from one set-up to another.
template <auto... members, class Setup>
void copy_members(Setup& to, const Setup& from) {
  ((to.*members = from.*members), ...);
}

/// The table as the engine's interface shows it.
template <class Setup, std::size_t n>
std::vector<Switch> switches_of(const std::array<SetupSwitch<Setup>, n>& table) {
  std::vector<Switch> switches;
  switches.reserve(n);
  for (const SetupSwitch<Setup>& row : table)
    switches.push_back({std::string(row.name), std::string(row.meaning)});
  return switches;
}

/// `setup` with the settings of these names as `other` has them. @throws std::logic_error for an unknown name
template <class Setup, std::size_t n>
Setup switched(Setup setup, const Setup& other, std::span<const std::string> names,
               const std::array<SetupSwitch<Setup>, n>& table) {
  for (const std::string& name : names) {
    const auto row = std::find_if(table.begin(), table.end(),
                                  [&name](const SetupSwitch<Setup>& each) { return each.name == name; });
    if (row == table.end()) throw std::logic_error("no setting " + name + " to switch");
    row->copy(setup, other);
  }
  return setup;
}

/// Of an adapter's two profiles the one that is not `profile`.
inline std::string_view other_profile(std::string_view profile) {
  return profile == "default" ? "faithful" : "default";
}

}  // namespace carom::reference
