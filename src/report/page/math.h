#pragma once

#include <initializer_list>
#include <string>

#include "report/page/html.h"

namespace carom::page {

// Formulas as MathML, which browsers lay out and screen readers read. Each function makes one element.

/// A name: x, v, or Greek.
std::string mi(const std::string& name);
/// A number.
std::string mn(const std::string& digits);
/// An operator, a relation or a bracket.
std::string mo(const std::string& sign);
/// A few words.
std::string mtext(const std::string& words);
std::string row(std::initializer_list<std::string> parts);
std::string sub(const std::string& base, const std::string& index);
std::string sup(const std::string& base, const std::string& power);
std::string frac(const std::string& above, const std::string& below);

/// A formula on a line of its own. @pre each part was made by these functions
void add_formula(Node parent, std::initializer_list<std::string> parts);

}  // namespace carom::page
