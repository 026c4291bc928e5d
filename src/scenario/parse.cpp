#include "scenario/parse.h"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sha256.h>
#include <toml++/toml.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/files.h"
#include "scenario/cast.h"
#include "scenario/generate.h"
#include "scenario/read.h"
#include "scenario/room.h"

namespace carom {

namespace {

/// More balls or frames than this are a typing error rather than a scene.
constexpr std::int64_t kMostBalls = 100'000'000;
constexpr std::int64_t kMostFrames = 10'000'000;
/// At a nanosecond each these take eleven days.
constexpr double kMostSteps = 1e15;
constexpr std::int64_t kLargestSeed = std::numeric_limits<std::int64_t>::max();

std::string sha256_hex(std::string_view bytes) {
  std::array<char, SHA256_DIGEST_STRING_LENGTH> hex{};
  SHA256Data(reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size(), hex.data());
  return hex.data();
}

Effects read_effects(Reader reader, int dimension) {
  Effects effects;
  effects.gravity = reader.vector("gravity", dimension);
  if (auto drag = reader.table("drag")) {
    const auto linear = drag->number("linear", kNotNegative);
    const auto quadratic = drag->number("quadratic", kNotNegative);
    if (linear.has_value() == quadratic.has_value()) {
      reader.fail("drag", "needs either linear or quadratic, exactly one of the two");
    }
    effects.drag = linear ? Drag{Drag::Kind::linear, *linear} : Drag{Drag::Kind::quadratic, *quadratic};
    drag->finish();
  }
  effects.spin = reader.boolean("spin").value_or(false);
  effects.magnus = reader.number("magnus", kFinite);
  effects.collisions = reader.boolean("collisions").value_or(true);
  if (effects.magnus && !effects.spin) reader.fail("magnus", "needs effects.spin = true");
  reader.finish();
  return effects;
}

Contact read_contact_keys(Reader& reader, Contact contact, bool spin) {
  contact.restitution = reader.number_or("restitution", kUnitInterval, contact.restitution);
  contact.friction = reader.number_or("friction", kNotNegative, contact.friction);
  contact.tangential_restitution =
      reader.number_or("tangential_restitution", kMinusOneToOne, contact.tangential_restitution);
  if (contact.friction > 0.0 && !spin) reader.fail("friction", "above 0 it needs effects.spin = true");
  return contact;
}

/// The laws of several contacts at once know no friction, on balls or on walls.
MultiContact read_law(Reader& reader, const Scenario& scene) {
  const std::vector<std::string_view> laws = {"sequential", "simultaneous", "generalized-reflections"};
  const auto law = static_cast<MultiContact>(reader.word("law", laws).value_or(0));
  const bool friction = scene.ball_contact.friction > 0.0 || scene.wall_contact.friction > 0.0;
  if (law != MultiContact::sequential && friction) {
    reader.fail_value("law", "\"sequential\" where friction is above 0: the other laws are frictionless");
  }
  return law;
}

void read_contacts(Reader& root, Scenario& scene) {
  if (auto reader = root.table("contact")) {
    scene.ball_contact = read_contact_keys(*reader, {}, scene.effects.spin);
    scene.wall_contact = scene.ball_contact;
    if (auto wall = reader->table("wall")) {
      scene.wall_contact = read_contact_keys(*wall, scene.ball_contact, scene.effects.spin);
      wall->finish();
    }
    scene.multi_contact = read_law(*reader, scene);
    reader->finish();
  }
}

Box read_box(Reader reader, int dimension) {
  Box box;
  box.min = reader.required("min", reader.vector("min", dimension));
  box.max = reader.required("max", reader.vector("max", dimension));
  for (int axis = 0; axis < dimension; ++axis) {
    if (box.min[axis] >= box.max[axis]) reader.fail_value("max", "above min in every coordinate");
  }
  reader.finish();
  return box;
}

std::vector<Wall> walls_of(const Box& box, int dimension) {
  std::vector<Wall> walls;
  for (int axis = 0; axis < dimension; ++axis) {
    walls.push_back({Vec3::Unit(axis), box.min[axis]});
    walls.push_back({-Vec3::Unit(axis), -box.max[axis]});
  }
  return walls;
}

/// The keys that walls, slabs and barriers share. A normal of any length is made a unit vector, and the
/// offset goes with it: normal·x >= offset says the same after both are divided by the normal's length.
template <class Plane>
Plane read_plane(Reader& reader, int dimension) {
  Plane plane;
  const Vec3 normal = reader.required("normal", reader.vector("normal", dimension));
  if (normal.isZero(0.0)) reader.fail_value("normal", "a direction");
  // The stable forms do not square numbers whose squares are no doubles.
  plane.offset = reader.required("offset", reader.number("offset", kFinite)) / normal.stableNorm();
  plane.normal = normal.stableNormalized();
  return plane;
}

void read_solids(Reader& root, Scenario& scene) {
  if (auto reader = root.table("box")) {
    scene.box = read_box(*reader, scene.dimension);
    scene.walls = walls_of(*scene.box, scene.dimension);
  }
  for (Reader& reader : root.tables("wall")) {
    scene.walls.push_back(read_plane<Wall>(reader, scene.dimension));
    reader.finish();
  }
  for (Reader& reader : root.tables("slab")) {
    Slab slab = read_plane<Slab>(reader, scene.dimension);
    slab.thickness = reader.required("thickness", reader.number("thickness", kPositive));
    scene.slabs.push_back(slab);
    reader.finish();
  }
  for (Reader& reader : root.tables("barrier")) {
    Barrier barrier = read_plane<Barrier>(reader, scene.dimension);
    barrier.thickness = reader.required("thickness", reader.number("thickness", kPositive));
    barrier.height = reader.required("height", reader.number("height", kNotNegative));
    barrier.hbar = reader.required("hbar", reader.number("hbar", kPositive));
    barrier.seed = static_cast<std::uint64_t>(reader.integer("seed", 0, kLargestSeed).value_or(0));
    scene.barriers.push_back(barrier);
    reader.finish();
  }
}

Ball read_ball(Reader& reader, const Scenario& scene) {
  Ball ball;
  ball.mass = reader.required("mass", reader.number("mass", kPositiveOrInfinite));
  ball.radius = reader.required("radius", reader.number("radius", kPositive));
  ball.position = reader.required("position", reader.vector("position", scene.dimension));
  ball.velocity = reader.vector("velocity", scene.dimension).value_or(Vec3::Zero());
  ball.spin = reader.spin("spin", scene.dimension).value_or(Vec3::Zero());
  ball.inertia = reader.number_or("inertia", kPositiveToOne, ball.inertia);
  if (!ball.spin.isZero(0.0) && !scene.effects.spin) reader.fail("spin", "needs effects.spin = true");
  reader.finish();
  return ball;
}

Generator read_generator(Reader& reader, const Scenario& scene, const SceneOptions& options) {
  using Kind = Generator::Kind;
  Generator g;
  const std::vector<std::string_view> kinds = {"gas", "lattice", "line"};
  g.kind = static_cast<Kind>(reader.required("kind", reader.word("kind", kinds)));
  g.count = static_cast<std::size_t>(reader.required("count", reader.integer("count", 1, kMostBalls)));
  g.seed = static_cast<std::uint64_t>(reader.integer("seed", 0, kLargestSeed).value_or(0));
  if (options.seed) g.seed = *options.seed;
  g.radius = reader.number_or_range("radius", kPositive);
  g.mass = reader.number("mass", kPositive);
  g.density = reader.number("density", kPositive);
  g.inertia = reader.number_or("inertia", kPositiveToOne, g.inertia);
  g.speed = reader.number_or("speed", kNotNegative, 0.0);
  g.velocity = reader.vector("velocity", scene.dimension);
  if (g.kind == Kind::gas) {
    g.packing = reader.number("packing", kOpenUnitInterval);
    if (!scene.box) reader.fail("kind", "a gas needs [box]");
  } else {
    g.position = reader.vector("position", scene.dimension);
    g.gap = reader.number("gap", kNotNegative);
  }
  if (g.kind == Kind::lattice) {
    const std::vector<std::string_view> arrangements = {"cubic", "close"};
    const auto arrangement = reader.word("arrangement", arrangements).value_or(0);
    g.arrangement = static_cast<Generator::Arrangement>(arrangement);
  }
  if (g.kind == Kind::line) {
    g.direction = reader.vector("direction", scene.dimension);
    if (g.direction && g.direction->isZero(0.0)) reader.fail_value("direction", "a direction");
  }
  if (!g.radius && !g.packing) reader.fail("radius", "is missing");
  if (g.mass && g.density) reader.fail("density", "mass is given too, allowed: one of the two");
  if (g.speed > 0.0 && g.count < 2) reader.fail("speed", "a single ball with total momentum zero is at rest");
  reader.finish();
  return g;
}

/// @throws InputError at the key, where `more` balls beside `before` others are more than the options allow.
void check_count(const Reader& reader, std::string_view key, std::size_t before, std::size_t more,
                 const SceneOptions& options) {
  if (before <= options.most_balls && more <= options.most_balls - before) return;
  reader.fail(key, fmt::format("found {} {} beside {} others, allowed here: at most {} balls in all", more,
                               more == 1 ? "ball" : "balls", before, options.most_balls));
}

/// All tables are read before the first generator places a ball: what is refused costs no placement.
void read_balls(Reader& root, Scenario& scene, const SceneOptions& options) {
  for (Reader& reader : root.tables("ball")) {
    check_count(reader, "", scene.balls.size(), 1, options);
    scene.balls.push_back(read_ball(reader, scene));
  }
  std::vector<std::pair<Generator, Reader>> generators;
  std::size_t count = scene.balls.size();
  for (Reader& reader : root.tables("balls")) {
    Generator generator = read_generator(reader, scene, options);
    check_count(reader, "count", count, generator.count, options);
    count += generator.count;
    generators.emplace_back(std::move(generator), reader);
  }
  for (const auto& [generator, reader] : generators) {
    try {
      std::vector<Ball> made = generate(generator, scene);
      if (scene.balls.empty()) {
        scene.balls = std::move(made);  // a million balls are not held twice
      } else {
        scene.balls.insert(scene.balls.end(), made.begin(), made.end());
      }
    } catch (const DoesNotFit& error) {
      reader.fail("count", fmt::format("{}, allowed: fewer or smaller balls, or a larger box", error.what()));
    }
  }
  if (scene.balls.empty()) root.fail("", "no ball: a scene needs a [[ball]] or [[balls]] table");
  if (const auto contradiction = lack_of_room(scene)) {
    root.fail("", *contradiction + ", allowed: at least its diameter");
  }
}

/// Whether the ball that it is about is there is checked once all events are in order.
Event read_event(Reader& reader, const Scenario& scene, std::size_t numbers) {
  Event event;
  const Range within{0.0, scene.duration_s, false, false, "a time within the duration"};
  event.time = reader.required("time", reader.number("time", within));
  const auto ball = reader.integer("ball", 0, static_cast<std::int64_t>(numbers) - 1);
  if (const auto factor = reader.number("scale_mass", kPositive)) event.actions.push_back(ScaleMass{*factor});
  if (const auto factor = reader.number("scale_radius", kPositive)) {
    event.actions.push_back(ScaleRadius{*factor});
  }
  if (const auto v = reader.vector("set_velocity", scene.dimension)) event.actions.push_back(SetVelocity{*v});
  if (const auto x = reader.vector("set_position", scene.dimension)) event.actions.push_back(SetPosition{*x});
  if (reader.boolean("remove").value_or(false)) event.actions.push_back(RemoveBall{});
  const bool about_a_ball = !event.actions.empty();
  if (auto added = reader.table("add_ball")) event.actions.push_back(AddBall{read_ball(*added, scene)});
  if (event.actions.empty()) {
    reader.fail("",
                "nothing happens, allowed: scale_mass, scale_radius, set_velocity, set_position, add_ball, "
                "remove");
  }
  if (about_a_ball) event.ball = static_cast<std::size_t>(reader.required("ball", ball));
  reader.finish();
  return event;
}

bool is_about_a_ball(const Event& event) {
  return !std::all_of(event.actions.begin(), event.actions.end(),
                      [](const Action& action) { return std::holds_alternative<AddBall>(action); });
}

/// What no ball can be.
void check_grown(const Reader& reader, const Scenario& scene, const Ball& before, const Ball& after) {
  const bool immovable = std::isinf(before.mass);
  if (!immovable && !(std::isfinite(after.mass) && after.mass > 0.0)) {
    reader.fail_value("scale_mass", fmt::format("a factor that keeps {} kg finite and above 0", before.mass));
  }
  if (!(std::isfinite(after.radius) && after.radius > 0.0)) {
    reader.fail_value("scale_radius",
                      fmt::format("a factor that keeps {} m finite and above 0", before.radius));
  }
  Scenario grown = scene;
  grown.balls = {after};
  // Only walls that face each other count here: which side of a slab the ball is on, the file does not tell.
  grown.slabs.clear();
  if (lack_of_room(grown)) {
    reader.fail("", fmt::format("the ball has a diameter of {} m then, and stands between walls nearer to "
                                "each other, allowed: at most their distance",
                                2.0 * after.radius));
  }
}

/// Events in the order in which they happen, each about a ball that is there then.
void read_events(Reader& root, Scenario& scene, const SceneOptions& options) {
  std::vector<Reader> readers = root.tables("event");
  if (readers.empty()) return;  // and no cast of all balls
  std::size_t numbers = scene.balls.size();
  for (Reader reader : readers) {  // a copy: what a reader was asked for, it names in errors
    if (!reader.has("add_ball")) continue;
    check_count(reader, "add_ball", numbers, 1, options);
    ++numbers;
  }
  std::vector<std::pair<Event, Reader>> read;
  for (Reader& reader : readers) {
    Event event = read_event(reader, scene, numbers);
    read.emplace_back(std::move(event), reader);
  }
  std::stable_sort(read.begin(), read.end(),
                   [](const auto& a, const auto& b) { return a.first.time < b.first.time; });
  for (const auto& [event, reader] : read) scene.events.push_back(event);
  Cast cast(scene);
  for (const auto& [event, reader] : read) {
    if (is_about_a_ball(event) && (event.ball >= cast.size() || !cast[event.ball])) {
      reader.fail_value("ball",
                        fmt::format("a ball that is there at t = {} s (from 0 to {}, without those that an "
                                    "event removed before or adds later)",
                                    event.time, cast.size() - 1));
    }
    for (const BallChange& change : cast.take_next()) {
      if (change.after) check_grown(reader, scene, change.before.value_or(*change.after), *change.after);
    }
  }
}

Limits read_limits(Reader& reader) {
  Limits limits;
  for (std::size_t metric = 0; metric < kMetricNames.size(); ++metric) {
    const auto limit = reader.number(kMetricNames[metric], kNotNegative);
    if (limit) limits.emplace(static_cast<Metric>(metric), *limit);
  }
  return limits;
}

Gate read_gate(Reader reader, const std::vector<std::string>& engines) {
  Gate gate;
  gate.under_test = read_limits(reader);
  for (auto& [engine, table] : reader.remaining_tables()) {
    if (!engines.empty() && std::find(engines.begin(), engines.end(), engine) == engines.end()) {
      reader.fail(engine, fmt::format("unknown engine or metric, allowed engines: {}; allowed metrics: {}",
                                      fmt::join(engines, ", "), fmt::join(kMetricNames, ", ")));
    }
    gate.per_engine[engine] = read_limits(table);
    table.finish();
  }
  reader.finish();
  return gate;
}

TruthKind read_truth(Reader reader) {
  const std::vector<std::string_view> kinds = {"auto", "closed-form", "exact", "converged", "none"};
  const auto kind = static_cast<TruthKind>(reader.word("kind", kinds).value_or(0));
  reader.finish();
  return kind;
}

std::vector<Symmetry> read_symmetries(Reader reader) {
  std::vector<Symmetry> symmetries;
  const std::vector<std::string_view> names(kSymmetryNames.begin(), kSymmetryNames.end());
  for (const std::size_t index : reader.required("checks", reader.words("checks", names))) {
    symmetries.push_back(static_cast<Symmetry>(index));
  }
  reader.finish();
  return symmetries;
}

/// Keys are read in this order because later ones lean on earlier ones: vectors on the dimension, friction on
/// spin, generated balls on the box.
void read_scene(Reader& root, const SceneOptions& options, Scenario& scene) {
  scene.title = root.required("title", root.text("title"));
  scene.about = root.text("about").value_or("");
  scene.dimension = static_cast<int>(root.required("dimension", root.integer("dimension", 2, 3)));
  scene.duration_s = root.required("duration", root.number("duration", kPositive));
  scene.step_s = root.required("step", root.number("step", kPositive));
  if (options.step_s) scene.step_s = *options.step_s;
  scene.frames = root.required("frames", root.integer("frames", 1, kMostFrames));
  if (scene.duration_s / scene.step_s > kMostSteps) {
    root.fail("step",
              fmt::format("found {}, allowed: at least {} of the duration", scene.step_s, 1.0 / kMostSteps));
  }
  if (auto effects = root.table("effects")) scene.effects = read_effects(*effects, scene.dimension);
  read_contacts(root, scene);
  read_solids(root, scene);
  read_balls(root, scene, options);
  read_events(root, scene, options);
  if (auto truth = root.table("truth")) scene.truth = read_truth(*truth);
  if (auto symmetry = root.table("symmetry")) scene.symmetries = read_symmetries(*symmetry);
  if (auto gate = root.table("gate")) scene.gate = read_gate(*gate, options.engines);
  root.finish();
}

std::shared_ptr<Scenario> parse(std::string_view toml_text, const std::string& file,
                                const SceneOptions& options) {
  auto scene = std::make_shared<Scenario>();
  scene->file = file;
  scene->sha256 = sha256_hex(toml_text);
  try {
    const toml::table table = toml::parse(toml_text, file);
    Reader root(table, file, "");
    read_scene(root, options, *scene);
  } catch (const toml::parse_error& error) {
    const auto& place = error.source().begin;
    throw InputError(
        fmt::format("{}:{}:{}: not TOML: {}", file, place.line, place.column, error.description()));
  }
  return scene;
}

}  // namespace

ScenarioPtr parse_scene(std::string_view toml_text, const std::string& file, const SceneOptions& options) {
  return parse(toml_text, file, options);
}

ScenarioPtr load_scene(const std::filesystem::path& file, const SceneOptions& options) {
  const std::shared_ptr<Scenario> scene = parse(read_file(file), file.string(), options);
  const std::filesystem::path absolute = std::filesystem::absolute(file);
  const std::string group = absolute.parent_path().filename().string();
  // A file in the root folder has no group; an id with a leading slash would be taken for an absolute path.
  scene->id =
      group.empty() ? absolute.stem().string() : fmt::format("{}/{}", group, absolute.stem().string());
  return scene;
}

}  // namespace carom
