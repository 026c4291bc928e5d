// How fast Carom is beside its peers, how its cost grows, and what the harness around it costs.
//
//   carom-peers [--quick] FILE        measures everything and writes what the page shows into a file: engines
//                                     write to standard output too. Quick: to see that it works, with numbers
//                                     that say nothing
//   carom-peers weigh EVOLVER BALLS   sets up a gas, takes ten steps and ends: for its memory to be measured

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "app/machine.h"
#include "carom/carom_engine.h"
#include "core/error.h"
#include "core/files.h"
#include "core/heap.h"
#include "core/least_squares.h"
#include "scenario/parse.h"
#include "tests/benchmarks/speed/processes.h"
#include "tests/benchmarks/speed/race.h"
#include "tests/benchmarks/speed/scenes.h"
#include "tests/support/folder.h"
#include "trajectory/cpu_time.h"

namespace carom::benchmark {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::ordered_json;

/// How much is measured.
struct Effort {
  int rounds = 7;
  double shortest_s = 0.1;
  std::size_t thousand = 1000;  ///< what stands for a thousand balls
  std::size_t most_balls = 1'000'000;
};

Effort quick() {
  return {1, 1e-3, 100, 1000};
}

/// The numbers of balls from a thousand on, each ten times the one before.
std::vector<std::size_t> decades(const Effort& effort, std::size_t most) {
  std::vector<std::size_t> counts;
  for (std::size_t balls = effort.thousand; balls <= std::min(most, effort.most_balls); balls *= 10)
    counts.push_back(balls);
  return counts;
}

/// What the project sets out to reach, and how near it came.
struct Goal {
  std::string what;
  std::string unit;  ///< of the numbers; empty for a ratio
  bool at_least = true;
  double limit = 0.0;
  Samples measured;
};

Json json_of(const Samples& samples) {
  return {{"median", samples.median()}, {"low", samples.low()}, {"high", samples.high()}};
}

Json json_of(const Goal& goal) {
  const double median = goal.measured.median();
  return {{"what", goal.what},
          {"unit", goal.unit},
          {goal.at_least ? "at_least" : "at_most", goal.limit},
          {"measured", json_of(goal.measured)},
          {"met", goal.at_least ? median >= goal.limit : median <= goal.limit}};
}

/// Everything that is found out.
struct Findings {
  Json costs = Json::array();
  std::vector<Goal> goals;

