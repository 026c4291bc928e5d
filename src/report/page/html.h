#pragma once

#include <initializer_list>
#include <pugixml.hpp>
#include <string>
#include <vector>

namespace carom::page {

// The page is built as a tree of nodes, so that what a scene or an engine says can never become markup.

using Node = pugi::xml_node;

struct Attribute {
  const char* name;
  std::string value;
};

/// A new last child of `parent`, with this text in it. An attribute without a value is left out.
Node add(Node parent, const char* tag, std::initializer_list<Attribute> attributes = {},
         const std::string& text = {});

/// Text after what `parent` already has.
void say(Node parent, const std::string& text);

/// Markdown as it stands in scene files. Raw HTML is left out. So that the page asks nothing of a network,
/// links become their text and their address, and images their description.
/// @param heading_shift  what is added to the level of its headings
void add_markdown(Node parent, const std::string& markdown, int heading_shift);

/// What stands above a column, and how the style sheet calls such a column ("number").
struct Heading {
  std::string text;
  std::string look;
};

/// A table that scrolls in a box of its own, which the keyboard can reach. @return its body
Node add_table(Node parent, const char* look, const std::string& caption,
               const std::vector<Heading>& headings);

/// A cell of a table that holds a number.
void add_number(Node row, const std::string& text);

/// A closed box with a summary that opens it.
Node add_details(Node parent, const std::string& summary);

/// The tree as HTML that is well-formed XML too.
std::string markup(Node node);

}  // namespace carom::page
