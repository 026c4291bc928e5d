#pragma once

#include <string>

namespace carom::test {

/// A cell of a table of numbers, as the page writes it.
inline std::string cell(const std::string& text) {
  return "<td class=\"number\">" + text + "</td>";
}

}  // namespace carom::test