  void add(const std::string& layout, const std::string& per, const std::vector<Cost>& found) {
    for (const Cost& cost : found) {
      costs.push_back({{"layout", layout},
                       {"per", per},
                       {"balls", cost.balls},
                       {"engine", cost.engine},
                       {"ns", json_of(cost.ns)}});
    }
  }
};

void say(const std::string& what) {
  fmt::print(stderr, "carom: {}\n", what);
}

const Samples& of(const std::vector<Cost>& costs, const std::string& engine) {
  for (const Cost& cost : costs) {
    if (cost.engine == engine) return cost.ns;
  }
  throw std::logic_error("nothing was measured of " + engine);
}

/// The peers that take part with so many balls. ODE's broad phase marks pairs in a table of a bit for every
/// two balls: with a hundred thousand it does little but clear it, and a run of this program would be long.
std::vector<std::string> without_ode_among_many(std::vector<std::string> engines, std::size_t balls,
                                                const Effort& effort) {
  if (balls > 10 * effort.thousand) std::erase(engines, "ode");
  return engines;
}

std::vector<Runner> runners(const std::vector<std::string>& engines, const Scenario& scene) {
  std::vector<Runner> all;
  all.reserve(engines.size());
  for (const std::string& engine : engines) all.push_back({engine, &scene});
  return all;
}

constexpr const char* kPerCollision = "collision, or ball and step of Bullet's";

// How fast the event-driven evolver is by the collision, beside a step of Bullet's for one of the same balls,
// and for one of a gas where balls have fewer neighbours.
void note_collisions(const Cost& event, const Cost& bullet, const Cost& bullet_in_a_thin_gas, double limit,
                     Findings& findings) {
  const std::string goal =
      fmt::format("event, a collision at nσ³ = 0.5 by a ball's step in Bullet in double precision, {} balls",
                  event.balls);
  findings.goals.push_back({goal + ", the same ones", "", false, limit, ratio(event.ns, bullet.ns)});
  findings.goals.push_back(
      {goal + ", Bullet's at packing 0.1", "", false, limit, ratio(event.ns, bullet_in_a_thin_gas.ns)});
}

// In space, against Bullet in double precision; with them the event-driven evolver, by the collision.
void race_in_space(const Effort& effort, Findings& findings) {
  for (const std::size_t balls : decades(effort, 100'000)) {
    say(fmt::format("{} balls in space", balls));
    const Scenario scene = scene_of(gas(3), balls);
    const Scenario hard_spheres = scene_of(hard_sphere_gas(), balls);
    std::vector<Runner> field = runners(
        without_ode_among_many({"bullet-f64", "bullet", "ode", "carom:step", "carom:toi"}, balls, effort),
        scene);
    field.push_back({"bullet-f64", &hard_spheres, Unit::ball_step});
    field.push_back({"carom:event", &hard_spheres, Unit::ball_impact});
    const std::vector<Cost> costs = race(field, effort.rounds, effort.shortest_s);
    const std::vector<Cost> in_the_gas(costs.begin(), costs.end() - 2);
    const std::vector<Cost> of_hard_spheres(costs.end() - 2, costs.end());
    findings.add(gas(3).name, "ball and step", in_the_gas);
    findings.add(hard_sphere_gas().name, kPerCollision, of_hard_spheres);
    if (balls <= effort.thousand) continue;
    const Cost& bullet = in_the_gas.front();
    const std::string where = fmt::format("{} balls in space", balls);
    findings.goals.push_back({"step, times faster than Bullet in double precision, " + where, "", true, 100.0,
                              ratio(bullet.ns, of(costs, "carom:step"))});
    findings.goals.push_back({"toi, times faster than Bullet in double precision, " + where, "", true, 40.0,
                              ratio(bullet.ns, of(costs, "carom:toi"))});
    note_collisions(of_hard_spheres.back(), of_hard_spheres.front(), bullet,
                    balls == 10 * effort.thousand ? 0.8 : 1.5, findings);
  }
}

// A million balls in the event-driven evolver: that it runs, and how fast.
void race_a_million(const Effort& effort, Findings& findings) {
  say(fmt::format("{} balls from collision to collision", effort.most_balls));
  const Scenario scene = scene_of(hard_sphere_gas(), effort.most_balls);
  constexpr int kFewRounds = 3;
  const std::vector<Cost> costs = race({{"carom:event", &scene, Unit::ball_impact}},
                                       std::min(effort.rounds, kFewRounds), effort.shortest_s);
  findings.add(hard_sphere_gas().name, kPerCollision, costs);
  Samples per_second;
  for (const double ns : costs.front().ns.values) per_second.values.push_back(1e9 / ns);
  findings.goals.push_back(
      {fmt::format("event, {} balls run: collisions in a second of CPU", effort.most_balls), "1/s", true, 0.0,
       per_second});
}

void race_in_the_plane(const Effort& effort, Findings& findings) {
  for (const std::size_t balls : decades(effort, 100'000)) {
    say(fmt::format("{} balls in the plane", balls));
    const Scenario scene = scene_of(gas(2), balls);
    const std::vector<Cost> costs = race(
        runners(without_ode_among_many({"box2d", "chipmunk", "bullet-f64", "ode", "carom:step", "carom:toi"},
                                       balls, effort),
                scene),
        effort.rounds, effort.shortest_s);
    findings.add(gas(2).name, "ball and step", costs);
    if (balls != 10 * effort.thousand) continue;
    const std::string where = fmt::format(", {} balls in the plane", balls);
    findings.goals.push_back({"step, times faster than Box2D without continuous collision" + where, "", true,
                              50.0, ratio(of(costs, "box2d"), of(costs, "carom:step"))});
    findings.goals.push_back({"step, times faster than Chipmunk" + where, "", true, 15.0,
                              ratio(of(costs, "chipmunk"), of(costs, "carom:step"))});
  }
}

/// The power of the number of balls by which a step's cost grows, round by round.
Samples exponents(const std::vector<Cost>& costs) {
  Samples result;
  for (std::size_t round = 0; round < costs.front().ns.values.size(); ++round) {
    std::vector<double> log_balls;
    std::vector<double> log_cost;
    for (const Cost& cost : costs) {
      const auto balls = static_cast<double>(cost.balls);
      log_balls.push_back(std::log(balls));
      log_cost.push_back(std::log(balls * cost.ns.values[round]));
    }
    result.values.push_back(line_through(log_balls, log_cost).slope);
  }
  return result;
}

// From a thousand to a million balls, which take turns: a round has all of them.
void race_in_numbers(const Effort& effort, Findings& findings) {
  constexpr int kFewRounds = 3;
  for (const Layout& layout : growth_layouts()) {
    std::vector<Scenario> scenes;
    for (const std::size_t balls : decades(effort, effort.most_balls))
      scenes.push_back(scene_of(layout, balls));
    for (const std::string evolver : {"step", "toi"}) {
      say(fmt::format("the growth of {}, {}", evolver, layout.name));
      std::vector<Runner> field;
      for (const Scenario& scene : scenes) {
        // Long enough for many of a pair list's lives, each of which begins with all the work of its making.
        const double longer = scene.balls.size() >= effort.most_balls ? 15.0 : 3.0;
        field.push_back({"carom:" + evolver, &scene, Unit::ball_step, longer});
      }
      const std::vector<Cost> costs = race(field, std::min(effort.rounds, kFewRounds), effort.shortest_s);
      findings.add("growth: " + layout.name, "ball and step", costs);
      findings.goals.push_back(
          {fmt::format("{}, x where a step costs (number of balls)^x, {}", evolver, layout.name), "", false,
           1.1, exponents(costs)});
    }
  }
}

// Two threads beside one, which take turns.
void race_by_threads(const Effort& effort, Findings& findings) {
  say(fmt::format("two threads, {} balls", effort.most_balls));
  constexpr double kManyLists = 15.0;
  const Scenario scene = scene_of(gas(3), effort.most_balls);
  const auto with = [&](std::size_t threads) {
    return Runner{"carom:step", &scene, Unit::ball_step, kManyLists, threads, true};
  };
  const std::vector<Cost> costs = race({with(1), with(2)}, effort.rounds, effort.shortest_s);
  findings.goals.push_back(
      {fmt::format("step, times faster with two threads than with one, {} balls in space", effort.most_balls),
       "", true, 1.7, ratio(costs[0].ns, costs[1].ns)});
}

fs::path own_program() {
  return program_prefix() / "bin/carom-peers";
}

void weigh_balls(const Effort& effort, Findings& findings) {
  say(fmt::format("the memory of {} balls", effort.most_balls));
  const auto balls = static_cast<double>(effort.most_balls);
  // Once: it counts, and does not time.
  const Spent spent = run_program({own_program(), "weigh", "step", fmt::format("{}", effort.most_balls)});
  const Samples bytes = {{spent.peak_bytes / balls}};
  findings.goals.push_back(
      {fmt::format("step, memory of the whole program by the ball, {} balls in space", effort.most_balls),
       "bytes", false, 200.0, bytes});
}

/// The CPU time of a comparison that is not its engines' stepping, by that.
double harness_share(const test::TestFolder& folder, const fs::path& scene,
                     std::vector<std::string> engines) {
  const fs::path json = folder / "result.json";
  std::vector<std::string> words = {
      program_prefix() / "bin/carom", "run", scene, "--quiet", "-j", "1", "--json", json};
  for (std::string& engine : engines) {
    words.emplace_back("--engine");
    words.push_back(std::move(engine));
  }
  const double cpu_s = run_program(words).cpu_s;
  double stepping_s = 0.0;
  const Json result = Json::parse(read_file(json));
  for (const Json& run : result.at("scenes").at(0).at("runs")) {
    if (run.at("status") == "ok") stepping_s += run.at("cpu_seconds").get<double>();
  }
  return cpu_s / stepping_s - 1.0;
}

void time_the_harness(const Effort& effort, Findings& findings) {
  say("the harness");
  const test::TestFolder folder;
  const fs::path scene = folder / "scene/gas.toml";
  write_file(scene, toml_of(gas(3), effort.thousand));
  const fs::path million = folder / "scene/million.toml";
  write_file(million, toml_of(gas(3), effort.most_balls));
  const std::string one_run = fmt::format("{} balls × 1000 steps at 100 frames", effort.thousand);
  Samples all;
  Samples own;
  Samples loading;
  Samples start;
  for (int round = 0; round < std::min(effort.rounds, 5); ++round) {
    all.values.push_back(harness_share(folder, scene, {}));
    own.values.push_back(harness_share(folder, scene, {"carom:step"}));
    const double before = cpu_now();
    load_scene(million);
    loading.values.push_back(cpu_now() - before);
    start.values.push_back(
        run_program({program_prefix() / "bin/carom", "run", "impact/head-on", "--engine", "carom", "--quiet"})
            .cpu_s);
  }
  findings.goals.push_back(
      {"all that is not stepping, by the stepping: every engine, " + one_run, "", false, 0.05, all});
  findings.goals.push_back({"the same of carom:step alone", "", false, 0.05, own});
  findings.goals.push_back(
      {fmt::format("loading a scene of {} balls", effort.most_balls), "s of CPU", false, 2.0, loading});
  findings.goals.push_back(
      {"the harness: a comparison of two balls, from start to end", "s of CPU", false, 0.03, start});
}

Json measure(const Effort& effort) {
  Findings findings;
  weigh_balls(effort, findings);  // first: a program's peak counts that of the one that started it
  race_in_space(effort, findings);
  race_a_million(effort, findings);
  race_in_the_plane(effort, findings);
  race_in_numbers(effort, findings);
  race_by_threads(effort, findings);
  time_the_harness(effort, findings);
  const Machine machine = this_machine();
  Json goals = Json::array();
  for (const Goal& goal : findings.goals) goals.push_back(json_of(goal));
  return {{"machine",
           {{"cpu", machine.cpu},
            {"cores", machine.cores},
            {"compiler", machine.compiler},
            {"build", machine.build}}},
          {"rounds", effort.rounds},
          {"goals", goals},
          {"costs", findings.costs}};
}

void be_weighed(const std::string& evolver, std::size_t balls) {
  // Not scene_of(), which copies: that would weigh the scene twice.
  const ScenarioPtr scene = parse_scene(toml_of(gas(3), balls), gas(3).name);
  constexpr std::int64_t kSteps = 10;
  make_carom_engine("carom:" + evolver)->create(*scene, "faithful")->advance(scene->step_s, kSteps);
}

int run(const std::vector<std::string>& words) {
  if (words.size() == 3 && words[0] == "weigh") {
    be_weighed(words[1], std::stoul(words[2]));
    return 0;
  }
  const bool in_a_hurry = words.size() == 2 && words[0] == "--quick";
  if (words.size() != (in_a_hurry ? 2 : 1)) {
    fmt::print(stderr, "Usage: carom-peers [--quick] FILE\n");
    return 2;
  }
  write_file(words.back(), measure(in_a_hurry ? quick() : Effort()).dump(2) + "\n");
  return 0;
}

}  // namespace
}  // namespace carom::benchmark

int main(int argc, char** argv) {
  carom::give_large_blocks_back();  // as the program does
  try {
    return carom::benchmark::run({argv + 1, argv + argc});
  } catch (const std::exception& error) {
    fmt::print(stderr, "carom-peers: {}\n", error.what());
    return 3;
  }
}
