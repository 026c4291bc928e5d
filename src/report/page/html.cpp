#include "report/page/html.h"

#include <cmark.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <memory>
#include <sstream>
#include <string_view>

namespace carom::page {

namespace {

/// These start on a line of their own, so that two pages can be compared line by line.
bool starts_line(std::string_view tag) {
  constexpr std::array kBlocks = {"section", "header",  "main",  "footer", "h2",    "h3",      "p",
                                  "ul",      "dl",      "div",   "tr",     "tbody", "figure",  "li",
                                  "svg",     "details", "table", "path",   "g",     "polygon", "dt"};
  return std::find(kBlocks.begin(), kBlocks.end(), tag) != kBlocks.end();
}

std::string without_scheme(const std::string& address) {
  const std::size_t end = address.find("://");
  return end == std::string::npos ? address : address.substr(end + 3);
}

void name_address_instead_of_linking(Node link) {
  const std::string address = link.attribute("href").value();
  const bool is_its_own_text = address == link.text().get();
  if (is_its_own_text) link.text().set(without_scheme(address).c_str());
  if (!is_its_own_text && !address.empty()) say(link, " (" + without_scheme(address) + ")");
  link.set_name("span");
  link.remove_attributes();
}

/// Keeps what cmark wrote within this page and its outline.
void tame(Node parent, int heading_shift) {
  for (Node child : parent.children()) {
    tame(child, heading_shift);
    const std::string name = child.name();
    if (name == "a") {
      name_address_instead_of_linking(child);
    } else if (name == "img") {
      const std::string description = child.attribute("alt").value();
      child.set_name("span");
      child.remove_attributes();
      say(child, description);
    } else if (name.size() == 2 && name[0] == 'h' && name[1] >= '1' && name[1] <= '6') {
      const int level = std::min(name[1] - '0' + heading_shift, 6);
      child.set_name(("h" + std::to_string(level)).c_str());
    }
  }
}

void replace_all(std::string& text, std::string_view what, std::string_view with) {
  for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + with.size())) {
    text.replace(at, what.size(), with);
  }
}

}  // namespace

Node add(Node parent, const char* tag, std::initializer_list<Attribute> attributes, const std::string& text) {
  if (starts_line(tag)) say(parent, "\n");
  Node node = parent.append_child(tag);
  for (const Attribute& attribute : attributes) {
    if (attribute.value.empty()) continue;
    node.append_attribute(attribute.name).set_value(attribute.value.c_str());
  }
  if (!text.empty()) say(node, text);
  return node;
}

void say(Node parent, const std::string& text) {
  parent.append_child(pugi::node_pcdata).set_value(text.c_str());
}

void add_markdown(Node parent, const std::string& markdown, int heading_shift) {
  const std::unique_ptr<char, decltype(&std::free)> html(
      cmark_markdown_to_html(markdown.data(), markdown.size(), CMARK_OPT_DEFAULT | CMARK_OPT_VALIDATE_UTF8),
      &std::free);
  pugi::xml_document fragment;
  fragment.load_string(html.get(), pugi::parse_default | pugi::parse_fragment | pugi::parse_ws_pcdata);
  tame(fragment, heading_shift);
  for (const Node child : fragment.children()) parent.append_copy(child);
}

Node add_table(Node parent, const char* look, const std::string& caption,
               const std::vector<Heading>& headings) {
  Node box = add(parent, "div",
                 {{"class", "scroll"}, {"role", "region"}, {"tabindex", "0"}, {"aria-label", caption}});
  Node table = add(box, "table", {{"class", look}});
  add(table, "caption", {}, caption);
  Node row = add(add(table, "thead"), "tr");
  for (const Heading& heading : headings) {
    add(row, "th", {{"class", heading.look}, {"scope", "col"}}, heading.text);
  }
  return add(table, "tbody");
}

void add_number(Node row, const std::string& text) {
  add(row, "td", {{"class", "number"}}, text);
}

Node add_details(Node parent, const std::string& summary) {
  Node details = add(parent, "details");
  add(details, "summary", {}, summary);
  return details;
}

std::string markup(Node node) {
  std::ostringstream out;
  // HTML reads <td/> as an open tag, so every element gets its end tag …
  node.print(out, "", pugi::format_raw | pugi::format_no_empty_element_tags, pugi::encoding_utf8);
  std::string text = std::move(out).str();
  // … except the two of Markdown that must not have one.
  replace_all(text, "<br></br>", "<br/>");
  replace_all(text, "<hr></hr>", "<hr/>");
  return text;
}

}  // namespace carom::page
