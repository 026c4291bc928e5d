#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <pty.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <ostream>
#include <pugixml.hpp>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/folder.h"

// The program as people and scripts use it: started as a process, judged by its exit code, what it prints and
// what it writes.
namespace carom {

namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;
using Words = std::vector<std::string>;

constexpr int kHolds = 0;
constexpr int kViolated = 1;
constexpr int kBadInput = 2;
constexpr int kMachineFailed = 3;

/// Twenty balls in a box; the seed decides everything.
const std::string kGas = R"(title = "A small gas"
dimension = 2
duration = 0.5
step = 0.01
frames = 10
[box]
min = [0, 0]
max = [1, 1]
[[balls]]
kind = "gas"
count = 20
seed = 1
packing = 0.1
speed = 1.0
[gate]
energy = 1e-9
escaped = 0
)";

/// A ball in space, where Box2D cannot follow.
const std::string kSpace = R"(title = "One ball in space"
dimension = 3
duration = 1
step = 0.01
frames = 10
[[ball]]
mass = 1
radius = 0.1
position = [0, 0, 0]
velocity = [1, 2, 3]
[gate]
position = 1e-9
)";

struct Ended {
  int exit_code = -1;
  std::string out;
  std::string err;
};

std::string contents(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Starts programs in a folder of its own.
class CommandLine : public ::testing::Test {
 protected:
  CommandLine() : work_(folder_ / "work") {
    fs::create_directory(work_);
    write("gas.toml", kGas);
    write("space.toml", kSpace);
  }

  void write(const fs::path& file, const std::string& text) const { std::ofstream(work_ / file) << text; }

  json results(const fs::path& file = "results.json") const { return json::parse(contents(work_ / file)); }

  std::vector<json> scenes() const { return results().at("scenes"); }
  /// Those of the first scene.
  std::vector<json> runs() const { return scenes().at(0).at("runs"); }

  Ended carom(const Words& words) const { return start(CAROM_PROGRAM, words, work_, folder_ / "out"); }

  /// Runs the program in a folder with its standard output going to a file, and `more` added to the
  /// environment.
  Ended start(const std::string& program, Words words, const fs::path& where, const fs::path& out,
              const Words& more = {}) const {
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addchdir_np(&files, where.c_str());
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, out.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    const fs::path err = folder_ / "err";
    posix_spawn_file_actions_addopen(&files, STDERR_FILENO, err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
    words.insert(words.begin(), program);
    Words environment = more;
    for (char** variable = environ; *variable != nullptr; ++variable) {
      if (!std::string(*variable).starts_with("NO_COLOR=")) environment.emplace_back(*variable);
    }
    pid_t process = -1;
    const int failed = posix_spawn(&process, program.c_str(), &files, nullptr, pointers(words).data(),
                                   pointers(environment).data());
    posix_spawn_file_actions_destroy(&files);
    Ended ended;
    if (failed != 0) return ended;
    int status = 0;
    waitpid(process, &status, 0);
    if (WIFEXITED(status)) ended.exit_code = WEXITSTATUS(status);
    ended.out = fs::is_regular_file(out) ? contents(out) : std::string();
    ended.err = contents(err);
    return ended;
  }

  static std::vector<char*> pointers(Words& words) {
    std::vector<char*> pointers;
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    return pointers;
  }

  /// What stands in the work folder, with contents, so that "nothing was touched" can be said.
  std::map<fs::path, std::string> files() const {
    std::map<fs::path, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(work_)) {
      files[entry.path()] = entry.is_regular_file() ? contents(entry.path()) : std::string();
    }
    return files;
  }

  test::TestFolder folder_;
  fs::path work_;
};

// --- help and version
// ----------------------------------------------------------------------------------------

TEST_F(CommandLine, Version_IsPrinted) {
  const Ended ended = carom({"--version"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_EQ(ended.out, "carom " CAROM_VERSION "\n");
  EXPECT_THAT(ended.err, IsEmpty());
}

TEST_F(CommandLine, Help_NamesEveryCommandAndTheExitCodes) {
  for (const Words& words : {Words{"help"}, Words{"--help"}, Words{"-h"}}) {
    const Ended ended = carom(words);
    EXPECT_EQ(ended.exit_code, kHolds);
    EXPECT_THAT(ended.out, AllOf(HasSubstr("list"), HasSubstr("run"), HasSubstr("check"),
                                 HasSubstr("explain"), HasSubstr("help")));
    EXPECT_THAT(ended.out, AllOf(HasSubstr("Exit codes"), HasSubstr("--version")));
  }
}

TEST_F(CommandLine, HelpOnACommand_ShowsHowToTypeIt) {
  const std::map<std::string, std::string> options = {{"list", "--engines-from"},
                                                      {"run", "--csv"},
                                                      {"check", "--junit"},
                                                      {"explain", "--metric"},
                                                      {"help", "COMMAND"}};
  for (const auto& [command, option] : options) {
    for (const Words& words : {Words{"help", command}, Words{command, "--help"}}) {
      const Ended ended = carom(words);
      EXPECT_EQ(ended.exit_code, kHolds) << command;
      EXPECT_THAT(ended.out, HasSubstr("carom " + command + " "));
      EXPECT_THAT(ended.out, HasSubstr(option));
      EXPECT_THAT(ended.err, IsEmpty());
    }
  }
}

// --- list
// ----------------------------------------------------------------------------------------------------

TEST_F(CommandLine, List_ShowsScenesEnginesAndEffects) {
  const Ended scenes = carom({"list", "scenarios"});
  EXPECT_EQ(scenes.exit_code, kHolds);
  EXPECT_THAT(scenes.out, HasSubstr("impact/head-on "));
  const Ended engines = carom({"list", "engines"});
  EXPECT_THAT(engines.out, AllOf(HasSubstr("carom "), HasSubstr("box2d "), HasSubstr("cannot ")));
  const Ended effects = carom({"list", "effects"});
  EXPECT_THAT(effects.out, AllOf(HasSubstr("gravity"), HasSubstr("barrier")));
  EXPECT_EQ(carom({"list"}).out, scenes.out + "\n" + engines.out + "\n" + effects.out);
}

// --- bad usage and bad input
// ---------------------------------------------------------------------------------

struct Bad {
  std::string name;
  Words words;
  std::string says;
};

std::ostream& operator<<(std::ostream& out, const Bad& bad) {
  return out << bad.name;
}

class BadUsage : public CommandLine, public ::testing::WithParamInterface<Bad> {};

TEST_P(BadUsage, Command_IsRefusedOnStderrAlone) {
  const Ended ended = carom(GetParam().words);
  EXPECT_EQ(ended.exit_code, kBadInput);
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_THAT(ended.err, StartsWith("carom: "));
  EXPECT_THAT(ended.err, HasSubstr(GetParam().says));
  // A message for people: no number of three hundred digits.
  EXPECT_LT(ended.err.size(), 400U) << ended.err;
}

template <class Row>
std::string name_of_row(const ::testing::TestParamInfo<Row>& info) {
  return info.param.name;
}

INSTANTIATE_TEST_SUITE_P(
    Words, BadUsage,
    ::testing::Values(
        Bad{"Nothing", {}, "command"}, Bad{"Command", {"jump"}, "jump"},
        Bad{"OptionForCommand", {"--nope"}, "--nope"},
        Bad{"Option", {"run", "impact/head-on", "--nope"}, "--nope"},
        Bad{"OptionOfAnother", {"run", "impact/head-on", "--junit", "x.xml"}, "--junit"},
        Bad{"NoScene", {"run"}, "SCENE"}, Bad{"NoSceneToCheck", {"check"}, "SCENE"},
        Bad{"Scene", {"run", "impact/nothing"}, "impact/nothing"},
        Bad{"Group", {"run", "nothing/"}, "allowed: "},
        Bad{"SceneOfMany", {"run", "impact/head-on", "impact/nothing"}, "impact/nothing"},
        Bad{"EmptyScene", {"run", ""}, "no scene \"\""},
        Bad{"Engine", {"run", "impact/head-on", "--engine", "havok"}, "allowed: carom, box2d"},
        Bad{"EmptyEngine", {"run", "impact/head-on", "--engine", ""}, "no engine \"\""},
        Bad{"Profile", {"run", "impact/head-on", "--engine", "box2d@fast"}, "allowed: faithful, default"},
        Bad{"EmptyProfile", {"run", "impact/head-on", "--engine", "box2d@"}, "faithful"},
        Bad{"NoSceneToExplain", {"explain", "--engine", "box2d"}, "SCENE"},
        Bad{"NoEngineToExplain", {"explain", "impact/head-on"}, "--engine"},
        Bad{"TwoEnginesToExplain",
            {"explain", "impact/head-on", "--engine", "box2d", "--engine", "bullet"},
            "--engine"},
        Bad{"GroupToExplain", {"explain", "impact/", "--engine", "box2d"}, "one scene"},
        Bad{"MetricToExplain",
            {"explain", "impact/head-on", "--engine", "box2d", "--metric", "beauty"},
            "beauty"},
        Bad{"MetricThatIsNotKnown",
            {"explain", "impact/head-on", "--engine", "box2d", "--metric", "escaped"},
            "escaped"},
        Bad{"EngineFolder", {"run", "impact/head-on", "--engines-from", "nowhere"}, "nowhere"},
        Bad{"Topic", {"list", "colours"}, "colours"}, Bad{"HelpTopic", {"help", "jump"}, "jump"}),
    name_of_row<Bad>);

INSTANTIATE_TEST_SUITE_P(
    Numbers, BadUsage,
    ::testing::Values(Bad{"StepZero", {"run", "gas.toml", "--step", "0"}, "--step"},
                      Bad{"StepNegative", {"run", "gas.toml", "--step", "-0.1"}, "--step"},
                      Bad{"StepNan", {"run", "gas.toml", "--step", "nan"}, "--step"},
                      Bad{"StepInf", {"run", "gas.toml", "--step", "inf"}, "--step"},
                      Bad{"StepWord", {"run", "gas.toml", "--step", "fast"}, "--step"},
                      Bad{"StepTail", {"run", "gas.toml", "--step", "0.1s"}, "--step"},
                      Bad{"StepHuge", {"run", "gas.toml", "--step", "1e400"}, "--step"},
                      // More steps than a 64-bit integer counts.
                      Bad{"StepTiny", {"run", "gas.toml", "--step", "1e-300"}, "step"},
                      Bad{"StepTwice", {"run", "gas.toml", "--step", "1", "--step", "2"}, "--step"},
                      Bad{"SeedNegative", {"run", "gas.toml", "--seed", "-1"}, "--seed"},
                      Bad{"SeedReal", {"run", "gas.toml", "--seed", "1.5"}, "--seed"},
                      Bad{"SeedTooLarge", {"run", "gas.toml", "--seed", "99999999999999999999"}, "--seed"},
                      Bad{"SeedWord", {"run", "gas.toml", "--seed", "x"}, "--seed"},
                      Bad{"ParallelZero", {"run", "gas.toml", "-j", "0"}, "-j"},
                      Bad{"ParallelNegative", {"run", "gas.toml", "-j", "-1"}, "-j"},
                      Bad{"ParallelReal", {"run", "gas.toml", "-j", "1.5"}, "-j"},
                      Bad{"ParallelWord", {"run", "gas.toml", "-j", "all"}, "-j"},
                      Bad{"TimeoutZero", {"run", "gas.toml", "--timeout", "0"}, "--timeout"},
                      Bad{"TimeoutNegative", {"run", "gas.toml", "--timeout", "-1"}, "--timeout"},
                      Bad{"TimeoutNan", {"run", "gas.toml", "--timeout", "nan"}, "--timeout"},
                      Bad{"TimeoutWord", {"run", "gas.toml", "--timeout", "1m"}, "--timeout"},
                      Bad{"MemoryNan", {"run", "gas.toml", "--memory", "nan"}, "--memory"},
                      Bad{"NoFile", {"run", "gas.toml", "--json"}, "--json"},
                      Bad{"EmptyFile", {"run", "gas.toml", "--json", ""}, "--json"}),
    name_of_row<Bad>);

/// Nothing is written before everything is understood: neither are new files made nor old ones changed.
TEST_F(CommandLine, BadInput_TouchesNoFile) {
  write("bad.toml", kGas + "colour = 1\n");
  write("old.json", "old");
  write("old.xml", "old");
  write("old.md", "old");
  fs::create_directory(work_ / "old");
  write("old/index.html", "old");
  const auto before = files();
  for (const Words& input : {Words{"bad.toml"},
                             {"gas.toml", "bad.toml"},
                             {"gas.toml", "--engine", "havok"},
                             {"gas.toml", "--engine", "box2d@fast"},
                             {"gas.toml", "none.toml"}}) {
    for (Words words : {Words{"run", "--json", "new.json", "--csv", "new-csv", "--report", "new-report"},
                        Words{"run", "--json", "old.json", "--csv", "old", "--report", "old"},
                        Words{"check", "--json", "new.json", "--junit", "new.xml", "--summary", "new.md"},
                        Words{"check", "--json", "old.json", "--junit", "old.xml", "--summary", "old.md"}}) {
      words.insert(words.end(), input.begin(), input.end());
      const Ended ended = carom(words);
      EXPECT_EQ(ended.exit_code, kBadInput);
      EXPECT_THAT(ended.out, IsEmpty());
      EXPECT_THAT(ended.err, StartsWith("carom: "));
      EXPECT_EQ(files(), before);
    }
  }
}

TEST_F(CommandLine, BadScene_IsNamedWithItsPlace) {
  write("bad.toml", kGas + "colour = 1\n");
  EXPECT_THAT(carom({"run", "bad.toml"}).err, StartsWith("carom: bad.toml:18:1: gate.colour: unknown key"));
}

// --- the machine fails
// ---------------------------------------------------------------------------------------

TEST_F(CommandLine, OutputThatCannotBeWritten_IsTheMachinesFault) {
  write("file", "in the way");
  const Words run = {"run", "gas.toml", "--engine", "carom"};
  for (const char* option : {"--json", "--csv", "--report"}) {
    Words words = run;
    words.insert(words.end(), {option, "file/below"});
    const Ended ended = carom(words);
    EXPECT_EQ(ended.exit_code, kMachineFailed) << option;
    EXPECT_THAT(ended.err, AllOf(HasSubstr("file/below"), HasSubstr("Not a directory")));
  }
  for (const char* option : {"--junit", "--summary"}) {
    EXPECT_EQ(carom({"check", "gas.toml", "--engine", "carom", option, "file/below"}).exit_code,
              kMachineFailed);
  }
  EXPECT_EQ(contents(work_ / "file"), "in the way");
}

TEST_F(CommandLine, FullDevice_IsTheMachinesFault) {
  fs::create_symlink("/dev/full", work_ / "full");
  const Ended ended = carom({"run", "gas.toml", "--engine", "carom", "--json", "full"});
  EXPECT_EQ(ended.exit_code, kMachineFailed);
  EXPECT_THAT(ended.err, HasSubstr("No space left on device"));
  EXPECT_EQ(start(CAROM_PROGRAM, {"run", "gas.toml", "--engine", "carom"}, work_, "/dev/full").exit_code,
            kMachineFailed);
  EXPECT_EQ(start(CAROM_PROGRAM, {"--version"}, work_, "/dev/full").exit_code, kMachineFailed);
}

/// What is not a plain file is written to, not replaced: a link still points where it did, /dev/null stays a
/// device.
TEST_F(CommandLine, Links_AreFollowedAndDevicesStayDevices) {
  write("target.json", "old");
  fs::create_symlink("target.json", work_ / "link.json");
  fs::create_symlink("/dev/null", work_ / "null");
  EXPECT_EQ(carom({"run", "gas.toml", "--engine", "carom", "--json", "link.json"}).exit_code, kHolds);
  EXPECT_TRUE(fs::is_symlink(work_ / "link.json"));
  EXPECT_TRUE(json::accept(contents(work_ / "target.json")));
  EXPECT_EQ(carom({"run", "gas.toml", "--engine", "carom", "--json", "null"}).exit_code, kHolds);
  EXPECT_TRUE(fs::is_symlink(work_ / "null"));
  EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

// --- where it is started
// -------------------------------------------------------------------------------------

TEST_F(CommandLine, Program_FindsItsScenesAndEngines_FromAnywhere) {
  const fs::path out = folder_ / "out";
  const Ended here = start(CAROM_PROGRAM, {"list"}, work_, out);
  EXPECT_EQ(here.exit_code, kHolds);
  EXPECT_THAT(here.out, AllOf(HasSubstr("impact/head-on "), HasSubstr("box2d ")));
  EXPECT_EQ(start(CAROM_PROGRAM, {"list"}, "/", out).out, here.out);
  fs::create_symlink(CAROM_PROGRAM, work_ / "carom-link");
  EXPECT_EQ(start((work_ / "carom-link").string(), {"list"}, "/", out).out, here.out);
}

TEST_F(CommandLine, Scene_IsAnIdAPathAGroupOrSeveral) {
  const auto ids = [this](Words words) {
    words.insert(words.begin(), "run");
    words.insert(words.end(), {"--engine", "carom", "--json", "results.json"});
    EXPECT_THAT(carom(words).err, IsEmpty());
    Words ids;
    for (const json& scene : scenes()) ids.push_back(scene.at("id"));
    return ids;
  };
  EXPECT_EQ(ids({"impact/head-on"}), Words{"impact/head-on"});
  EXPECT_EQ(ids({CAROM_SOURCE_DIR "/scenarios/impact/head-on.toml", "impact/head-on"}),
            Words{"impact/head-on"});
  EXPECT_EQ(ids({"gas.toml"}), Words{"work/gas"});
  EXPECT_EQ(ids({"gas.toml", "wall/bounce"}), (Words{"work/gas", "wall/bounce"}));
  EXPECT_GT(ids({"wall/"}).size(), 1U);
}

// --- what it prints
// ------------------------------------------------------------------------------------------

TEST_F(CommandLine, Table_FitsEightyColumns) {
  const Ended ended = carom({"run", "impact/head-on"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.err, IsEmpty());  // progress is for terminals
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 80U) << line;
}

/// Letters, not bytes: those that go on with a letter in UTF-8 begin with the bits 10.
std::size_t columns(const std::string& line) {
  return static_cast<std::size_t>(
      std::count_if(line.begin(), line.end(), [](char byte) { return (byte & 0xC0) != 0x80; }));
}

TEST_F(CommandLine, TableOfSymmetries_FitsEightyColumnsToo) {
  const Ended ended = carom({"run", "symmetry/free-disks"});
  EXPECT_EQ(ended.exit_code, kHolds);
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) EXPECT_LE(columns(line), 80U) << line;
}

TEST_F(CommandLine, Quiet_PrintsNothing_WhereEveryGateHolds) {
  const Ended ended = carom({"check", "gas.toml", "--engine", "carom", "--quiet", "--json", "results.json"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out, IsEmpty());
  EXPECT_THAT(ended.err, IsEmpty());
  EXPECT_EQ(scenes().size(), 1U);
}

/// What the program prints when its standard output is a terminal.
std::string on_a_terminal(const std::string& command) {
  int program_end = -1;
  const pid_t process = forkpty(&program_end, nullptr, nullptr, nullptr);
  if (process == 0) {
    execl("/bin/sh", "sh", "-c", command.c_str(), nullptr);
    _exit(127);
  }
  std::string out;
  char letter = '\0';
  while (read(program_end, &letter, 1) == 1) out += letter;
  close(program_end);
  waitpid(process, nullptr, 0);
  return out;
}

TEST_F(CommandLine, Colours_AreForTerminalsAndCanBeTurnedOff) {
  const std::string command =
      "'" CAROM_PROGRAM "' run impact/head-on --engine carom 2>" + (folder_ / "err").string();
  EXPECT_THAT(on_a_terminal("unset NO_COLOR; " + command), HasSubstr("\x1b["));
  EXPECT_THAT(on_a_terminal("NO_COLOR= " + command), HasSubstr("\x1b["));
  EXPECT_THAT(on_a_terminal("NO_COLOR=1 " + command), Not(HasSubstr("\x1b")));
  EXPECT_THAT(on_a_terminal("unset NO_COLOR; " + command + " --no-color"), Not(HasSubstr("\x1b")));
  EXPECT_THAT(carom({"run", "impact/head-on", "--engine", "carom"}).out, Not(HasSubstr("\x1b")));
}

// --- results
// -------------------------------------------------------------------------------------------------

/// "name" or "name?" (may be null) with the JSON types it may have.
void expect_keys(const json& object, const std::map<std::string, std::set<json::value_t>>& types) {
  for (const auto& [key, allowed] : types) {
    ASSERT_TRUE(object.contains(key)) << key << " is not in " << object.dump().substr(0, 200);
    EXPECT_TRUE(allowed.contains(object.at(key).type()))
        << key << " is " << object.at(key).dump().substr(0, 200);
  }
}

using T = json::value_t;
const std::set<T> kText = {T::string};
const std::set<T> kCount = {T::number_unsigned};
const std::set<T> kNumber = {T::number_float};
const std::set<T> kMaybe = {T::number_float, T::null};
const std::set<T> kList = {T::array};
const std::set<T> kObject = {T::object};
const std::set<T> kTruth = {T::boolean};

void expect_vector(const json& vector) {
  ASSERT_EQ(vector.size(), 3U);
  for (const json& number : vector) EXPECT_TRUE(number.is_number_float());
}

void expect_run(const json& run) {
  expect_keys(run, {{"engine", kText},
                    {"profile", kText},
                    {"version", kText},
                    {"precision", kText},
                    {"settings", kObject},
                    {"status", kText},
                    {"reason", kText},
                    {"cpu_seconds", kNumber},
                    {"steps", kCount},
                    {"collisions", kCount},
                    {"metrics", kObject},
                    {"first_divergence", {T::object, T::null}},
                    {"gates", kList},
                    {"verdict", kText},
                    {"final", kList}});
  expect_keys(run.at("metrics"), {{"energy", kMaybe},
                                  {"energy_gain", kMaybe},
                                  {"energy_loss", kMaybe},
                                  {"momentum", kMaybe},
                                  {"angular_momentum", kMaybe},
                                  {"position", kMaybe},
                                  {"position_rms", kMaybe},
                                  {"penetration", kMaybe},
                                  {"escaped", {T::number_unsigned, T::null}},
                                  {"symmetry", kMaybe}});
  for (const json& check : run.at("symmetries")) {
    expect_keys(check, {{"check", kText},
                        {"verdict", kText},
                        {"reason", kText},
                        {"position_radii", kMaybe},
                        {"energy", kMaybe},
                        {"floor_radii", kMaybe}});
  }
  for (const json& gate : run.at("gates")) {
    const std::set<T> limit = {T::number_float, T::number_unsigned};
    expect_keys(gate, {{"metric", kText},
                       {"limit", limit},
                       {"value", {T::number_float, T::number_unsigned, T::null}},
                       {"holds", kTruth}});
  }
  for (const json& ball : run.at("final")) {
    expect_keys(ball, {{"mass", kNumber}, {"radius", kNumber}});
    for (const char* key : {"position", "velocity", "spin"}) expect_vector(ball.at(key));
  }
}

TEST_F(CommandLine, Json_HasEveryDocumentedKey) {
  carom({"run", "impact/head-on", "gas.toml", "space.toml", "--json", "results.json"});
  const json all = results();
  expect_keys(all, {{"carom", kText}, {"machine", kObject}, {"scenes", kList}});
  expect_keys(all.at("machine"), {{"cpu", kText}, {"cores", kCount}, {"compiler", kText}, {"build", kText}});
  EXPECT_EQ(all.at("carom"), CAROM_VERSION);
  ASSERT_EQ(all.at("scenes").size(), 3U);
  for (const json& scene : all.at("scenes")) {
    expect_keys(scene, {{"id", kText},
                        {"sha256", kText},
                        {"dimension", kCount},
                        {"duration", kNumber},
                        {"step", kNumber},
                        {"balls", kCount},
                        {"effects", kList},
                        {"truth", kObject},
                        {"runs", kList}});
    EXPECT_EQ(scene.at("sha256").get<std::string>().size(), 64U);
    expect_keys(scene.at("truth"), {{"kind", kText}, {"uncertainty", kMaybe}, {"horizon", kMaybe}});
    for (const json& run : scene.at("runs")) {
      if (run.at("status") == "ok") expect_run(run);
    }
  }
  const json& truth = all.at("scenes").at(0).at("truth");
  EXPECT_EQ(truth.at("kind"), "closed-form");
}

TEST_F(CommandLine, Json_SaysUnsupportedWithTheReason) {
  EXPECT_EQ(carom({"run", "space.toml", "--json", "results.json"}).exit_code, kHolds);
  for (const json& run : runs()) {
    if (run.at("engine") != "box2d") continue;
    EXPECT_EQ(run.at("status"), "unsupported");
    EXPECT_EQ(run.at("verdict"), "unsupported");
    EXPECT_THAT(run.at("reason").get<std::string>(), HasSubstr("two-dimensional"));
    EXPECT_TRUE(run.at("metrics").at("energy").is_null());
  }
}

TEST_F(CommandLine, EngineThatCannotRunASceneThatGatesIt_IsAViolation) {
  write("gated.toml", kSpace + "[gate.box2d]\nposition = 1.0\n");
  const Ended ended = carom({"check", "gated.toml"});
  EXPECT_EQ(ended.exit_code, kViolated);
  EXPECT_THAT(ended.out, HasSubstr("violated: work/gated: box2d: unsupported"));
}

/// The last frame of the CSV and the final states of the JSON are the same doubles, to the bit.
TEST_F(CommandLine, Numbers_ReadBackToTheSameDouble) {
  carom({"run", "gas.toml", "--engine", "carom", "--json", "results.json", "--csv", "csv"});
  const json final = runs().at(0).at("final");
  ASSERT_EQ(final.size(), 20U);
  std::ifstream csv(work_ / "csv/work/gas/carom.csv");
  std::string line;
  std::getline(csv, line);
  EXPECT_EQ(line, "time,ball,x,y,z,vx,vy,vz,wx,wy,wz");
  std::vector<std::string> lines;
  while (std::getline(csv, line)) lines.push_back(line);
  ASSERT_EQ(lines.size(), 11U * 20U);
  for (std::size_t ball = 0; ball < 20; ++ball) {
    std::istringstream cells(lines[200 + ball]);
    std::vector<double> numbers;
    for (std::string cell; std::getline(cells, cell, ',');)
      numbers.push_back(std::strtod(cell.c_str(), nullptr));
    ASSERT_EQ(numbers.size(), 11U);
    EXPECT_EQ(numbers[0], 0.5);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(final[ball].at("position").at(axis).get<double>(), numbers[2 + axis]);
      EXPECT_EQ(final[ball].at("velocity").at(axis).get<double>(), numbers[5 + axis]);
    }
  }
}

TEST_F(CommandLine, ManyBalls_AreListedToAThousandOrAll) {
  std::string many = kGas;
  many.replace(many.find("count = 20"), 10, "count = 1001");
  write("many.toml", many);
  const auto listed = [this](const Words& more) {
    Words words = {"run", "many.toml", "--engine", "carom", "--json", "results.json"};
    words.insert(words.end(), more.begin(), more.end());
    carom(words);
    return runs().at(0).at("final").size();
  };
  EXPECT_EQ(listed({}), 1000U);
  EXPECT_EQ(listed({"--all-balls"}), 1001U);
}

// 0.5 s in 10 frames: a step of 0.02 s cuts each frame of 0.05 s into three.
TEST_F(CommandLine, Step_ReplacesThatOfTheScene) {
  carom({"run", "gas.toml", "--engine", "carom", "--step", "0.02", "--json", "results.json"});
  const json scene = scenes().at(0);
  EXPECT_EQ(scene.at("step"), 0.02);
  EXPECT_EQ(scene.at("runs").at(0).at("steps"), 30);
}

TEST_F(CommandLine, Seed_ReplacesThatOfTheScene) {
  const auto first_ball = [this](const Words& more) {
    Words words = {"run", "gas.toml", "--engine", "carom", "--json", "results.json"};
    words.insert(words.end(), more.begin(), more.end());
    carom(words);
    return runs().at(0).at("final").at(0);
  };
  EXPECT_EQ(first_ball({}), first_ball({"--seed", "1"}));
  EXPECT_NE(first_ball({}), first_ball({"--seed", "2"}));
}

TEST_F(CommandLine, Engines_AreThoseNamed_InTheirOrder_EachOnce) {
  carom({"run", "gas.toml", "--engine", "box2d@default", "--engine", "carom", "--engine", "box2d", "--engine",
         "carom@faithful", "--json", "results.json"});
  Words engines;
  for (const json& run : runs()) {
    engines.push_back(run.at("engine").get<std::string>() + "@" + run.at("profile").get<std::string>());
  }
  EXPECT_EQ(engines, (Words{"box2d@default", "carom@faithful", "box2d@faithful"}));
}

TEST_F(CommandLine, Results_AreTheSameBytes_EveryTimeAndHoweverManyRunAtOnce) {
  const auto bytes = [this](const std::string& parallel) {
    carom({"run", "gas.toml", "impact/head-on", "-j", parallel, "--json", "results.json"});
    return std::regex_replace(contents(work_ / "results.json"), std::regex("\"cpu_seconds\": [^,]*"), "");
  };
  const std::string once = bytes("1");
  EXPECT_GT(once.size(), 1000U);
  EXPECT_EQ(bytes("1"), once);
  EXPECT_EQ(bytes("2"), once);
}

// --- JUnit
// ---------------------------------------------------------------------------------------------------

void expect_counts(const pugi::xml_node& node) {
  const auto count = [&node](const std::string& below) {
    return static_cast<int>(node.select_nodes((".//testcase" + below).c_str()).size());
  };
  EXPECT_EQ(node.attribute("tests").as_int(-1), count(""));
  EXPECT_EQ(node.attribute("failures").as_int(-1), count("[failure]"));
  EXPECT_EQ(node.attribute("errors").as_int(-1), count("[error]"));
  EXPECT_EQ(node.attribute("skipped").as_int(-1), count("[skipped]"));
}

TEST_F(CommandLine, JUnit_IsXmlWithTheRightCounts) {
  write("a<b>&\".toml", kGas);
  const Ended ended = carom({"check", "gas.toml", "space.toml", "a<b>&\".toml", "--engines-from",
                             CAROM_TEST_ENGINE_DIR, "--engine", "carom", "--engine", "box2d", "--engine",
                             "broken-impulse", "--junit", "junit.xml", "--summary", "summary.md"});
  EXPECT_EQ(ended.exit_code, kHolds);
  pugi::xml_document document;
  ASSERT_TRUE(document.load_file((work_ / "junit.xml").c_str()));
  const pugi::xml_node suites = document.child("testsuites");
  expect_counts(suites);
  int scenes = 0;
  for (const pugi::xml_node& suite : suites.children("testsuite")) {
    ++scenes;
    expect_counts(suite);
  }
  EXPECT_EQ(scenes, 3);
  EXPECT_STREQ(suites.last_child().attribute("name").value(), "work/a<b>&\"");
  EXPECT_THAT(contents(work_ / "summary.md"), HasSubstr("| work/gas | carom | "));
}

TEST_F(CommandLine, JUnit_TellsFailuresFromErrors) {
  const auto totals = [this](const std::string& engine) {
    carom({"check", "impact/head-on", "--engines-from", CAROM_TEST_ENGINE_DIR, "--engine", engine, "--junit",
           "junit.xml"});
    pugi::xml_document document;
    EXPECT_TRUE(document.load_file((work_ / "junit.xml").c_str()));
    const pugi::xml_node suites = document.child("testsuites");
    expect_counts(suites);
    return std::pair(suites.attribute("failures").as_int() > 0, suites.attribute("errors").as_int() > 0);
  };
  EXPECT_EQ(totals("carom"), std::pair(false, false));
  EXPECT_EQ(totals("broken-impulse"), std::pair(true, false));
  EXPECT_EQ(totals("broken-abort"), std::pair(false, true));
}

// --- baseline
// ------------------------------------------------------------------------------------------------

/// The gates of the first run that come from the baseline.
std::vector<json> from_baseline(const json& run) {
  std::vector<json> gates;
  for (const json& gate : run.at("gates")) {
    if (gate.at("from") == "baseline") gates.push_back(gate);
  }
  return gates;
}

class BaselineOption : public CommandLine {
 protected:
  static Words with(const Words& more) {
    Words words = {"check",
                   "impact/head-on",
                   "impact/resting-target",
                   "--engines-from",
                   CAROM_TEST_ENGINE_DIR,
                   "--engine",
                   "plain",
                   "--json",
                   "results.json"};
    words.insert(words.end(), more.begin(), more.end());
    return words;
  }
  json baseline() const { return json::parse(contents(work_ / "base.json")); }
  void write_baseline() const { EXPECT_EQ(carom(with({"--write-baseline", "base.json"})).exit_code, kHolds); }
};

TEST_F(BaselineOption, WrittenAndHeldAgainst_Holds) {
  write_baseline();
  const json scene = baseline().at("scenes").at("impact/head-on");
  EXPECT_EQ(scene.at("step"), 0.004);
  EXPECT_EQ(scene.at("sha256").get<std::string>().size(), 64U);
  EXPECT_TRUE(scene.at("engines").at("plain").contains("momentum"));
  const Ended ended = carom(with({"--baseline", "base.json"}));
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("of them made from base.json"), Not(HasSubstr("baseline:"))));
  EXPECT_EQ(from_baseline(runs().at(0)).size(), scene.at("engines").at("plain").size());
}

/// The value 0.5 of the loss at rest was 0.2 once: worse by 2.5.
TEST_F(BaselineOption, WorseValue_IsAViolationEverywhere) {
  write_baseline();
  json changed = baseline();
  changed["scenes"]["impact/resting-target"]["engines"]["plain@velocity-threshold"] = {{"energy", 0.2}};
  write("base.json", changed.dump());
  const Words engine = {"--engine", "plain@velocity-threshold", "--baseline", "base.json"};
  Words words = with(engine);
  words.insert(words.end(), {"--junit", "junit.xml", "--summary", "summary.md"});
  const Ended ended = carom(words);
  EXPECT_EQ(ended.exit_code, kViolated);
  const std::string says = "energy = 0.5 is above 0.4, what its baseline 0.2 allows";
  EXPECT_THAT(ended.out, HasSubstr("violated: impact/resting-target: plain@velocity-threshold: " + says));
  const std::vector<json> gates = from_baseline(scenes().at(1).at("runs").at(1));
  ASSERT_EQ(gates.size(), 1U);
  EXPECT_EQ(gates[0].at("baseline"), 0.2);
  EXPECT_EQ(gates[0].at("limit"), 0.4);
  EXPECT_EQ(gates[0].at("holds"), false);
  EXPECT_THAT(contents(work_ / "junit.xml"), HasSubstr(says));
  EXPECT_THAT(contents(work_ / "summary.md"), HasSubstr("| energy | 0.5 | 0.4 | the baseline's 0.2 |"));
  words.insert(words.end(), {"--baseline-factor", "2.6"});
  EXPECT_THAT(carom(words).out, Not(HasSubstr(says)));
}

TEST_F(BaselineOption, BetterValue_IsOffered_AndTakenOver) {
  write_baseline();
  json changed = baseline();
  changed["scenes"]["impact/head-on"]["engines"]["plain"]["position"] = 1e-3;
  changed["scenes"]["another/scene"] = changed["scenes"]["impact/head-on"];
  write("base.json", changed.dump());
  const Ended ended = carom(with({"--quiet", "--baseline", "base.json", "--write-baseline", "base.json"}));
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out,
              AllOf(StartsWith("baseline: better than the baseline: impact/head-on plain position"),
                    HasSubstr("(was 0.001); carom check … --baseline base.json --write-baseline")));
  EXPECT_LT(baseline().at("scenes").at("impact/head-on").at("engines").at("plain").at("position"), 1e-9);
  // What did not take part is kept.
  EXPECT_TRUE(baseline().at("scenes").contains("another/scene"));
}

