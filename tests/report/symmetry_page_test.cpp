#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>

#include "report/page/symmetry.h"

namespace carom::test {
namespace {

using page::Node;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

SceneComparison checked_scene(const std::string& id, std::vector<SymmetryResult> checks) {
  auto made = std::make_shared<Scenario>();
  made->id = id;
  made->title = "Scene " + id;
  for (const SymmetryResult& check : checks) made->symmetries.push_back(check.symmetry);
  SceneComparison comparison;
  comparison.scene = std::move(made);
  RunComparison& run = comparison.runs.emplace_back();
  run.run.engine = "engine";
  run.run.profile = "faithful";
  run.symmetries = {1e-10, std::move(checks)};
  return comparison;
}

SymmetryResult result(Symmetry symmetry, SymmetryVerdict verdict, double radii) {
  return {symmetry, verdict, "", radii, 0.0};
}

std::string symmetry_markup_of(std::vector<SceneComparison> scenes) {
  Results results;
  results.scenes = std::move(scenes);
  pugi::xml_document document;
  Node body = document.append_child("body");
  page::add_symmetries(body, results, page::Legend(results.scenes));
  EXPECT_EQ(page::has_symmetries(results), !body.first_child().empty());
  return page::markup(body);
}

TEST(SymmetryChapter, IsAbsent_WhereNoSceneAsks) {
  EXPECT_THAT(symmetry_markup_of({checked_scene("a/b", {})}), Not(HasSubstr("section")));
}

TEST(SymmetryChapter, HasAWordAGlyphAndAValue_ForEachVerdict) {
  const std::string text = symmetry_markup_of({checked_scene(
      "a/b", {result(Symmetry::mirror, SymmetryVerdict::to_the_bit, 0.0),
              result(Symmetry::relabel, SymmetryVerdict::to_rounding, 2e-12),
              result(Symmetry::boost, SymmetryVerdict::broken, 0.25),
              {Symmetry::reverse, SymmetryVerdict::does_not_apply, "friction loses energy", {}, {}},
              {Symmetry::rescale_2, SymmetryVerdict::twin_did_not_run, "crashed: x", {}, {}}})});
  EXPECT_THAT(text, AllOf(HasSubstr("to the bit"), HasSubstr("to rounding"), HasSubstr("2e-12 radii"),
                          HasSubstr("breaks"), HasSubstr("0.25 radii"), HasSubstr("✓"), HasSubstr("✗"),
                          HasSubstr("does not apply"), HasSubstr("friction loses energy"),
                          HasSubstr("twin did not run"), HasSubstr("crashed: x"), HasSubstr("1e-10")));
  EXPECT_THAT(text, Not(HasSubstr("rotate-90")));  // nobody asked
  EXPECT_THAT(text, Not(HasSubstr("Scene by scene")));
}

TEST(SymmetryChapter, WorstOfAllScenes_StandsInTheTable_ThenEachByItself) {
  const std::string text = symmetry_markup_of(
      {checked_scene("a/good", {result(Symmetry::boost, SymmetryVerdict::to_the_bit, 0.0)}),
       checked_scene("a/bad", {result(Symmetry::boost, SymmetryVerdict::broken, 0.5)}),
       checked_scene("a/worse", {result(Symmetry::boost, SymmetryVerdict::broken, 0.75)})});
  const std::string table = text.substr(0, text.find("Scene by scene"));
  EXPECT_THAT(table, AllOf(HasSubstr("0.75 radii"), HasSubstr("a/worse"), Not(HasSubstr("0.5 radii"))));
  EXPECT_THAT(text.substr(table.size()),
              AllOf(HasSubstr("0.5 radii"), HasSubstr("0.75 radii"), HasSubstr("to the bit")));
}

}  // namespace
}  // namespace carom::test
