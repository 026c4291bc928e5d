#include "report/playback.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "comparison/comparison.h"
#include "comparison/conserved.h"
#include "comparison/metrics/brought.h"
#include "report/impacts.h"
#include "report/json_number.h"
#include "report/pack.h"
#include "report/pair_tests.h"
#include "scenario/cast.h"

namespace carom {

namespace {

using Json = nlohmann::ordered_json;

constexpr double kLargest = 1 << 29;  // a first difference of two such numbers fits into 31 bits
constexpr double kTimeUnits = 1 << 30;
/// A person looks at the pair tests of no more balls; and counts of these fit into 31 bits.
constexpr std::size_t kCountedBalls = 5000;

Json vector_json(const Vec3& v) {
  return {v.x(), v.y(), v.z()};
}

/// The largest power of two that is at most `finest` and on whose grid `largest` fits into 30 bits.
double grid(double finest, double largest) {
  const double needed = largest / kLargest;
  const double step = std::max(finest, std::numeric_limits<double>::min());
  return std::exp2(needed > step ? std::ceil(std::log2(needed)) : std::floor(std::log2(step)));
}

struct Grids {
  double position_m = 1.0;
  double speed_mps = 1.0;
  double spin_radps = 1.0;
};

/// What is played: which balls, which frames, on which grids.
struct Cut {
  std::size_t balls = 0;
  std::size_t every = 1;
  std::vector<std::size_t> frames;  ///< of a whole run
  Grids grids;
};

bool plays(const Run& run) {
  return run.status == RunStatus::ok && run.trajectory.frames() > 0;
}

bool finite(const BallState& state) {
  return state.position.allFinite() && state.velocity.allFinite() && state.spin.allFinite();
}

/// What is played: a run, or the truth.
struct Film {
  const Trajectory* trajectory = nullptr;
  const Run* run = nullptr;  ///< nothing: the truth
  std::size_t known = 0;     ///< its frames; later ones say nothing
};

/// The number of frames until the first that is not finite.
std::size_t known_frames(const Trajectory& trajectory) {
  for (std::size_t k = 0; k < trajectory.frames(); ++k) {
    for (std::size_t i = 0; i < trajectory.balls(); ++i) {
      if (trajectory.present(k, i) && !finite(trajectory.frame(k)[i])) return k;
    }
  }
  return trajectory.frames();
}

Grids grids_of(const Scenario& scenario, const std::vector<Film>& films, const PlaybackLimits& limits) {
  double radius = std::numeric_limits<double>::infinity();
  ever(scenario, [&](const Ball& ball) {
    radius = std::min(radius, ball.radius);
    return false;
  });
  double farthest = 0.0;
  double fastest = 0.0;
  double spin = 0.0;
  for (const auto& [trajectory, run, known] : films) {
    for (std::size_t k = 0; k < known; ++k) {
      for (std::size_t i = 0; i < trajectory->balls(); ++i) {
        if (!trajectory->present(k, i)) continue;
        const BallState& state = trajectory->frame(k)[i];
        farthest = std::max(farthest, state.position.cwiseAbs().maxCoeff());
        fastest = std::max(fastest, state.velocity.cwiseAbs().maxCoeff());
        spin = std::max(spin, state.spin.cwiseAbs().maxCoeff());
      }
    }
  }
  return {grid(std::ldexp(radius, -limits.position_bits), farthest),
          grid(std::ldexp(fastest, -limits.speed_bits), fastest),
          grid(std::ldexp(spin, -limits.speed_bits), spin)};
}

Cut cut_of(const Scenario& scenario, const std::vector<Film>& films, const PlaybackLimits& limits) {
  Cut cut;
  cut.balls = std::min(numbered_balls(scenario), limits.balls);
  const auto intervals = static_cast<std::size_t>(scenario.frames);
  const std::size_t most = std::max<std::size_t>(limits.states / std::max<std::size_t>(cut.balls, 1), 2);
  cut.every = most > intervals ? 1 : (intervals + most - 2) / (most - 1);
  for (std::size_t k = 0; k < intervals; k += cut.every) cut.frames.push_back(k);
  cut.frames.push_back(intervals);
  cut.grids = grids_of(scenario, films, limits);
  return cut;
}

double on_grid(double value, double grid) {
  return std::nearbyint(value / grid);
}

/// A quantity of the balls over frames on a grid, as first differences: packed integers.
template <class Quantity>
std::string pack_states(const Trajectory& trajectory, std::span<const std::size_t> frames, std::size_t balls,
                        std::span<const int> axes, double grid, Quantity quantity) {
  std::vector<std::int32_t> differences;
  differences.reserve(frames.size() * balls * axes.size());
  for (const int axis : axes) {
    for (std::size_t i = 0; i < balls; ++i) {
      std::int32_t last = 0;
      for (const std::size_t k : frames) {
        // A ball that is not there is packed where it was.
        const std::int32_t now =
            trajectory.present(k, i)
                ? static_cast<std::int32_t>(on_grid(quantity(trajectory.frame(k)[i])[axis], grid))
                : last;
        differences.push_back(now - last);
        last = now;
      }
    }
  }
  return pack_integers(differences);
}

/// Where the flight of a ball goes, from frame to frame. What is unpacked is known here too, so that
/// roundings do not add up over frames, and a ball that flies freely leaves nothing but zeros.
class PackedFlight {
 public:
  PackedFlight(std::span<const int> axes, const Grids& grids) : axes_(axes), grids_(grids) {}

