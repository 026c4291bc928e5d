#pragma once

#include <string>

#include "comparison/results.h"
#include "report/page/html.h"

namespace carom::page {

/// How to read the page. @param markdown  the text, from the page's web folder
void add_guide(Node parent, const std::string& markdown);

/// What each engine is, and what it cannot do.
void add_engines(Node parent, const Results& results);

/// Where and how all of this was made.
void add_footer(Node parent, const Results& results);

}  // namespace carom::page
