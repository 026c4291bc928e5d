#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <csignal>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <thread>
#include <vector>

#include "carom/carom_engine.h"
#include "core/files.h"
#include "report/playback.h"
#include "scenario/parse.h"
#include "tests/lab/http_client.h"
#include "tests/support/folder.h"
#include "tests/support/two_balls.h"
#include "trajectory/record.h"

// The lab as a browser meets it: the program as a process, and HTTP.

namespace carom::test {
namespace {

namespace fs = std::filesystem;
using nlohmann::json;
using testing::AllOf;
using testing::HasSubstr;

const std::string kScene = kTwoBalls;

/// A started program: what it prints comes through a pipe.
class Program {
 public:
  explicit Program(std::vector<std::string> words) {
    std::array<int, 2> ends{};
    EXPECT_EQ(pipe2(ends.data(), O_CLOEXEC), 0);
    posix_spawn_file_actions_t files{};
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_adddup2(&files, ends[1], STDERR_FILENO);
    words.insert(words.begin(), CAROM_PROGRAM);
    std::vector<char*> pointers;
    pointers.reserve(words.size() + 1);
    for (std::string& word : words) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    EXPECT_EQ(posix_spawn(&pid_, CAROM_PROGRAM, &files, nullptr, pointers.data(), environ), 0);
    posix_spawn_file_actions_destroy(&files);
    close(ends[1]);
    out_ = ends[0];
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;
  ~Program() {
    if (pid_ > 0) end(SIGKILL);
    close(out_);
  }

  /// What it prints up to the end of a line.
  std::string line() const {
    std::string text;
    char c = 0;
    while (read(out_, &c, 1) == 1 && c != '\n') text += c;
    return text;
  }

  /// Ends it with a signal, or waits where that is 0. @return its exit code, or -1 where the signal killed it
  int end(int signal) {
    if (signal != 0) kill(pid_, signal);
    int status = 0;
    waitpid(pid_, &status, 0);
    pid_ = -1;
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  }

 private:
  pid_t pid_ = -1;
  int out_ = -1;
};

class Lab : public ::testing::Test {
 protected:
  Lab() : program_({"lab", "--port", "0", "-j", "2"}) {
    const std::string line = program_.line();
    const std::string address = "http://127.0.0.1:";
    const std::size_t found = line.find(address);
    if (found == std::string::npos) throw std::runtime_error("no address in: " + line);
    port_ = std::stoi(line.substr(found + address.size()));
  }

  httplib::Client client() const {
    httplib::Client client("127.0.0.1", port_);
    client.set_read_timeout(120);  // the sanitizers make engines slow
    return client;
  }

  httplib::Response get(const std::string& path, const httplib::Headers& headers = {}) const {
    const httplib::Result result = client().Get(path, headers);
    EXPECT_TRUE(result) << path << ": " << to_string(result.error());
    return result ? *result : httplib::Response();
  }

  httplib::Response post(const std::string& path, const json& body) const {
    const httplib::Result result = client().Post(path, body.dump(), "application/json");
    EXPECT_TRUE(result) << path << ": " << to_string(result.error());
    return result ? *result : httplib::Response();
  }

  std::string error_of(const std::string& path, const json& body, int status = 400) const {
    const httplib::Response response = post(path, body);
    EXPECT_EQ(response.status, status) << response.body;
    return json::parse(response.body).value("error", "no error");
  }