  /// Goes on to a ball's next frame. @param state  nothing: the ball is not there, and is held where it was
  /// @returns for each axis by how many grids the flight misses it
  Eigen::Array<std::int32_t, 3, 1> next(const BallState* state, double interval_s) {
    Vec3 after = v_;
    if (state != nullptr) {
      for (const int c : axes_) after[c] = on_grid(state->velocity[c], grids_.speed_mps) * grids_.speed_mps;
      wanted_ = state->position;
    }
    // |x| is at most this on its grid, so three of them, x and x' and the flight, fit into 31 bits.
    const double farthest = kLargest * grids_.position_m;
    const Vec3 jump = after - v_;
    int lead = axes_.front();
    for (const int c : axes_) {
      if (std::abs(jump[c]) > std::abs(jump[lead])) lead = c;
    }
    Eigen::Array<std::int32_t, 3, 1> off = {0, 0, 0};
    const auto fly = [&](int c, double aside) {
      x_[c] += std::clamp(0.5 * interval_s * (v_[c] + after[c]) + aside, -farthest, farthest);
      off[c] = static_cast<std::int32_t>(on_grid(wanted_[c] - x_[c], grids_.position_m));
      x_[c] += off[c] * grids_.position_m;
    };
    fly(lead, 0.0);
    // Where the velocity jumps once, at a time t of its interval h, the flight misses by (h/2 - t) times the
    // jump.
    const double missed = off[lead] * grids_.position_m;
    const bool once = interval_s > 0.0 && jump[lead] != 0.0 && std::isfinite(jump[lead]) &&
                      std::abs(missed) <= 0.5 * interval_s * std::abs(jump[lead]) + grids_.position_m;
    for (const int c : axes_) {
      if (c != lead) fly(c, once ? missed * (jump[c] / jump[lead]) : 0.0);
    }
    v_ = after;
    return off;
  }