TEST_F(BaselineOption, WhatCannotBeCompared_IsSaid) {
  write_baseline();
  json changed = baseline();
  changed["scenes"]["impact/head-on"]["sha256"] = "another";
  changed["scenes"].erase("impact/resting-target");
  write("base.json", changed.dump());
  const Ended ended = carom(with({"--baseline", "base.json"}));
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out,
              AllOf(HasSubstr("baseline: not compared, the scene's file has changed since (its sha256): "
                              "impact/head-on\n"),
                    HasSubstr("baseline: not compared, the scene is not in the baseline: "
                              "impact/resting-target\n")));
  write_baseline();
  const Ended other = carom({"check", "impact/head-on", "--engine", "carom", "--baseline", "base.json"});
  EXPECT_THAT(other.out, AllOf(HasSubstr("not compared, carom is not in the baseline for: impact/head-on\n"),
                               HasSubstr("plain is in the baseline and did not take part in: impact/")));
  EXPECT_THAT(carom(with({"--baseline", "base.json", "--step", "0.002"})).out,
              HasSubstr("the step is another"));
  EXPECT_THAT(carom(with({"--baseline", "base.json", "--seed", "3"})).out, HasSubstr("the seed is another"));
}

TEST_F(BaselineOption, EngineThatCrashesWhereItHadValues_IsAViolation) {
  write_baseline();
  json changed = baseline();
  changed["scenes"]["impact/head-on"]["engines"]["broken-abort"] = {{"energy", 0.0}};
  write("base.json", changed.dump());
  // Not under test beside carom, and a row that is shown; held by the baseline it counts.
  const Words words = {"check",    "impact/head-on", "--engines-from", CAROM_TEST_ENGINE_DIR,
                       "--engine", "carom",          "--engine",       "broken-abort"};
  EXPECT_EQ(carom(words).exit_code, kHolds);
  Words held = words;
  held.insert(held.end(), {"--baseline", "base.json"});
  const Ended ended = carom(held);
  EXPECT_EQ(ended.exit_code, kViolated);
  EXPECT_THAT(ended.out, HasSubstr("violated: impact/head-on: broken-abort: crashed"));
}