  Program program_;
  int port_ = 0;
};

// --- what it gives

TEST_F(Lab, Modes_AreTheScenes_ThoseOfTheCourseFirst) {
  const httplib::Response response = get("/api/modes");
  ASSERT_EQ(response.status, 200) << response.body;
  EXPECT_EQ(response.get_header_value("Content-Type"), "application/json");
  const json modes = json::parse(response.body);
  bool others = false;
  bool normal = false;
  for (const json& mode : modes) {
    const std::string id = mode.at("id");
    if (!id.starts_with("course/")) others = true;
    EXPECT_FALSE(others && id.starts_with("course/")) << id;
    normal = normal || id == "course/normal-mode";
    EXPECT_FALSE(mode.at("title").get<std::string>().empty()) << id;
    EXPECT_TRUE(mode.at("dimension") == 2 || mode.at("dimension") == 3) << id;
    EXPECT_TRUE(mode.at("about").is_string()) << id;
  }
  EXPECT_TRUE(others && normal);
}

TEST_F(Lab, Engines_SayWhatTheyAreAndCannot) {
  const json engines = json::parse(get("/api/engines").body);
  ASSERT_FALSE(engines.empty());
  EXPECT_EQ(engines[0].at("name"), "carom");
  EXPECT_EQ(engines[0].at("label"), "carom");
  EXPECT_EQ(engines[0].at("profile"), "faithful");
  EXPECT_FALSE(engines[0].at("cannot").contains("events"));
}

TEST_F(Lab, Scene_IsItsFile_ToTheByte) {
  const json scene = json::parse(get("/api/scene?id=course/normal-mode").body);
  EXPECT_EQ(scene.at("toml"), read_file(fs::path(CAROM_SOURCE_DIR) / "scenarios/course/normal-mode.toml"));
}

TEST_F(Lab, Run_IsAPlaybackOfWhatWasAskedFor) {
  const json playback = json::parse(
      post("/api/run", {{"toml", kScene}, {"engines", {"carom", "carom:step"}}, {"truth", true}}).body);
  EXPECT_EQ(playback.at("format"), "carom-playback-2");
  EXPECT_EQ(playback.at("scene").at("title"), "Two");
  ASSERT_EQ(playback.at("runs").size(), 3U);
  EXPECT_EQ(playback.at("runs")[0].at("label"), "truth");
  EXPECT_EQ(playback.at("runs")[2].at("label"), "carom:step");
  EXPECT_EQ(json::parse(post("/api/run", {{"id", "impact/head-on"}}).body).at("scene").at("id"),
            "impact/head-on");
}

TEST_F(Lab, ALawOfOnesOwn_RunsBesideTheOthers_AndIsJudged) {
  const std::string law = read_file(fs::path(CAROM_SOURCE_DIR) / "scenarios/laws/momentum-for-energy.toml");
  const json playback = json::parse(post("/api/run", {{"toml", kScene}, {"law", law}}).body);
  ASSERT_EQ(playback.at("runs").size(), 2U);
  EXPECT_EQ(playback.at("runs")[1].at("label"), "law@own");
  EXPECT_EQ(playback.at("runs")[1].at("status"), "ok");
  const httplib::Response judged = post("/api/law", {{"law", law}});
  EXPECT_EQ(judged.status, 200) << judged.body;
  EXPECT_TRUE(json::parse(judged.body).is_object());
  for (const char* path : {"/api/run", "/api/law"}) {
    EXPECT_THAT(error_of(path, {{"toml", kScene}, {"law", law + "\nnonsense = 1\n"}}),
                AllOf(HasSubstr("law.toml:"), HasSubstr("nonsense")));
  }
  EXPECT_THAT(error_of("/api/law", json::object()), HasSubstr("allowed: law"));
}

// --- a click, and the file that it makes

TEST_F(Lab, Toml_AppendsAnEvent_AndLeavesTheRestAsItWas) {
  const json event = {
      {"time", 0.1 + 0.2}, {"ball", 1}, {"scale_mass", 1.1}, {"set_velocity", {1e-5, -1.0 / 3.0}}};
  const std::string toml =
      json::parse(post("/api/toml", {{"toml", kScene}, {"event", event}}).body).at("toml");
  EXPECT_TRUE(toml.starts_with(kScene));
  EXPECT_THAT(
      toml.substr(kScene.size()),
      AllOf(HasSubstr("[[event]]\ntime = 0.30000000000000004\nball = 1\n"), HasSubstr("scale_mass = 1.1\n"),
            HasSubstr("set_velocity = [1e-05, -0.3333333333333333]\n")));
  const json added = {{"time", 0.5}, {"add_ball", {{"mass", "inf"}, {"radius", 0.1}, {"position", {3, 3}}}}};
  const std::string twice =
      json::parse(post("/api/toml", {{"toml", toml}, {"event", added}}).body).at("toml");
  EXPECT_TRUE(twice.starts_with(toml));
  EXPECT_THAT(twice.substr(toml.size()), HasSubstr("mass = inf"));
}

/// What a person did in the lab, saved, and run on the command line. A playback holds the energy of every
/// frame with all its digits: the lab's is, letter for letter, that of a run of the saved file; and this run
/// ends where the program's ends.
TEST_F(Lab, ASavedScene_GivesTheSameBits_OnTheCommandLine) {
  json body = {{"toml", kScene},
               {"event", {{"time", 0.437}, {"ball", 1}, {"scale_mass", 1.1}, {"scale_radius", 1.05}}}};
  body["toml"] = json::parse(post("/api/toml", body).body).at("toml");
  body["event"] = {{"time", 0.7},
                   {"add_ball", {{"mass", 0.3}, {"radius", 0.05}, {"position", {0.0, 1.0 / 3.0}}}}};
  const std::string toml = json::parse(post("/api/toml", body).body).at("toml");
  const TestFolder folder;
  const fs::path file = folder / "saved.toml";
  write_file(file, toml);

  Scenario saved = *load_scene(file);
  saved.id = "lab/scene";
  const std::shared_ptr<const Engine> carom = make_carom_engine();
  const EngineChoice choice{{"carom", [carom]() -> const Engine& { return *carom; }}};
  const carom::Run run = run_engines(saved, {choice}, {}, 1).front();
  EXPECT_EQ(run.trajectory.balls(), 3U);
  EXPECT_EQ(post("/api/run", {{"toml", toml}}).body, playback_json(saved, {&run}));

  Program program(
      {"run", file.string(), "--engine", "carom", "--quiet", "--json", (folder / "results.json").string()});
  EXPECT_EQ(program.end(0), 0);
  const json results = json::parse(read_file(folder / "results.json"));
  const json final = results.at("scenes").at(0).at("runs").at(0).at("final");
  for (std::size_t i = 0; i < 3; ++i) {
    const BallState& state = run.trajectory.frame(run.trajectory.frames() - 1)[i];
    for (int axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(final.at(i).at("position").at(static_cast<std::size_t>(axis)), state.position[axis]);
      EXPECT_EQ(final.at(i).at("velocity").at(static_cast<std::size_t>(axis)), state.velocity[axis]);
    }
  }
}

// --- what it refuses

TEST_F(Lab, BadScenes_AreAnswered_WithTheMessageOfTheCommandLine) {
  const std::string right = "radius = 0.1";
  std::string bad = kScene;
  bad.replace(bad.find(right), right.size(), "radius = -1");
  const TestFolder folder;
  write_file(folder / "scene.toml", bad);
  Program run({"run", (folder / "scene.toml").string()});
  std::string told = run.line();
  EXPECT_EQ(run.end(0), 2);
  const std::string here = "carom: " + (folder / "").string();
  ASSERT_TRUE(told.starts_with(here)) << told;
  told.erase(0, here.size());
  EXPECT_EQ(error_of("/api/run", {{"toml", bad}}), told);
  EXPECT_THAT(told, HasSubstr("scene.toml:8:10: ball[0].radius: found -1"));
  EXPECT_THAT(error_of("/api/run", {{"toml", kScene}, {"engines", {"nobody"}}}),
              HasSubstr("no engine \"nobody\""));
  EXPECT_THAT(error_of("/api/run", {{"toml", kScene}, {"engines", {"carom@odd"}}}),
              HasSubstr("carom has no profile \"odd\""));
  EXPECT_THAT(
      error_of("/api/toml", {{"toml", kScene}, {"event", {{"time", 0.5}, {"ball", 7}, {"remove", true}}}}),
      HasSubstr("event[0].ball: found 7"));
}

TEST_F(Lab, BadBodies_AreAnswered) {
  EXPECT_THAT(error_of("/api/run", json::object()), HasSubstr("allowed: toml"));
  EXPECT_THAT(error_of("/api/run", {{"toml", 3}}), HasSubstr("toml: found 3"));
  EXPECT_THAT(error_of("/api/run", {{"toml", kScene}, {"engines", json::array()}}),
              HasSubstr("engines: allowed"));
  EXPECT_THAT(error_of("/api/run", {{"toml", kScene}, {"engines", "carom"}}), HasSubstr("engines: allowed"));
  EXPECT_THAT(error_of("/api/run", {{"id", "no/such"}}), HasSubstr("no scene \"no/such\""));
  EXPECT_THAT(error_of("/api/toml", {{"toml", kScene}}), HasSubstr("event is missing"));
  EXPECT_THAT(error_of("/api/toml", {{"toml", kScene}, {"event", nullptr}}), HasSubstr("event: allowed"));
  EXPECT_THAT(error_of("/api/toml", {{"toml", kScene}, {"event", {{"a b\n[[ball]]", 1}, {"time", 0}}}}),
              HasSubstr("scene.toml"));
  const httplib::Result text = client().Post("/api/run", "{", "application/json");
  ASSERT_TRUE(text);
  EXPECT_EQ(text->status, 400);
  EXPECT_THAT(text->body, HasSubstr("not JSON"));
}

TEST_F(Lab, LimitsOfARequest_AreTold) {
  const auto gas = [](const std::string& count, const std::string& frames) {
    return "title = \"gas\"\ndimension = 2\nduration = 1\nstep = 0.01\nframes = " + frames +
           "\n[box]\nmin = [0, 0]\nmax = [9, 9]\n[[balls]]\nkind = \"lattice\"\nradius = 0.001\nmass = "
           "1\ncount = " +
           count + "\n";
  };
  EXPECT_THAT(error_of("/api/run", {{"toml", gas("5001", "10")}}),
              HasSubstr("scene.toml:13:9: balls[0].count: found 5001 balls beside 0 others, allowed here: at "
                        "most 5000 balls in all"));
  EXPECT_THAT(error_of("/api/run", {{"toml", gas("5000", "400")}}), HasSubstr("5000 balls in 401 frames"));
  const httplib::Result large =
      client().Post("/api/run", std::string((1U << 20U) + 1, ' '), "application/json");
  ASSERT_TRUE(large);
  EXPECT_EQ(large->status, 413);
}

TEST_F(Lab, Paths_LeadNowhereElse) {
  const std::string secret = "title     = ";
  for (const char* path :
       {"/../README.md", "/%2e%2e/README.md", "/..%2f..%2fREADME.md", "//etc/passwd", "/etc/passwd", "/.",
        "/..", "/lab/../../x", "/%00", "/api/scene?id=../scenarios/course/normal-mode",
        "/api/scene?id=/etc/passwd", "/api/scene?id=course/normal-mode.toml",
        "/api/scene?id=course%2f..%2fcourse%2fnormal-mode", "/api/scene?id=", "/api/scene",
        "/api/scene?id=\"}", "/api/nothing"}) {
    const httplib::Response response = get(path);
    EXPECT_TRUE(response.status == 400 || response.status == 404) << path << ": " << response.status;
    EXPECT_EQ(response.body.find(secret), std::string::npos) << path;
    EXPECT_EQ(response.body.find("root:"), std::string::npos) << path;
  }
}

TEST_F(Lab, OtherSites_AreRefused) {
  EXPECT_EQ(get("/api/engines", {{"Host", "evil.example:80"}}).status, 403);
  EXPECT_EQ(get("/api/engines", {{"Origin", "http://evil.example"}}).status, 403);
  EXPECT_EQ(
      get("/api/scene?id=impact/head-on", {{"Origin", "http://127.0.0.1:" + std::to_string(port_)}}).status,
      200);
  const httplib::Result form = client().Post("/api/run", json({{"toml", kScene}}).dump(), "text/plain");
  ASSERT_TRUE(form);
  EXPECT_EQ(form->status, 415);
  // Bound to this machine alone: 127.0.0.2 is this machine too, and is not the lab's.
  httplib::Client elsewhere("127.0.0.2", port_);
  EXPECT_FALSE(elsewhere.Get("/api/engines"));
}

TEST_F(Lab, EveryAnswer_HasTheHeadersThatKeepAPageToItself) {
  for (const char* path : {"/", "/api/modes", "/nothing"}) {
    const httplib::Response response = get(path);
    EXPECT_THAT(response.get_header_value("Content-Security-Policy"), HasSubstr("default-src 'self'"))
        << path;
    EXPECT_EQ(response.get_header_value("X-Content-Type-Options"), "nosniff") << path;
    EXPECT_EQ(response.get_header_value("X-Frame-Options"), "DENY") << path;
    EXPECT_EQ(response.get_header_value("Access-Control-Allow-Origin"), "") << path;
  }
}

/// The page's files come with their types, where this build has a page; where it has none, `/` says so.
TEST_F(Lab, ThePage_IsServedByTheNamesOfItsFiles) {
  const fs::path page = fs::path(CAROM_PROGRAM).parent_path().parent_path() / "lib/carom/web";
  const httplib::Response start = get("/");
  EXPECT_EQ(start.status, 200);
  if (!fs::exists(page / "lab.html")) {
    EXPECT_THAT(start.body, HasSubstr("no page"));
    return;
  }
  EXPECT_EQ(start.body, read_file(page / "lab.html"));
  EXPECT_EQ(start.get_header_value("Content-Type"), "text/html; charset=utf-8");
  EXPECT_EQ(get("/lab.js").get_header_value("Content-Type"), "text/javascript; charset=utf-8");
  EXPECT_EQ(get("/lab.css").get_header_value("Content-Type"), "text/css; charset=utf-8");
}

// --- many at once, and the end

TEST_F(Lab, ManyRequestsAtOnce_AreAnsweredOrToldToWait) {
  std::atomic<int> done = 0;
  std::atomic<int> waiting = 0;
  constexpr int kRequests = 14;
  std::vector<std::string> answers(kRequests);
  std::vector<std::thread> threads;
  threads.reserve(kRequests);
  for (int i = 0; i < kRequests; ++i) {
    threads.emplace_back([&, i] {
      httplib::Client own = client();
      const httplib::Result result =
          own.Post("/api/run", json({{"toml", kScene}}).dump(), "application/json");
      if (result && result->status == 200) ++done;
      if (result && result->status == 503) ++waiting;
      answers[static_cast<std::size_t>(i)] =
          result ? std::to_string(result->status) + ": " + result->body.substr(0, 200)
                 : to_string(result.error());
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(done + waiting, kRequests) << testing::PrintToString(answers);
  EXPECT_GE(done, 1);
  EXPECT_EQ(get("/api/engines").status, 200);
}

TEST_F(Lab, ASignal_EndsItCleanly_AlsoDuringARequest) {
  EXPECT_EQ(get("/").status, 200);
  std::thread busy([this] {
    httplib::Client own = client();
    own.Post("/api/run", json({{"id", "hard/ten-million-steps"}}).dump(), "application/json");
  });
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(program_.end(SIGINT), 0);
  busy.join();
  EXPECT_FALSE(client().Get("/"));
  Program next({"lab", "--port", std::to_string(port_)});
  EXPECT_THAT(next.line(), HasSubstr(std::to_string(port_)));
  EXPECT_EQ(next.end(SIGTERM), 0);
}

TEST_F(Lab, APortThatIsTaken_IsAnErrorOfTheMachine_AndABadOneOfTheUser) {
  Program second({"lab", "--port", std::to_string(port_)});
  EXPECT_THAT(second.line(),
              AllOf(HasSubstr("port " + std::to_string(port_)), HasSubstr("Address already in use")));
  EXPECT_EQ(second.end(0), 3);
  for (const char* port : {"65536", "-1", "x"}) {
    Program bad({"lab", "--port", port});
    EXPECT_EQ(bad.end(0), 2) << port;
  }
}

}  // namespace
}  // namespace carom::test
