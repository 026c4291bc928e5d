#include "report/page.h"

#include "core/files.h"
#include "report/page/accuracy.h"
#include "report/page/catches.h"
#include "report/page/chapters.h"
#include "report/page/coefficients.h"
#include "report/page/costs.h"
#include "report/page/html.h"
#include "report/page/laws.h"
#include "report/page/measured.h"
#include "report/page/orders.h"
#include "report/page/overview.h"
#include "report/page/scene_section.h"
#include "report/page/speed.h"
#include "report/page/study.h"
#include "report/page/style.h"
#include "report/page/survival.h"
#include "report/page/symmetry.h"
#include "report/page/textbook.h"

namespace carom {

namespace {

using namespace page;

bool has_viewer(const std::filesystem::path& viewer) {
  return std::filesystem::exists(viewer / "report.js");
}

/// Style and script stand before the body and are not part of its tree: their text must not be escaped.
std::string head(const std::string& title, const std::filesystem::path& web,
                 const std::filesystem::path& viewer) {
  const std::string viewer_style = has_viewer(viewer) ? read_file(viewer / "report.css") : "";
  const std::string viewer_script = has_viewer(viewer) ? read_file(viewer / "report.js") : "";
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
         "<title>" +
         title + "</title>\n<style>\n" + read_file(web / "page.css") + viewer_style + "</style>\n<script>\n" +
         read_file(web / "page.js") + viewer_script + "</script>\n</head>\n";
}

/// Counted by tests/benchmarks/run, and not there where that never ran.
std::filesystem::path costs_file(const std::filesystem::path& web) {
  return web.parent_path() / "measured/costs.json";
}

/// Measured by tests/benchmarks/run, like the costs.
std::filesystem::path published_file(const std::filesystem::path& web) {
  return web.parent_path() / "measured/published.json";
}

/// Measured by the same.
std::filesystem::path orders_file(const std::filesystem::path& web) {
  return web.parent_path() / "measured/orders.json";
}

std::filesystem::path speed_file(const std::filesystem::path& web) {
  return web.parent_path() / "measured/speed.json";
}

/// Found out by the same.
std::filesystem::path catches_file(const std::filesystem::path& web) {
  return web.parent_path() / "measured/gates.json";
}

void add_navigation(Node body, const Results& results, const std::filesystem::path& web, bool has_study) {
  add(body, "a", {{"class", "skip"}, {"href", "#overview"}}, "Skip to the results");
  Node bar = add(body, "nav", {{"aria-label", "Parts of this page"}});
  add(bar, "a", {{"href", "#overview"}}, "All scenes");
  if (has_judgements(results)) add(bar, "a", {{"href", "#accuracy"}}, "Who is right");
  if (has_hard_cases(results)) add(bar, "a", {{"href", "#survival"}}, "Hard cases");
  if (!results.coefficients.empty()) add(bar, "a", {{"href", "#coefficients"}}, "Impacts");
  if (has_symmetries(results)) add(bar, "a", {{"href", "#symmetry"}}, "Symmetries");
  if (results.textbook) add(bar, "a", {{"href", "#textbook"}}, "The course program");
  if (!results.laws.empty()) add(bar, "a", {{"href", "#laws"}}, "Laws of impact");
  if (has_study) add(bar, "a", {{"href", "#study"}}, "What accuracy costs");
  add(bar, "a", {{"href", "#guide"}}, "How to read this page");
  add(bar, "a", {{"href", "#engines"}}, "The engines");
  if (std::filesystem::exists(published_file(web)))
    add(bar, "a", {{"href", "#measured"}}, "Published values");
  if (std::filesystem::exists(orders_file(web))) add(bar, "a", {{"href", "#orders"}}, "Orders");
  if (std::filesystem::exists(catches_file(web))) {
    add(bar, "a", {{"href", "#catches"}}, "What the gates catch");
  }
  if (std::filesystem::exists(speed_file(web))) add(bar, "a", {{"href", "#speed"}}, "How fast");
  if (std::filesystem::exists(costs_file(web))) add(bar, "a", {{"href", "#costs"}}, "What effects cost");
}

}  // namespace

std::string render_page(const Results& results, const std::filesystem::path& web,
                        const std::filesystem::path& viewer, const Study* study) {
  const bool plays = has_viewer(viewer);
  const Legend legend(results.scenes);
  pugi::xml_document document;
  Node body = document.append_child("body");
  add_navigation(body, results, web, study != nullptr);
  Node main = add(body, "main");
  add_overview(main, results, legend);
  add_accuracy(main, results, legend);
  add_survival(main, results, legend);
  add_coefficients(main, results.coefficients, legend);
  add_symmetries(main, results, legend);
  if (study != nullptr) add_study(main, *study, read_file(web / "study.md"));
  for (const SceneComparison& scene : results.scenes) add_scene(main, scene, legend, plays);
  add_textbook(main, results.textbook);
  add_laws(main, results.laws);
  add_guide(main, read_file(web / "guide.md"));
  add_engines(main, results);
  add_measured(main, published_file(web));
  add_orders(main, orders_file(web));
  add_catches(main, catches_file(web));
  add_speed(main, speed_file(web));
  add_costs(main, costs_file(web));
  add_footer(body, results);
  return head("Carom report", web, viewer) + markup(body) + "\n</html>\n";
}

std::string render_study_page(const Study& study, const std::filesystem::path& web) {
  pugi::xml_document document;
  Node body = document.append_child("body");
  add(body, "nav", {{"aria-label", "Parts of this page"}});
  Node main = add(body, "main");
  add(add(main, "header", {{"class", "top"}}), "h1", {}, "Carom study");
  add_study(main, study, read_file(web / "study.md"));
  return head("Carom study", web, {}) + markup(body) + "\n</html>\n";
}

}  // namespace carom