TEST_F(BaselineOption, BadFile_IsRefusedWithItsPlace) {
  const std::string scene = R"({"carom_baseline": 1,
"scenes": {
  "a/b": {"sha256": "x", "step": 1, "engines": {
    "carom": {)";
  const std::map<std::string, std::string> bad = {
      {"", "base.json:1: not JSON"},
      {"[]", "base.json:1: the file: found a list"},
      {"7", "base.json:1: found no table"},
      {"{\n\"scenes\": {}}", "base.json:1: carom_baseline: is missing"},
      {"{\"carom_baseline\": 2, \"scenes\": {}}", "base.json:1: carom_baseline: found 2, allowed: 1"},
      {"{\"carom_baseline\": 1,\n\"scenes\": 3}", "base.json:2: scenes: found 3, allowed: a table"},
      {"{\"carom_baseline\": 1,\n\"scenes\": {\n\"a/b\": {}}}", "base.json:3: scenes.a/b.sha256: is missing"},
      {scene + "\n\"energy\": -1}}}}}",
       "base.json:5: scenes.a/b.engines.carom.energy: found -1, allowed: a finite"},
      {scene + "\"speed\": 1}}}}}",
       "base.json:4: scenes.a/b.engines.carom.speed: unknown key, allowed: energy"},
      {scene + "\n\"energy\": 1,\n\"energy\": 1}}}}}", "base.json:6: energy: stands twice, line 5"},
      {scene + "\n\"energy\": 1", "base.json:5: not JSON"},
  };
  for (const auto& [text, says] : bad) {
    write("base.json", text);
    const Ended ended = carom(with({"--baseline", "base.json", "--write-baseline", "new.json"}));
    EXPECT_EQ(ended.exit_code, kBadInput) << text;
    EXPECT_THAT(ended.err, StartsWith("carom: " + says)) << text;
    EXPECT_FALSE(fs::exists(work_ / "new.json"));
  }
  EXPECT_EQ(carom(with({"--baseline", "none.json"})).exit_code, kBadInput);
  EXPECT_EQ(carom(with({"--baseline-factor", "2"})).exit_code, kBadInput);
  EXPECT_EQ(carom(with({"--baseline", "base.json", "--baseline-factor", "0.5"})).exit_code, kBadInput);
}

TEST_F(BaselineOption, BaselineThatCannotBeWritten_IsTheMachinesFault) {
  write("file", "in the way");
  EXPECT_EQ(carom(with({"--write-baseline", "file/below"})).exit_code, kMachineFailed);
}

// --- engines that are broken
// ---------------------------------------------------------------------------------

TEST_F(CommandLine, ImpulseAThousandthTooLarge_IsCaughtAndNamed) {
  const Ended ended = carom({"check", "impact/head-on", "--engines-from", CAROM_TEST_ENGINE_DIR, "--engine",
                             "broken-impulse", "--json", "results.json"});
  EXPECT_EQ(ended.exit_code, kViolated);
  const json run = runs().at(0);
  EXPECT_EQ(run.at("status"), "ok");
  EXPECT_EQ(run.at("verdict"), "fail");
  // With the impulse a thousandth too large the energy after is ½(0.001² + 1.001²)/½ of E_0, 0.002002 above
  // it.
  EXPECT_NEAR(run.at("metrics").at("energy").get<double>(), 0.002002, 1e-12);
  const auto says = [&](const std::string& metric, const std::string& limit) {
    return HasSubstr("impact/head-on: broken-impulse: " + metric + " = " +
                     run.at("metrics").at(metric).dump() + " is above its limit " + limit);
  };
  EXPECT_THAT(ended.out, says("energy", "1e-14"));
  EXPECT_THAT(ended.out, says("position", "1e-13"));
}

/// The checks that a run does not pass.
std::set<std::string> broken_symmetries(const json& run) {
  std::set<std::string> names;
  for (const json& check : run.at("symmetries")) {
    if (check.at("verdict") == "broken") names.insert(check.at("check"));
  }
  return names;
}

TEST_F(CommandLine, BrokenSymmetry_IsCaughtWithoutATruth_AndNamed) {
  const Ended ended =
      carom({"check", "symmetry/free-disks", "--engines-from", CAROM_TEST_ENGINE_DIR, "--engine",
             "broken-label", "--engine", "broken-direction", "--json", "results.json"});
  EXPECT_EQ(ended.exit_code, kViolated);
  EXPECT_THAT(ended.out, HasSubstr("symmetry/free-disks: broken-label: symmetry = "));
  EXPECT_THAT(ended.out, HasSubstr("symmetry/free-disks: broken-direction: symmetry = "));
  EXPECT_EQ(broken_symmetries(runs().at(0)), (std::set<std::string>{"relabel"}));
  EXPECT_EQ(broken_symmetries(runs().at(1)), (std::set<std::string>{"rotate-1-rad", "rotate-90"}));
}

struct Broken {
  std::string name;
  std::string status;
  std::string reason;
};

std::ostream& operator<<(std::ostream& out, const Broken& broken) {
  return out << broken.name;
}

class BrokenEngine : public CommandLine, public ::testing::WithParamInterface<Broken> {
 protected:
  /// Checks a scene with the broken engine and others; what of the results does not change from run to run.
  Ended check(const Words& engines) const {
    const std::string patience_s = GetParam().status == "timeout" ? "1" : "60";
    Words words = {"check",          "impact/head-on",
                   "--engines-from", CAROM_TEST_ENGINE_DIR,
                   "--json",         "results.json",
                   "--timeout",      patience_s,
                   "--memory",       "256"};
    for (const std::string& engine : engines) words.insert(words.end(), {"--engine", engine});
    return carom(words);
  }

  /// The JSON of one engine's run, without its time.
  std::string row(const std::string& engine) const {
    for (json run : runs()) {
      run.erase("cpu_seconds");
      if (run.at("engine") == engine) return run.dump();
    }
    return "no row of " + engine;
  }
};

TEST_P(BrokenEngine, UnderTest_IsARowWithItsStatusAndReason_AndAViolation) {
  const std::string name = "broken-" + GetParam().name;
  const Ended ended = check({name});
  EXPECT_EQ(ended.exit_code, kViolated);
  const json run = json::parse(row(name));
  EXPECT_EQ(run.at("status"), GetParam().status);
  EXPECT_EQ(run.at("verdict"), "error");
  EXPECT_THAT(run.at("reason").get<std::string>(), HasSubstr(GetParam().reason));
  EXPECT_TRUE(run.at("metrics").at("energy").is_null());
  EXPECT_TRUE(run.at("final").empty());
  EXPECT_THAT(ended.out, HasSubstr("violated: impact/head-on: " + name + ": " + GetParam().status));
  EXPECT_THAT(ended.out, HasSubstr(GetParam().reason));
}

TEST_P(BrokenEngine, BesideOthers_LeavesTheirRowsAsTheyAre) {
  check({"carom", "box2d"});
  const std::string carom_alone = row("carom");
  const std::string box2d_alone = row("box2d");
  const std::string name = "broken-" + GetParam().name;
  check({"carom", name, "box2d"});
  EXPECT_EQ(row("carom"), carom_alone);
  EXPECT_EQ(row("box2d"), box2d_alone);
  EXPECT_EQ(json::parse(row(name)).at("status"), GetParam().status);
}

INSTANTIATE_TEST_SUITE_P(
    All, BrokenEngine,
    ::testing::Values(Broken{"abort", "crashed", "mass > 0"}, Broken{"crash", "crashed", "signal 11"},
                      Broken{"exit", "crashed", "without a result"}, Broken{"hang", "timeout", "after 1 s"},
                      Broken{"memory", "crashed", "memory"}, Broken{"nan", "invalid", "ball 1 is not finite"},
                      Broken{"silent", "invalid", "ball 1 is not finite"},
                      Broken{"throw", "crashed", "exception"}),
    name_of_row<Broken>);

/// Two engines of one name could not be told apart.
TEST_F(CommandLine, ModuleWithTheNameOfAnEngine_IsRefused) {
  fs::create_directory(work_ / "modules");
  fs::copy_file(CAROM_TEST_ENGINE_DIR "/broken-nan.so", work_ / "modules/box2d.so");
  const Ended ended = carom({"run", "impact/head-on", "--engines-from", "modules"});
  EXPECT_EQ(ended.exit_code, kBadInput);
  EXPECT_THAT(ended.err, HasSubstr("box2d"));
}

TEST_F(CommandLine, FileThatIsNoModule_IsARowWithTheReason) {
  fs::create_directory(work_ / "modules");
  write("modules/text.so", "not a library");
  const Ended ended = carom({"run", "impact/head-on", "--engines-from", "modules", "--engine", "text"});
  EXPECT_EQ(ended.exit_code, kViolated);
  EXPECT_THAT(ended.out, HasSubstr("modules/text.so"));
}

// --- explain
// -------------------------------------------------------------------------------------------------

class Explain : public CommandLine {
 protected:
  json explained(const std::string& scene, const std::string& engine, const Words& more = {}) const {
    Words words = {"explain", scene, "--engine", engine, "--json", "explained.json"};
    words.insert(words.end(), more.begin(), more.end());
    const Ended ended = carom(words);
    EXPECT_EQ(ended.exit_code, kHolds) << ended.out << ended.err;
    return results("explained.json");
  }
};

TEST_F(Explain, RestingTarget_NamesBox2dsVelocityThresholdFirst) {
  const json found = explained("impact/resting-target", "box2d@default");
  EXPECT_EQ(found.at("metric"), "position");
  EXPECT_EQ(found.at("settings").size(), 9U);
  const json& first = found.at("settings").at(0);
  EXPECT_EQ(first.at("name"), "velocity_threshold_mps");
  EXPECT_EQ(first.at("from"), 1.0);
  EXPECT_EQ(first.at("to"), 0.0);
  EXPECT_GT(first.at("share"), 0.9);
  // What a fixed step leaves: an impact up to a step late.
  EXPECT_EQ(found.at("remainder"), "step");
}

// A ball dropped from 10 m with e = 1 in Bullet as it comes: at the scene's step of 1 ms it gains energy,
// because overlaps are pushed out through the velocity; at 0.1 ms every contact is seen before the ball
// arrives, and takes the whole bounce. Both at once is a pair: neither alone explains the position.
TEST_F(Explain, DropFromTenMetres_NamesWhatChangesBulletsEnergy) {
  // The first bounce of wall/drop-elastic.
  write("drop.toml", R"(title = "A drop"
    dimension = 2
    duration = 2.0
    step = 0.001
    frames = 20
    effects = { gravity = [0, -9.81] }
    wall = [{ normal = [0, 1], offset = 0.0 }]
    ball = [{ mass = 1.0, radius = 0.1, position = [0.0, 10.1] }]
  )");
  const json gain = explained("drop.toml", "bullet@default");
  EXPECT_EQ(gain.at("settings").at(0).at("name"), "erp2");
  EXPECT_GT(gain.at("settings").at(0).at("share"), 0.9);
  const json loss = explained("drop.toml", "bullet@default", {"--step", "1e-4", "--metric", "energy_loss"});
  EXPECT_EQ(loss.at("settings").at(0).at("name"), "contact_processing_threshold_m");
  EXPECT_GT(loss.at("settings").at(0).at("share"), 0.9);
  const json both = explained("drop.toml", "bullet@default", {"--step", "1e-4"});
  EXPECT_THAT(both.at("pair").at("settings").get<Words>(),
              ::testing::UnorderedElementsAre("erp2", "contact_processing_threshold_m"));
  EXPECT_GT(both.at("pair").at("share"), 0.9);
}

TEST_F(Explain, Table_NamesTheFirst_AndFitsEightyColumns) {
  const Ended ended = carom({"explain", "impact/resting-target", "--engine", "box2d@default"});
  EXPECT_THAT(ended.out, HasSubstr("velocity_threshold_mps comes first"));
  std::istringstream lines(ended.out);
  for (std::string line; std::getline(lines, line);) {
    const auto columns = std::count_if(line.begin(), line.end(), [](char byte) {
      return (static_cast<unsigned char>(byte) & 0xC0U) != 0x80U;
    });
    EXPECT_LE(columns, 80) << line;
  }
}

TEST_F(Explain, SharesAddUpToOne) {
  double sum = 0.0;
  const json found = explained("impact/resting-target", "bullet-f64@default");
  for (const json& setting : found.at("settings")) sum += setting.at("share").get<double>();
  EXPECT_NEAR(sum, 1.0, 1e-12);
}

TEST_F(Explain, EngineWithoutSettings_IsExplainedByItsStepAlone) {
  const json found = explained("impact/oblique", "carom:step");
  EXPECT_TRUE(found.at("settings").empty());
  EXPECT_EQ(found.at("remainder"), "step");
}

TEST_F(Explain, MetricAskedFor_IsTheOneExplained) {
  const json found = explained("impact/resting-target", "box2d@default", {"--metric", "energy_loss"});
  EXPECT_EQ(found.at("metric"), "energy_loss");
  EXPECT_NEAR(found.at("divergence").get<double>(), 0.5, 1e-6);
}

TEST_F(Explain, RunThatDoesNotEndWell_IsAViolationWithTheReason) {
  const Ended ended = carom({"explain", "space.toml", "--engine", "box2d"});
  EXPECT_EQ(ended.exit_code, kViolated);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("unsupported"), HasSubstr("two-dimensional")));
  const Ended broken =
      carom({"explain", "impact/head-on", "--engines-from", CAROM_TEST_ENGINE_DIR, "--engine", "broken-nan"});
  EXPECT_EQ(broken.exit_code, kViolated);
  EXPECT_THAT(broken.out, HasSubstr("invalid"));
}

// --- laws of impact
// ------------------------------------------------------------------------------------------

TEST_F(CommandLine, Law_RunsAsAnEngineUnderTest_BesideTheOthers) {
  write("half.toml", "name = \"Half\"\nnormal = \"-0.5 * m * vn - m * vn\"\n");
  const Ended ended = carom({"check", "impact/head-on", "--engine", "carom", "--law", "right", "--law",
                             "half.toml", "--json", "results.json"});
  EXPECT_EQ(ended.exit_code, kViolated);
  ASSERT_EQ(runs().size(), 3U);
  EXPECT_EQ(runs()[1].at("engine"), "carom:law");
  EXPECT_EQ(runs()[1].at("profile"), "right");
  EXPECT_EQ(runs()[1].at("verdict"), "pass");
  EXPECT_EQ(runs()[2].at("profile"), "half");
  EXPECT_EQ(runs()[2].at("verdict"), "fail");
  EXPECT_EQ(runs()[2].at("settings").at("law_normal"), "-0.5 * m * vn - m * vn");
  EXPECT_THAT(ended.out, HasSubstr("violated: impact/head-on: carom:law@half: energy = "));
}

TEST_F(CommandLine, Explain_HoldsALawAgainstTheRightOne) {
  const Ended ended = carom({"explain", "impact/restitution-half", "--law", "impulse-times-e"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("carom:law@impulse-times-e is off by"),
                               HasSubstr("law comes first (what two balls do when they meet): ")));
  EXPECT_EQ(carom({"explain", "impact/oblique"}).exit_code, kBadInput);
  EXPECT_EQ(carom({"explain", "impact/oblique", "--law", "right", "--engine", "carom"}).exit_code, kBadInput);
}

TEST_F(CommandLine, Law_SaysWhatALawBreaks) {
  const Ended ended = carom({"law", "mirrored", "--json", "laws.json"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("momentum is kept                        0 %"),
                               HasSubstr("20000 random pairs")));
  EXPECT_EQ(results("laws.json").at(0).at("rules").at(0).at("rule"), "momentum");
  EXPECT_EQ(results("laws.json").at(0).at("rules").at(0).at("holds"), false);
}

TEST_F(CommandLine, LawWithoutAName_ListsWhatThereIs) {
  const Ended ended = carom({"law"});
  EXPECT_EQ(ended.exit_code, kHolds);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("course-program"), HasSubstr("momentum-for-energy"),
                               HasSubstr("reduced mass")));
}

TEST_F(CommandLine, LawsAreNoScenes) {
  EXPECT_THAT(carom({"list", "scenarios"}).out, Not(HasSubstr("laws/")));
}

TEST_F(CommandLine, LawWithAMistake_IsAnsweredWithThePlaceAndTheNames) {
  write("bad.toml", "name = \"Bad\"\nnormal = \"-2 * mm * vn\"\n");
  for (const Words& words : {Words{"law", "bad.toml"}, Words{"run", "impact/head-on", "--law", "bad.toml"}}) {
    const Ended ended = carom(words);
    EXPECT_EQ(ended.exit_code, kBadInput);
    EXPECT_THAT(ended.out, IsEmpty());
    EXPECT_THAT(ended.err,
                AllOf(StartsWith("carom: bad.toml:2:16: normal: "), HasSubstr("allowed names: m1, m2, m,")));
  }
  EXPECT_THAT(carom({"law", "nope"}).err, HasSubstr("no law \"nope\""));
  EXPECT_THAT(carom({"run", "impact/head-on", "--engine", "carom:law"}).err,
              HasSubstr("takes part with --law FILE"));
}

}  // namespace

}  // namespace carom
