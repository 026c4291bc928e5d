#include "report/page/math.h"

#include <fmt/format.h>

namespace carom::page {

namespace {

std::string element(const char* tag, const std::string& inside) {
  return fmt::format("<{0}>{1}</{0}>", tag, inside);
}

/// Text inside an element: < and & are MathML's, too.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '<') {
      safe += "&lt;";
    } else if (c == '&') {
      safe += "&amp;";
    } else {
      safe += c;
    }
  }
  return safe;
}

std::string joined(std::initializer_list<std::string> parts) {
  std::string all;
  for (const std::string& part : parts) all += part;
  return all;
}

}  // namespace

std::string mi(const std::string& name) {
  return element("mi", escaped(name));
}

std::string mn(const std::string& digits) {
  return element("mn", escaped(digits));
}

std::string mo(const std::string& sign) {
  return element("mo", escaped(sign));
}

std::string mtext(const std::string& words) {
  return element("mtext", escaped(words));
}

std::string row(std::initializer_list<std::string> parts) {
  return element("mrow", joined(parts));
}

std::string sub(const std::string& base, const std::string& index) {
  return element("msub", base + index);
}

std::string sup(const std::string& base, const std::string& power) {
  return element("msup", base + power);
}

std::string frac(const std::string& above, const std::string& below) {
  return element("mfrac", above + below);
}

void add_formula(Node parent, std::initializer_list<std::string> parts) {
  const std::string math = joined(parts);
  Node line = add(add(parent, "div", {{"class", "formula"}}), "math", {{"display", "block"}});
  line.append_buffer(math.data(), math.size(), pugi::parse_default | pugi::parse_fragment,
                     pugi::encoding_utf8);
}

}  // namespace carom::page
