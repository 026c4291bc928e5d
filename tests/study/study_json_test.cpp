#include "study/study_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "core/error.h"

namespace carom::test {
namespace {

using ::testing::HasSubstr;

Study some_study() {
  Study study;
  study.version = "0.1.0";
  study.own = "carom";
  study.machine = {"a \"CPU\"", 2, "GCC", "Release", "-O3"};
  study.limits = {0.7, 512.0, 3, 20.0};
  StudyScene scene;
  scene.id = "impact/head-on";
  scene.title = "Head-on, b = ½";
  scene.sha256 = "abc";
  scene.seed = 0xffffffffffffffffULL;
  scene.balls = 2;
  scene.smallest_radius_m = 0.1;
  scene.reach_m = 0.7;
  scene.truth = "closed-form";
  scene.uncertainty_m = 1.0 / 3.0;
  scene.engines = {{"carom:event", false, true, std::nullopt}, {"box2d", true, true, 1}};
  StudyPoint point;
  point.engine = "box2d";
  point.setting = "velocity_iterations = 8";
  point.step_s = 0.1;
  point.status = RunStatus::timeout;
  point.reason = "stopped, after \"2 s\"";
  point.errors = {1e-300, std::nullopt, 0.1, std::nullopt, 1.0 / 3.0, 2.0};
  point.cpu_s = {1e-7, 1.0 / 7.0};
  scene.points.push_back(point);
  point.status = std::nullopt;
  scene.points.push_back(point);
  study.scenes.push_back(scene);
  study.growths.push_back({3, 0.1, "box2d", {{10, RunStatus::ok, "", 20, 7, {0.1}}}});
  return study;
}

TEST(StudyJson, ReadsBack_ToTheSame) {
  const std::string text = study_json(some_study());
  const Study read = parse_study(text, "study.json");
  EXPECT_EQ(study_json(read), text);
  const StudyScene& scene = read.scenes.front();
  EXPECT_EQ(scene.uncertainty_m, 1.0 / 3.0);
  EXPECT_EQ(scene.seed, 0xffffffffffffffffULL);
  EXPECT_EQ(scene.engines[1].claimed_order, 1);
  EXPECT_EQ(scene.points[0].status, RunStatus::timeout);
  EXPECT_EQ(scene.points[0].errors.position_m, 1e-300);
  EXPECT_EQ(scene.points[0].errors.final_position_m, std::nullopt);
  EXPECT_EQ(scene.points[0].cpu_s[1], 1.0 / 7.0);
  EXPECT_EQ(scene.points[1].status, std::nullopt);
}

TEST(StudyJson, NamesTheFile_OfWhatIsNoStudy) {
  const std::string whole = study_json(some_study());
  for (const std::string& text :
       {std::string(), std::string("{}"), std::string("[1]"), whole.substr(0, whole.size() / 2),
        std::string(R"({"format": "carom study 2"})")}) {
    try {
      parse_study(text, "some.json");
      FAIL() << text;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), HasSubstr("some.json: "));
    }
  }
}

}  // namespace
}  // namespace carom::test