 private:
  std::span<const int> axes_;
  Grids grids_;
  Vec3 wanted_ = Vec3::Zero();  ///< m, where the ball was last
  Vec3 x_ = Vec3::Zero();       ///< m, where it is unpacked
  Vec3 v_ = Vec3::Zero();       ///< m/s
};

/// Positions as packed integers: by how many grids the flight from the frame before misses them.
std::string pack_positions(const Scenario& scenario, const Trajectory& trajectory,
                           std::span<const std::size_t> frames, std::size_t balls, std::span<const int> axes,
                           const Grids& grids) {
  const auto intervals = static_cast<double>(scenario.frames);
  const auto time = [&](std::size_t k) { return static_cast<double>(k) / intervals * scenario.duration_s; };
  std::vector<std::int32_t> missed(frames.size() * balls * axes.size());
  for (std::size_t i = 0; i < balls; ++i) {
    PackedFlight flight(axes, grids);
    for (std::size_t f = 0; f < frames.size(); ++f) {
      const std::size_t k = frames[f];
      const BallState* state = trajectory.present(k, i) ? &trajectory.frame(k)[i] : nullptr;
      const auto off = flight.next(state, f > 0 ? time(k) - time(frames[f - 1]) : 0.0);
      for (std::size_t a = 0; a < axes.size(); ++a) {
        missed[(a * balls + i) * frames.size() + f] = off[axes[a]];
      }
    }
  }
  return pack_integers(missed);
}

/// Translation, rotation, potential of every frame, one after the other, J.
std::string pack_energies(const Reference& reference, const Trajectory& trajectory,
                          std::span<const std::size_t> frames) {
  const Scenario& scenario = *reference.scenario;
  const Vec3 gravity = scenario.effects.gravity.value_or(Vec3::Zero());
  std::vector<double> translation;
  std::vector<double> rotation;
  std::vector<double> potential;
  Cast cast(scenario);
  for (const std::size_t k : frames) {
    cast.to_frame(static_cast<std::int64_t>(k));
    double moving = 0.0;
    double turning = 0.0;
    double falling = 0.0;
    for (std::size_t i = 0; i < trajectory.balls(); ++i) {
      if (!cast[i] || !std::isfinite(cast[i]->mass)) continue;
      const Ball& ball = *cast[i];
      const BallState& state = trajectory.frame(k)[i];
      moving += 0.5 * ball.mass * state.velocity.squaredNorm();
      turning += 0.5 * ball.inertia * ball.mass * ball.radius * ball.radius * state.spin.squaredNorm();
      falling += ball.mass *
                 (gravity.norm() * reference.fall_m[i] - gravity.dot(state.position - reference.home[i]));
    }
    translation.push_back(moving);
    rotation.push_back(turning);
    potential.push_back(falling);
  }
  translation.insert(translation.end(), rotation.begin(), rotation.end());
  translation.insert(translation.end(), potential.begin(), potential.end());
  return pack_doubles(translation);
}

std::string pack_counted(const Trajectory& trajectory, std::span<const std::size_t> frames) {
  std::vector<std::int32_t> changes;
  std::uint32_t last = 0;
  for (const std::size_t k : frames) {
    const auto now = static_cast<std::uint32_t>(trajectory.tally(k).impacts);
    changes.push_back(static_cast<std::int32_t>(now - last));
    last = now;
  }
  return pack_integers(changes);
}

/// First differences.
std::string pack_counts(const std::vector<std::int64_t>& counts) {
  std::vector<std::int32_t> changes;
  std::int64_t last = 0;
  for (const std::int64_t count : counts) {
    changes.push_back(static_cast<std::int32_t>(count - last));
    last = count;
  }
  return pack_integers(changes);
}

/// What events brought and took until each of these frames, J.
std::string pack_added(const Reference& reference, const Run& run, std::span<const std::size_t> frames) {
  const std::vector<Conserved> brought = brought_by_events(reference, run);
  std::vector<double> added;
  added.reserve(frames.size());
  for (const std::size_t k : frames) added.push_back(brought[k].energy_J);
  return pack_doubles(added);
}

void add_impacts(Json& json, const Scenario& scenario, const Trajectory& trajectory, const Cut& cut,
                 std::size_t most) {
  const SeenImpacts seen = find_impacts(scenario, trajectory, most);
  std::vector<std::int32_t> numbers;
  std::int32_t last = 0;
  for (const SeenImpact& impact : seen.impacts) {
    if (static_cast<std::size_t>(impact.ball) >= cut.balls) continue;
    const auto time = static_cast<std::int32_t>(impact.time_s / scenario.duration_s * kTimeUnits);
    numbers.push_back(time - last);
    last = time;
  }
  const auto shown = [&](std::int32_t ball) { return static_cast<std::size_t>(ball) < cut.balls; };
  for (const SeenImpact& impact : seen.impacts) {
    if (shown(impact.ball)) numbers.push_back(impact.ball);
  }
  for (const SeenImpact& impact : seen.impacts) {
    if (shown(impact.ball)) {
      numbers.push_back(impact.other < 0 || shown(impact.other) ? impact.other : SeenImpact::kUnknown);
    }
  }
  json["impacts"] = pack_integers(numbers);
  json["more_impacts"] = seen.more;
}

void add_states(Json& json, const Reference& reference, const Film& film, const Cut& cut,
                const PlaybackLimits& limits) {
  const Scenario& scenario = *reference.scenario;
  const auto& [film_trajectory, run, known] = film;
  const Trajectory& trajectory = *film_trajectory;
  const auto end = std::lower_bound(cut.frames.begin(), cut.frames.end(), known);
  const std::span<const std::size_t> frames(cut.frames.begin(), end);
  const bool plane = scenario.dimension == 2;
  const std::vector<int> axes = plane ? std::vector<int>{0, 1} : std::vector<int>{0, 1, 2};
  const std::vector<int> turns = plane ? std::vector<int>{2} : axes;
  json["known"] = frames.size();
  json["positions"] = pack_positions(scenario, trajectory, frames, cut.balls, axes, cut.grids);
  json["velocities"] = pack_states(trajectory, frames, cut.balls, axes, cut.grids.speed_mps,
                                   [](const BallState& s) -> const Vec3& { return s.velocity; });
  if (scenario.effects.spin) {
    json["spins"] = pack_states(trajectory, frames, cut.balls, turns, cut.grids.spin_radps,
                                [](const BallState& s) -> const Vec3& { return s.spin; });
  }
  json["energy"] = pack_energies(reference, trajectory, frames);
  json["counted"] = pack_counted(trajectory, frames);
  if (scenario.effects.collisions && trajectory.balls() <= kCountedBalls) {
    const PairTests tests = count_pair_tests(scenario, trajectory, frames);
    json["brute_force_tests"] = pack_counts(tests.brute_force);
    json["tree_tests"] = pack_counts(tests.tree);
  }
  if (run != nullptr && !scenario.events.empty()) json["added"] = pack_added(reference, *run, frames);
  if (known == trajectory.frames()) add_impacts(json, scenario, trajectory, cut, limits.impacts);
}

Json event_json(const Event& event) {
  Json json = {{"time", event.time}, {"ball", event.ball}};
  for (const Action& action : event.actions) {
    if (const auto* mass = std::get_if<ScaleMass>(&action)) json["scale_mass"] = mass->factor;
    if (const auto* radius = std::get_if<ScaleRadius>(&action)) json["scale_radius"] = radius->factor;
    if (const auto* set = std::get_if<SetVelocity>(&action))
      json["set_velocity"] = vector_json(set->velocity);
    if (const auto* set = std::get_if<SetPosition>(&action))
      json["set_position"] = vector_json(set->position);
    if (std::holds_alternative<AddBall>(action)) json["add_ball"] = true;
    if (std::holds_alternative<RemoveBall>(action)) json["remove"] = true;
  }
  return json;
}

Json sheet_json(const Vec3& normal, double offset, double thickness) {
  return {{"normal", vector_json(normal)}, {"offset", offset}, {"thickness", thickness}};
}

Json scene_json(const Scenario& scenario) {
  Json json = {{"id", scenario.id},
               {"title", scenario.title},
               {"dimension", scenario.dimension},
               {"duration", scenario.duration_s},
               {"step", scenario.step_s},
               {"spin", scenario.effects.spin},
               {"collisions", scenario.effects.collisions},
               {"restitution", scenario.ball_contact.restitution},
               {"gravity", nullptr},
               {"box", nullptr},
               {"walls", Json::array()},
               {"slabs", Json::array()},
               {"barriers", Json::array()},
               {"events", Json::array()}};
  if (scenario.effects.gravity) json["gravity"] = vector_json(*scenario.effects.gravity);
  if (scenario.box) {
    json["box"] = {{"min", vector_json(scenario.box->min)}, {"max", vector_json(scenario.box->max)}};
  }
  for (const Wall& wall : scenario.walls) json["walls"].push_back(sheet_json(wall.normal, wall.offset, 0.0));
  for (const Slab& slab : scenario.slabs) {
    json["slabs"].push_back(sheet_json(slab.normal, slab.offset, slab.thickness));
  }
  for (const Barrier& barrier : scenario.barriers) {
    Json sheet = sheet_json(barrier.normal, barrier.offset, barrier.thickness);
    sheet["height"] = barrier.height;
    sheet["hbar"] = barrier.hbar;
    json["barriers"].push_back(std::move(sheet));
  }
  for (const Event& event : scenario.events) json["events"].push_back(event_json(event));
  return json;
}

/// What events do to the balls that are shown, by the first frame that shows it.
Json changes_json(const Scenario& scenario, std::size_t shown) {
  Json changes = Json::array();
  Cast cast(scenario);
  while (cast.next() != nullptr) {
    const std::int64_t frame = first_frame_after(scenario, *cast.next());
    for (const BallChange& change : cast.take_next()) {
      if (change.ball >= shown) continue;
      Json json = {{"frame", frame}, {"ball", change.ball}, {"there", change.after.has_value()}};
      if (change.after) {
        json["mass"] = number_or_null(change.after->mass);
        json["radius"] = change.after->radius;
      }
      changes.push_back(std::move(json));
    }
  }
  return changes;
}

/// Balls as they are when they are first there.
std::vector<Ball> first_balls(const Scenario& scenario) {
  std::vector<Ball> balls = scenario.balls;
  Cast cast(scenario);
  while (cast.next() != nullptr) {
    for (const BallChange& change : cast.take_next()) {
      if (!change.before) balls.push_back(*change.after);
    }
  }
  return balls;
}

Json balls_json(const Scenario& scenario, std::size_t shown) {
  std::vector<double> masses;
  std::vector<double> radii;
  std::vector<double> inertias;
  const std::vector<Ball> balls = first_balls(scenario);
  for (std::size_t i = 0; i < shown; ++i) {
    masses.push_back(balls[i].mass);
    radii.push_back(balls[i].radius);
    inertias.push_back(balls[i].inertia);
  }
  return {{"count", balls.size()},
          {"shown", shown},
          {"first", std::min(scenario.balls.size(), shown)},
          {"mass", pack_doubles(masses)},
          {"radius", pack_doubles(radii)},
          {"inertia", pack_doubles(inertias)},
          {"changes", changes_json(scenario, shown)}};
}

bool same_states(const Trajectory& a, const Trajectory& b) {
  if (a.frames() != b.frames() || a.balls() != b.balls()) return false;
  for (std::size_t k = 0; k < a.frames(); ++k) {
    for (std::size_t i = 0; i < a.balls(); ++i) {
      if (!a.present(k, i) && !b.present(k, i)) continue;
      const BallState& s = a.frame(k)[i];
      const BallState& t = b.frame(k)[i];
      if (s.position != t.position || s.velocity != t.velocity || s.spin != t.spin) return false;
    }
    if (a.tally(k).impacts != b.tally(k).impacts) return false;
  }
  return true;
}

/// The runs, written one by one within the limit of bytes.
class Runs {
 public:
  Runs(const Reference& reference, const Cut& cut, const PlaybackLimits& limits)
      : reference_(reference), cut_(cut), limits_(limits) {}

