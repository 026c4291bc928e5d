#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <memory>
#include <set>
#include <string>

#include "carom/carom_engine.h"
#include "comparison/check_symmetries.h"
#include "comparison/compare.h"
#include "tests/engines/lopsided.h"
#include "tests/support/scenes.h"

// What the checks say of an engine that keeps every symmetry, and of engines that break one each.

namespace carom::test {
namespace {

using testing::IsEmpty;

constexpr ProcessLimits kLimits{20.0, 4096.0};

EngineChoice choice(const std::string& name, const std::shared_ptr<const Engine>& engine) {
  return {{name, [engine]() -> const Engine& { return *engine; }}, "faithful"};
}

ScenarioPtr symmetry_scene(const std::string& name) {
  return load_scene(std::string(CAROM_SOURCE_DIR) + "/scenarios/symmetry/" + name + ".toml");
}

RunSymmetries checked(const Scenario& scene, const EngineChoice& engine) {
  const auto runs = run_engines(scene, {engine}, kLimits, 1);
  EXPECT_EQ(runs[0].status, RunStatus::ok) << runs[0].reason;
  return check_symmetries(scene, runs, {engine}, kLimits, 1)[0];
}

std::set<std::string> with_verdict(const RunSymmetries& symmetries, SymmetryVerdict verdict) {
  std::set<std::string> names;
  for (const SymmetryResult& check : symmetries.checks) {
    if (check.verdict == verdict) names.emplace(name_of(check.symmetry));
  }
  return names;
}

using Names = std::set<std::string>;

TEST(Symmetries, CaromKeepsAll_TheExactOnesToTheBit) {
  const std::shared_ptr<const Engine> carom = make_carom_engine("carom");
  const std::map<std::string, Names> does_not_apply = {{"free-disks", {}},
                                                       {"boxed-disks", {"boost"}},
                                                       {"boxed-balls", {"boost"}},
                                                       {"rough-disks", {"boost", "reverse"}}};
  for (const auto& [name, none] : does_not_apply) {
    SCOPED_TRACE(name);
    const RunSymmetries found = checked(*symmetry_scene(name), choice("carom", carom));
    EXPECT_THAT(with_verdict(found, SymmetryVerdict::broken), IsEmpty());
    EXPECT_THAT(with_verdict(found, SymmetryVerdict::twin_did_not_run), IsEmpty());
    EXPECT_EQ(with_verdict(found, SymmetryVerdict::to_the_bit),
              (Names{"mirror", "rotate-90", "relabel", "rescale-2"}));
    EXPECT_EQ(with_verdict(found, SymmetryVerdict::does_not_apply), none);
  }
}

/// What an engine with this flaw breaks in twelve disks in free space.
template <class Flaw>
Names broken_by() {
  const auto engine = std::make_shared<TestEngine<LopsidedGas<Flaw>>>();
  const RunSymmetries found = checked(*symmetry_scene("free-disks"), choice("flawed", engine));
  EXPECT_THAT(with_verdict(found, SymmetryVerdict::does_not_apply), IsEmpty());
  EXPECT_THAT(with_verdict(found, SymmetryVerdict::twin_did_not_run), IsEmpty());
  return with_verdict(found, SymmetryVerdict::broken);
}

TEST(Symmetries, EachFlawIsCaught_ByExactlyTheSymmetriesThatItBreaks) {
  EXPECT_EQ(broken_by<NoFlaw>(), Names{});
  EXPECT_EQ(broken_by<BallZeroIsHeavier>(), Names{"relabel"});
  EXPECT_EQ(broken_by<WiderThanHigh>(), (Names{"rotate-1-rad", "rotate-90"}));
  EXPECT_EQ(broken_by<LeftHanded>(), Names{"mirror"});
  EXPECT_EQ(broken_by<Lossy>(), Names{"reverse"});
  EXPECT_EQ(broken_by<FrameAtRest>(), (Names{"boost", "reverse"}));
  EXPECT_EQ(broken_by<OwnSpeed>(), (Names{"rescale-1.7", "rescale-2", "reverse"}));
}

/// Runs what it is given, but for scenes of units that it does not like.
class PickyEngine final : public Engine {
 public:
  EngineInfo info() const override { return gas_.info(); }
  std::string refuses(const Scenario& scene, std::string_view /*profile*/) const override {
    return scene.duration_s < 1.0 ? "too short" : "";
  }
  std::unique_ptr<Simulation> create(const Scenario& scene, std::string_view profile) const override {
    return gas_.create(scene, profile);
  }

 private:
  TestEngine<LopsidedGas<NoFlaw>> gas_;
};

TEST(Symmetries, TwinThatDoesNotRun_IsARowWithItsReason_AndTheMetricHasNoValue) {
  const RunSymmetries found =
      checked(*symmetry_scene("free-disks"), choice("picky", std::make_shared<PickyEngine>()));
  EXPECT_EQ(with_verdict(found, SymmetryVerdict::twin_did_not_run), Names{"rescale-2"});
  for (const SymmetryResult& check : found.checks) {
    if (check.symmetry == Symmetry::rescale_2) {
      EXPECT_EQ(check.reason, "unsupported: too short");
    }
  }
  EXPECT_FALSE(found.worst_radii());
}

TEST(Symmetries, OnlyWhatASceneAsksFor_OfRunsThatEndedWell) {
  Scenario scene = *symmetry_scene("free-disks");
  scene.symmetries = {Symmetry::relabel};
  const EngineChoice engine = choice("gas", std::make_shared<TestEngine<LopsidedGas<NoFlaw>>>());
  EXPECT_EQ(checked(scene, engine).checks.size(), 1U);
  scene.symmetries.clear();
  EXPECT_THAT(checked(scene, engine).checks, IsEmpty());
  scene.symmetries = {Symmetry::relabel};
  auto runs = run_engines(scene, {engine}, kLimits, 1);
  runs[0].status = RunStatus::crashed;
  EXPECT_THAT(check_symmetries(scene, runs, {engine}, kLimits, 1)[0].checks, IsEmpty());
}

TEST(Symmetries, WorstOfAll_IsWhatAGateLimits) {
  const ScenarioPtr scene = symmetry_scene("free-disks");
  const EngineChoice engine =
      choice("flawed", std::make_shared<TestEngine<LopsidedGas<BallZeroIsHeavier>>>());
  auto runs = run_engines(*scene, {engine}, kLimits, 1);
  std::vector<RunSymmetries> found = check_symmetries(*scene, runs, {engine}, kLimits, 1);
  double worst = 0.0;
  for (const SymmetryResult& check : found[0].checks) worst = std::max(worst, *check.position_radii);
  const SceneComparison comparison = compare(scene, {}, std::move(runs), {"flawed"}, std::move(found));
  const RunComparison& run = comparison.runs[0];
  EXPECT_EQ(run.metrics[Metric::symmetry], worst);
  EXPECT_EQ(run.verdict, Verdict::fail);
  for (const GateResult& gate : run.gates) {
    if (gate.metric == Metric::symmetry) {
      EXPECT_FALSE(gate.holds);
    }
  }
}

}  // namespace
}  // namespace carom::test