  void add(Json about, const Film& film) {
    const Trajectory& trajectory = *film.trajectory;
    const std::string label = about.at("label");
    for (const auto& [other, states] : written_) {
      if (!same_states(*states, trajectory)) continue;
      about["same_as"] = other;
      json_.push_back(std::move(about));
      return;
    }
    add_states(about, reference_, film, cut_, limits_);
    const std::size_t bytes = about.dump().size();
    if (!written_.empty() && bytes_ + bytes > limits_.bytes) {
      left_out_.push_back(label);
      return;
    }
    bytes_ += bytes;
    written_.emplace_back(label, &trajectory);
    json_.push_back(std::move(about));
  }

  void add_without_states(Json about) { json_.push_back(std::move(about)); }

  Json take() { return std::move(json_); }
  const std::vector<std::string>& left_out() const { return left_out_; }

 private:
  const Reference& reference_;
  const Cut& cut_;
  const PlaybackLimits& limits_;
  Json json_ = Json::array();
  std::size_t bytes_ = 0;
  std::vector<std::pair<std::string, const Trajectory*>> written_;
  std::vector<std::string> left_out_;
};

Json run_json(const Run& run) {
  return {{"label", run.label()},       {"engine", run.engine},          {"profile", run.profile},
          {"precision", run.precision}, {"status", name_of(run.status)}, {"reason", run.reason}};
}

/// Markup is escaped as JSON allows it, so that the text may stand in a page.
std::string without_markup(const std::string& json) {
  std::string text;
  text.reserve(json.size());
  for (const char c : json) {
    if (c == '<' || c == '>' || c == '&') {
      text += fmt::format("\\u{:04x}", static_cast<int>(c));
    } else {
      text += c;
    }
  }
  return text;
}

/// The truth knows nothing of what events do, whatever stands in its frames after the first of them.
Film film_of(const Truth& truth, const Scenario& scenario) {
  std::size_t known = known_frames(truth.trajectory);
  if (!scenario.events.empty()) {
    known = std::min(known, static_cast<std::size_t>(first_frame_after(scenario, scenario.events.front())));
  }
  return {&truth.trajectory, nullptr, known};
}

/// Those that end well, the truth first.
std::vector<Film> films_of(const Scenario& scenario, const std::vector<const Run*>& runs,
                           const Truth* truth) {
  std::vector<Film> films;
  if (truth != nullptr) films.push_back(film_of(*truth, scenario));
  for (const Run* run : runs) {
    if (plays(*run)) films.push_back({&run->trajectory, run, known_frames(run->trajectory)});
  }
  return films;
}

}  // namespace

PlaybackText write_playback(const Scenario& scenario, const std::vector<const Run*>& runs, const Truth* truth,
                            const PlaybackLimits& limits) {
  const std::string no_truth = truth != nullptr && !truth->known() ? truth->reason : "";
  if (truth != nullptr && (!truth->known() || truth->trajectory.frames() == 0)) truth = nullptr;
  const std::vector<Film> films = films_of(scenario, runs, truth);
  const Cut cut = cut_of(scenario, films, limits);
  const Reference reference(scenario);
  Runs written(reference, cut, limits);
  auto film = films.begin();
  if (truth != nullptr) {
    written.add({{"label", "truth"}, {"engine", "truth"}, {"status", "ok"}, {"reason", truth->kind}},
                *film++);
  }
  if (!no_truth.empty()) {
    written.add_without_states(
        {{"label", "truth"}, {"engine", "truth"}, {"status", "unsupported"}, {"reason", no_truth}});
  }
  for (const Run* run : runs) {
    if (plays(*run)) {
      written.add(run_json(*run), *film++);
    } else {
      written.add_without_states(run_json(*run));
    }
  }
  Json json = {
      {"format", "carom-playback-2"},
      {"scene", scene_json(scenario)},
      {"balls", balls_json(scenario, cut.balls)},
      {"frames", {{"intervals", scenario.frames}, {"every", cut.every}, {"count", cut.frames.size()}}},
      {"rounding",
       {{"position_m", cut.grids.position_m},
        {"speed_mps", cut.grids.speed_mps},
        {"spin_radps", cut.grids.spin_radps}}},
      {"runs", written.take()},
      {"left_out", written.left_out()}};
  return {without_markup(json.dump(-1, ' ', false, Json::error_handler_t::replace)), written.left_out()};
}

}  // namespace carom
